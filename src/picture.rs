//! Pictures of 8 bits a channel that know which pixels were drawn: from frames
//! and files, to PNG.

use std::io;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageReader};

use crate::error::Error;
use crate::output;

/// A picture. Pixels are row-major from the top left; both lists hold
/// `width * height` of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green and blue of each pixel.
    pub rgb: Vec<[u8; 3]>,
    /// Which pixels were drawn (alpha other than 0). The others count as black
    /// whatever their colour.
    pub drawn: Vec<bool>,
}

/// Widens 5:6:5 to 8 bits a channel by bit replication: 0 stays 0, full scale
/// becomes 255.
pub fn widen_rgb565(pixel: u16) -> [u8; 3] {
    let [red, green, blue] = [pixel >> 11, pixel >> 5 & 63, pixel & 31];
    let five = |bits: u16| (bits << 3 | bits >> 2) as u8;
    [five(red), (green << 2 | green >> 4) as u8, five(blue)]
}

/// The nearest RGB565 pixel of channels from 0 to 255.
pub fn rgb565(channels: [f64; 3]) -> u16 {
    let nearest = |value: f64, full: f64| (value / 255.0 * full).round().clamp(0.0, full) as u16;
    let [red, green, blue] = channels;
    nearest(red, 31.0) << 11 | nearest(green, 63.0) << 5 | nearest(blue, 31.0)
}

impl Picture {
    /// Widens a frame of `width * height` RGB565 pixels without stride.
    ///
    /// # Panics
    ///
    /// If `frame` or `drawn` holds another number of pixels.
    pub fn from_rgb565(width: u32, height: u32, frame: &[u16], drawn: Vec<bool>) -> Self {
        let count = width as usize * height as usize;
        assert_eq!(frame.len(), count, "pixels of the frame");
        assert_eq!(drawn.len(), count, "pixels of the drawn mask");
        Self {
            width,
            height,
            rgb: frame.iter().map(|&pixel| widen_rgb565(pixel)).collect(),
            drawn,
        }
    }

    /// Reads a PNG or JPEG file, told apart by content. Deeper channels are
    /// rounded to 8 bits; colour is not blended with alpha.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or is neither.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let open = || ImageReader::open(path)?.with_guessed_format();
        let reader = open().map_err(|error| {
            Error::file(path, format!("cannot be read: {error}"), "check the name")
        })?;
        let decoded = reader.decode().map_err(|error| {
            Error::file(
                path,
                format!("not a picture: {error}"),
                "give a whole PNG or JPEG file",
            )
        })?;
        let rgba = decoded.into_rgba8();
        Ok(Self {
            width: rgba.width(),
            height: rgba.height(),
            rgb: rgba
                .pixels()
                .map(|pixel| [pixel[0], pixel[1], pixel[2]])
                .collect(),
            drawn: rgba.pixels().map(|pixel| pixel[3] != 0).collect(),
        })
    }

    /// Writes a PNG with alpha, whole or not at all: 255 where drawn; where not,
    /// black with 0.
    ///
    /// # Errors
    ///
    /// If the file cannot be written or the picture is empty.
    pub fn save_png(&self, path: &Path) -> Result<(), Error> {
        let alpha = self.drawn.iter().map(|&drawn| if drawn { 255 } else { 0 });
        let rgba: Vec<u8> = self
            .seen()
            .zip(alpha)
            .flat_map(|([red, green, blue], alpha)| [red, green, blue, alpha])
            .collect();
        output::write_whole(path, |file| {
            PngEncoder::new(file)
                .write_image(&rgba, self.width, self.height, ExtendedColorType::Rgba8)
                .map_err(io::Error::other)
        })
    }

    /// The colours as they are seen: black where nothing was drawn.
    pub fn seen(&self) -> impl Iterator<Item = [u8; 3]> + Clone {
        self.rgb
            .iter()
            .zip(&self.drawn)
            .map(|(&rgb, &drawn)| if drawn { rgb } else { [0; 3] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn sample() -> Picture {
        Picture {
            width: 3,
            height: 2,
            rgb: vec![
                [0, 0, 0],
                [255, 1, 2],
                [9, 8, 7],
                [0, 255, 128],
                [1, 1, 1],
                [0, 0, 0],
            ],
            drawn: vec![true, true, true, true, true, false],
        }
    }

    #[test]
    fn widening_replicates_bits() {
        assert_eq!(widen_rgb565(0), [0, 0, 0]);
        assert_eq!(widen_rgb565(0xffff), [255, 255, 255]);
        assert_eq!(widen_rgb565(16 << 11 | 1 << 5 | 15), [132, 4, 123]);
        for pixel in 0..=u16::MAX {
            let [red, green, blue] = widen_rgb565(pixel).map(u16::from);
            assert_eq!((red >> 3) << 11 | (green >> 2) << 5 | blue >> 3, pixel);
            assert_eq!(rgb565([red, green, blue].map(f64::from)), pixel);
        }
    }

    #[test]
    fn png_round_trip_keeps_every_pixel() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        sample().save_png(&path).unwrap();
        assert_eq!(Picture::load(&path).unwrap(), sample());
    }

    #[test]
    fn undrawn_pixels_are_saved_black() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        let mut picture = sample();
        picture.rgb[5] = [200, 100, 50];
        picture.save_png(&path).unwrap();
        assert_eq!(Picture::load(&path).unwrap(), sample());
    }

    #[test]
    fn broken_files_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        sample().save_png(&path).unwrap();
        let whole = fs::read(&path).unwrap();
        for length in [0, 4, 20, whole.len() / 2] {
            fs::write(&path, &whole[..length]).unwrap();
            let message = Picture::load(&path).unwrap_err().to_string();
            assert!(message.contains("frame.png"), "{length} bytes: {message}");
        }
        let message = Picture::load(&folder.path().join("none.png"))
            .unwrap_err()
            .to_string();
        assert!(message.contains("cannot be read"), "{message}");
    }
}
