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

use core::hint::black_box;

use super::affine::Affine;
use super::mask::{self, MAX_WORDS, Mask, SLOTS, Walk, slabs, slot};
use super::normals::Normals;
use super::record::{Stored, record_of};
use crate::asset::Level;
use crate::asset::node::Flags;
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
/// They lead by the middle of a word's slabs and the *pivot* of a row, its
/// middle cell or the one before the middle. Each sum that reaches a subcell is
/// rounded to sixteenths once for the row, once for the word if there are
/// several, and once for each step from the pivot: for rho 3 a subcell lies
/// within 2/32 px of where its steps lead, for rho 4 and 5 within 4/32.
pub(super) struct Subcells {
    /// From the middle of a word's slabs to its cells, by slot.
    pub cells: [u32; SLOTS],
    /// From the centre to the middle of each word's slabs.
    pub words: [u32; MAX_WORDS],
}

impl Subcells {
    /// To be filled. Of a word that the compiler does not know: zeros would be
    /// stored by a call that costs more than the filling.
    #[inline(always)]
    pub fn blank() -> Self {
        let word = black_box(0);
        Self {
            cells: [word; SLOTS],
            words: [word; MAX_WORDS],
        }
    }

    /// Fills the table from the steps between neighbours along x, y and z.
    #[inline(always)]
    pub fn fill<const RHO: u8>(&mut self, steps: &[Step; 3]) {
        let along_x = steps[0].packed();
        let rho = usize::from(RHO);
        let pivot = (rho - 1) / 2;
        let back = along_x.wrapping_mul(pivot as u32).wrapping_neg();
        // In half steps from the middle of as many as there are.
        let half_steps = |index: usize, count: usize| 2 * index as i32 + 1 - count as i32;
        for z in 0..slabs(RHO) {
            for y in 0..rho {
                let [x, y_steps, z_steps] = [
                    half_steps(pivot, rho),
                    half_steps(y, rho),
                    half_steps(z, slabs(RHO)),
                ];
                let row = Step::sum(steps, [x, y_steps, z_steps]);
                let mut place = row.packed().wrapping_add(back);
                for x in 0..rho {
                    self.cells[slot((z * rho + y) * rho + x)] = place;
                    place = place.wrapping_add(along_x);
                }
            }
        }
        let words = rho / slabs(RHO);
        for (index, word) in self.words.iter_mut().take(words).enumerate() {
            let along_z = half_steps(index, words) * slabs(RHO) as i32;
            *word = Step::sum(steps, [0, 0, along_z]).packed();
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

/// Draws a sample, COLUMNS by ROWS pixels of it. Of two samples the larger word
/// stays: the nearer one, whichever comes first, and of equal depths always
/// the same.
#[inline(always)]
fn dab<const COLUMNS: usize, const ROWS: usize>(place: u32, attribute: u16, window: &mut Window) {
    let first = (place >> 20 & 0xf0f) as usize;
    let word = place << 16 | u32::from(attribute);
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let pixel = &mut window[first + row * PITCH + column];
            if word > *pixel {
                *pixel = word;
            }
        }
    }
}

/// A cell whose children are drawn.
#[derive(Clone, Copy)]
pub(super) struct Block<'a> {
    /// Its centre as a word, with the brush's offset.
    pub place: u32,
    /// Its drawn record where that is one word, else the record's index in the
    /// level below.
    pub record: u32,
    /// Attributes of the children that are drawn.
    pub attributes: &'a [u16],
}

impl Block<'_> {
    /// To be overwritten.
    pub const NONE: Self = Self {
        place: 0,
        record: 0,
        attributes: &[],
    };

    /// Its drawn record. `level` is its children's.
    #[inline(always)]
    fn drawn<const RHO: u8>(&self, level: &Level<'_>) -> (Mask<RHO>, Flags) {
        if RHO == 3 {
            let flags = Flags::from_bits(self.record.flag_bits(RHO));
            return (self.record.mask(), flags);
        }
        match record_of(level, None, self.record as usize) {
            Some(record) => (record.drawn, record.flags),
            None => (Mask::NOTHING, Flags::from_bits(0)),
        }
    }
}

/// Least aperture, of 84 degrees, of blocks of which single samples are tested
/// for facing away: narrower ones are mostly skipped or seen as a whole.
const BOTH_WAYS: u8 = 13;

/// Draws the children of blocks; gives how many they are. `level` is the
/// children's.
#[inline(never)]
pub(super) fn draw_blocks<const RHO: u8, const COLUMNS: usize, const ROWS: usize>(
    blocks: &[Block<'_>],
    level: &Level<'_>,
    affine: &Affine,
    normals: &Normals,
    window: &mut Window,
) -> u32 {
    let mut drawn = 0;
    let walk = Walk::new();
    for block in blocks {
        drawn += block.attributes.len() as u32;
        let (mask, flags) = block.drawn::<RHO>(level);
        if flags.aperture >= BOTH_WAYS {
            let seen = (normals, flags.is_sheet());
            draw_both_ways::<RHO, COLUMNS, ROWS>(block, mask, affine, seen, window);
        } else {
            let as_it_is = |attribute| (attribute, 0);
            draw::<RHO, COLUMNS, ROWS>(block, mask, &walk, &affine.leaves, as_it_is, window);
        }
    }
    drawn
}

/// Draws the children of a block. `seen` tells how a sample shows, and how
/// much deeper.
#[inline(always)]
fn draw<const RHO: u8, const COLUMNS: usize, const ROWS: usize>(
    block: &Block<'_>,
    drawn: Mask<RHO>,
    walk: &Walk,
    subcells: &Subcells,
    seen: impl Fn(u16) -> (u16, u32),
    window: &mut Window,
) {
    let mut rest = block.attributes;
    for (word, &middle) in drawn.words().zip(&subcells.words) {
        // One word has as many cells as there are attributes.
        let count = match mask::words(RHO) {
            1 => rest.len(),
            _ => word.count_ones() as usize,
        };
        let Some((own, others)) = rest.split_at_checked(count) else {
            break;
        };
        rest = others;
        let middle = block.place.wrapping_add(middle);
        let mut slots = word;
        for &attribute in own {
            let slot = walk.lowest(&mut slots);
            let place = middle.wrapping_add(subcells.cells[slot]);
            let (attribute, deeper) = seen(attribute);
            dab::<COLUMNS, ROWS>(place.wrapping_sub(deeper), attribute, window);
        }
    }
}

/// Draws a block whose samples may face either way. Those that face away lie
/// deeper: where a wall has samples of its own on either side, the far side's
/// do not show between the near side's. Of a sheet they show the side that is
/// seen.
#[inline(never)]
fn draw_both_ways<const RHO: u8, const COLUMNS: usize, const ROWS: usize>(
    block: &Block<'_>,
    drawn: Mask<RHO>,
    affine: &Affine,
    (normals, is_sheet): (&Normals, bool),
    window: &mut Window,
) {
    let flip = if is_sheet { OPPOSITE } else { 0 };
    let seen = |attribute| match normals.faces_away(attribute) {
        true => (attribute ^ flip, affine.far_side),
        false => (attribute, 0),
    };
    let walk = Walk::new();
    draw::<RHO, COLUMNS, ROWS>(block, drawn, &walk, &affine.leaves, seen, window);
}
