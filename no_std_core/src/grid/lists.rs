//! From occupancy bits to lists of cells, nine bits at a time.
//!
//! A record is read in *chunks* of whole rows, at most nine bits: the slabs
//! of a tri-grid, pairs of rows for rho 4, rows for rho 5. Entry b of
//! [`LISTS`] names the set bits of b, lowest first, four bits each, as index
//! XOR 8: what follows the eighth is zero, which names index 8.

/// Cells of a chunk in [`LISTS`]' numbering, and what indices wrap at.
pub(super) const CHUNK_CELLS: usize = 16;

/// Rows of a chunk.
pub(super) const fn chunk_rows(rho: u8) -> usize {
    match rho {
        2 | 4 => 2,
        3 => 3,
        _ => 1,
    }
}

/// Chunks of a record.
pub(super) const fn chunks(rho: u8) -> usize {
    let rho_rows = rho as usize * rho as usize;
    rho_rows / chunk_rows(rho)
}

/// Most chunks of a record: 25 rows of rho 5.
pub(super) const MAX_CHUNKS: usize = 25;

/// The set bits of a chunk: see the module.
pub(super) static LISTS: [u32; 512] = {
    let mut lists = [0; 512];
    let mut bits = 0;
    while bits < 512 {
        let (mut list, mut count, mut bit) = (0u32, 0, 0);
        while bit < 9 {
            if bits >> bit & 1 != 0 {
                if count < 8 {
                    list |= (bit ^ 8) << (4 * count);
                }
                count += 1;
            }
            bit += 1;
        }
        lists[bits as usize] = list;
        bits += 1;
    }
    lists
};

/// How many bits of a chunk are set.
pub(super) static COUNTS: [u8; 512] = {
    let mut counts = [0; 512];
    let mut bits = 0;
    while bits < 512 {
        counts[bits] = bits.count_ones() as u8;
        bits += 1;
    }
    counts
};

/// The cells of a record, as words of 32.
#[derive(Clone, Copy)]
pub(super) struct Mask<const RHO: u8>([u32; 4]);

impl<const RHO: u8> Mask<RHO> {
    /// Reads a record; of one that is too short, no cells.
    #[inline(always)]
    pub fn of(record: &[u16]) -> Self {
        let word = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
        Self(match (RHO, record) {
            (2, &[only, ..]) => [word(only, 0), 0, 0, 0],
            (3, &[a, b, ..]) => [word(a, b), 0, 0, 0],
            (4, &[a, b, c, d, ..]) => [word(a, b), word(c, d), 0, 0],
            (5, &[a, b, c, d, e, f, g, h, ..]) => [word(a, b), word(c, d), word(e, f), word(g, h)],
            _ => [0; 4],
        })
    }

    /// The same of a record that is one word, flags above: tri-grids' are.
    #[inline(always)]
    pub fn of_word(word: u32) -> Option<Self> {
        (RHO == 3).then_some(Self([word, 0, 0, 0]))
    }

    /// A record as one word, if it is one.
    #[inline(always)]
    pub fn word(record: &[u16]) -> Option<u32> {
        match (RHO, record) {
            (3, &[low, high]) => Some(u32::from(low) | u32::from(high) << 16),
            _ => None,
        }
    }

    /// The cells that are not in another mask.
    #[inline(always)]
    pub fn without(self, other: Self) -> Self {
        let [a, b, c, d] = self.0;
        let [e, f, g, h] = other.0;
        Self([a & !e, b & !f, c & !g, d & !h])
    }

    /// A chunk's bits, below 512.
    #[inline(always)]
    pub fn chunk(self, index: usize) -> usize {
        let [a, b, c, d] = self.0;
        let bits = match RHO {
            2 => a >> (4 * index) & 0xf,
            3 => a >> (9 * index) & 0x1ff,
            4 => self.0[index / 4 % 4] >> (8 * (index % 4)) & 0xff,
            _ => {
                let wide =
                    u128::from(a) | u128::from(b) << 32 | u128::from(c) << 64 | u128::from(d) << 96;
                (wide >> (5 * index)) as u32 & 0x1f
            }
        };
        bits as usize % 512
    }

    /// Number of cells.
    #[inline(always)]
    pub fn count(self) -> u32 {
        if RHO > 3 {
            return self.0.iter().map(|word| word.count_ones()).sum();
        }
        (0..chunks(RHO))
            .map(|index| u32::from(COUNTS[self.chunk(index)]))
            .sum()
    }
}

/// The masks of a cell's children in file order: first the drawn ones, then
/// the others.
#[inline(always)]
pub(super) fn in_file_order<const RHO: u8>(node: &[u16], drawn: &[u16]) -> [Mask<RHO>; 2] {
    let drawn = Mask::of(drawn);
    [drawn, Mask::of(node).without(drawn)]
}
