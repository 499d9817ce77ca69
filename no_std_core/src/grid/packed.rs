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

use super::mask::{MAX_WORDS, SLOTS, slabs, slot};
use crate::canvas::WINDOW_CENTRE;

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
