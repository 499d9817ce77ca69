//! Where a cell lands on the screen, and how much of it the cell covers.
//!
//! Source: Duguet and Drettakis 2003, 5.2 (bounds of a projected cell).

use super::tables::Point;
use crate::numbers::SCREEN_BITS;
use crate::projection::Projection;
use crate::reciprocal::{Reciprocal, reciprocal};
use crate::splat::Extent;
use crate::target::Rect;

/// Half sides of rectangles saturate here, at 2^17 px: a place is at most 2^30
/// and half a picture from zero, so that it and a half side add up.
const HALF_LIMIT: i32 = 1 << 29;

/// A projected centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Q20.12 pixels from the picture's top left corner.
    pub x: i32,
    pub y: i32,
    pub depth: u16,
}

impl Place {
    /// Projects a point in front of the eye, given 1 / w.
    #[inline(always)]
    pub fn of(projection: &Projection, point: Point, inverse: Reciprocal) -> Self {
        let scale = projection.screen_scale + SCREEN_BITS;
        let [middle_x, middle_y] = projection.middle;
        Self {
            x: inverse.times(point.x, scale) + middle_x.to_bits(),
            y: inverse.times(point.y, scale) + middle_y.to_bits(),
            depth: projection.depth(inverse),
        }
    }

    /// Whether a cell here lies wholly beside a band; a saturated half side
    /// reaches anywhere.
    pub fn is_outside(&self, extent: &Extent, band: Rect) -> bool {
        let pixel = |bound: u16| i32::from(bound) << SCREEN_BITS;
        let is_beside = |at: i32, half: i32, low: u16, high: u16| {
            // 1/16 px and 2^-16 of the half side: more than rounding.
            let reach = half + (half >> 16) + (1 << (SCREEN_BITS - 4));
            half < HALF_LIMIT && (at + reach < pixel(low) || at - reach > pixel(high))
        };
        let [half_x, half_y] = extent.half;
        is_beside(self.x, half_x, band.left, band.right)
            || is_beside(self.y, half_y, band.top, band.bottom)
    }
}

/// The extent of a cell whose centre has a given 1 / w and whose nearest
/// corner has the w `nearest`.
///
/// For a corner c + d: (X + dX) / (w + dw) - X / w = (dX - X / w dw) / (w +
/// dw), so half the rectangle's sides are at most the sum over the half edges
/// of |dX - X / w dw|, over the nearest w.
pub(super) fn extent(
    projection: &Projection,
    centre: Point,
    inverse: Reciprocal,
    half_edges: &[Point; 3],
    nearest: i32,
) -> Extent {
    let nearest_inverse = reciprocal(nearest as u32);
    let (mut sum_x, mut sum_y) = (0i32, 0i32);
    for edge in half_edges {
        // dw / w, Q2.30; saturates at one, which only a leaf that reaches
        // behind the eye exceeds: no rectangle bounds that one.
        let ratio = i64::from(inverse.times(edge.w, 30));
        let shear = |value: i32| ((i64::from(value) * ratio) >> 30) as i32;
        sum_x = sum_x.saturating_add((edge.x - shear(centre.x)).saturating_abs());
        sum_y = sum_y.saturating_add((edge.y - shear(centre.y)).saturating_abs());
    }
    let scale = projection.screen_scale + SCREEN_BITS;
    // The rim lies a cell's diagonal deeper, at least one step.
    let diagonal: i32 = half_edges.iter().map(|edge| edge.w.abs()).sum();
    let rim = reciprocal(centre.w.saturating_add(2 * diagonal) as u32);
    let drop = projection
        .depth(inverse)
        .saturating_sub(projection.depth(rim));
    Extent {
        half: [sum_x, sum_y].map(|sum| (nearest_inverse.times(sum, scale) + 1).min(HALF_LIMIT)),
        rim_drop: drop.saturating_add(1),
    }
}
