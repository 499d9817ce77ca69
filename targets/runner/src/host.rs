//! The same frames, by the same core, on the host.

use rhogrid::error::Error;
use rhogrid_core::asset::Grid;
use rhogrid_core::draw::draw;
use rhogrid_core::target::{Target, frame_hash};

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
/// When the core refuses the asset or the size.
pub fn render(file: &FrameFile) -> Result<Vec<HostFrame>, Error> {
    let frame = file.open()?;
    let settings = frame.settings();
    let grid = Grid::open(frame.asset())
        .map_err(|error| failure(format!("not a usable asset: {error:?}"), ""))?;
    let pixels = usize::from(settings.width) * usize::from(settings.height);
    let one_view = |view: rhogrid_frame::View| {
        let mut colour = vec![0; pixels];
        let mut depth = vec![0; pixels];
        let mut shades = vec![0; grid.shades_len()];
        let mut target = Target::new(settings.width, settings.height, &mut colour, &mut depth)
            .map_err(|error| failure(format!("not a picture size: {error:?}"), ""))?;
        let (light, quality) = (&settings.light, &settings.quality);
        draw(
            &grid,
            &view.measured,
            light,
            quality,
            &mut shades,
            &mut target,
        );
        let hash = frame_hash(&colour);
        Ok(HostFrame { colour, hash })
    };
    frame.views().map(one_view).collect()
}
