//! Where the parts of an asset lie.

use std::ops::Range;

use rhogrid_core::asset::coded::{BASE_LINKS, FLAGS, START_CODES};
use rhogrid_core::asset::node::halves;
use rhogrid_core::asset::{
    HEADER_BYTES, SECTION_BYTES, SECTION_CODED_LEVEL, SECTION_DICTIONARY, SECTION_LEVEL, Shell,
};

/// An asset and where its parts lie.
pub struct Layout {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    pub rho: u8,
    pub levels: Vec<Level>,
    /// Empty where there is none.
    pub dictionary: Range<usize>,
}

pub struct Level {
    /// Of a coded level all 32-bit words behind its counts, else empty.
    pub tables: Range<usize>,
    pub links: Range<usize>,
    /// Records or codes.
    pub nodes: Range<usize>,
    /// Empty where the nodes are what is drawn.
    pub drawn: Range<usize>,
    pub attributes: Range<usize>,
    pub end: usize,
}

impl Layout {
    pub fn new(name: &'static str, rho: u8, shell: Shell, bytes: Vec<u8>) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let mut cells: Vec<usize> = vec![];
        let mut levels = vec![];
        let mut dictionary = 0..0;
        for entry in (0..usize::from(bytes[15])).map(|index| HEADER_BYTES + SECTION_BYTES * index) {
            let (start, length) = (word(entry + 4), word(entry + 8));
            let is_coded = match word(entry) as u32 {
                SECTION_LEVEL => false,
                SECTION_CODED_LEVEL => true,
                SECTION_DICTIONARY => {
                    dictionary = start..start + length;
                    continue;
                }
                _ => continue,
            };
            let (links, parents) = match cells[..] {
                [] => (0, 0),
                [parents] => (1, parents),
                [.., above, parents] => (above, parents),
            };
            // The header's depth.
            let depth = cells.len();
            let stores_drawn = shell == Shell::Thin && (1..usize::from(bytes[10])).contains(&depth);
            let arrays = 1 + usize::from(stores_drawn);
            let (tables, link_bytes, record_bytes) = if is_coded {
                let starts = arrays * parents.div_ceil(START_CODES);
                let words = FLAGS + links.div_ceil(BASE_LINKS) + starts + word(start + 4);
                (start + 8..start + 8 + 4 * words, 2 * links, 2)
            } else {
                (start + 4..start + 4, 4 * links, 2 * halves(rho))
            };
            let links = tables.end..tables.end + link_bytes.next_multiple_of(4);
            let nodes = links.end..links.end + record_bytes * parents;
            let start_of_drawn = nodes.end.next_multiple_of(4);
            let drawn_bytes = if stores_drawn { nodes.len() } else { 0 };
            let drawn = start_of_drawn..start_of_drawn + drawn_bytes;
            let attributes = drawn.end.next_multiple_of(4);
            cells.push(word(start));
            levels.push(Level {
                tables,
                links,
                nodes,
                drawn,
                attributes: attributes..attributes + 2 * word(start),
                end: start + length,
            });
        }
        Self {
            name,
            bytes,
            rho,
            levels,
            dictionary,
        }
    }
}
