//! Records of [coded levels](crate::asset::coded), read like a plain level's.

use super::blocks::{Queue, place_children};
use super::facing::Facing;
use super::mask::Mask;
use super::packed::Block;
use super::record::{Record, record_of};
use super::subtree::Subtree;
use super::traverse::Frame;
use crate::asset::coded::Coding;
use crate::asset::node::Flags;
use crate::asset::{Grid, Level};
use crate::stats::Stats;

/// A level whose cells' parents have records in it.
#[derive(Clone, Copy)]
pub(super) struct Below<'g, 'a, const RHO: u8> {
    pub level: &'g Level<'a>,
    /// What its codes stand for, if it is a tri-grid's and has codes.
    coding: Option<&'g Coding<'a>>,
}

impl<'g, 'a, const RHO: u8> Below<'g, 'a, RHO> {
    /// The level of a depth.
    #[inline(always)]
    pub fn at(grid: &'g Grid<'a>, depth: usize) -> Option<Self> {
        Some(Self {
            level: grid.levels().get(depth)?,
            coding: match RHO {
                3 => grid.coding(depth),
                _ => None,
            },
        })
    }

    /// Index in the level of a cell's first grandchild.
    #[inline(always)]
    pub fn link<const CODED: bool>(&self, cell: usize) -> usize {
        match self.coding {
            Some(coding) if CODED => coding.link(cell) as usize,
            _ => self.level.links.get(cell).copied().unwrap_or(0) as usize,
        }
    }

    /// A cell's record.
    #[inline(always)]
    pub fn record<const CODED: bool>(&self, index: usize) -> Option<Record<RHO>> {
        match self.coding {
            Some(coding) if CODED => decoded(self.level, coding, index),
            _ => record_of(self.level, index),
        }
    }

    /// Whether its records are codes.
    #[inline(always)]
    pub fn is_coded(&self) -> bool {
        self.coding.is_some()
    }
}

#[inline(always)]
fn decoded<const RHO: u8>(
    level: &Level<'_>,
    coding: &Coding<'_>,
    index: usize,
) -> Option<Record<RHO>> {
    let codes = [*level.nodes.get(index)?, *level.drawn.get(index)?];
    let [children, drawn] = coding.pair(codes, index);
    Some(Record {
        children: Mask::of_word(children),
        drawn: Mask::of_word(drawn),
        flags: Flags::from_word(drawn),
    })
}

impl<'a, const CELLS: usize, const LEVELS: usize> Frame<'a, CELLS, LEVELS> {
    /// [`Frame::blocks`] where the children's records are coded: how many
    /// cells a mask has is known without it.
    #[inline(never)]
    pub(super) fn coded_blocks<'q, const RHO: u8>(
        &self,
        subtree: &Subtree<'_, 'a, RHO>,
        start: u32,
        queue: &'q mut Queue<'_, 'a>,
        stats: &mut Stats,
    ) -> &'q [Block<'a>] {
        let Subtree {
            cell,
            record,
            below,
            ..
        } = *subtree;
        let faces = subtree.facing != Facing::Toward;
        let own = self.grid.levels().get(usize::from(cell.depth) + 1);
        let (Some(own), Some(coding)) = (own, below.coding) else {
            return &[];
        };
        let count = place_children(record, start, &subtree.affine.blocks, queue.places);
        let first = cell.first_child;
        let [axes, nodes, drawn] = [own.attributes, below.level.nodes, below.level.drawn]
            .map(|words| words.get(first..).unwrap_or(&[]).iter());
        let children = axes.zip(nodes.zip(drawn)).zip(first..);
        let link = below.link::<true>(cell.index);
        let mut attributes = below.level.attributes.get(link..).unwrap_or(&[]);
        let room = queue.blocks.len();
        let mut free = queue.blocks.iter_mut();
        for (((&axis, (&node, &drawn)), index), &place) in
            children.zip(queue.places.iter()).take(count)
        {
            let (cells, flags) = coding.node(node, index);
            let Some((all, others)) = attributes.split_at_checked(cells as usize) else {
                break;
            };
            attributes = others;
            if faces && subtree.normals.is_away(Flags::from_word(flags), axis) {
                continue;
            }
            let record = coding.drawn(drawn, index);
            if let Some(attributes) = all.get(..Mask::<RHO>::of_word(record).count())
                && let Some(block) = free.next()
            {
                *block = Block {
                    place,
                    record,
                    attributes,
                };
            }
        }
        let kept = room - free.len();
        stats.visit(count, kept, faces);
        queue.blocks.get(..kept).unwrap_or(&[])
    }
}
