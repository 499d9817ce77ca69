//! Records one by one, whether they are stored as they are or coded.

use core::iter::Zip;
use core::ops::Range;
use core::slice::{ChunksExact, Iter};

use super::coded::Coding;

/// One record: see [`super::node`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record<'a> {
    /// The file's own words.
    Stored(&'a [u16]),
    /// A tri-grid's record, decoded.
    Decoded([u16; 2]),
}

impl Record<'_> {
    /// The record's words.
    pub fn halves(&self) -> &[u16] {
        match self {
            Self::Stored(halves) => halves,
            Self::Decoded(halves) => halves,
        }
    }
}

/// Records of a level, in order.
#[derive(Clone, Debug)]
pub struct Records<'a>(Words<'a>);

#[derive(Clone, Debug)]
enum Words<'a> {
    Stored(ChunksExact<'a, u16>),
    Coded {
        codes: Zip<Range<usize>, Iter<'a, u16>>,
        coding: Coding<'a>,
        starts: &'a [u32],
    },
}

impl<'a> Records<'a> {
    /// Records of `size` words each.
    pub(super) fn stored(words: &'a [u16], size: usize) -> Self {
        Self(Words::Stored(words.chunks_exact(size)))
    }

    /// What codes stand for. `starts` belongs to them.
    pub(super) fn coded(codes: &'a [u16], coding: Coding<'a>, starts: &'a [u32]) -> Self {
        Self(Words::Coded {
            codes: (0..codes.len()).zip(codes),
            coding,
            starts,
        })
    }
}

impl<'a> Iterator for Records<'a> {
    type Item = Record<'a>;

    fn next(&mut self) -> Option<Record<'a>> {
        match &mut self.0 {
            Words::Stored(records) => records.next().map(Record::Stored),
            Words::Coded {
                codes,
                coding,
                starts,
            } => {
                let (index, &code) = codes.next()?;
                let word = coding.record(code, index, starts);
                Some(Record::Decoded([word as u16, (word >> 16) as u16]))
            }
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        match &self.0 {
            Words::Stored(records) => records.size_hint(),
            Words::Coded { codes, .. } => codes.size_hint(),
        }
    }
}

impl ExactSizeIterator for Records<'_> {}
