//! Packed subtrees: from an exactly projected cell down to points.

use super::affine::Affine;
use super::blocks::block;
use super::children::Spot;
use super::facing::Facing;
use super::footprint::Place;
use super::normals::Normals;
use super::packed::Brush;
use super::record::Record;
use super::samples::draw_blocks;
use super::traverse::{Cell, Frame, Output};
use crate::asset::Level;
use crate::canvas::Pixel;
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::reciprocal;

impl<'a, const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'a, CELLS, LEVELS, P> {
    /// Draws the descendants of a cell, SPAN levels down, as points. `false`,
    /// with nothing done, if they do not fit a window.
    #[inline(never)]
    pub(super) fn packed<const RHO: u8, const SPAN: usize>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        attribute: u16,
        normals: &Normals,
        output: &mut Output<'_, '_, 'a, P>,
    ) -> bool {
        let bottom = cell.depth + SPAN as u8;
        let Some(level) = self.level(bottom) else {
            return false;
        };
        let inverse = reciprocal(cell.centre.w as u32);
        let place = Place::of(self.projection, cell.centre, inverse);
        let mut affine = Affine::blank();
        let at = (&place, inverse);
        if !self.map_around::<RHO, SPAN>(cell, at, bottom, normals, &mut affine)
            || !affine.reach.fits_depth(&place)
        {
            return false;
        }
        if !cell.inside && !self.is_near_strip(&place, output) {
            return true;
        }
        if self.is_hidden(&place, &affine, output.canvas) {
            output.stats.nodes_hidden += 1;
        } else {
            let subtree = Subtree {
                depth: cell.depth,
                spot: Spot {
                    at: 0,
                    index: cell.index,
                    first_child: cell.first_child,
                },
                record: *record,
                normals: *normals,
                facing: match self.plan.faces {
                    true => normals.facing(record.flags, attribute),
                    false => Facing::Toward,
                },
                affine: &affine,
                level,
            };
            self.subtree::<RHO, SPAN>(&subtree, &place, output);
        }
        true
    }

    /// Draws a subtree that lies at a place.
    #[inline(always)]
    pub(super) fn subtree<const RHO: u8, const SPAN: usize>(
        &self,
        subtree: &Subtree<'_, 'a, RHO>,
        place: &Place,
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        let affine = subtree.affine;
        let start = place.step().packed_in_window();
        let start = start.wrapping_add(affine.brush.offset());
        let window = output
            .canvas
            .window(place.x >> SCREEN_BITS, place.y >> SCREEN_BITS);
        let Some(window) = window else {
            return;
        };
        let level = subtree.level;
        let (queue, stats) = (&mut output.queue, &mut *output.stats);
        let blocks = match (SPAN, subtree.facing) {
            (1, _) => block::<RHO, P>(subtree, level, start, queue),
            (_, Facing::Toward) => self.blocks::<RHO, false>(subtree, level, start, queue, stats),
            _ => self.blocks::<RHO, true>(subtree, level, start, queue, stats),
        };
        let draw = match affine.brush {
            Brush::Point => draw_blocks::<RHO, 1, 1, P>,
            Brush::Wide => draw_blocks::<RHO, 2, 1, P>,
            Brush::Square => draw_blocks::<RHO, 2, 2, P>,
        };
        output.stats.samples_drawn += draw(window, blocks, affine, level, &subtree.normals);
    }
}

/// What a subtree is drawn from.
pub(super) struct Subtree<'s, 'a, const RHO: u8> {
    /// Its cell's.
    pub depth: u8,
    pub affine: &'s Affine,
    /// Its bottom's.
    pub level: &'a Level<'a>,
    /// From here on, siblings have each their own.
    pub spot: Spot,
    pub record: Record<RHO>,
    pub normals: Normals,
    /// How all of it faces.
    pub facing: Facing,
}
