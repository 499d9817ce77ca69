//! Packed subtrees: from an exactly projected cell down to points.

use super::facing::Normals;
use super::footprint::Place;
use super::lists::{self, COUNTS, LISTS};
use super::packed::{HALF_LEFT, Step, Subcells, block};
use super::tables::Point;
use super::traverse::{Cell, Frame, Output, Record, records};
use crate::asset::Shell;
use crate::asset::node::Flags;
use crate::canvas::Window;
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::{Reciprocal, reciprocal};

/// Centres of a packed subtree stay within this of its own, Q20.12 pixels,
/// where points are one pixel wide.
///
/// A window reaches eight pixels back and seven beyond its middle pixel, in
/// which the subtree's own centre lies, rounded to sixteenths: from its left
/// side on, 8 to 9. With at most 10/32 for the rounding of two levels,
/// 9 + 6 5/8 + 10/32 stays below 16. A subtree beyond [`crate::canvas::REACH`]
/// of the strip, 8 pixels, stays clear of the pixel next to the strip.
const REACH: i32 = (6 << SCREEN_BITS) + (5 << SCREEN_BITS) / 8;
/// The same where points are two pixels wide: half a pixel to the left, and
/// one more to the right.
const WIDE_REACH: i32 = (6 << SCREEN_BITS) + (3 << SCREEN_BITS) / 16;

/// What a subtree's depths may be off by rounding, at most one for each step
/// and chunk.
const DEPTH_ROUNDING: i32 = 16;

/// Tables of the subtree at hand; filled before they are read, and kept so
/// that nobody clears them.
pub(super) struct Scratch {
    blocks: Subcells,
    leaves: Subcells,
}

impl Scratch {
    pub const EMPTY: Self = Self {
        blocks: Subcells::EMPTY,
        leaves: Subcells::EMPTY,
    };
}

/// The steps between neighbours of one level along x, y and z.
#[derive(Clone, Copy)]
struct Steps([Step; 3]);

impl Steps {
    /// Whether a subtree of `cells` an axis around a place fits a window and
    /// the depth field.
    #[inline(always)]
    fn fit(&self, place: &Place, cells: i32, is_narrow: bool) -> bool {
        let reach = |of: fn(&Step) -> i32| {
            let sum = |sum: i32, step| sum.saturating_add(of(step).saturating_abs());
            // Beyond this nothing fits; below it, the product does.
            self.0.iter().fold(0, sum).min(1 << 24) * (cells - 1) / 2
        };
        let depth = reach(|step| step.depth) + DEPTH_ROUNDING;
        let middle = i32::from(place.depth);
        let limit = if is_narrow { REACH } else { WIDE_REACH };
        reach(|step| step.x) <= limit
            && reach(|step| step.y) <= limit
            && middle > depth
            && middle + depth <= 65535
    }

    #[inline(always)]
    fn times(self, factor: i32) -> Self {
        Self(self.0.map(|step| Step {
            x: step.x * factor,
            y: step.y * factor,
            depth: step.depth * factor,
        }))
    }
}

/// Fraction bits of dw / w.
const RATIO_BITS: i32 = 24;

impl<const CELLS: usize, const LEVELS: usize> Frame<'_, CELLS, LEVELS> {
    /// The steps between cells of a depth, at a place: with x = X / w, the
    /// step along an edge d is dX / w - x dw / w, and depth moves by its scale
    /// over w times -dw / w.
    #[inline(always)]
    fn steps(&self, depth: u8, place: &Place, inverse: Reciprocal) -> Steps {
        let bits = self.projection.screen_scale + SCREEN_BITS + 1;
        let [middle_x, middle_y] = self.projection.middle;
        let (x, y) = (place.x - middle_x.to_bits(), place.y - middle_y.to_bits());
        let scaled = self.projection.depth_scaled(inverse).min(1 << 30) as i32;
        let step = |edge: &Point| {
            // Half edges; dw is at most w.
            let ratio = inverse.times(edge.w, RATIO_BITS + 1);
            let shear = |of: i32| ((i64::from(of) * i64::from(ratio)) >> RATIO_BITS) as i32;
            Step {
                x: inverse.times(edge.x, bits).saturating_sub(shear(x)),
                y: inverse.times(edge.y, bits).saturating_sub(shear(y)),
                depth: -shear(scaled),
            }
        };
        let [first, second, third] = self.tables.extents(depth).half_edges;
        Steps([step(first), step(second), step(third)])
    }

    /// Whether the cells of a depth, at a cell's distance, are drawn as points
    /// one pixel wide.
    ///
    /// A thin shell of a surface that faces the eye holds, for each cell's
    /// area of the picture, as many cells as the largest component of the
    /// viewing direction says: one where an axis leads to the eye, 0.58 where
    /// a diagonal does. So that is what a pixel's area is held against.
    #[inline(always)]
    fn is_narrow(&self, cell: &Cell, depth: u8, normals: &Normals) -> bool {
        let narrow = i64::from(self.plan.level(depth).narrow >> 8);
        let w = i64::from(cell.centre.w >> 8);
        let density = match self.grid.shell() {
            Shell::Fat => 1 << 14,
            Shell::Thin => normals.largest(),
        };
        // 22 + 22 + 14 bits.
        w * w * i64::from(density) >= (narrow * narrow) << 14
    }

    /// Draws the children of a cell as points. `false`, with nothing done, if
    /// they do not fit a window.
    #[inline(never)]
    pub(super) fn packed_block<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &[u16],
        flags: Flags,
        normals: &Normals,
        output: &mut Output<'_, '_>,
    ) -> bool {
        let inverse = reciprocal(cell.centre.w as u32);
        let place = Place::of(self.projection, cell.centre, inverse);
        let steps = self.steps(cell.depth + 1, &place, inverse);
        let is_narrow = self.is_narrow(cell, cell.depth + 1, normals);
        if !steps.fit(&place, i32::from(RHO), is_narrow) {
            return false;
        }
        if !self.is_near_strip(&place, output) {
            return true;
        }
        let below = usize::from(cell.depth) + 1;
        let level = self.grid.levels().get(below);
        let Some(attributes) = level.and_then(|level| level.attributes.get(cell.first_child..))
        else {
            return true;
        };
        output.scratch.leaves.fill::<RHO>(&steps.0);
        let start = place.step().packed_in_window();
        let Some(window) = output
            .canvas
            .window(place.x >> SCREEN_BITS, place.y >> SCREEN_BITS)
        else {
            return true;
        };
        let start = if is_narrow {
            start
        } else {
            start.wrapping_add(HALF_LEFT)
        };
        let drawn = draw_block::<RHO>(
            start,
            record,
            attributes,
            &output.scratch.leaves,
            window,
            (is_narrow, flags.is_sheet().then_some(normals)),
        );
        output.stats.samples_drawn += drawn as u32;
        true
    }

    /// Draws the grandchildren of a cell as points. `false`, with nothing
    /// done, if they do not fit a window.
    #[inline(never)]
    pub(super) fn packed_tree<const RHO: u8>(
        &self,
        cell: &Cell,
        record: Record<'_>,
        normals: &Normals,
        output: &mut Output<'_, '_>,
    ) -> bool {
        let rho = i32::from(RHO);
        let inverse = reciprocal(cell.centre.w as u32);
        let place = Place::of(self.projection, cell.centre, inverse);
        let steps = self.steps(cell.depth + 2, &place, inverse);
        let is_narrow = self.is_narrow(cell, cell.depth + 2, normals);
        if !steps.fit(&place, rho * rho, is_narrow) {
            return false;
        }
        if !self.is_near_strip(&place, output) {
            return true;
        }
        let below = usize::from(cell.depth) + 1;
        let levels = self.grid.levels();
        let (Some(level), Some(next)) = (levels.get(below), levels.get(below + 1)) else {
            return true;
        };
        let Scratch { blocks, leaves } = &mut *output.scratch;
        blocks.fill::<RHO>(&steps.times(rho).0);
        leaves.fill::<RHO>(&steps.0);
        let mut start = place.step().packed_in_window();
        if !is_narrow {
            start = start.wrapping_add(HALF_LEFT);
        }
        let Some(window) = output
            .canvas
            .window(place.x >> SCREEN_BITS, place.y >> SCREEN_BITS)
        else {
            return true;
        };
        let axes = level.attributes.get(cell.first_child..).unwrap_or(&[]);
        let mut children = axes.iter().zip(records::<RHO>(next, cell.first_child));
        let first = next.links.get(cell.index).copied().unwrap_or(0) as usize;
        let mut attributes = next.attributes.get(first..).unwrap_or(&[]);
        let mut stats = *output.stats;
        for chunk in lists::in_file_order::<RHO>(record.node, record.drawn) {
            let mut list = LISTS[chunk.bits];
            let Some(offset) = blocks.chunks.get(chunk.index) else {
                break;
            };
            let pivot = start.wrapping_add(*offset);
            for (&axis, record) in children.by_ref().take(usize::from(COUNTS[chunk.bits])) {
                let place = pivot.wrapping_add(blocks.cells[(list & 15) as usize]);
                list >>= 4;
                stats.nodes_visited += 1;
                let flags = Flags::from_last(RHO, record.drawn.last().copied().unwrap_or(0));
                if normals.is_away(flags, axis) {
                    stats.nodes_back_facing += 1;
                } else {
                    let drawn = draw_block::<RHO>(
                        place,
                        record.drawn,
                        attributes,
                        leaves,
                        window,
                        (is_narrow, flags.is_sheet().then_some(normals)),
                    );
                    stats.samples_drawn += drawn as u32;
                }
                let count = lists::count::<RHO>(record.node);
                attributes = attributes.get(count..).unwrap_or(&[]);
            }
        }
        *output.stats = stats;
        true
    }
}

/// Draws a block the short way that suits it: points one pixel wide or two;
/// with normals, sheets that show the side that is seen.
#[inline(always)]
fn draw_block<const RHO: u8>(
    place: u32,
    record: &[u16],
    attributes: &[u16],
    leaves: &Subcells,
    window: &mut Window,
    (is_narrow, normals): (bool, Option<&Normals>),
) -> usize {
    let same = |attribute| attribute;
    match (normals, is_narrow) {
        (None, true) => block::<RHO, false>(place, record, attributes, leaves, window, same),
        (None, false) => block::<RHO, true>(place, record, attributes, leaves, window, same),
        (Some(normals), is_narrow) => {
            let turned = |attribute| normals.turned(attribute);
            match is_narrow {
                true => block::<RHO, false>(place, record, attributes, leaves, window, turned),
                false => block::<RHO, true>(place, record, attributes, leaves, window, turned),
            }
        }
    }
}

#[cfg(test)]
mod tests;
