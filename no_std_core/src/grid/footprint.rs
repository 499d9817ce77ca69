//! Where a cell lands on the screen, and how much of it the cell covers.
//!
//! Source: Duguet and Drettakis 2003, 5.2 (bounds of a projected cell).

use super::packed::Step;
use super::tables::Point;
use crate::numbers::{SCREEN_BITS, shift_round};
use crate::projection::Projection;
use crate::reciprocal::{Reciprocal, reciprocal};
use crate::splat::Extent;

/// Half sides of rectangles saturate here, at 2^17 px: a place is at most 2^30
/// and half a picture from zero, so that it and a half side add up.
const HALF_LIMIT: i32 = 1 << 29;

/// A projected centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Q20.12 pixels from the picture's top left corner.
    pub x: i32,
    pub y: i32,
    /// Of 16 bits, except as [`Octave::place`] says.
    pub depth: i32,
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
            depth: i32::from(projection.depth(inverse)),
        }
    }

    /// The place as a step from the picture's corner.
    pub fn step(self) -> Step {
        Step {
            x: self.x,
            y: self.y,
            depth: self.depth,
        }
    }
}

/// How the screen moves along a cell's half edges, at its centre.
///
/// For a corner c + d: (X + dX) / (w + dw) - X / w = (dX - X / w dw) / (w +
/// dw). The numerator is linear in d.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    /// dX - X / w dw and dY - Y / w dw of each half edge, block units.
    pub along: [[i32; 2]; 3],
}

impl Slopes {
    /// The slopes at a centre with a given 1 / w.
    #[inline(always)]
    pub fn at(centre: Point, inverse: Reciprocal, half_edges: &[Point; 3]) -> Self {
        let [first, second, third] = half_edges;
        // dw / w, Q2.30. It saturates at one, which only a leaf that reaches
        // behind the eye exceeds: no rectangle bounds that one.
        let ratio = |edge: &Point| inverse.times(edge.w, 30);
        let ratios = [ratio(first), ratio(second), ratio(third)];
        let along = |edge: &Point, ratio: i32| {
            let shear = |value: i32| ((i64::from(value) * i64::from(ratio)) >> 30) as i32;
            [edge.x - shear(centre.x), edge.y - shear(centre.y)]
        };
        Self {
            along: [
                along(first, ratios[0]),
                along(second, ratios[1]),
                along(third, ratios[2]),
            ],
        }
    }

    /// Half the sides of the cell's bounding rectangle, Q20.12 pixels: the
    /// sums of the slopes' magnitudes over the nearest w, times `scale`.
    #[inline(always)]
    pub fn half(&self, projection: &Projection, nearest: Reciprocal, scale: i32) -> [i32; 2] {
        let bits = projection.screen_scale + SCREEN_BITS;
        let [first, second, third] = self.along;
        let half = |first: i32, second: i32, third: i32| {
            let sum = first
                .saturating_abs()
                .saturating_add(second.saturating_abs());
            let sum = sum
                .saturating_add(third.saturating_abs())
                .saturating_mul(scale);
            (nearest.times(sum, bits) + 1).min(HALF_LIMIT)
        };
        [
            half(first[0], second[0], third[0]),
            half(first[1], second[1], third[1]),
        ]
    }
}

/// The extent of a cell whose nearest corner has the w `nearest`.
pub(super) fn extent(
    projection: &Projection,
    centre: Point,
    inverse: Reciprocal,
    half_edges: &[Point; 3],
    nearest: i32,
) -> Extent {
    let slopes = Slopes::at(centre, inverse, half_edges);
    Extent {
        half: slopes.half(projection, reciprocal(nearest as u32), 1),
        rim_drop: rim_drop(projection, centre.w, inverse, half_edges),
    }
}

/// How much deeper a rim lies: a cell's diagonal, at least one step.
pub(super) fn rim_drop(
    projection: &Projection,
    w: i32,
    inverse: Reciprocal,
    half_edges: &[Point; 3],
) -> u16 {
    let diagonal: i32 = half_edges.iter().map(|edge| edge.w.abs()).sum();
    let rim = reciprocal(w.saturating_add(2 * diagonal) as u32);
    let drop = projection
        .depth(inverse)
        .saturating_sub(projection.depth(rim));
    drop.saturating_add(1)
}

/// A cell whose nearest corner is nearer than this, given the near plane's w
/// and its centre's, is *near*: its rectangle, taken over the nearest w, would
/// be more than twice too large and say little of where the cell is.
#[inline(always)]
pub(super) fn near_limit(near: i32, w: i32) -> i32 {
    near.max(w / 2)
}

/// Whether a near cell lies wholly beside the picture: on the far side of one
/// of its four planes through the eye.
///
/// The picture and not the band, because no rectangle bounds such a cell.
/// With b for half the picture in pixels, a plane is X 2^screen_scale = b w,
/// linear in the point, so the cell's reach across it is the sum over the half
/// edges.
pub(super) fn is_beside(projection: &Projection, centre: Point, half_edges: &[Point; 3]) -> bool {
    let scale = projection.screen_scale + SCREEN_BITS;
    let is_beyond = |row: fn(Point) -> i32, side: i64, bound: i64| {
        // Positive beyond the plane. Saturated values keep their sign, which
        // is all that counts.
        let across = |point: Point| {
            let screen = shift_round(i128::from(row(point)), -scale);
            i128::from(side) * i128::from(screen) - i128::from(bound) * i128::from(point.w)
        };
        let reach: i128 = half_edges.iter().map(|&edge| across(edge).abs()).sum();
        // Eight block units for the rounded centre and edges.
        let slack = (i128::from(bound) + (1 << scale.clamp(0, 62))) * 8;
        across(centre) > reach + slack
    };
    let [half_width, half_height] = projection.middle.map(|middle| i64::from(middle.to_bits()));
    [-1, 1].iter().any(|&side| {
        is_beyond(|point| point.x, side, half_width)
            || is_beyond(|point| point.y, side, half_height)
    })
}
