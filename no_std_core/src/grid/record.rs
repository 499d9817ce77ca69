//! The records of cells, as they are read for drawing.

use core::marker::PhantomData;

use super::mask::Mask;
use crate::asset::Level;
use crate::asset::coded::Coding;
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

impl<const RHO: u8> Record<RHO> {
    /// Replaces the record where it lies: less is stored than of a new one.
    #[inline(always)]
    pub fn set(&mut self, other: Self) {
        self.children.set(other.children);
        self.drawn.set(other.drawn);
        self.flags = other.flags;
    }

    #[inline(always)]
    fn of<S: Stored>([node, drawn]: [S; 2]) -> Self {
        Self {
            children: node.mask(),
            drawn: drawn.mask(),
            flags: Flags::from_bits(drawn.flag_bits(RHO)),
        }
    }
}

/// A cell's records as the file holds them.
#[inline(always)]
fn stored<S: Stored>(level: &Level<'_>, index: usize) -> Option<[S; 2]> {
    let [nodes, drawn] = S::of(level);
    Some([*nodes.get(index)?, *drawn.get(index)?])
}

/// What a cell's codes stand for.
#[inline(always)]
fn decoded(level: &Level<'_>, coding: &Coding<'_>, index: usize) -> Option<[u32; 2]> {
    let codes = [*level.nodes.get(index)?, *level.drawn.get(index)?];
    Some(coding.pair(codes, index))
}

/// A cell's record in the level of its children, which may be coded.
#[inline(always)]
pub(super) fn record_of<const RHO: u8>(
    level: &Level<'_>,
    coding: Option<&Coding<'_>>,
    index: usize,
) -> Option<Record<RHO>> {
    match RHO {
        2 => stored::<[u16; 1]>(level, index).map(Record::of),
        3 => match coding {
            None => stored::<u32>(level, index),
            Some(coding) => decoded(level, coding, index),
        }
        .map(Record::of),
        4 => stored::<[u16; 5]>(level, index).map(Record::of),
        _ => stored::<[u16; 9]>(level, index).map(Record::of),
    }
}

/// A level's link of a group; zero where there is none.
#[inline(always)]
pub(super) fn link_of(level: &Level<'_>, coding: Option<&Coding<'_>>, group: usize) -> usize {
    let link = match coding {
        None => level.links.get(group).copied().unwrap_or(0),
        Some(coding) => coding.link(group),
    };
    link as usize
}

/// Reads records one by one, each with its index in their level.
pub(super) trait Reader: Copy {
    /// What the file holds of each.
    type Stored: Copy;

    /// A level's node and drawn records.
    fn records<'a>(self, level: &Level<'a>) -> [&'a [Self::Stored]; 2];

    /// A level's link of a group; zero where there is none.
    fn link(self, level: &Level<'_>, group: usize) -> usize;

    /// The number of a node's cells.
    fn cells<const RHO: u8>(self, node: Self::Stored, index: usize) -> usize;

    fn flags<const RHO: u8>(self, drawn: Self::Stored, index: usize) -> Flags;

    /// The drawn record where that is one word, else its index; and the number
    /// of its cells.
    fn drawn<const RHO: u8>(self, drawn: Self::Stored, index: usize) -> (u32, usize);
}

/// Records as they are.
impl<S: Stored> Reader for PhantomData<S> {
    type Stored = S;

    #[inline(always)]
    fn records<'a>(self, level: &Level<'a>) -> [&'a [S]; 2] {
        S::of(level)
    }

    #[inline(always)]
    fn link(self, level: &Level<'_>, group: usize) -> usize {
        link_of(level, None, group)
    }

    #[inline(always)]
    fn cells<const RHO: u8>(self, node: S, _: usize) -> usize {
        node.mask::<RHO>().count()
    }

    #[inline(always)]
    fn flags<const RHO: u8>(self, drawn: S, _: usize) -> Flags {
        Flags::from_bits(drawn.flag_bits(RHO))
    }

    #[inline(always)]
    fn drawn<const RHO: u8>(self, drawn: S, index: usize) -> (u32, usize) {
        let record = drawn.word().unwrap_or(index as u32);
        (record, drawn.mask::<RHO>().count())
    }
}

/// Codes: how many cells a mask has stands beside it.
impl Reader for &Coding<'_> {
    type Stored = u16;

    #[inline(always)]
    fn records<'a>(self, level: &Level<'a>) -> [&'a [u16]; 2] {
        [level.nodes, level.drawn]
    }

    #[inline(always)]
    fn link(self, level: &Level<'_>, group: usize) -> usize {
        link_of(level, Some(self), group)
    }

    #[inline(always)]
    fn cells<const RHO: u8>(self, node: u16, index: usize) -> usize {
        Coding::cells(self, node, index) as usize
    }

    #[inline(always)]
    fn flags<const RHO: u8>(self, drawn: u16, index: usize) -> Flags {
        Flags::from_bits(self.drawn_flags(drawn, index) as u16)
    }

    #[inline(always)]
    fn drawn<const RHO: u8>(self, drawn: u16, index: usize) -> (u32, usize) {
        let (record, cells) = Coding::drawn(self, drawn, index);
        (record, cells as usize)
    }
}
