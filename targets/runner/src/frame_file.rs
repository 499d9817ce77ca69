//! What the command line asks for, as a frame file.

use std::fs;
use std::path::Path;

use rhogrid::error::Error;
use rhogrid_frame::{Content, Frame, MAX_ASSETS, MAX_INSTANCES};

use crate::aligned::AlignedBytes;
use crate::failure;
use crate::machine::Machine;

/// A frame file in host memory.
#[derive(Debug)]
pub struct FrameFile(AlignedBytes);

impl FrameFile {
    /// Writes what is drawn.
    ///
    /// # Errors
    /// When it does not fit a frame file.
    pub fn new(content: &Content<'_>) -> Result<Self, Error> {
        let mut bytes = Vec::new();
        rhogrid_frame::write(content, |piece| bytes.extend_from_slice(piece)).ok_or_else(|| {
            failure(
                format!(
                    "a frame file is smaller than 4 GB, with at most {MAX_ASSETS} assets and \
                     {MAX_INSTANCES} instances"
                ),
                "use smaller or fewer assets",
            )
        })?;
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
    use rhogrid_core::draw::Quality;
    use rhogrid_core::numbers::{FocalPx, Length, Turns, Weight};
    use rhogrid_core::shadow::Shadows;
    use rhogrid_frame::{Placed, Settings, View};

    fn file(asset: &[u8], views: &[View]) -> FrameFile {
        let settings = Settings {
            width: 240,
            height: 320,
            ambient: Weight::ZERO,
            quality: Quality::default(),
            shadows: Shadows::default(),
        };
        let content = Content {
            settings,
            views,
            assets: &[asset],
            instances: &[Placed::ALONE],
            lamps: &[],
            matcap: None,
        };
        FrameFile::new(&content).expect("fits a file")
    }

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
        let file = file(b"asset", &[view; 2]);
        let frame = file.open().expect("opens");
        let assets: Vec<_> = frame.assets().collect();
        assert_eq!(assets, [b"asset"]);
        assert_eq!(assets[0].as_ptr().addr() % 4, 0);
        assert_eq!(frame.views().collect::<Vec<_>>(), [view; 2]);
    }

    #[test]
    fn too_large_for_a_machine_is_said() {
        let file = file(&vec![0; 16 << 20], &[]);
        let error = file.check_fits(&MACHINES[1]).expect_err("header and 16 MB");
        assert!(
            error.to_string().contains("m3 has room for 16777216"),
            "{error}"
        );
        assert_eq!(file.check_fits(&MACHINES[0]), Ok(()));
    }
}
