//! Subtrees that are walked in screen space, with one addition a cell.
//!
//! A place is one word, relative to a [`Window`] of the canvas:
//!
//! ```text
//! bits 31..28  row          bits 23..20  column       bits 15..0  depth
//!      27..24  1/16 px           19..16  1/16 px
//! ```
//!
//! Places and displacements are added as wrapping words: fields of either
//! sign carry into each other and come out right as long as every sum fits
//! its field. Shifted right by 20 and masked, a place is the pixel's index in
//! the window; shifted left by 16 it is what the canvas compares.

use super::affine::Affine;
use super::lists::{CHUNK_CELLS, COUNTS, LISTS, MAX_CHUNKS, Mask, chunk_rows, chunks};
use super::normals::Normals;
use crate::asset::Level;
use crate::asset::node::{Flags, halves};
use crate::canvas::{PITCH, WINDOW_CENTRE, Window};
use crate::normal::OPPOSITE;

/// A position on the screen, or a step of one: Q20.12 pixels and depth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub x: i32,
    pub y: i32,
    pub depth: i32,
}

impl Step {
    /// So many halves of each of three steps.
    #[inline(always)]
    fn sum([first, second, third]: &[Self; 3], halves: [i32; 3]) -> Self {
        let along = |first, second, third| {
            (first * halves[0] + second * halves[1] + third * halves[2]) >> 1
        };
        Self {
            x: along(first.x, second.x, third.x),
            y: along(first.y, second.y, third.y),
            depth: along(first.depth, second.depth, third.depth),
        }
    }

    /// The step as a word to be added.
    #[inline(always)]
    pub fn packed(self) -> u32 {
        let x = (self.x + (1 << 7)) >> 8;
        let y = (self.y + (1 << 7)) >> 8;
        ((y << 24) as u32)
            .wrapping_add((x << 16) as u32)
            .wrapping_add(self.depth as u32)
    }

    /// The place as a word relative to the window around its own pixel.
    #[inline(always)]
    pub fn packed_in_window(self) -> u32 {
        let sixteenths = |at: i32| ((at & 0xfff) + (1 << 7)) >> 8;
        let x = sixteenths(self.x) + (WINDOW_CENTRE << 4);
        let y = sixteenths(self.y) + (WINDOW_CENTRE << 4);
        ((y << 24) | (x << 16) | self.depth) as u32
    }
}

/// Displacements from a cell's centre to its subcells', packed.
///
/// A chunk's *pivot* is its middle cell, or the one before the middle. Each
/// sum that reaches a subcell is rounded to sixteenths once for its chunk and
/// once for each step from the pivot along x and y: for rho 3 a subcell lies
/// within 3/32 px of where its steps lead.
pub(super) struct Subcells {
    /// From a chunk's pivot to its cells, in the lists' numbering.
    pub cells: [u32; CHUNK_CELLS],
    /// From the centre to each chunk's pivot.
    pub chunks: [u32; MAX_CHUNKS],
}

impl Subcells {
    pub const EMPTY: Self = Self {
        cells: [0; CHUNK_CELLS],
        chunks: [0; MAX_CHUNKS],
    };

    /// Fills the table from the steps between neighbours along x, y and z.
    #[inline(always)]
    pub fn fill<const RHO: u8>(&mut self, steps: &[Step; 3]) {
        let [along_x, along_y, _] = steps.map(Step::packed);
        let rho = usize::from(RHO);
        let rows = chunk_rows(RHO);
        let [pivot_x, pivot_y] = [(rho - 1) / 2, (rows - 1) / 2];
        let back = |step: u32, count: usize| step.wrapping_mul(count as u32).wrapping_neg();
        let mut row = back(along_x, pivot_x).wrapping_add(back(along_y, pivot_y));
        for y in 0..rows {
            let mut place = row;
            for x in 0..rho {
                self.cells[((y * rho + x) ^ 8) % CHUNK_CELLS] = place;
                place = place.wrapping_add(along_x);
            }
            row = row.wrapping_add(along_y);
        }
        // In half steps from the centre.
        let half_steps = |index: usize| 2 * index as i32 + 1 - rho as i32;
        let mut chunks = self.chunks.iter_mut();
        for z in 0..rho {
            for (y, chunk) in (pivot_y..rho).step_by(rows).zip(chunks.by_ref()) {
                let [x, y, z] = [pivot_x, y, z].map(half_steps);
                *chunk = Step::sum(steps, [x, y, z]).packed();
            }
        }
    }
}

/// What a sample is drawn with: the pixel that holds its centre, two pixels
/// side by side, or a square of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Brush {
    Point,
    Wide,
    Square,
}

impl Brush {
    /// From a sample's centre to the centre of its first pixel, as a word.
    #[inline(always)]
    pub fn offset(self) -> u32 {
        const HALF_LEFT: u32 = (8u32 << 16).wrapping_neg();
        const HALF_UP: u32 = (8u32 << 24).wrapping_neg();
        match self {
            Self::Point => 0,
            Self::Wide => HALF_LEFT,
            Self::Square => HALF_LEFT.wrapping_add(HALF_UP),
        }
    }
}

/// Draws a sample, COLUMNS by ROWS pixels of it; of equal depths the first
/// stays.
#[inline(always)]
fn dab<const COLUMNS: usize, const ROWS: usize>(place: u32, attribute: u16, window: &mut Window) {
    let first = (place >> 20 & 0xf0f) as usize;
    let depth = place << 16;
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let pixel = &mut window[first + row * PITCH + column];
            if depth > *pixel {
                *pixel = depth | u32::from(attribute);
            }
        }
    }
}

/// A cell whose children are drawn.
#[derive(Clone, Copy)]
pub(super) struct Block {
    /// Its centre as a word, with the brush's offset.
    pub place: u32,
    /// Its drawn record where that is one word, as [`Mask::word`] has it, else
    /// the record's index in the level below.
    pub record: u32,
    /// Index of its first child there.
    pub first: u32,
}

impl Block {
    /// To be overwritten.
    pub const NONE: Self = Self {
        place: 0,
        record: 0,
        first: 0,
    };

    /// Its drawn record.
    #[inline(always)]
    fn drawn<const RHO: u8>(&self, level: &Level<'_>) -> (Mask<RHO>, Flags) {
        if let Some(word) = Mask::<RHO>::of_word(self.record) {
            return (word, Flags::from_last(RHO, (self.record >> 16) as u16));
        }
        let first = self.record as usize * halves(RHO);
        let record = level.drawn.get(first..first + halves(RHO)).unwrap_or(&[]);
        let last = record.last().copied().unwrap_or(0);
        (Mask::of(record), Flags::from_last(RHO, last))
    }
}

/// Least aperture, of 84 degrees, of blocks of which single samples are tested
/// for facing away: narrower ones are mostly skipped or seen as a whole.
const BOTH_WAYS: u8 = 13;

/// Draws the children of blocks; gives how many they are. `level` is the
/// children's.
#[inline(never)]
pub(super) fn draw_blocks<const RHO: u8, const COLUMNS: usize, const ROWS: usize>(
    blocks: &[Block],
    level: &Level<'_>,
    affine: &Affine,
    normals: &Normals,
    window: &mut Window,
) -> u32 {
    let mut drawn = 0;
    for block in blocks {
        let attributes = level.attributes.get(block.first as usize..).unwrap_or(&[]);
        let (mask, flags) = block.drawn::<RHO>(level);
        drawn += if flags.aperture >= BOTH_WAYS {
            draw_both_ways::<RHO, COLUMNS, ROWS>(
                block,
                mask,
                attributes,
                affine,
                (normals, flags.is_sheet()),
                window,
            )
        } else {
            let as_it_is = |attribute| (attribute, 0);
            draw::<RHO, COLUMNS, ROWS>(block, mask, attributes, &affine.leaves, as_it_is, window)
        };
    }
    drawn
}

/// Draws the children of a block. `seen` tells how a sample shows, and how
/// much deeper.
#[inline(always)]
fn draw<const RHO: u8, const COLUMNS: usize, const ROWS: usize>(
    block: &Block,
    drawn: Mask<RHO>,
    attributes: &[u16],
    subcells: &Subcells,
    seen: impl Fn(u16) -> (u16, u32),
    window: &mut Window,
) -> u32 {
    let mut rest = attributes;
    for index in 0..chunks(RHO) {
        let bits = drawn.chunk(index);
        let Some((own, others)) = rest.split_at_checked(usize::from(COUNTS[bits])) else {
            break;
        };
        rest = others;
        let pivot = block.place.wrapping_add(subcells.chunks[index]);
        let mut list = LISTS[bits];
        for &attribute in own {
            let place = pivot.wrapping_add(subcells.cells[(list & 15) as usize]);
            list >>= 4;
            let (attribute, deeper) = seen(attribute);
            dab::<COLUMNS, ROWS>(place.wrapping_sub(deeper), attribute, window);
        }
    }
    (attributes.len() - rest.len()) as u32
}

/// Draws a block whose samples may face either way. Those that face away lie
/// deeper: where a wall has samples of its own on either side, the far side's
/// do not show between the near side's. Of a sheet they show the side that is
/// seen.
#[inline(never)]
fn draw_both_ways<const RHO: u8, const COLUMNS: usize, const ROWS: usize>(
    block: &Block,
    drawn: Mask<RHO>,
    attributes: &[u16],
    affine: &Affine,
    (normals, is_sheet): (&Normals, bool),
    window: &mut Window,
) -> u32 {
    let flip = if is_sheet { OPPOSITE } else { 0 };
    let seen = |attribute| match normals.faces_away(attribute) {
        true => (attribute ^ flip, affine.far_side),
        false => (attribute, 0),
    };
    draw::<RHO, COLUMNS, ROWS>(block, drawn, attributes, &affine.leaves, seen, window)
}
