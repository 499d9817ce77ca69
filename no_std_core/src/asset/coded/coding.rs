//! A coded level's tables, checked, and what its codes stand for.

use super::{BASE_LINKS, FIRST_ESCAPE, FLAGS, MASK_BITS, MAX_MASKS, START_CODES};
use crate::asset::colours::Colours;
use crate::asset::level::{Counts, Level, Shape, Stored, split_halves};
use crate::asset::section::{Section, u32_at};
use crate::asset::{AssetError, max_depth};

/// Most levels of a tri-grid.
const MAX_LEVELS: usize = max_depth(3) as usize + 1;
/// Bits of a word that are a mask.
const MASK: u32 = (1 << MASK_BITS) - 1;
/// Bits of a code that tell an escape from its neighbours.
const ESCAPE_BITS: u32 = START_CODES as u32 - 1;

/// The masks of a file.
#[derive(Clone, Copy, Debug)]
pub struct Dictionary<'a>(&'a [u32]);

impl<'a> Dictionary<'a> {
    /// Checks a dictionary.
    pub fn open(section: &Section<'a>) -> Result<Self, AssetError> {
        let offset = section.offset;
        let error = AssetError::Dictionary { offset };
        let masks: &[u32] = bytemuck::try_cast_slice(section.bytes).map_err(|_| error)?;
        let is_counted = |&mask: &u32| mask >> MASK_BITS == (mask & MASK).count_ones();
        if masks.len() > MAX_MASKS || !masks.iter().all(is_counted) {
            return Err(error);
        }
        Ok(Self(masks))
    }

    /// Its masks, with the number of their cells.
    pub fn masks(self) -> &'a [u32] {
        self.0
    }
}

/// What the codes and links of a level stand for.
#[derive(Clone, Copy, Debug)]
pub struct Coding<'a> {
    masks: &'a [u32],
    flags: &'a [u32; FLAGS],
    bases: &'a [u32],
    links: &'a [u16],
    node_starts: &'a [u32],
    drawn_starts: &'a [u32],
    escapes: &'a [u32],
}

impl<'a> Coding<'a> {
    /// Cuts a coded level's section into its parts; `None` where sizes do not
    /// fit.
    pub(in crate::asset) fn split(
        shape: Shape,
        counts: Counts,
        section: &Section<'a>,
        dictionary: Dictionary<'a>,
    ) -> Option<Stored<'a>> {
        let stores_drawn = shape.stores_drawn;
        let cells = u32_at(section.bytes, 0)? as usize;
        let escapes = u32_at(section.bytes, 4)? as usize;
        let rest = section.bytes.get(8..)?;
        let (flags, rest) = split_words(rest, FLAGS)?;
        let (bases, rest) = split_words(rest, counts.links.div_ceil(BASE_LINKS))?;
        let (node_starts, rest) = split_words(rest, counts.records.div_ceil(START_CODES))?;
        let (drawn_starts, rest) = match stores_drawn {
            true => split_words(rest, node_starts.len())?,
            false => (node_starts, rest),
        };
        let (escapes, rest) = split_words(rest, escapes)?;
        let (links, rest) = split_halves(rest, counts.links)?;
        let (nodes, rest) = split_halves(rest, counts.records)?;
        let (drawn, rest) = match stores_drawn {
            true => split_halves(rest, counts.records)?,
            false => (nodes, rest),
        };
        let (attributes, rest) = split_halves(rest, cells)?;
        let (colours, rest) = Colours::split(rest, shape.attribute_bits, cells)?;
        rest.is_empty().then_some(())?;
        let flags = flags.first_chunk()?;
        let coding = Self {
            masks: dictionary.0,
            flags,
            bases,
            links,
            node_starts,
            drawn_starts,
            escapes,
        };
        let level = Level {
            links: &[],
            nodes,
            drawn,
            attributes,
            colours,
            words: [&[]; 2],
        };
        Some(Stored {
            level,
            coding: Some(coding),
        })
    }

    /// Every code has its mask or its escape, every escape its code, and flags
    /// are nothing else.
    pub(in crate::asset) fn check(
        &self,
        level: &Level<'a>,
        stores_drawn: bool,
        depth: u8,
        offset: u32,
    ) -> Result<(), AssetError> {
        let is_stray = |&flags: &u32| flags & MASK != 0;
        if self.flags.iter().any(is_stray) {
            return Err(AssetError::Flags { offset });
        }
        let mut escapes = 0;
        let mut check = |codes: &[u16], starts: &[u32]| {
            let bad = codes
                .iter()
                .enumerate()
                .position(|(index, &code)| !self.is_next(code, index, starts, &mut escapes));
            match bad {
                None => Ok(()),
                Some(index) => Err(AssetError::Code {
                    depth,
                    index: index as u32,
                }),
            }
        };
        check(level.nodes, self.node_starts)?;
        if stores_drawn {
            check(level.drawn, self.drawn_starts)?;
        }
        if escapes as usize == self.escapes.len() {
            Ok(())
        } else {
            Err(AssetError::LevelSize { offset })
        }
    }

    /// Whether a code may follow so many escapes, which it may add to.
    fn is_next(&self, code: u16, index: usize, starts: &[u32], escapes: &mut u32) -> bool {
        if index.is_multiple_of(START_CODES) && starts.get(index / START_CODES) != Some(escapes) {
            return false;
        }
        if code < FIRST_ESCAPE {
            return usize::from(code) / FLAGS < self.masks.len();
        }
        let own = *escapes;
        *escapes += 1;
        u32::from(code) & ESCAPE_BITS == own & ESCAPE_BITS && (own as usize) < self.escapes.len()
    }

    /// The record that a code stands for. `starts` belongs to the codes.
    #[inline(always)]
    pub(crate) fn record(&self, code: u16, index: usize, starts: &[u32]) -> u32 {
        if code < FIRST_ESCAPE {
            return self.mask(code) & MASK | self.flags(code);
        }
        self.escape(code, index, starts)
    }

    /// A mask with the number of its cells. The code is none of an escape.
    #[inline(always)]
    fn mask(&self, code: u16) -> u32 {
        let mask = self.masks.get(usize::from(code) / FLAGS);
        mask.copied().unwrap_or(0)
    }

    #[inline(always)]
    fn flags(&self, code: u16) -> u32 {
        self.flags[usize::from(code) % FLAGS]
    }

    /// The number of a node's cells.
    #[inline(always)]
    pub(crate) fn cells(&self, node: u16, index: usize) -> u32 {
        if node < FIRST_ESCAPE {
            return self.mask(node) >> MASK_BITS;
        }
        (self.escape(node, index, self.node_starts) & MASK).count_ones()
    }

    /// The flags of what is drawn of a node, as five bits.
    #[inline(always)]
    pub(crate) fn drawn_flags(&self, drawn: u16, index: usize) -> u32 {
        let record = match drawn < FIRST_ESCAPE {
            true => self.flags(drawn),
            false => self.escape(drawn, index, self.drawn_starts),
        };
        record >> MASK_BITS
    }

    /// What is drawn of a node, and the number of these cells.
    #[inline(always)]
    pub(crate) fn drawn(&self, drawn: u16, index: usize) -> (u32, u32) {
        if drawn < FIRST_ESCAPE {
            let mask = self.mask(drawn);
            return (mask & MASK | self.flags(drawn), mask >> MASK_BITS);
        }
        let record = self.escape(drawn, index, self.drawn_starts);
        (record, (record & MASK).count_ones())
    }

    /// The records that a node's code and that of what is drawn of it stand
    /// for.
    #[inline(always)]
    pub(crate) fn pair(&self, [node, drawn]: [u16; 2], index: usize) -> [u32; 2] {
        let own = self.record(node, index, self.node_starts);
        if node == drawn && node < FIRST_ESCAPE {
            return [own, own];
        }
        [own, self.record(drawn, index, self.drawn_starts)]
    }

    /// The record that has no code.
    #[cold]
    #[inline(never)]
    fn escape(&self, code: u16, index: usize, starts: &[u32]) -> u32 {
        let start = starts.get(index / START_CODES).copied().unwrap_or(0);
        let more = u32::from(code).wrapping_sub(start) & ESCAPE_BITS;
        let escape = self.escapes.get(start.wrapping_add(more) as usize);
        escape.copied().unwrap_or(0)
    }

    /// The link of a group; zero where there is none.
    #[inline(always)]
    pub(crate) fn link(&self, group: usize) -> u32 {
        match (self.bases.get(group / BASE_LINKS), self.links.get(group)) {
            (Some(base), Some(&more)) => base.wrapping_add(u32::from(more)),
            _ => 0,
        }
    }

    /// Number of links.
    pub fn links(&self) -> usize {
        self.links.len()
    }

    /// Records that have no code.
    pub fn escapes(&self) -> usize {
        self.escapes.len()
    }

    /// Starts of node codes.
    pub(crate) fn node_starts(&self) -> &'a [u32] {
        self.node_starts
    }

    /// Starts of drawn codes; those of nodes where there are no others.
    pub(crate) fn drawn_starts(&self) -> &'a [u32] {
        self.drawn_starts
    }
}

/// What the levels of a tri-grid are coded with.
#[derive(Clone, Debug)]
pub struct Codings<'a>([Option<Coding<'a>>; MAX_LEVELS]);

impl<'a> Codings<'a> {
    pub const EMPTY: Self = Self([None; MAX_LEVELS]);

    #[inline(always)]
    pub fn get(&self, depth: usize) -> Option<&Coding<'a>> {
        self.0.get(depth)?.as_ref()
    }

    /// Tri-grids have no depths but those that there is room for.
    pub fn set(&mut self, depth: usize, coding: Coding<'a>) {
        if let Some(slot) = self.0.get_mut(depth) {
            *slot = Some(coding);
        }
    }
}

/// Takes so many 32-bit words.
fn split_words(bytes: &[u8], count: usize) -> Option<(&[u32], &[u8])> {
    let (words, rest) = bytes.split_at_checked(count.checked_mul(4)?)?;
    Some((bytemuck::try_cast_slice(words).ok()?, rest))
}
