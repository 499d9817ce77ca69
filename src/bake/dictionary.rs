//! Coded levels: the finest ones' records as indices into a dictionary. See
//! [`rhogrid_core::asset::coded`] for the format.

use std::cmp::Reverse;
use std::collections::HashMap;

use rhogrid_core::asset::coded::{
    BASE_LINKS, FIRST_ESCAPE, FLAGS, MASK_BITS, MAX_MASKS, START_CODES,
};
use rhogrid_core::asset::{SECTION_CODED_LEVEL, SECTION_DICTIONARY};

use super::writer::{Linked, extend_colours, extend_padded, extend_words, plain};

/// Most levels that are coded: the third has a hundredth of all records, and
/// cones of every aperture.
const MOST_LEVELS: usize = 3;

/// The sections of a tri-grid's levels: as many coded as makes them smallest.
pub(super) fn smallest(levels: &[Linked<'_>]) -> Vec<(u32, Vec<u8>)> {
    let most = MOST_LEVELS.min(levels.len().saturating_sub(1));
    let written = (0..=most).map(|count| sections(levels, count));
    let bytes = |sections: &Vec<(u32, Vec<u8>)>| -> usize {
        sections.iter().map(|(_, bytes)| bytes.len()).sum()
    };
    written.min_by_key(bytes).unwrap_or_default()
}

/// The sections with so many of the finest levels coded.
pub(super) fn sections(levels: &[Linked<'_>], count: usize) -> Vec<(u32, Vec<u8>)> {
    let (coarse, fine) = levels.split_at(levels.len().saturating_sub(count));
    let mut sections: Vec<(u32, Vec<u8>)> = coarse.iter().map(plain).collect();
    if !fine.is_empty() {
        sections.extend(coded(fine));
    }
    sections
}

/// A dictionary and the levels that use it.
fn coded(levels: &[Linked<'_>]) -> Vec<(u32, Vec<u8>)> {
    let levels: Vec<(Vec<u32>, &Linked<'_>)> = levels
        .iter()
        .map(|linked| (frequent_flags(linked), linked))
        .collect();
    let masks = dictionary(&levels);
    let mut bytes = Vec::new();
    let counted: Vec<u32> = masks
        .iter()
        .map(|mask| mask | mask.count_ones() << MASK_BITS)
        .collect();
    extend_words(&mut bytes, &counted);
    let places: HashMap<u32, u16> = masks.into_iter().zip(0..).collect();
    let mut sections = vec![(SECTION_DICTIONARY, bytes)];
    sections.extend(levels.iter().map(|(flags, linked)| {
        let bytes = level(linked, flags, &places);
        (SECTION_CODED_LEVEL, bytes)
    }));
    sections
}

/// Records as words.
fn words(records: &[u16]) -> impl Iterator<Item = u32> {
    let (records, _) = records.as_chunks();
    records
        .iter()
        .map(|&[low, high]| u32::from(low) | u32::from(high) << 16)
}

/// All records of a level.
fn records<'a>(linked: &Linked<'a>) -> impl Iterator<Item = u32> + use<'a> {
    words(&linked.level.nodes).chain(words(&linked.level.drawn))
}

fn flags_of(record: u32) -> u32 {
    record >> MASK_BITS << MASK_BITS
}

/// Values that occur more than once, the most frequent first.
fn by_frequency(values: impl Iterator<Item = u32>) -> impl Iterator<Item = u32> {
    let mut counts: HashMap<u32, usize> = HashMap::new();
    for value in values {
        *counts.entry(value).or_default() += 1;
    }
    let mut counts: Vec<(u32, usize)> = counts.into_iter().collect();
    counts.retain(|&(_, count)| count > 1);
    counts.sort_unstable_by_key(|&(value, count)| (Reverse(count), value));
    counts.into_iter().map(|(value, _)| value)
}

/// The flags that most records of a level have.
fn frequent_flags(linked: &Linked<'_>) -> Vec<u32> {
    let flags = by_frequency(records(linked).map(flags_of));
    flags.take(FLAGS).collect()
}

/// The masks that most records share, of those whose flags have codes. A mask
/// that occurs once takes as much as an escape.
fn dictionary(levels: &[(Vec<u32>, &Linked<'_>)]) -> Vec<u32> {
    let masks = levels.iter().flat_map(|(flags, linked)| {
        records(linked)
            .filter(|&record| flags.contains(&flags_of(record)))
            .map(|record| record ^ flags_of(record))
    });
    by_frequency(masks).take(MAX_MASKS).collect()
}

/// Codes, and what belongs to them.
struct Codes<'a> {
    flags: &'a [u32],
    places: &'a HashMap<u32, u16>,
    escapes: Vec<u32>,
}

impl Codes<'_> {
    /// Starts and codes of records.
    fn of(&mut self, records: &[u16]) -> (Vec<u32>, Vec<u16>) {
        let mut starts = Vec::new();
        let mut codes = Vec::new();
        for record in words(records) {
            if codes.len() % START_CODES == 0 {
                starts.push(self.escapes.len() as u32);
            }
            codes.push(self.code(record));
        }
        (starts, codes)
    }

    fn code(&mut self, record: u32) -> u16 {
        let own = flags_of(record);
        let flags = self.flags.iter().position(|&flags| flags == own);
        let mask = self.places.get(&(record ^ own));
        if let (Some(flags), Some(&mask)) = (flags, mask) {
            return mask << FLAGS.ilog2() | flags as u16;
        }
        self.escapes.push(record);
        FIRST_ESCAPE | ((self.escapes.len() - 1) % START_CODES) as u16
    }
}

fn level(linked: &Linked<'_>, flags: &[u32], places: &HashMap<u32, u16>) -> Vec<u8> {
    let Linked { level, links, .. } = linked;
    let mut coder = Codes {
        flags,
        places,
        escapes: Vec::new(),
    };
    let (node_starts, nodes) = coder.of(&level.nodes);
    let (drawn_starts, drawn) = coder.of(&level.drawn);
    let escapes = coder.escapes;
    let bases: Vec<u32> = links.iter().step_by(BASE_LINKS).copied().collect();
    let above = |(index, link): (usize, &u32)| (link - bases[index / BASE_LINKS]) as u16;
    let narrow: Vec<u16> = links.iter().enumerate().map(above).collect();
    let mut flags = flags.to_vec();
    flags.resize(FLAGS, 0);
    let mut bytes = Vec::new();
    extend_words(
        &mut bytes,
        &[level.attributes.len(), escapes.len()].map(|count| count as u32),
    );
    for words in [&flags, &bases, &node_starts, &drawn_starts, &escapes] {
        extend_words(&mut bytes, words);
    }
    for halves in [&narrow, &nodes, &drawn, &level.attributes] {
        extend_padded(&mut bytes, halves);
    }
    extend_colours(&mut bytes, linked);
    bytes
}
