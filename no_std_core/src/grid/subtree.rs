//! Packed subtrees: from an exactly projected cell down to points.

use super::facing::Normals;
use super::footprint::Place;
use super::lists::{self, COUNTS, LISTS};
use super::packed::{HALF_LEFT, Step, Subcells, block, block_turned};
use super::tables::Point;
use super::traverse::{Cell, Frame, Output};
use crate::asset::node::{Flags, halves};
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::{Reciprocal, reciprocal};

/// Centres of a packed subtree stay within this of its own, Q20.12 pixels:
/// a window reaches seven pixels beyond its middle one; rounding and the
/// fraction need the rest.
const REACH: i32 = 6 * (1 << SCREEN_BITS) + (7 << SCREEN_BITS) / 8;

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
    /// How far the outermost of `cells` an axis lie from the middle.
    #[inline(always)]
    fn reach(&self, cells: i32) -> i32 {
        let sum = |of: fn(&Step) -> i32| self.0.iter().map(|step| of(step).abs()).sum::<i32>();
        sum(|step| step.x).max(sum(|step| step.y)) * (cells - 1) / 2
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
                x: inverse.times(edge.x, bits) - shear(x),
                y: inverse.times(edge.y, bits) - shear(y),
                depth: -shear(scaled),
            }
        };
        let [first, second, third] = self.tables.extents(depth).half_edges;
        Steps([step(first), step(second), step(third)])
    }

    /// Draws the children of a cell as points.
    #[inline(never)]
    pub(super) fn packed_block<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &[u16],
        flags: Flags,
        normals: &Normals,
        output: &mut Output<'_, '_>,
    ) {
        let inverse = reciprocal(cell.centre.w as u32);
        let place = Place::of(self.projection, cell.centre, inverse);
        if !self.is_near_strip(&place, output) {
            return;
        }
        let below = usize::from(cell.depth) + 1;
        let level = self.grid.levels().get(below);
        let Some(attributes) = level.and_then(|level| level.attributes.get(cell.first_child..))
        else {
            return;
        };
        let steps = self.steps(cell.depth + 1, &place, inverse);
        output.scratch.leaves.fill::<RHO>(&steps.0);
        let start = place.step().packed_in_window();
        let Some(window) = output
            .canvas
            .window(place.x >> SCREEN_BITS, place.y >> SCREEN_BITS)
        else {
            return;
        };
        let leaves = &output.scratch.leaves;
        let is_narrow = cell.centre.w >= self.plan.level(cell.depth + 1).narrow;
        let drawn = match (flags.is_sheet(), is_narrow) {
            (false, true) => block::<RHO, false>(start, record, attributes, leaves, window),
            (false, false) => {
                let start = start.wrapping_add(HALF_LEFT);
                block::<RHO, true>(start, record, attributes, leaves, window)
            }
            (true, true) => {
                block_turned::<RHO, false>(start, record, attributes, leaves, window, normals)
            }
            (true, false) => {
                let start = start.wrapping_add(HALF_LEFT);
                block_turned::<RHO, true>(start, record, attributes, leaves, window, normals)
            }
        };
        output.stats.samples_drawn += drawn as u32;
    }

    /// Draws the grandchildren of a cell as points. `false`, with nothing
    /// done, if they do not fit a window.
    #[inline(never)]
    pub(super) fn packed_tree<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &[u16],
        normals: &Normals,
        output: &mut Output<'_, '_>,
    ) -> bool {
        let rho = i32::from(RHO);
        let inverse = reciprocal(cell.centre.w as u32);
        let place = Place::of(self.projection, cell.centre, inverse);
        let steps = self.steps(cell.depth + 2, &place, inverse);
        if steps.reach(rho * rho) > REACH {
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
        let is_narrow = cell.centre.w >= self.plan.level(cell.depth + 2).narrow;
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
        let size = halves(RHO);
        let axes = level.attributes.get(cell.first_child..).unwrap_or(&[]);
        let records = next.nodes.get(cell.first_child * size..).unwrap_or(&[]);
        let mut children = axes.iter().zip(records.chunks_exact(size));
        let first = next.links.get(cell.index).copied().unwrap_or(0) as usize;
        let mut attributes = next.attributes.get(first..).unwrap_or(&[]);
        let mut stats = *output.stats;
        for (index, &offset) in (0..lists::chunks(RHO)).zip(&blocks.chunks) {
            let bits = lists::chunk::<RHO>(record, index) % 512;
            let mut list = LISTS[bits];
            let chunk = start.wrapping_add(offset);
            for (&axis, record) in children.by_ref().take(usize::from(COUNTS[bits])) {
                let place = chunk.wrapping_add(blocks.cells[(list & 15) as usize]);
                list >>= 4;
                stats.nodes_visited += 1;
                let flags = Flags::from_last(RHO, record.last().copied().unwrap_or(0));
                if normals.is_away(flags, axis) {
                    stats.nodes_back_facing += 1;
                    let count = lists::count::<RHO>(record);
                    attributes = attributes.get(count..).unwrap_or(&[]);
                    continue;
                }
                let drawn = match (flags.is_sheet(), is_narrow) {
                    (false, true) => block::<RHO, false>(place, record, attributes, leaves, window),
                    (false, false) => block::<RHO, true>(place, record, attributes, leaves, window),
                    (true, true) => block_turned::<RHO, false>(
                        place, record, attributes, leaves, window, normals,
                    ),
                    (true, false) => block_turned::<RHO, true>(
                        place, record, attributes, leaves, window, normals,
                    ),
                };
                stats.samples_drawn += drawn as u32;
                attributes = attributes.get(drawn..).unwrap_or(&[]);
            }
        }
        *output.stats = stats;
        true
    }
}
