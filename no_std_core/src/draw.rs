//! One frame, from cleared buffers to pixels.

mod stages;

use crate::asset::Grid;
use crate::camera::Camera;
use crate::canvas::Pixel;
use crate::grid::traverse;
use crate::normal::CODES;
use crate::numbers::{SplatPx, Unit, Weight};
use crate::plan::Plan;
use crate::projection::Projection;
use crate::shade::Paint;
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
    /// Cells with an edge of at most so many pixels, at their distance, are
    /// drawn as one sample each; the cell above decides for all its children.
    pub splat: SplatPx,
    /// The last one or two levels are walked by additions in screen space
    /// where that errs by at most so many pixels, and their cells are drawn as
    /// points. That is a bound that a subtree's corners reach in the worst
    /// view; at zero each cell is projected and drawn as a splat that covers
    /// it.
    pub distortion: SplatPx,
    /// Whether pixels that points have missed are closed: see
    /// [`crate::target::Target`].
    pub repair: bool,
    /// Whether what faces away or is hidden is left out. Without it each surface
    /// is drawn from both sides as it is, and costs what it would in full view:
    /// to measure what a sample costs.
    pub culling: bool,
}

impl Quality {
    /// The largest cell that is one sample unless somebody says otherwise,
    /// pixels.
    pub const SPLAT: SplatPx = SplatPx::lit("1.25");
    /// The distortion that is allowed unless somebody says otherwise, pixels.
    pub const DISTORTION: SplatPx = SplatPx::ONE;
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            splat: Self::SPLAT,
            distortion: Self::DISTORTION,
            repair: true,
            culling: true,
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
/// is shorter, or where few pixels can show anything, they are shaded one by
/// one, to the same bytes.
///
/// Samples with colours of their own take two words of the canvas a pixel: of a
/// canvas for so many rows, about half. A canvas of less than twice
/// [`crate::target::canvas_len`] of one row shows their materials instead.
pub fn draw(
    grid: &Grid<'_>,
    camera: &Camera,
    light: &Light,
    quality: &Quality,
    shades: &mut [u16],
    target: &mut Target<'_>,
) -> Stats {
    let view = (camera, quality);
    match Paint::of(grid, target.canvas.len()) {
        paint @ Paint::Samples(_) => {
            draw_on::<[u32; 2]>(grid, view, light, (paint, shades), target)
        }
        paint => draw_on::<u32>(grid, view, light, (paint, shades), target),
    }
}

/// The same with pixels of one kind.
#[inline(always)]
fn draw_on<P: Pixel>(
    grid: &Grid<'_>,
    (camera, quality): (&Camera, &Quality),
    light: &Light,
    (paint, shades): (Paint<'_>, &mut [u16]),
    target: &mut Target<'_>,
) -> Stats {
    let projection = Projection::new(camera);
    let plan = Plan::with(grid, camera, quality, &projection);
    let shades = if plan.tabulates { shades } else { &mut [] };
    let shader = stages::shade(light, paint, shades);
    let mut stats = Stats::default();
    for strip in target.strips::<P>() {
        let mut canvas = stages::clear::<P>(target.canvas, strip.intersection(plan.part));
        if canvas.strip.pixels() > 0 {
            traverse(
                grid,
                camera.eye,
                &projection,
                &plan,
                &mut canvas,
                &mut stats,
            );
        }
        stages::resolve(&canvas, strip, &plan, &shader, &mut target.picture);
    }
    stats
}

#[cfg(test)]
mod tests;
