//! Node records: the occupancy of one intermediate cell, with its cone.
//!
//! A record is `halves(rho)` 16-bit words. Bit i of the words' sequence, for
//! i < rho^3, says whether subcell i holds surface, i = x + rho (y + rho z).
//! Five bits of the last word, from bit `flags_shift(rho)` on, hold the
//! normal cone's aperture (four bits) and the two-sided flag. For rho = 3 the
//! record is one 32-bit word: 27 mask bits, aperture, flag. All other bits
//! are zero. Thin shells have second records of the same layout: see
//! [the format](super).

/// 16-bit words of a record.
pub const fn halves(rho: u8) -> usize {
    match rho {
        2 => 1,
        3 => 2,
        4 => 5,
        _ => 9,
    }
}

/// First flag bit in a record's last word.
pub const fn flags_shift(rho: u8) -> u32 {
    match rho {
        2 => 8,
        3 => 11,
        _ => 0,
    }
}

/// The five flag bits of a record's last word.
pub const fn flag_bits(rho: u8, last: u16) -> u16 {
    last >> flags_shift(rho) & 31
}

/// Aperture that stands for "normals in every direction".
pub const APERTURE_ALL: u8 = 15;

/// Sine of the largest angle between a cell's own normal and that of any
/// sample that may be drawn below it, by four-bit aperture: aperture a < 15
/// covers angles up to 6 (a + 1) degrees. Q1.15, rounded up. Aperture 15 covers
/// every angle.
pub const APERTURE_SINE: [u16; 15] = [
    3426, 6813, 10126, 13328, 16384, 19261, 21927, 24352, 26510, 28378, 29936, 31165, 32052, 32589,
    32768,
];

/// Cosine of the same angles, Q1.15, rounded down.
pub const APERTURE_COSINE: [u16; 15] = [
    32588, 32051, 31164, 29935, 28377, 26509, 24351, 21926, 19260, 16384, 13327, 10125, 6812, 3425,
    0,
];

/// The flags of a node record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flags {
    /// Cone aperture, 0 to 15: see [`APERTURE_SINE`].
    pub aperture: u8,
    /// Whether the cell's leaves are drawn even where their own normals face
    /// away: thin sheets, and shading normals bent beyond their faces.
    pub two_sided: bool,
}

impl Flags {
    /// The flags in a record's last word.
    pub const fn from_last(rho: u8, last: u16) -> Self {
        Self::from_bits(flag_bits(rho, last))
    }

    /// The flags of their five bits, as [`flag_bits`] has them.
    pub const fn from_bits(bits: u16) -> Self {
        Self {
            aperture: (bits & 15) as u8,
            two_sided: bits & 16 != 0,
        }
    }

    /// Whether samples that face away show their other side: faces of every
    /// direction, drawn from both sides.
    pub const fn is_sheet(self) -> bool {
        self.two_sided && self.aperture == APERTURE_ALL
    }

    /// The flags as bits of a record's last word.
    pub const fn to_last(self, rho: u8) -> u16 {
        self.bits() << flags_shift(rho)
    }

    /// The flags as five bits, as [`flag_bits`] has them.
    pub const fn bits(self) -> u16 {
        (self.aperture as u16 & 15) | (self.two_sided as u16) << 4
    }
}

/// Bits of the last word that mask and flags use.
const fn last_used(rho: u8) -> u16 {
    match rho {
        2 => 0x1fff,
        3 => 0xffff,
        _ => 0x001f,
    }
}

/// Number of occupied subcells.
pub fn occupied(rho: u8, record: &[u16]) -> u32 {
    let Some((&last, body)) = record.split_last() else {
        return 0;
    };
    let flags = 31u16 << flags_shift(rho);
    body.iter().map(|half| half.count_ones()).sum::<u32>() + (last & !flags).count_ones()
}

/// Whether a record has bits without meaning.
pub fn has_stray_bits(rho: u8, record: &[u16]) -> bool {
    let Some((&last, body)) = record.split_last() else {
        return true;
    };
    // rho = 5: 125 mask bits in eight words leave three.
    let stray = rho == 5 && body.last().is_some_and(|half| half >> 13 != 0);
    last & !last_used(rho) != 0 || stray
}

/// Whether a record has no subcells but those of a node, and the node's
/// flags.
pub fn is_part(rho: u8, record: &[u16], node: &[u16]) -> bool {
    let (Some(&last), Some(&node_last)) = (record.last(), node.last()) else {
        return false;
    };
    let flags = 31u16 << flags_shift(rho);
    let is_subset = record.iter().zip(node).all(|(part, all)| part & !all == 0);
    is_subset && (last ^ node_last) & flags == 0
}
