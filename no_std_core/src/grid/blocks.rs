//! From a subtree to its blocks: the cells whose children are drawn.
//!
//! Three short loops, each of which keeps its data in registers: places by
//! additions, facing by cones, then what is drawn of those that are kept.

use core::marker::PhantomData;
use core::slice;

use super::mask::{self, SLOTS};
use super::normals::Normals;
use super::packed::Subcells;
use super::record::{Reader, Record, Stored};
use super::samples::Block;
use super::subtree::Subtree;
use super::traverse::Frame;
use crate::asset::Level;
use crate::asset::coded::Coding;
use crate::canvas::Pixel;
use crate::stats::Stats;

/// Memory for one subtree, as much as a cell has subcells.
pub(super) struct Queue<'t, 'a, P: Pixel> {
    /// Where a cell's children lie.
    pub places: &'t mut [u32],
    /// Those that are drawn.
    pub blocks: &'t mut [Block<'a, P>],
}

impl<'a, const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'a, CELLS, LEVELS, P> {
    /// The children of the subtree's cell; without those that face away, if
    /// any may. `level` is that of their own children, which are drawn.
    #[inline(never)]
    pub(super) fn blocks<'q, const RHO: u8, const FACES: bool>(
        &self,
        subtree: &Subtree<'_, '_, RHO>,
        level: &Level<'a>,
        start: u32,
        queue: &'q mut Queue<'_, 'a, P>,
        stats: &mut Stats,
    ) -> &'q [Block<'a, P>] {
        if let Some(coding) = self.coding::<RHO>(subtree.depth + 2) {
            return self.coded_blocks::<RHO, FACES>(subtree, level, coding, start, queue, stats);
        }
        match RHO {
            2 => self.plain_blocks::<RHO, FACES, [u16; 1]>(subtree, level, start, queue, stats),
            3 => self.plain_blocks::<RHO, FACES, u32>(subtree, level, start, queue, stats),
            4 => self.plain_blocks::<RHO, FACES, [u16; 5]>(subtree, level, start, queue, stats),
            _ => self.plain_blocks::<RHO, FACES, [u16; 9]>(subtree, level, start, queue, stats),
        }
    }

    #[inline(always)]
    fn plain_blocks<'q, const RHO: u8, const FACES: bool, S: Stored>(
        &self,
        subtree: &Subtree<'_, '_, RHO>,
        level: &Level<'a>,
        start: u32,
        queue: &'q mut Queue<'_, 'a, P>,
        stats: &mut Stats,
    ) -> &'q [Block<'a, P>] {
        let records = PhantomData::<S>;
        self.read_blocks::<RHO, FACES, _>(subtree, level, records, start, queue, stats)
    }

    /// Where the children's records are coded; compiled by itself, so that
    /// others do not pay for it.
    #[inline(never)]
    fn coded_blocks<'q, const RHO: u8, const FACES: bool>(
        &self,
        subtree: &Subtree<'_, '_, RHO>,
        level: &Level<'a>,
        coding: &Coding<'a>,
        start: u32,
        queue: &'q mut Queue<'_, 'a, P>,
        stats: &mut Stats,
    ) -> &'q [Block<'a, P>] {
        self.read_blocks::<RHO, FACES, _>(subtree, level, coding, start, queue, stats)
    }

    #[inline(always)]
    fn read_blocks<'q, const RHO: u8, const FACES: bool, R: Reader>(
        &self,
        subtree: &Subtree<'_, '_, RHO>,
        level: &Level<'a>,
        reader: R,
        start: u32,
        queue: &'q mut Queue<'_, 'a, P>,
        stats: &mut Stats,
    ) -> &'q [Block<'a, P>] {
        let Some(children) = self.children::<RHO, R>(subtree, level, reader, start, queue.places)
        else {
            return &[];
        };
        let link = reader.link(level, subtree.spot.index);
        let room = queue.blocks.len();
        let mut kept = Kept {
            free: queue.blocks.iter_mut(),
            attributes: level.attributes.get(link..).unwrap_or(&[]),
            sample: P::sample(subtree.depth + 2, link),
        };
        let normals = FACES.then_some(&subtree.normals);
        if RHO > 3 {
            children.in_groups(|group| kept.keep::<RHO, R>(group, normals));
        } else {
            kept.keep::<RHO, R>(&children, normals);
        }
        let count = room - kept.free.len();
        let visited = children.own.len() as u32;
        stats.nodes_visited += visited;
        stats.nodes_back_facing += visited - count as u32;
        stats.facing_tests += if FACES { visited } else { 0 };
        queue.blocks.get(..count).unwrap_or(&[])
    }

    /// The children of the subtree's cell, with their places.
    #[inline(always)]
    fn children<'c, const RHO: u8, R: Reader>(
        &self,
        subtree: &Subtree<'_, '_, RHO>,
        level: &Level<'c>,
        reader: R,
        start: u32,
        places: &'c mut [u32],
    ) -> Option<Children<'c, R>>
    where
        'a: 'c,
    {
        let count = place_children(&subtree.record, start, &subtree.affine.blocks, places);
        let first = subtree.spot.first_child;
        let cells = first..first.checked_add(count)?;
        let own = self.grid.levels().get(usize::from(subtree.depth) + 1)?;
        let [nodes, drawn] = reader.records(level);
        Some(Children {
            reader,
            first,
            own: own.attributes.get(cells.clone())?,
            nodes: nodes.get(cells.clone())?,
            drawn: drawn.get(cells)?,
            places: places.get(..count)?,
        })
    }
}

/// Siblings that may become blocks; as many of each.
struct Children<'a, R: Reader> {
    reader: R,
    /// Index of the first one.
    first: usize,
    /// Their attributes.
    own: &'a [u16],
    nodes: &'a [R::Stored],
    drawn: &'a [R::Stored],
    places: &'a [u32],
}

impl<R: Reader> Children<'_, R> {
    /// Visits groups of up to 32.
    #[inline(always)]
    fn in_groups(&self, mut visit: impl FnMut(&Children<'_, R>)) {
        let own = self.own.chunks(32).zip(self.nodes.chunks(32));
        let places = self.drawn.chunks(32).zip(self.places.chunks(32));
        for (index, ((own, nodes), (drawn, places))) in own.zip(places).enumerate() {
            visit(&Children {
                reader: self.reader,
                first: self.first + 32 * index,
                own,
                nodes,
                drawn,
                places,
            });
        }
    }

    /// Which of up to 32 do not face away, lowest bit first.
    #[inline(always)]
    fn not_away<const RHO: u8>(&self, normals: &Normals) -> u32 {
        let (mut kept, mut bit) = (0, 1u32);
        for ((&axis, &drawn), index) in self.own.iter().zip(self.drawn).zip(self.first..) {
            if !normals.is_away(self.reader.flags::<RHO>(drawn, index), axis) {
                kept |= bit;
            }
            bit = bit.wrapping_shl(1);
        }
        kept
    }
}

/// Where blocks go.
struct Kept<'q, 'a, P: Pixel> {
    free: slice::IterMut<'q, Block<'a, P>>,
    /// Attributes of their children and those behind.
    attributes: &'a [u16],
    /// The first of these.
    sample: P::Sample,
}

impl<P: Pixel> Kept<'_, '_, P> {
    /// Keeps those of up to 32 cells that do not face away; all without
    /// normals.
    #[inline(always)]
    fn keep<const RHO: u8, R: Reader>(
        &mut self,
        children: &Children<'_, R>,
        normals: Option<&Normals>,
    ) {
        let mut bits = match normals {
            Some(normals) => children.not_away::<RHO>(normals),
            None => u32::MAX,
        };
        let reader = children.reader;
        let records = children.drawn.iter().zip(children.nodes);
        let cells = records.zip(children.places).zip(children.first..);
        for (((&drawn, &node), &place), index) in cells {
            let count = reader.cells::<RHO>(node, index);
            let Some((all, others)) = self.attributes.split_at_checked(count) else {
                return;
            };
            self.attributes = others;
            let sample = self.sample;
            self.sample = P::ahead(sample, count);
            let is_kept = bits & 1 != 0;
            bits >>= 1;
            if is_kept
                && let (record, count) = reader.drawn::<RHO>(drawn, index)
                && let Some(attributes) = all.get(..count)
                && let Some(block) = self.free.next()
            {
                *block = Block {
                    place,
                    record,
                    attributes,
                    sample,
                };
            }
        }
    }
}

/// The cell itself, whose children, in `level`, are drawn.
#[inline(always)]
pub(super) fn block<'q, 'a, const RHO: u8, P: Pixel>(
    subtree: &Subtree<'_, '_, RHO>,
    level: &Level<'a>,
    start: u32,
    queue: &'q mut Queue<'_, 'a, P>,
) -> &'q [Block<'a, P>] {
    let Subtree { spot, record, .. } = subtree;
    let count = record.drawn.count();
    let attributes = level.attributes.get(spot.first_child..);
    let (Some((own, _)), Some(attributes)) = (
        queue.blocks.split_first_chunk_mut::<1>(),
        attributes.and_then(|attributes| attributes.get(..count)),
    ) else {
        return &[];
    };
    *own = [Block {
        place: start,
        record: match RHO {
            3 => record.drawn.first_word() | u32::from(record.flags.bits()) << 27,
            _ => spot.index as u32,
        },
        attributes,
        sample: P::sample(subtree.depth + 1, spot.first_child),
    }];
    own
}

/// Writes the places of a cell's children, in file order; gives their number.
#[inline(always)]
fn place_children<const RHO: u8>(
    record: &Record<RHO>,
    start: u32,
    blocks: &Subcells,
    places: &mut [u32],
) -> usize {
    let room = places.len();
    let mut free = places.iter_mut();
    for mask in mask::in_file_order(record) {
        for (word, &middle) in mask.words().zip(&blocks.words) {
            let middle = start.wrapping_add(middle);
            for (slot, place) in mask::slots(word).zip(free.by_ref()) {
                *place = middle.wrapping_add(blocks.cells[slot % SLOTS]);
            }
        }
    }
    room - free.len()
}
