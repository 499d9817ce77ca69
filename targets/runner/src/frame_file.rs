//! What the command line asks for, as a frame file.

use std::fs;
use std::path::Path;

use rhogrid::error::Error;
use rhogrid_core::draw::{Light, Quality};
use rhogrid_frame::{Frame, Settings, View};

use crate::aligned::AlignedBytes;
use crate::failure;
use crate::machine::Machine;

/// A frame file in host memory.
#[derive(Debug)]
pub struct FrameFile(AlignedBytes);

impl FrameFile {
    /// Writes cameras, all of one size, and an asset.
    ///
    /// # Errors
    /// When they do not fit a frame file.
    pub fn new(
        asset: &[u8],
        views: &[View],
        light: Light,
        quality: Quality,
    ) -> Result<Self, Error> {
        let size = views.first().map(|view| view.measured);
        let settings = Settings {
            width: size.map_or(0, |camera| camera.width),
            height: size.map_or(0, |camera| camera.height),
            light,
            quality,
        };
        let mut bytes = Vec::new();
        let put = |piece: &[u8]| bytes.extend_from_slice(piece);
        rhogrid_frame::write(&settings, views, asset, put)
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
    use rhogrid_core::camera::{Camera, Orbit};
    use rhogrid_core::numbers::{FocalPx, Length, Turns, Unit, Weight};

    const LIGHT: Light = Light {
        towards: [Unit::ONE, Unit::ZERO, Unit::ZERO],
        ambient: Weight::ZERO,
        diffuse: Weight::ONE,
    };

    #[test]
    fn views_and_asset_are_in_the_file() {
        let orbit = Orbit {
            yaw: Turns::ZERO,
            pitch: Turns::ZERO,
            distance: Length::ONE,
        };
        let camera = Camera::orbit(&orbit, FocalPx::from_num(320), 240, 320);
        let view = View {
            warm_up: camera,
            measured: camera,
        };
        let file = FrameFile::new(b"asset", &[view; 2], LIGHT, Quality::default()).expect("fits");
        let frame = file.open().expect("opens");
        assert_eq!(frame.asset(), b"asset");
        assert_eq!(frame.asset().as_ptr().addr() % 4, 0);
        assert_eq!(frame.views().collect::<Vec<_>>(), [view; 2]);
    }

    #[test]
    fn too_large_for_a_machine_is_said() {
        let asset = vec![0; 16 << 20];
        let file = FrameFile::new(&asset, &[], LIGHT, Quality::default()).expect("fits a file");
        let error = file.check_fits(&MACHINES[1]).expect_err("header and 16 MB");
        assert!(
            error.to_string().contains("m3 has room for 16777216"),
            "{error}"
        );
        assert_eq!(file.check_fits(&MACHINES[0]), Ok(()));
    }
}
