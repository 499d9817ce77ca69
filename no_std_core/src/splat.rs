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

impl Extent {
    /// Whether no pixel but the home pixel can be covered: half sides below
    /// half a pixel.
    pub fn is_point(&self) -> bool {
        let [half_x, half_y] = self.half;
        half_x.max(half_y) < SCREEN_ONE / 2
    }
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

/// Draws a splat that covers its home pixel alone.
#[inline(always)]
pub(crate) fn draw_point(
    target: &mut Target<'_>,
    stats: &mut Stats,
    [x, y]: [i32; 2],
    depth: u16,
    colour: impl FnOnce() -> u16,
) {
    let band = target.band;
    let column = (x - i32::from(band.left)) as usize;
    let row = (y - i32::from(band.top)) as usize;
    if column >= band.width() || row >= band.height() {
        return;
    }
    let index = row * band.width() + column;
    if let (Some(own_depth), Some(own_colour)) =
        (target.depth.get_mut(index), target.colour.get_mut(index))
        && depth > *own_depth
    {
        *own_depth = depth;
        *own_colour = colour();
        stats.pixels_written += 1;
    }
}

/// Draws one splat. A function of its own: a traversal that also holds its
/// registers would spill them for every leaf.
#[inline(never)]
pub(crate) fn draw(target: &mut Target<'_>, stats: &mut Stats, splat: &Splat, extent: &Extent) {
    let band = target.band;
    let [half_x, half_y] = extent.half;
    let (left, right) = span(splat.x, half_x, band.left, band.right);
    let (top, bottom) = span(splat.y, half_y, band.top, band.bottom);
    if left >= right || top >= bottom {
        return;
    }
    let home = [splat.x >> SCREEN_BITS, splat.y >> SCREEN_BITS];
    if right - left == 1 && bottom - top == 1 && home == [left, top] {
        return draw_point(target, stats, home, splat.depth, || splat.colour);
    }
    // The core: centres within half the half extent.
    let (core_left, core_right) = span(splat.x, half_x / 2, band.left, band.right);
    let (core_top, core_bottom) = span(splat.y, half_y / 2, band.top, band.bottom);
    let rim_depth = splat.depth.saturating_sub(extent.rim_drop).max(1);
    // One unsigned comparison tells whether a pixel is in the core.
    let core_first = (core_left - left) as u32;
    let core_columns = (core_right - core_left).max(0) as u32;
    let pitch = band.width();
    let columns = (right - left) as usize;
    let mut start =
        (top - i32::from(band.top)) as usize * pitch + (left - i32::from(band.left)) as usize;
    for row in top..bottom {
        let (Some(colours), Some(depths)) = (
            target.colour.get_mut(start..start + columns),
            target.depth.get_mut(start..start + columns),
        ) else {
            return;
        };
        let core_columns = if row >= core_top && row < core_bottom {
            core_columns
        } else {
            0
        };
        for ((colour, depth), column) in colours.iter_mut().zip(depths).zip(0u32..) {
            let in_core = column.wrapping_sub(core_first) < core_columns;
            let candidate = if in_core { splat.depth } else { rim_depth };
            if candidate > *depth {
                *depth = candidate;
                *colour = splat.colour;
                stats.pixels_written += 1;
            }
        }
        start += pitch;
    }
}

#[cfg(test)]
mod tests;
