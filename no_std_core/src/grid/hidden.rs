//! What lies behind what is drawn.
//!
//! A subtree whose every sample is deeper than each pixel that it may touch
//! changes nothing: it is left out, and the canvas is the same to the bit. Cells
//! above are visited [nearest first](Frame::for_each_child_nearest_first), so
//! that what hides is there before what is hidden.

use super::affine::Affine;
use super::footprint::{Place, Slopes};
use super::packed::Brush;
use super::traverse::{Cell, Frame};
use crate::canvas::{Canvas, Pixel};
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::{Reciprocal, reciprocal};

/// What rounding moves a packed place by, at most, Q20.12 pixels: see
/// [`super::packed::Subcells`].
const ROUNDING: i32 = 9 << (SCREEN_BITS - 5);

impl<const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'_, CELLS, LEVELS, P> {
    /// Whether nothing of a subtree that lies at a place would show. Its depths
    /// fit their field there.
    #[inline(always)]
    pub(super) fn is_hidden(&self, place: &Place, affine: &Affine, canvas: &Canvas<'_, P>) -> bool {
        if !self.plan.hides {
            return false;
        }
        let nearest = (place.depth + affine.reach.depth) as u32;
        let word = nearest << 16 | 0xffff;
        canvas.exceeds_at(place.x >> SCREEN_BITS, place.y >> SCREEN_BITS, word)
            && is_behind(place, affine, canvas, word)
    }
}

impl<const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'_, CELLS, LEVELS, P> {
    /// Whether nothing of a cell's children would show, drawn as splats of their
    /// own size. `nearest` bounds their w from below.
    ///
    /// A child's splat reaches as far from its centre as the cell's own bounding
    /// rectangle over the nearest w does at that side: both are sums of the same
    /// slopes.
    #[inline(never)]
    pub(super) fn hides_block(
        &self,
        cell: &Cell,
        inverse: Reciprocal,
        nearest: i32,
        canvas: &Canvas<'_, P>,
    ) -> bool {
        let place = Place::of(self.projection, cell.centre, inverse);
        let nearest = reciprocal(nearest as u32);
        let word = u32::from(self.projection.depth(nearest)) << 16 | 0xffff;
        if !canvas.exceeds_at(place.x >> SCREEN_BITS, place.y >> SCREEN_BITS, word) {
            return false;
        }
        let extents = self.tables.extents(cell.depth);
        let slopes = Slopes::at(cell.centre, inverse, extents.half_edges);
        let [half_x, half_y] = slopes.half(self.projection, nearest, 1);
        // A pixel for what rounding moves.
        let pixels = |at: i32, half: i32| {
            [
                ((at - half) >> SCREEN_BITS) - 1,
                ((at + half) >> SCREEN_BITS) + 1,
            ]
        };
        canvas.exceeds(pixels(place.x, half_x), pixels(place.y, half_y), word)
    }
}

/// Whether all pixels that a subtree may touch show more than a word.
#[inline(never)]
fn is_behind<P: Pixel>(place: &Place, affine: &Affine, canvas: &Canvas<'_, P>, word: u32) -> bool {
    let pixels = |at: i32, reach: i32, is_two: bool| {
        // Half a pixel back and one ahead: see [`Brush`].
        let at = at - if is_two { 1 << (SCREEN_BITS - 1) } else { 0 };
        let reach = reach + ROUNDING;
        let (first, last) = (at - reach, at + reach);
        [
            first >> SCREEN_BITS,
            (last >> SCREEN_BITS) + i32::from(is_two),
        ]
    };
    let reach = &affine.reach;
    let columns = pixels(place.x, reach.x, affine.brush != Brush::Point);
    let rows = pixels(place.y, reach.y, affine.brush == Brush::Square);
    canvas.exceeds(columns, rows, word)
}
