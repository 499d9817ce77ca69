//! What the command line asks for, as a frame file.

use std::fs;
use std::path::Path;

use rhogrid::error::Error;
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{Length, SplatPx, Unit, Weight};
use rhogrid_frame::{Frame, Settings};

use crate::asset::AlignedBytes;
use crate::failure;
use crate::machine::Machine;
use crate::views::{HEIGHT, View, WIDTH};

const AMBIENT: f64 = 0.2;
const DIFFUSE: f64 = 0.8;

/// A light from a direction of any length.
///
/// # Errors
/// When it has no direction.
pub fn light(towards: [f64; 3]) -> Result<Light, String> {
    let scale = towards.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let scaled = towards.map(|component| component / scale);
    let length = scaled.iter().map(|c| c * c).sum::<f64>().sqrt();
    if !(scale.is_finite() && scale > 0.0 && length.is_finite()) {
        return Err("a light's direction is X,Y,Z and not zero".to_owned());
    }
    Ok(Light {
        towards: scaled.map(|component| Unit::from_num(component / length)),
        ambient: Weight::from_num(AMBIENT),
        diffuse: Weight::from_num(DIFFUSE),
    })
}

/// Options from numbers.
///
/// # Errors
/// When the splat size is not one.
pub fn quality(splat_px: f64) -> Result<Quality, String> {
    SplatPx::checked_from_num(splat_px)
        .map(|splat| Quality { splat })
        .ok_or_else(|| format!("a splat size is between 0 and {} pixels", SplatPx::MAX))
}

/// A frame file in host memory.
#[derive(Debug)]
pub struct FrameFile(AlignedBytes);

impl FrameFile {
    /// Writes the views of an asset.
    ///
    /// # Errors
    /// When they do not fit a frame file.
    pub fn new(
        asset: &[u8],
        radius: Length,
        views: &[View],
        light: Light,
        quality: Quality,
    ) -> Result<Self, Error> {
        let settings = Settings {
            width: WIDTH,
            height: HEIGHT,
            light,
            quality,
        };
        let cameras: Vec<rhogrid_frame::View> = views
            .iter()
            .map(|view| rhogrid_frame::View {
                warm_up: view.warm_up(radius),
                measured: view.camera(radius),
            })
            .collect();
        let mut bytes = Vec::new();
        let put = |piece: &[u8]| bytes.extend_from_slice(piece);
        rhogrid_frame::write(&settings, &cameras, asset, put)
            .ok_or_else(|| failure("a frame file is smaller than 4 GB", "use a smaller asset"))?;
        Ok(Self(AlignedBytes::new(&bytes)))
    }

    /// What was written, read back.
    ///
    /// # Errors
    /// Never, for files that [`FrameFile::new`] made.
    pub fn open(&self) -> Result<Frame<'_>, Error> {
        Frame::open(self.0.bytes())
            .map_err(|error| failure(format!("the frame file is broken: {error:?}"), ""))
    }

    /// Checks that the file fits into a machine.
    ///
    /// # Errors
    /// When it does not.
    pub fn check_fits(&self, machine: &Machine) -> Result<(), Error> {
        let (length, room) = (self.0.bytes().len(), machine.window.length as usize);
        if length > room {
            return Err(failure(
                format!(
                    "the frame file has {length} bytes, and {} has room for {room}",
                    machine.name
                ),
                "use a coarser asset",
            ));
        }
        Ok(())
    }

    /// Writes the file for QEMU to load.
    ///
    /// # Errors
    /// When that fails.
    pub fn save(&self, file: &Path) -> Result<(), Error> {
        fs::write(file, self.0.bytes())
            .map_err(|error| Error::file(file, error.to_string(), "make room there"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::MACHINES;
    use crate::views;

    const TOWARDS: [f64; 3] = [1.0, 2.0, 1.5];

    #[test]
    fn lights_are_unit_vectors() {
        for towards in [TOWARDS, [0.0, -1e300, 1e300], [1e-310, 0.0, 0.0]] {
            let light = light(towards).expect("a direction");
            let length: f64 = light
                .towards
                .iter()
                .map(|c| c.to_num::<f64>().powi(2))
                .sum();
            assert!((length - 1.0).abs() < 1e-8, "{towards:?}");
        }
        for towards in [[0.0; 3], [f64::NAN, 1.0, 0.0], [f64::INFINITY, 0.0, 0.0]] {
            assert!(light(towards).is_err(), "{towards:?}");
        }
    }

    #[test]
    fn splat_sizes_are_checked() {
        assert_eq!(quality(1.0), Ok(Quality::default()));
        for splat in [-1.0, 65_536.0, f64::NAN, f64::INFINITY] {
            assert!(quality(splat).is_err(), "{splat}");
        }
    }

    #[test]
    fn all_views_are_in_the_file() {
        let light = light(TOWARDS).expect("a direction");
        let standard = views::standard();
        let file = FrameFile::new(b"asset", Length::ONE, &standard, light, Quality::default())
            .expect("fits");
        let frame = file.open().expect("opens");
        assert_eq!(frame.asset(), b"asset");
        let cameras: Vec<_> = frame.views().map(|view| view.measured).collect();
        let expected: Vec<_> = standard.iter().map(|v| v.camera(Length::ONE)).collect();
        assert_eq!(cameras, expected);
    }

    #[test]
    fn too_large_for_a_machine_is_said() {
        let light = light(TOWARDS).expect("a direction");
        let asset = vec![0; 16 << 20];
        let file = FrameFile::new(&asset, Length::ONE, &[], light, Quality::default())
            .expect("fits a file");
        let error = file.check_fits(&MACHINES[1]).expect_err("header and 16 MB");
        assert!(
            error.to_string().contains("m3 has room for 16777216"),
            "{error}"
        );
        assert_eq!(file.check_fits(&MACHINES[0]), Ok(()));
    }
}
