//! Square splats: a sample becomes pixels.
//!
//! A splat covers the pixels whose centres lie in the projected bounding
//! rectangle of its cell, and always the pixel that holds its centre, so that
//! cells that tile a surface leave no holes. Its *core*, the pixels around
//! the centre, has the sample's depth; the *rim* lies `rim_drop` deeper: it
//! fills gaps between cores but does not cover a neighbour's core, which
//! knows the surface there better.

use crate::canvas::{AROUND, Canvas, Pixel};
use crate::numbers::{SCREEN_BITS, SCREEN_ONE};

/// Size of the splats of one block of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    /// Half the width and height, Q20.12 pixels.
    pub half: [i32; 2],
    /// How much deeper the rim lies, depth units.
    pub rim_drop: u16,
}

/// One sample on the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Splat<S> {
    /// Centre, Q20.12 pixels from the picture's top left corner.
    pub x: i32,
    pub y: i32,
    pub depth: u16,
    pub attribute: u16,
    /// See [`Pixel::Sample`].
    pub sample: S,
}

/// First pixel and the pixel behind the last whose centres lie in [centre -
/// half, centre + half), with the pixel that holds the centre; clipped.
#[inline(always)]
fn span(centre: i32, half: i32, first: i32, end: i32) -> (i32, i32) {
    const ROUND: i32 = SCREEN_ONE / 2 - 1;
    let home = centre >> SCREEN_BITS;
    let low = (centre - half + ROUND) >> SCREEN_BITS;
    let high = (centre + half + ROUND) >> SCREEN_BITS;
    (low.min(home).max(first), high.max(home + 1).min(end))
}

/// Draws one splat. A function of its own: a traversal that also holds its
/// registers would spill them for every leaf.
#[inline(never)]
pub(crate) fn draw<P: Pixel>(
    canvas: &mut Canvas<'_, P>,
    splat: &Splat<P::Sample>,
    extent: &Extent,
) {
    let strip = canvas.strip;
    let within =
        |first: u16, end: u16, around: i32| [i32::from(first) - around, i32::from(end) + around];
    let [half_x, half_y] = extent.half;
    let columns = within(strip.left, strip.right, AROUND[0]);
    let rows = within(strip.top, strip.bottom, AROUND[1]);
    let (left, right) = span(splat.x, half_x, columns[0], columns[1]);
    let (top, bottom) = span(splat.y, half_y, rows[0], rows[1]);
    if left >= right || top >= bottom {
        return;
    }
    // The core: centres within half the half extent.
    let (core_left, core_right) = span(splat.x, half_x / 2, columns[0], columns[1]);
    let (core_top, core_bottom) = span(splat.y, half_y / 2, rows[0], rows[1]);
    let rim_depth = splat.depth.saturating_sub(extent.rim_drop).max(1);
    let core = u32::from(splat.depth) << 16;
    let rim = u32::from(rim_depth) << 16;
    // One unsigned comparison tells whether a pixel is in the core.
    let core_first = (core_left - left) as u32;
    let core_columns = (core_right - core_left).max(0) as u32;
    for (pixels, row) in canvas.rows([left, right], [top, bottom]).zip(top..) {
        let core_columns = if row >= core_top && row < core_bottom {
            core_columns
        } else {
            0
        };
        for (pixel, column) in pixels.iter_mut().zip(0u32..) {
            let in_core = column.wrapping_sub(core_first) < core_columns;
            let depth = if in_core { core } else { rim };
            if depth > pixel.word() {
                *pixel = P::new(depth | u32::from(splat.attribute), splat.sample);
            }
        }
    }
}

#[cfg(test)]
mod tests;
