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

/// A chunk of a record.
#[inline(always)]
pub(super) fn chunk<const RHO: u8>(record: &[u16], index: usize) -> usize {
    let word = |at: usize| usize::from(record.get(at).copied().unwrap_or(0));
    match RHO {
        2 => word(0) >> (4 * index) & 0xf,
        3 => (word(0) | word(1) << 16) >> (9 * index) & 0x1ff,
        4 => word(index / 2) >> (8 * (index % 2)) & 0xff,
        _ => {
            let bit = 5 * index;
            (word(bit / 16) | word(bit / 16 + 1) << 16) >> (bit % 16) & 0x1f
        }
    }
}

/// Number of cells in a record.
#[inline(always)]
pub(super) fn count<const RHO: u8>(record: &[u16]) -> usize {
    (0..chunks(RHO))
        .map(|index| usize::from(COUNTS[chunk::<RHO>(record, index) % 512]))
        .sum()
}

/// A chunk with its place in the record.
pub(super) struct Chunk {
    pub index: usize,
    /// Below 512.
    pub bits: usize,
}

/// The chunks of a cell's children in file order: first the drawn ones, then
/// the others.
#[inline(always)]
pub(super) fn in_file_order<'a, const RHO: u8>(
    node: &'a [u16],
    drawn: &'a [u16],
) -> impl Iterator<Item = Chunk> + use<'a, RHO> {
    let bits = |record: &'a [u16], index| chunk::<RHO>(record, index) % 512;
    let of_drawn = (0..chunks(RHO)).map(move |index| Chunk {
        index,
        bits: bits(drawn, index),
    });
    let others = (0..chunks(RHO)).map(move |index| Chunk {
        index,
        bits: bits(node, index) & !bits(drawn, index),
    });
    of_drawn.chain(others)
}
