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

use super::lists::{CHUNK_CELLS, COUNTS, LISTS, MAX_CHUNKS, chunk, chunk_rows, chunks};
use crate::canvas::{WINDOW_CENTRE, Window};

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

/// Half a pixel to the left: a place whose point is two pixels wide.
pub(super) const HALF_LEFT: u32 = (8u32 << 16).wrapping_neg();

/// Draws the cells of a list as points, one pixel wide or two.
#[inline(always)]
fn points<const WIDE: bool>(
    attributes: &[u16],
    mut list: u32,
    place: u32,
    cells: &[u32; CHUNK_CELLS],
    window: &mut Window,
    seen: impl Fn(u16) -> u16,
) {
    for &attribute in attributes {
        let place = place.wrapping_add(cells[(list & 15) as usize]);
        list >>= 4;
        let index = (place >> 20 & 0xf0f) as usize;
        let depth = place << 16;
        // Of equal depths the first stays.
        if depth > window[index] {
            window[index] = depth | u32::from(seen(attribute));
        }
        if WIDE && depth > window[index + 1] {
            window[index + 1] = depth | u32::from(seen(attribute));
        }
    }
}

/// Draws the children of a cell as points; gives how many there are. `seen`
/// tells how a sample shows.
#[inline(never)]
pub(super) fn block<const RHO: u8, const WIDE: bool>(
    place: u32,
    record: &[u16],
    attributes: &[u16],
    subcells: &Subcells,
    window: &mut Window,
    seen: impl Fn(u16) -> u16,
) -> usize {
    let mut rest = attributes;
    for (index, &offset) in (0..chunks(RHO)).zip(&subcells.chunks) {
        let bits = chunk::<RHO>(record, index) % 512;
        let Some((own, others)) = rest.split_at_checked(usize::from(COUNTS[bits])) else {
            break;
        };
        rest = others;
        let place = place.wrapping_add(offset);
        points::<WIDE>(own, LISTS[bits], place, &subcells.cells, window, &seen);
    }
    attributes.len() - rest.len()
}
