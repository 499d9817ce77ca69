//! Records of [coded levels](crate::asset::coded), as words that are read
//! like a plain level's.

use super::traverse::{Cell, Record};
use crate::asset::coded::Coding;
use crate::asset::{Grid, Level};

/// How the level of a depth is coded, if it is a tri-grid's and is.
#[inline(always)]
pub(super) fn coding_of<'g, 'a, const RHO: u8>(
    grid: &'g Grid<'a>,
    depth: usize,
) -> Option<&'g Coding<'a>> {
    match RHO {
        3 => grid.coding(depth),
        _ => None,
    }
}

/// How the records of a cell's children are coded.
#[inline(always)]
pub(super) fn coding<'g, 'a, const RHO: u8>(
    grid: &'g Grid<'a>,
    cell: &Cell,
) -> Option<&'g Coding<'a>> {
    coding_of::<RHO>(grid, usize::from(cell.depth) + 2)
}

/// What a record is read from.
pub(super) trait AsRecord {
    fn as_record(&self) -> Record<'_>;
}

impl AsRecord for Record<'_> {
    #[inline(always)]
    fn as_record(&self) -> Record<'_> {
        *self
    }
}

/// The record of a cell and what is drawn of it.
pub(super) struct Pair([[u16; 2]; 2]);

impl AsRecord for Pair {
    #[inline(always)]
    fn as_record(&self) -> Record<'_> {
        let [node, drawn] = &self.0;
        Record { node, drawn }
    }
}

/// The records of a coded level, from a cell on.
#[inline(always)]
pub(super) fn decoded<'a>(
    level: &Level<'a>,
    coding: &Coding<'a>,
    first: usize,
) -> impl Iterator<Item = Pair> {
    let [nodes, drawn] =
        [level.nodes, level.drawn].map(|codes| codes.get(first..).unwrap_or(&[]).iter());
    let codes = nodes.zip(drawn).zip(first..);
    codes.map(|((&node, &drawn), index)| {
        let words = coding.pair([node, drawn], index);
        Pair(words.map(|word| [word as u16, (word >> 16) as u16]))
    })
}
