//! Packed subtrees: from an exactly projected cell down to points.

use super::affine::Affine;
use super::decoded::coding;
use super::facing::Facing;
use super::footprint::Place;
use super::lists::{self, COUNTS, LISTS, Mask};
use super::normals::Normals;
use super::packed::{Block, Brush, Subcells, draw_blocks};
use super::traverse::{Cell, Frame, Output, Record, records};
use crate::asset::node::Flags;
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::reciprocal;
use crate::stats::Stats;

impl<const CELLS: usize, const LEVELS: usize> Frame<'_, CELLS, LEVELS> {
    /// Draws the descendants of a cell, SPAN levels down, as points. `false`,
    /// with nothing done, if they do not fit a window.
    #[inline(never)]
    pub(super) fn packed<const RHO: u8, const SPAN: usize>(
        &self,
        cell: &Cell,
        record: Record<'_>,
        attribute: u16,
        normals: &Normals,
        output: &mut Output<'_, '_>,
    ) -> bool {
        let inverse = reciprocal(cell.centre.w as u32);
        let place = Place::of(self.projection, cell.centre, inverse);
        let bottom = cell.depth + SPAN as u8;
        let mut affine = Affine::EMPTY;
        let at = (&place, inverse);
        if !self.map_around::<RHO, SPAN>(cell, at, bottom, normals, &mut affine)
            || !affine.reach.fits_depth(&place)
        {
            return false;
        }
        if cell.inside || self.is_near_strip(&place, output) {
            let last = record.drawn.last().copied().unwrap_or(0);
            let flags = Flags::from_last(RHO, last);
            let subtree = Subtree {
                cell,
                record,
                normals,
                facing: match self.plan.faces {
                    true => normals.facing(flags, attribute),
                    false => Facing::Toward,
                },
                affine: &affine,
            };
            self.subtree::<RHO, SPAN>(&subtree, &place, output);
        }
        true
    }

    /// Draws a subtree that lies at a place.
    #[inline(always)]
    pub(super) fn subtree<const RHO: u8, const SPAN: usize>(
        &self,
        subtree: &Subtree<'_>,
        place: &Place,
        output: &mut Output<'_, '_>,
    ) {
        let Subtree { cell, affine, .. } = subtree;
        let start = place.step().packed_in_window();
        let start = start.wrapping_add(affine.brush.offset());
        let (queue, stats) = (&mut *output.queue, &mut *output.stats);
        let blocks = match (SPAN, subtree.facing) {
            (1, _) => block::<RHO>(subtree, start, queue),
            _ if coding::<RHO>(self.grid, cell).is_some() => {
                self.coded_blocks::<RHO>(subtree, start, queue, stats)
            }
            (_, Facing::Toward) => self.blocks::<RHO, false>(subtree, start, queue, stats),
            _ => self.blocks::<RHO, true>(subtree, start, queue, stats),
        };
        let bottom = usize::from(cell.depth) + SPAN;
        let window = output
            .canvas
            .window(place.x >> SCREEN_BITS, place.y >> SCREEN_BITS);
        let (Some(level), Some(window)) = (self.grid.levels().get(bottom), window) else {
            return;
        };
        let draw = match affine.brush {
            Brush::Point => draw_blocks::<RHO, 1, 1>,
            Brush::Wide => draw_blocks::<RHO, 2, 1>,
            Brush::Square => draw_blocks::<RHO, 2, 2>,
        };
        output.stats.samples_drawn += draw(blocks, level, affine, subtree.normals, window);
    }

    /// The children of the cell; without those that face away, if any may.
    #[inline(never)]
    fn blocks<'q, const RHO: u8, const FACES: bool>(
        &self,
        subtree: &Subtree<'_>,
        start: u32,
        queue: &'q mut [Block],
        stats: &mut Stats,
    ) -> &'q [Block] {
        let Subtree { cell, record, .. } = *subtree;
        let (normals, blocks) = (*subtree.normals, &subtree.affine.blocks);
        let below = usize::from(cell.depth) + 1;
        let levels = self.grid.levels();
        let (Some(level), Some(next)) = (levels.get(below), levels.get(below + 1)) else {
            return &[];
        };
        let count = place_children::<RHO>(record, start, blocks, queue);
        let axes = level.attributes.get(cell.first_child..).unwrap_or(&[]);
        let children = axes.iter().zip(records::<RHO>(next, cell.first_child));
        let mut first = next.links.get(cell.index).copied().unwrap_or(0);
        let mut kept = 0;
        for (index, (&axis, own)) in (0..count).zip(children) {
            let last = own.drawn.last().copied().unwrap_or(0);
            let is_away = FACES && normals.is_away(Flags::from_last(RHO, last), axis);
            // Kept blocks move up: none is overwritten before it is read.
            if !is_away
                && let Some(&Block { place, .. }) = queue.get(index)
                && let Some(block) = queue.get_mut(kept)
            {
                *block = Block {
                    place,
                    record: Mask::<RHO>::word(own.drawn)
                        .unwrap_or((cell.first_child + index) as u32),
                    first,
                };
                kept += 1;
            }
            first += Mask::<RHO>::of(own.node).count();
        }
        let visited = count as u32;
        stats.nodes_visited += visited;
        stats.nodes_back_facing += visited - kept as u32;
        stats.facing_tests += if FACES { visited } else { 0 };
        queue.get(..kept).unwrap_or(&[])
    }

    /// [`Self::blocks`] where the children's records are coded: how many cells
    /// a mask has is known without it.
    #[inline(never)]
    fn coded_blocks<'q, const RHO: u8>(
        &self,
        subtree: &Subtree<'_>,
        start: u32,
        queue: &'q mut [Block],
        stats: &mut Stats,
    ) -> &'q [Block] {
        let Subtree { cell, record, .. } = *subtree;
        let faces = subtree.facing != Facing::Toward;
        let below = usize::from(cell.depth) + 1;
        let levels = self.grid.levels();
        let (Some(level), Some(next)) = (levels.get(below), levels.get(below + 1)) else {
            return &[];
        };
        let Some(coding) = coding::<RHO>(self.grid, cell) else {
            return &[];
        };
        let (normals, blocks) = (*subtree.normals, &subtree.affine.blocks);
        let count = place_children::<RHO>(record, start, blocks, queue);
        let from = cell.first_child;
        let [axes, nodes, drawn] = [level.attributes, next.nodes, next.drawn]
            .map(|words| words.get(from..).unwrap_or(&[]).iter());
        let children = axes.zip(nodes.zip(drawn)).take(count);
        let mut first = coding.link(cell.index);
        let mut kept = 0;
        for (index, (&axis, (&node, &drawn))) in children.enumerate() {
            let (cells, flags) = coding.node(node, from + index);
            let is_away = faces && normals.is_away(Flags::from_word(flags), axis);
            // Kept blocks move up: none is overwritten before it is read.
            if !is_away
                && let Some(&Block { place, .. }) = queue.get(index)
                && let Some(block) = queue.get_mut(kept)
            {
                *block = Block {
                    place,
                    record: coding.drawn(drawn, from + index),
                    first,
                };
                kept += 1;
            }
            first += cells;
        }
        let visited = count as u32;
        stats.nodes_visited += visited;
        stats.nodes_back_facing += visited - kept as u32;
        stats.facing_tests += if faces { visited } else { 0 };
        queue.get(..kept).unwrap_or(&[])
    }
}

/// What a subtree is drawn from.
pub(super) struct Subtree<'a> {
    pub cell: &'a Cell,
    pub record: Record<'a>,
    pub normals: &'a Normals,
    /// How all of it faces.
    pub facing: Facing,
    pub affine: &'a Affine,
}

/// The cell itself, whose children are drawn.
#[inline(always)]
fn block<'q, const RHO: u8>(
    subtree: &Subtree<'_>,
    start: u32,
    queue: &'q mut [Block],
) -> &'q [Block] {
    let Subtree { cell, record, .. } = subtree;
    let Some((own, _)) = queue.split_first_chunk_mut::<1>() else {
        return &[];
    };
    *own = [Block {
        place: start,
        record: Mask::<RHO>::word(record.drawn).unwrap_or(cell.index as u32),
        first: cell.first_child as u32,
    }];
    own
}

/// Writes the places of a cell's children, in file order, to a queue; gives
/// their number.
#[inline(always)]
fn place_children<const RHO: u8>(
    record: Record<'_>,
    start: u32,
    blocks: &Subcells,
    queue: &mut [Block],
) -> usize {
    let room = queue.len();
    let mut free = queue.iter_mut();
    for mask in lists::in_file_order::<RHO>(record.node, record.drawn) {
        for index in 0..lists::chunks(RHO) {
            let bits = mask.chunk(index);
            let mut list = LISTS[bits];
            let pivot = start.wrapping_add(blocks.chunks[index]);
            for block in free.by_ref().take(usize::from(COUNTS[bits])) {
                block.place = pivot.wrapping_add(blocks.cells[(list & 15) as usize]);
                list >>= 4;
            }
        }
    }
    room - free.len()
}
