//! The same frames, by the same core, on the host.

use rhogrid::cli::draw_frame;
use rhogrid::error::Error;
use rhogrid_core::asset::Grid;

use crate::failure;
use crate::frame_file::FrameFile;

/// A picture of the host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HostFrame {
    /// RGB565, row-major.
    pub colour: Vec<u16>,
    /// Its hash.
    pub hash: u32,
}

/// Draws every measured view of a frame file, each into memory of its own.
///
/// # Errors
/// When the core refuses the asset.
pub fn render(file: &FrameFile) -> Result<Vec<HostFrame>, Error> {
    let frame = file.open()?;
    let settings = frame.settings();
    let grid = Grid::open(frame.asset()).map_err(|error| failure(error.to_string(), ""))?;
    let one_view = |view: rhogrid_frame::View| {
        let (light, quality) = (&settings.light, &settings.quality);
        let drawn = draw_frame(&grid, &view.measured, light, quality, 1);
        HostFrame {
            hash: drawn.hash(),
            colour: drawn.colour,
        }
    };
    Ok(frame.views().map(one_view).collect())
}
