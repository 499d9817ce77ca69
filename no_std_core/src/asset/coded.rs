//! Coded records: 16 bits for most of a tri-grid's masks and cones.
//!
//! The masks of real surfaces repeat. A *dictionary*, section kind 3, at most
//! one and before the levels that use it, holds up to 4032 of them: one 32-bit
//! word each, with the number of its cells in place of flags. A *coded level*,
//! section kind 4, has codes in place of records, and narrower links:
//!
//! | level of depth n | length |
//! |---|---|
//! | number of cells N(n) | one 32-bit word |
//! | number E of escapes | one 32-bit word |
//! | flags: sixteen cones with two-sided flags, where records have them | 16 32-bit words |
//! | bases: of each 64 links the first | links / 64, rounded up, 32-bit words |
//! | starts of nodes: how many escapes precede each 1024 codes | codes / 1024, rounded up, 32-bit words |
//! | starts of drawn, the same: escapes of nodes precede all of them | as many; none where there are no drawn codes |
//! | escapes: records that have no code, those of nodes first | E 32-bit words |
//! | links: what a link is above its base | 16-bit words, as many as links |
//! | nodes: codes | N(n - 1) 16-bit words |
//! | drawn: codes | as many; none where a level has no drawn records |
//! | attributes | N(n) 16-bit words |
//!
//! The last four are each padded to four bytes with zeros. A code below 64512
//! is mask << 4 | flags, indices of the dictionary and of the level's flags.
//! The others stand for escapes, in order: the lowest ten bits are those of the
//! escape's index, and the start before them tells the rest. 64 links span
//! 63 x 729 cells at most.

#[cfg(feature = "mask-dictionary")]
mod coding;
#[cfg(not(feature = "mask-dictionary"))]
#[path = "coded/left_out.rs"]
mod coding;

pub use coding::Coding;
pub(super) use coding::{Codings, Dictionary};

/// Bits of a tri-grid's record that are its mask; the others are flags.
pub const MASK_BITS: u32 = 27;
/// Most masks of a dictionary.
pub const MAX_MASKS: usize = 4032;
/// Flags of a coded level.
pub const FLAGS: usize = 16;
/// The first code that stands for an escape.
pub const FIRST_ESCAPE: u16 = (MAX_MASKS * FLAGS) as u16;
/// Codes that share a start: as many as there are for escapes.
pub const START_CODES: usize = 1024;
/// Links that share a base.
pub const BASE_LINKS: usize = 64;
