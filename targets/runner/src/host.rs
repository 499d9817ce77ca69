//! The same frames, by the same core, on the host.

use rhogrid::cli::{draw_frame, draw_placed};
use rhogrid::error::Error;
use rhogrid_core::asset::Grid;
use rhogrid_core::scene::{Instance, Lighting, Scene};
use rhogrid_frame::{Materials, Placed, View};

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
/// When the core refuses an asset.
pub fn render(file: &FrameFile) -> Result<Vec<HostFrame>, Error> {
    let frame = file.open()?;
    let settings = frame.settings();
    let grids: Result<Vec<_>, Error> = frame
        .assets()
        .map(|asset| Grid::open(asset).map_err(|error| failure(error.to_string(), "")))
        .collect();
    let grids = grids?;
    let placed: Vec<Placed> = frame.instances().collect();
    let instances: Vec<Instance<'_>> = placed
        .iter()
        .map(|placed| Instance {
            grid: &grids[placed.asset as usize],
            placement: placed.placement,
            materials: placed.materials.as_ref().map(Materials::as_slice),
        })
        .collect();
    let lamps: Vec<_> = frame.lamps().collect();
    let scene = Scene {
        instances: &instances,
        lighting: Lighting {
            ambient: settings.ambient,
            matcap: frame.matcap(),
            lamps: &lamps,
        },
        shadows: settings.shadows,
    };
    let quality = &settings.quality;
    let one_view = |view: View| {
        let drawn = match frame.lone_light() {
            Some(light) => draw_frame(&grids[0], &view.measured, &light, quality, 1),
            None => draw_placed(&scene, &view.measured, quality, 1),
        };
        HostFrame {
            hash: drawn.hash(),
            colour: drawn.colour,
        }
    };
    Ok(frame.views().map(one_view).collect())
}
