//! A screendump, back to the 16-bit words that the machine's screen was given.
//!
//! QEMU widens 5:6:5 by shifts; other versions may replicate bits. The upper
//! bits are the same either way, so the words are recovered exactly.

use std::fs;
use std::path::{Path, PathBuf};

use rhogrid::error::{Error, Place};
use rhogrid::picture::Picture;

/// A picture of 8-bit red, green and blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Screen {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl Screen {
    /// Reads a binary PPM with 8-bit values.
    ///
    /// # Errors
    /// When the file is anything else.
    pub fn read(file: &Path) -> Result<Self, Error> {
        let bytes = fs::read(file).map_err(|error| Error::file(file, error.to_string(), ""))?;
        Self::parse(&bytes)
            .map_err(|offset| Error::at(file, Place::Byte(offset), "not an 8-bit binary PPM", ""))
    }

    /// Parses a binary PPM; the error is the offset of what is wrong.
    fn parse(bytes: &[u8]) -> Result<Self, u64> {
        let mut offset = 0;
        if !bytes.starts_with(b"P6") {
            return Err(0);
        }
        offset += 2;
        let [width, height, max] = [(); 3].map(|()| number(bytes, &mut offset));
        let (width, height) = (width?, height?);
        if max? != 255 {
            return Err(offset as u64);
        }
        // One white space behind the header.
        let rgb = bytes.get(offset + 1..).unwrap_or(&[]);
        let expected = u64::from(width) * u64::from(height) * 3;
        if width == 0 || height == 0 || rgb.len() as u64 != expected {
            return Err(bytes.len() as u64);
        }
        Ok(Self {
            width,
            height,
            rgb: rgb.to_vec(),
        })
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The words that were widened to this picture.
    pub fn rgb565(&self) -> Vec<u16> {
        self.rgb
            .chunks_exact(3)
            .map(|rgb| {
                let [red, green, blue] = [rgb[0], rgb[1], rgb[2]].map(u16::from);
                red >> 3 << 11 | green >> 2 << 5 | blue >> 3
            })
            .collect()
    }
}

/// The next decimal number of a PPM header, behind white space and comments.
fn number(bytes: &[u8], offset: &mut usize) -> Result<u32, u64> {
    let mut in_comment = false;
    while let Some(byte) = bytes.get(*offset) {
        match byte {
            b'#' => in_comment = true,
            b'\n' => in_comment = false,
            b'0'..=b'9' if !in_comment => break,
            _ if in_comment || byte.is_ascii_whitespace() => {}
            _ => return Err(*offset as u64),
        }
        *offset += 1;
    }
    let start = *offset;
    while bytes.get(*offset).is_some_and(u8::is_ascii_digit) {
        *offset += 1;
    }
    std::str::from_utf8(&bytes[start..*offset])
        .ok()
        .and_then(|digits| digits.parse().ok())
        .ok_or(start as u64)
}

/// Where a screen differs from what it should show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// How many pixels differ.
    pub pixels: usize,
    /// Column and row of the first.
    pub first: (usize, usize),
}

/// Compares words, row by row.
///
/// # Errors
/// When they differ.
pub fn compare(actual: &[u16], expected: &[u16], width: usize) -> Result<(), Difference> {
    let missing = actual.len().abs_diff(expected.len());
    let differing = |(_, (a, b)): &(usize, (&u16, &u16))| a != b;
    let mut pairs = actual.iter().zip(expected).enumerate().filter(differing);
    let first = pairs.next().map(|(index, _)| index);
    let pixels = pairs.count() + usize::from(first.is_some()) + missing;
    if pixels == 0 {
        return Ok(());
    }
    let index = first.unwrap_or(actual.len().min(expected.len()));
    let width = width.max(1);
    Err(Difference {
        pixels,
        first: (index % width, index / width),
    })
}

/// Writes `NAME-actual.png`, `NAME-expected.png` and `NAME-difference.png`
/// (white where they differ) into a folder; returns their paths.
///
/// # Errors
/// When that fails.
pub fn save_difference(
    folder: &Path,
    name: &str,
    actual: &Screen,
    expected: &[u16],
) -> Result<[PathBuf; 3], Error> {
    fs::create_dir_all(folder).map_err(|error| Error::file(folder, error.to_string(), ""))?;
    let (width, height) = actual.size();
    let pairs = actual.rgb565().into_iter().zip(expected);
    let marks: Vec<u16> = pairs
        .map(|(a, b)| if a == *b { 0 } else { u16::MAX })
        .collect();
    let paths = ["actual", "expected", "difference"]
        .map(|which| folder.join(format!("{name}-{which}.png")));
    let pictures = [&actual.rgb565(), expected, &marks];
    for (path, words) in paths.iter().zip(pictures) {
        let drawn = vec![true; words.len()];
        Picture::from_rgb565(width, height, words, drawn).save_png(path)?;
    }
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rhogrid::picture::widen_rgb565;

    #[test]
    fn every_word_survives_both_ways_of_widening() {
        let words: Vec<u16> = (0..=u16::MAX).collect();
        let shift = |word: u16| {
            let [red, green, blue] = [word >> 11 << 3, (word >> 5 & 63) << 2, (word & 31) << 3];
            [red as u8, green as u8, blue as u8]
        };
        for widen in [widen_rgb565, shift] {
            let screen = Screen {
                width: 256,
                height: 256,
                rgb: words.iter().flat_map(|word| widen(*word)).collect(),
            };
            assert_eq!(screen.rgb565(), words);
        }
    }

    #[test]
    fn a_ppm_is_parsed() {
        let screen = Screen::parse(b"P6 # of QEMU 1 2\n2 1\n255\n\x0a\x20\x30ABC").expect("parses");
        assert_eq!(screen.size(), (2, 1));
        assert_eq!(screen.rgb, b"\x0a\x20\x30ABC");
    }

    #[test]
    fn broken_ppms_are_refused_where_they_break() {
        let cases: [(&[u8], u64); 7] = [
            (b"", 0),
            (b"P5\n2 1\n255\n123456", 0),
            (b"P6\n2 x\n255\n", 5),
            (b"P6\n2 1\n65535\n123456789012", 12),
            (b"P6\n2 1\n255\n12345", 16),
            (b"P6\n0 1\n255\n", 11),
            (b"P6\n99999999999 1\n255\n", 3),
        ];
        for (bytes, offset) in cases {
            assert_eq!(Screen::parse(bytes), Err(offset), "{bytes:?}");
        }
    }

    #[test]
    fn differences_are_counted_and_placed() {
        assert_eq!(compare(&[1, 2, 3, 4], &[1, 2, 3, 4], 2), Ok(()));
        let two = Difference {
            pixels: 2,
            first: (1, 0),
        };
        assert_eq!(compare(&[1, 9, 3, 9], &[1, 2, 3, 4], 2), Err(two));
        let short = Difference {
            pixels: 1,
            first: (1, 1),
        };
        assert_eq!(compare(&[1, 2, 3], &[1, 2, 3, 4], 2), Err(short));
    }

    #[test]
    fn pictures_of_a_difference_are_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let actual = Screen {
            width: 2,
            height: 1,
            rgb: [widen_rgb565(5), widen_rgb565(6)].concat(),
        };
        let paths = save_difference(folder.path(), "m", &actual, &[5, 7]).expect("writes");
        let difference = Picture::load(&paths[2]).expect("a PNG");
        assert_eq!(difference.rgb, [[0; 3], [255; 3]]);
    }
}
