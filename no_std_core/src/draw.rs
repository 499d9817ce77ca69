//! One frame, from cleared buffers to pixels.

use crate::asset::Grid;
use crate::camera::Camera;
use crate::grid::traverse;
use crate::normal::CODES;
use crate::numbers::{SplatPx, Unit, Weight};
use crate::shade::Shader;
use crate::stats::Stats;
use crate::target::Target;

/// A directional light and the weights of the shading model: colour =
/// material * (ambient + diffuse * max(0, normal . towards)), no gamma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light {
    /// Unit vector towards the light, model space.
    pub towards: [Unit; 3],
    /// Ambient weight.
    pub ambient: Weight,
    /// Diffuse weight.
    pub diffuse: Weight,
}

/// The knobs of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// A cell whose projected bounding rectangle has no side longer than
    /// this is drawn as one splat.
    pub splat: SplatPx,
    /// Leaves of a block are placed by additions in screen space where that
    /// errs by at most so many pixels; zero projects each of them.
    pub distortion: SplatPx,
}

impl Quality {
    /// The distortion that is allowed unless somebody says otherwise, pixels.
    pub const DISTORTION: SplatPx = SplatPx::lit("0.125");
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            splat: SplatPx::ONE,
            distortion: Self::DISTORTION,
        }
    }
}

/// Length of the shade table of a grid: 8192 words for each material.
pub const fn shades_len(material_count: usize) -> usize {
    CODES * material_count
}

/// Clears the target and draws a grid into it. Cannot fail.
///
/// `shades` is memory for a frame's colours, [`shades_len`] words; where it
/// is shorter, samples are shaded one by one, to the same bytes.
pub fn draw(
    grid: &Grid<'_>,
    camera: &Camera,
    light: &Light,
    quality: &Quality,
    shades: &mut [u16],
    target: &mut Target<'_>,
) -> Stats {
    target.clear();
    let shader = Shader::new(light, grid.materials(), shades);
    traverse(grid, camera, quality, &shader, target)
}

#[cfg(test)]
mod tests;
