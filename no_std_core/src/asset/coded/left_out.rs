//! Coded records where the core leaves them out: nothing opens, and what
//! would read them compiles to nothing.

use core::convert::Infallible;
use core::marker::PhantomData;

use crate::asset::AssetError;
use crate::asset::level::{Counts, Level, Shape, Stored};
use crate::asset::section::Section;

/// A dictionary that is never there.
#[derive(Clone, Copy, Debug)]
pub struct Dictionary<'a>(Infallible, PhantomData<&'a ()>);

impl<'a> Dictionary<'a> {
    pub fn open(section: &Section<'a>) -> Result<Self, AssetError> {
        Err(AssetError::LeftOut {
            offset: section.offset,
            feature: "mask-dictionary",
        })
    }

    pub fn masks(self) -> &'a [u32] {
        match self.0 {}
    }
}

/// A coding that is never there.
#[derive(Clone, Copy, Debug)]
pub struct Coding<'a>(Infallible, PhantomData<&'a ()>);

impl<'a> Coding<'a> {
    pub(in crate::asset) fn split(
        _: Shape,
        _: Counts,
        _: &Section<'a>,
        dictionary: Dictionary<'a>,
    ) -> Option<Stored<'a>> {
        match dictionary.0 {}
    }

    pub(in crate::asset) fn check(
        &self,
        _: &Level<'a>,
        _: bool,
        _: u8,
        _: u32,
    ) -> Result<(), AssetError> {
        match self.0 {}
    }

    pub(crate) fn record(&self, _: u16, _: usize, _: &[u32]) -> u32 {
        match self.0 {}
    }

    pub(crate) fn cells(&self, _: u16, _: usize) -> u32 {
        match self.0 {}
    }

    pub(crate) fn drawn_flags(&self, _: u16, _: usize) -> u32 {
        match self.0 {}
    }

    pub(crate) fn drawn(&self, _: u16, _: usize) -> (u32, u32) {
        match self.0 {}
    }

    pub(crate) fn pair(&self, _: [u16; 2], _: usize) -> [u32; 2] {
        match self.0 {}
    }

    pub(crate) fn link(&self, _: usize) -> u32 {
        match self.0 {}
    }

    /// Number of links.
    pub fn links(&self) -> usize {
        match self.0 {}
    }

    /// Records that have no code.
    pub fn escapes(&self) -> usize {
        match self.0 {}
    }

    pub(crate) fn node_starts(&self) -> &'a [u32] {
        match self.0 {}
    }

    pub(crate) fn drawn_starts(&self) -> &'a [u32] {
        match self.0 {}
    }
}

/// No codings.
#[derive(Clone, Debug)]
pub struct Codings<'a>(PhantomData<&'a ()>);

impl<'a> Codings<'a> {
    pub const EMPTY: Self = Self(PhantomData);

    pub fn get(&self, _: usize) -> Option<&Coding<'a>> {
        None
    }

    pub fn set(&mut self, _: usize, coding: Coding<'a>) {
        match coding.0 {}
    }
}
