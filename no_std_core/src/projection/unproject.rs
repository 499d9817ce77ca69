//! From depths back to w.
//!
//! With the scale s and the offset o of depth, w is s / (d + o + 1/2) in the
//! middle of a depth d. Where d + o is large, a chord over [`STEP`] depths lies
//! at most (STEP / (d + o))^2 / 8 of w above it: 2^-13 where that is tabulated.

use super::Projection;
use crate::reciprocal::reciprocal;

/// Depths from entry to entry.
const STEP: u32 = 256;
/// Entries, the last one behind the last depth.
const ENTRIES: usize = 257;
/// Bits of w that entries leave out, so that a chord's product fits a word.
const COARSE_BITS: i32 = 4;
/// Least offset with which w is tabulated.
const LEAST_OFFSET: u32 = 32 * STEP;

/// From depths to w.
#[derive(Clone, Debug)]
pub(crate) struct DepthToW {
    /// Of the depth scale: w = mantissa * reciprocal's mantissa >> shift.
    mantissa: u32,
    shift: i32,
    offset: u32,
    /// Whether w is looked up: 2^-4 of it, every [`STEP`] depths.
    tabulates: bool,
    table: [i32; ENTRIES],
}

impl DepthToW {
    pub fn new(projection: &Projection) -> Self {
        let scale = &projection.depth;
        let offset = scale.narrow_offset as u32;
        let mut to_w = Self {
            mantissa: scale.mantissa,
            // Twice the quotient by twice the depth and one.
            shift: scale.shift - 1,
            offset,
            tabulates: offset >= LEAST_OFFSET,
            table: [0; ENTRIES],
        };
        if to_w.tabulates {
            let mut table = to_w.table;
            for (entry, depth) in table.iter_mut().zip((0..).map(|index| index * STEP)) {
                *entry = to_w.exact(depth) >> COARSE_BITS;
            }
            to_w.table = table;
        }
        to_w
    }

    /// The w of a depth of 16 bits, block units; at most 2^30.
    #[inline(always)]
    pub fn w(&self, depth: u32) -> i32 {
        if !self.tabulates {
            return self.exact(depth);
        }
        let index = (depth / STEP) as usize % (ENTRIES - 1);
        let (near, far) = (self.table[index + 1], self.table[index]);
        // At most 2^30 / 2^4 / 32 times 2^8.
        let along = ((near - far) * (depth % STEP) as i32) >> 8;
        (far + along) << COARSE_BITS
    }

    /// The same by a reciprocal of its own.
    #[inline(never)]
    fn exact(&self, depth: u32) -> i32 {
        let inverse = reciprocal(2 * (depth + self.offset) + 1);
        let product = u64::from(self.mantissa) * u64::from(inverse.mantissa);
        let w = product >> (self.shift - inverse.shift).clamp(0, 63);
        w.min(1 << 30) as i32
    }
}
