//! Square splats: a sample becomes pixels.
//!
//! A splat covers the pixels whose centres lie in the projected bounding
//! rectangle of its cell, and always the pixel that holds its centre, so that
//! cells that tile a surface leave no holes. Its *core*, the pixels around
//! the centre, has the sample's depth; the *rim* lies `rim_drop` deeper: it
//! fills gaps between cores but does not cover a neighbour's core, which
//! knows the surface there better.

use crate::numbers::{SCREEN_BITS, SCREEN_ONE};
use crate::stats::Stats;
use crate::target::Target;

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
pub(crate) struct Splat {
    /// Centre, Q20.12 pixels from the picture's top left corner.
    pub x: i32,
    pub y: i32,
    pub depth: u16,
    pub colour: u16,
}

/// First pixel and the pixel behind the last whose centres lie in [centre -
/// half, centre + half), with the pixel that holds the centre; clipped.
#[inline(always)]
fn span(centre: i32, half: i32, first: u16, end: u16) -> (i32, i32) {
    const ROUND: i32 = SCREEN_ONE / 2 - 1;
    let home = centre >> SCREEN_BITS;
    let low = (centre - half + ROUND) >> SCREEN_BITS;
    let high = (centre + half + ROUND) >> SCREEN_BITS;
    (
        low.min(home).max(i32::from(first)),
        high.max(home + 1).min(i32::from(end)),
    )
}

/// Draws one splat.
#[inline(always)]
pub(crate) fn draw(target: &mut Target<'_>, stats: &mut Stats, splat: &Splat, extent: &Extent) {
    let band = target.band;
    let (left, right) = span(splat.x, extent.half[0], band.left, band.right);
    let (top, bottom) = span(splat.y, extent.half[1], band.top, band.bottom);
    if left >= right || top >= bottom {
        return;
    }
    // The core: centres within half the half extent.
    let (core_left, core_right) = span(splat.x, extent.half[0] / 2, band.left, band.right);
    let (core_top, core_bottom) = span(splat.y, extent.half[1] / 2, band.top, band.bottom);
    let rim_depth = splat.depth.saturating_sub(extent.rim_drop).max(1);
    let pitch = band.width();
    for row in top..bottom {
        let start = (row - i32::from(band.top)) as usize * pitch;
        let columns = start + (left - i32::from(band.left)) as usize
            ..start + (right - i32::from(band.left)) as usize;
        let (Some(colours), Some(depths)) = (
            target.colour.get_mut(columns.clone()),
            target.depth.get_mut(columns),
        ) else {
            return;
        };
        let in_core = row >= core_top && row < core_bottom;
        for ((colour, depth), column) in colours.iter_mut().zip(depths).zip(left..) {
            let core = in_core && column >= core_left && column < core_right;
            let candidate = if core { splat.depth } else { rim_depth };
            if candidate > *depth {
                *depth = candidate;
                *colour = splat.colour;
                stats.pixels_written += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests;
