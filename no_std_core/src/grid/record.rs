//! The records of cells, as they are read for drawing.

use super::mask::Mask;
use crate::asset::Level;
use crate::asset::node::{Flags, flag_bits};

/// The two records of a cell: see [the format](crate::asset).
#[derive(Clone, Copy)]
pub(super) struct Record<const RHO: u8> {
    /// All children.
    pub children: Mask<RHO>,
    /// Those that are drawn where drawing stops at their depth.
    pub drawn: Mask<RHO>,
    pub flags: Flags,
}

/// A record as the file holds it: a word for tri-grids, else halves of one.
pub(super) trait Stored: Copy {
    /// A level's node and drawn records.
    fn of<'a>(level: &Level<'a>) -> [&'a [Self]; 2];

    fn mask<const RHO: u8>(self) -> Mask<RHO>;

    /// See [`flag_bits`].
    fn flag_bits(self, rho: u8) -> u16;

    /// All of it, if that is a word.
    fn word(self) -> Option<u32>;
}

impl Stored for u32 {
    #[inline(always)]
    fn of<'a>(level: &Level<'a>) -> [&'a [Self]; 2] {
        level.words
    }

    #[inline(always)]
    fn mask<const RHO: u8>(self) -> Mask<RHO> {
        Mask::of_word(self)
    }

    #[inline(always)]
    fn flag_bits(self, _: u8) -> u16 {
        (self >> 27) as u16
    }

    #[inline(always)]
    fn word(self) -> Option<u32> {
        Some(self)
    }
}

impl<const HALVES: usize> Stored for [u16; HALVES] {
    #[inline(always)]
    fn of<'a>(level: &Level<'a>) -> [&'a [Self]; 2] {
        [level.nodes, level.drawn].map(|records| records.as_chunks().0)
    }

    #[inline(always)]
    fn mask<const RHO: u8>(self) -> Mask<RHO> {
        Mask::of(&self)
    }

    #[inline(always)]
    fn flag_bits(self, rho: u8) -> u16 {
        flag_bits(rho, self.last().copied().unwrap_or(0))
    }

    #[inline(always)]
    fn word(self) -> Option<u32> {
        None
    }
}

#[inline(always)]
fn get<const RHO: u8, S: Stored>(level: &Level<'_>, index: usize) -> Option<Record<RHO>> {
    let [nodes, drawn] = S::of(level);
    let (node, drawn) = (nodes.get(index)?, drawn.get(index)?);
    Some(Record {
        children: node.mask(),
        drawn: drawn.mask(),
        flags: Flags::from_bits(drawn.flag_bits(RHO)),
    })
}

/// A cell's record in the level of its children.
#[inline(always)]
pub(super) fn record_of<const RHO: u8>(level: &Level<'_>, index: usize) -> Option<Record<RHO>> {
    match RHO {
        2 => get::<RHO, [u16; 1]>(level, index),
        3 => get::<RHO, u32>(level, index),
        4 => get::<RHO, [u16; 5]>(level, index),
        _ => get::<RHO, [u16; 9]>(level, index),
    }
}
