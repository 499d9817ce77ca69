//! Occupancy masks, and the walk over their cells.
//!
//! A mask is held in words of whole slabs, so that its bit i is cell i. Cells
//! are visited lowest bit first, without counting zeros: a word's lowest set
//! bit times [`DE_BRUIJN`] has a number of its own, the bit's *slot*, in its
//! upper five bits, and tables of cells are laid out by slots.

use core::hint::black_box;

use super::record::Record;

/// Slots of a word.
pub(super) const SLOTS: usize = 32;
/// Most words of a mask: the slabs of rho 5.
pub(super) const MAX_WORDS: usize = 5;

/// Every window of five bits is another number; below them, zeros.
const DE_BRUIJN: u32 = 0x077c_b531;

/// Slabs of a word.
pub(super) const fn slabs(rho: u8) -> usize {
    match rho {
        2 | 4 => 2,
        3 => 3,
        _ => 1,
    }
}

/// Cells of a word.
pub(super) const fn cells(rho: u8) -> usize {
    slabs(rho) * rho as usize * rho as usize
}

/// Words of a mask.
pub(super) const fn words(rho: u8) -> usize {
    rho as usize / slabs(rho)
}

/// The slot of a word's bit.
pub(super) const fn slot(bit: usize) -> usize {
    ((DE_BRUIJN << bit) >> 27) as usize
}

/// The bit of a slot.
static BITS: [u8; SLOTS] = {
    let mut bits = [0; SLOTS];
    let mut bit = 0;
    while bit < SLOTS {
        bits[slot(bit)] = bit as u8;
        bit += 1;
    }
    bits
};

/// How many of nine bits are set: three of them count faster than a word's
/// bits without an instruction for it.
static COUNTS: [u8; 512] = {
    let mut counts = [0; 512];
    let mut bits = 0;
    while bits < 512 {
        counts[bits] = bits.count_ones() as u8;
        bits += 1;
    }
    counts
};

/// The cells of a record.
#[derive(Clone, Copy)]
pub(super) struct Mask<const RHO: u8>([u32; MAX_WORDS]);

impl<const RHO: u8> Mask<RHO> {
    pub const NOTHING: Self = Self([0; MAX_WORDS]);

    /// Reads a record; of one that is too short, no cells.
    #[inline(always)]
    pub fn of(record: &[u16]) -> Self {
        let word = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
        Self(match (RHO, record) {
            (2, &[only, ..]) => [word(only & 0xff, 0), 0, 0, 0, 0],
            (3, &[a, b, ..]) => [word(a, b & 0x7ff), 0, 0, 0, 0],
            (4, &[a, b, c, d, ..]) => [word(a, b), word(c, d), 0, 0, 0],
            (5, &[a, b, c, d, e, f, g, h, ..]) => {
                let half = |low, high| u64::from(word(low, high));
                let low = half(a, b) | half(c, d) << 32;
                let high = half(e, f) | half(g, h) << 32;
                let all = u128::from(low) | u128::from(high) << 64;
                [0, 25, 50, 75, 100].map(|shift| (all >> shift) as u32 & 0x1ff_ffff)
            }
            _ => [0; MAX_WORDS],
        })
    }

    /// The same of a record that is one word, flags above: tri-grids' are.
    #[inline(always)]
    pub fn of_word(word: u32) -> Self {
        Self([word & 0x7ff_ffff, 0, 0, 0, 0])
    }

    /// Replaces the cells. Words that no mask has stay as they are.
    #[inline(always)]
    pub fn set(&mut self, other: Self) {
        for (word, other) in self.0.iter_mut().zip(other.words()) {
            *word = other;
        }
    }

    /// Its first word.
    #[inline(always)]
    pub fn first_word(self) -> u32 {
        self.0[0]
    }

    /// The cells that are not in another mask.
    #[inline(always)]
    pub fn without(mut self, other: Self) -> Self {
        for (word, other) in self.0.iter_mut().zip(other.0) {
            *word &= !other;
        }
        self
    }

    /// Its words: see [`words`].
    #[inline(always)]
    pub fn words(self) -> impl Iterator<Item = u32> {
        self.0.into_iter().take(words(RHO))
    }

    /// Number of cells.
    #[inline(always)]
    pub fn count(self) -> usize {
        if RHO > 3 {
            return self.words().map(|word| word.count_ones() as usize).sum();
        }
        let word = self.0[0] as usize;
        let [low, middle, high] = [word, word >> 9, word >> 18].map(|nine| COUNTS[nine % 512]);
        usize::from(low) + usize::from(middle) + usize::from(high)
    }
}

/// The masks of a cell's children in file order: first the drawn ones, then
/// the others.
#[inline(always)]
pub(super) fn in_file_order<const RHO: u8>(record: &Record<RHO>) -> [Mask<RHO>; 2] {
    [record.drawn, record.children.without(record.drawn)]
}

/// The walk over set bits, lowest first.
pub(super) struct Walk {
    de_bruijn: u32,
    /// The bits of a slot.
    slot: u32,
}

impl Walk {
    /// Of constants that the compiler does not know: known ones are made anew
    /// for each bit.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            de_bruijn: black_box(DE_BRUIJN),
            slot: black_box(31),
        }
    }

    /// Takes a word's lowest bit out and gives its slot; of no bits, any slot.
    #[inline(always)]
    pub fn lowest(&self, word: &mut u32) -> usize {
        let lowest = *word & word.wrapping_neg();
        *word ^= lowest;
        (lowest.wrapping_mul(self.de_bruijn) >> 27 & self.slot) as usize
    }
}

/// The set bits of a word, lowest first, as slots.
pub(super) fn slots(mut word: u32) -> impl Iterator<Item = usize> {
    let walk = Walk {
        de_bruijn: DE_BRUIJN,
        slot: 31,
    };
    core::iter::from_fn(move || (word != 0).then(|| walk.lowest(&mut word)))
}

/// The set bits of a word, lowest first.
#[inline(always)]
pub(super) fn bits(word: u32) -> impl Iterator<Item = usize> {
    slots(word).map(|slot| usize::from(BITS[slot % SLOTS]))
}

#[cfg(test)]
mod tests;
