//! The affine map around a place of the screen: tables of one or two levels
//! of subcells, from which cells are placed by additions.
//!
//! It serves the subtree whose centre lies at that place and, a level down,
//! all subtrees of a cell that lies there: see `plan.rs` for what either
//! costs in pixels.

use super::footprint::Place;
use super::normals::Normals;
use super::packed::{Brush, Step, Subcells};
use super::tables::Point;
use super::traverse::{Cell, Frame};
use crate::asset::Shell;
use crate::asset::node::APERTURE_ALL;
use crate::canvas::Pixel;
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::Reciprocal;

/// Centres of a packed subtree stay within this of its own, Q20.12 pixels,
/// along an axis on which points are one pixel large.
///
/// A window reaches eight pixels back and seven beyond its middle pixel, in
/// which the subtree's own centre lies, rounded to sixteenths: from its left
/// side on, 8 to 9. With at most 8/32 for the rounding of two levels,
/// 9 + 6 5/8 + 8/32 stays below 16. A subtree beyond [`crate::canvas::REACH`]
/// of the strip, 8 columns or 9 rows, stays clear of what counts around it.
const REACH: i32 = (6 << SCREEN_BITS) + (5 << SCREEN_BITS) / 8;
/// The same where points are two pixels large: half a pixel back, and one
/// more ahead.
const REACH_TWO: i32 = (6 << SCREEN_BITS) + (3 << SCREEN_BITS) / 16;

/// How many cells deeper a sheet's samples are drawn that face away: as many as
/// make a [hole](crate::resolve) of what shows of them between nearer ones.
const FAR_SIDE_CELLS: u32 = 2;

/// Least aperture, of 48 degrees, of blocks of which single samples are tested
/// for facing away: narrower ones are mostly skipped or seen as a whole.
const BOTH_WAYS: u8 = 7;

/// What a subtree's depths may be off by rounding, at most one for each step,
/// row and word.
pub(super) const DEPTH_ROUNDING: i32 = 16;

/// The steps between neighbours of one level along x, y and z.
#[derive(Clone, Copy)]
pub(super) struct Steps(pub [Step; 3]);

/// How far a subtree's cells lie from its centre.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    pub x: i32,
    pub y: i32,
    pub depth: i32,
}

impl Steps {
    /// The reach of a subtree of `cells` an axis.
    #[inline(always)]
    pub fn reach(&self, cells: i32) -> Reach {
        let reach = |of: fn(&Step) -> i32| {
            let [a, b, c] = self.0.map(|step| of(&step).unsigned_abs());
            // Beyond this nothing fits; below it, the product does.
            let limit = 1 << 24;
            let sum = match a | b | c < limit {
                true => (a + b + c).min(limit),
                false => limit,
            };
            sum as i32 * (cells - 1) / 2
        };
        Reach {
            x: reach(|step| step.x),
            y: reach(|step| step.y),
            depth: reach(|step| step.depth) + DEPTH_ROUNDING,
        }
    }

    /// How much depth changes along an edge that leads to the eye, or up to a
    /// quarter more: the longest component and half of the others.
    #[inline(always)]
    fn across(&self) -> u32 {
        let depths = self.0.map(|step| step.depth.unsigned_abs());
        let [a, b, c] = depths;
        let longest = a.max(b).max(c);
        longest + (a + b + c - longest) / 2
    }

    #[inline(always)]
    pub fn times(self, factor: i32) -> Self {
        Self(self.0.map(|step| Step {
            x: step.x * factor,
            y: step.y * factor,
            depth: step.depth * factor,
        }))
    }
}

impl Reach {
    /// Whether points of a brush stay within a window.
    #[inline(always)]
    pub fn fits_window(&self, brush: Brush) -> bool {
        let limit = |is_two| if is_two { REACH_TWO } else { REACH };
        self.x <= limit(brush != Brush::Point) && self.y <= limit(brush == Brush::Square)
    }

    /// Whether depths around a place's stay within their field, above zero.
    #[inline(always)]
    pub fn fits_depth(&self, place: &Place) -> bool {
        let middle = place.depth;
        middle > self.depth && middle <= 65535 - self.depth
    }
}

/// The map.
pub(super) struct Affine {
    /// From a block's centre to its children.
    pub leaves: Subcells,
    /// From a subtree's centre to its blocks, where it has two levels.
    pub blocks: Subcells,
    pub brush: Brush,
    pub reach: Reach,
    /// How much deeper than they are a sheet's samples are drawn that face away;
    /// not at all where every surface is a sheet.
    pub far_side: u32,
    /// Least aperture of blocks of which single samples are tested for facing
    /// away.
    pub both_ways: u8,
}

impl Affine {
    /// To be filled.
    #[inline(always)]
    pub fn blank() -> Self {
        Self {
            leaves: Subcells::blank(),
            blocks: Subcells::blank(),
            brush: Brush::Point,
            reach: Reach {
                x: 0,
                y: 0,
                depth: 0,
            },
            far_side: 0,
            both_ways: u8::MAX,
        }
    }
}

/// Fraction bits of dw / w.
const RATIO_BITS: i32 = 24;

impl<const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'_, CELLS, LEVELS, P> {
    /// Fills the map around a cell whose place is given, for subtrees of SPAN
    /// levels with their bottom at a depth. `false` if they do not fit a window.
    #[inline(never)]
    pub(super) fn map_around<const RHO: u8, const SPAN: usize>(
        &self,
        cell: &Cell,
        (place, inverse): (&Place, Reciprocal),
        bottom: u8,
        normals: &Normals,
        affine: &mut Affine,
    ) -> bool {
        let rho = i32::from(RHO);
        let steps = self.steps(bottom, place, inverse);
        affine.brush = self.brush(cell, bottom, normals);
        affine.reach = steps.reach(rho.pow(SPAN as u32));
        if !affine.reach.fits_window(affine.brush) {
            return false;
        }
        if self.plan.faces {
            affine.far_side = FAR_SIDE_CELLS * steps.across();
            affine.reach.depth += affine.far_side as i32;
            affine.both_ways = BOTH_WAYS;
        } else if !self.plan.shows_all {
            affine.both_ways = APERTURE_ALL;
        }
        affine.leaves.fill::<RHO>(&steps.0);
        if SPAN > 1 {
            affine.blocks.fill::<RHO>(&steps.times(rho).0);
        }
        true
    }

    /// The steps between cells of a depth, at a place: with x = X / w, the
    /// step along an edge d is dX / w - x dw / w, and depth moves by its scale
    /// over w times -dw / w.
    fn steps(&self, depth: u8, place: &Place, inverse: Reciprocal) -> Steps {
        let [middle_x, middle_y] = self.projection.middle;
        let slant = Slant {
            inverse,
            bits: self.projection.screen_scale + SCREEN_BITS + 1,
            x: place.x - middle_x.to_bits(),
            y: place.y - middle_y.to_bits(),
            depth: self.projection.depth_scaled(inverse).min(1 << 30) as i32,
        };
        let [first, second, third] = self.tables.extents(depth).half_edges;
        Steps([slant.step(first), slant.step(second), slant.step(third)])
    }

    /// What cells of a depth, at a cell's distance, are drawn with.
    ///
    /// A thin shell of a surface that faces the eye holds, for each cell's
    /// area of the picture, as many cells as the largest component of the
    /// viewing direction says: one where an axis leads to the eye, 0.58 where
    /// a diagonal does. So that is what a point's area is held against.
    fn brush(&self, cell: &Cell, depth: u8, normals: &Normals) -> Brush {
        let plan = self.plan.level(depth);
        let w = i64::from(cell.centre.w >> 8);
        let density = match self.grid.shell() {
            Shell::Fat => 1 << 14,
            Shell::Thin => normals.largest(),
        };
        // 22 + 22 + 14 bits.
        let area = w * w * i64::from(density);
        let from = |least: i32| {
            let least = i64::from(least >> 8);
            area >= (least * least) << 14
        };
        if from(plan.point) {
            Brush::Point
        } else if from(plan.wide) {
            Brush::Wide
        } else {
            Brush::Square
        }
    }
}

/// What the steps at a place follow from.
struct Slant {
    inverse: Reciprocal,
    /// Fraction bits of a half edge's step over w.
    bits: i32,
    /// The place from the picture's middle, and its depth without the offset.
    x: i32,
    y: i32,
    depth: i32,
}

impl Slant {
    /// The step along an edge, given half of it.
    #[inline(always)]
    fn step(&self, edge: &Point) -> Step {
        // dw is at most w.
        let ratio = self.inverse.times(edge.w, RATIO_BITS + 1);
        let shear = |of: i32| ((i64::from(of) * i64::from(ratio)) >> RATIO_BITS) as i32;
        let across = |half: i32, at: i32| {
            let step = self.inverse.times(half, self.bits);
            step.saturating_sub(shear(at))
        };
        Step {
            x: across(edge.x, self.x),
            y: across(edge.y, self.y),
            depth: -shear(self.depth),
        }
    }
}

#[cfg(test)]
mod tests;
