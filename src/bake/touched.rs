//! Finished levels, before it is chosen what of them is stored.

use std::ops::Range;

use rhogrid_core::asset::Rgb;
use rhogrid_core::asset::node::Flags;

/// A touched cell of a finished level.
pub(super) struct Touched {
    /// Which subcell of its parent it is.
    pub bit: u8,
    /// Whether it is drawn where drawing stops at its depth.
    pub is_thin: bool,
    pub attribute: u16,
    pub colour: Rgb,
}

/// What a finished level tells of a cell above it.
pub(super) struct Above {
    pub flags: Flags,
    /// How many touched cells of the level it holds.
    pub children: u8,
    /// Of a cell whose children hold opposed faces, the normal codes of its own
    /// faces, each once; none of others.
    pub faces: Vec<u16>,
}

/// A finished level: every touched cell, and what was told of those above.
pub(super) struct TouchedLevel {
    /// The touched cells of the level above.
    pub above: Vec<Above>,
    /// Children of one cell are contiguous, in the order of their bits.
    pub cells: Vec<Touched>,
}

impl TouchedLevel {
    /// For each cell above the level the indices of its children.
    pub fn children(&self) -> Vec<Range<usize>> {
        let mut end = 0;
        let ranges = self.above.iter().map(|above| {
            let start = end;
            end += usize::from(above.children);
            start..end
        });
        ranges.collect()
    }
}
