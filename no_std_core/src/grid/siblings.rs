//! The children of a cell as packed subtrees that share one affine map.
//!
//! Each child is projected exactly; what lies below it is placed by the map
//! around its parent, so that tables are filled once for all of them.

use super::affine::Affine;
use super::children::Spot;
use super::facing::Facing;
use super::footprint::Place;
use super::normals::{Around, Normals};
use super::octave::Octave;
use super::record::Record;
use super::subtree::Subtree;
use super::traverse::{Cell, Frame, Output};
use crate::canvas::Pixel;
use crate::reciprocal::reciprocal;

impl<'a, const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'a, CELLS, LEVELS, P> {
    /// Draws what lies SPAN levels below the children of a cell. `false`, with
    /// nothing done, if such subtrees do not fit a window.
    #[inline(never)]
    pub(super) fn siblings<const RHO: u8, const SPAN: usize>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        normals: &Normals,
        output: &mut Output<'_, '_, 'a, P>,
    ) -> bool {
        let inverse = reciprocal(cell.centre.w as u32);
        let place = Place::of(self.projection, cell.centre, inverse);
        let bottom = cell.depth + 1 + SPAN as u8;
        let mut affine = Affine::blank();
        let at = (&place, inverse);
        if !self.map_around::<RHO, SPAN>(cell, at, bottom, normals, &mut affine) {
            return false;
        }
        let radius = |depth| self.tables.extents(depth).eye_radius;
        let around = Around::new(cell.view, radius(cell.depth), radius(cell.depth + 1));
        let octave = Octave::of(self.projection, inverse);
        let (stop, above) = (self.plan.stop(bottom), self.plan.stop(bottom - 1));
        let (Some(below), Some(level)) = (self.below(cell), self.level(bottom)) else {
            return false;
        };
        let count = record.children.count() as u32;
        output.stats.nodes_visited += count;
        output.stats.facing_tests += if self.plan.faces { count } else { 0 };
        // One for all children, set for each.
        // The first three hold for all children, the others are set for each.
        let mut subtree = Subtree {
            depth: cell.depth + 1,
            affine: &affine,
            level,
            spot: Spot::NONE,
            record: *record,
            normals: *normals,
            facing: Facing::Toward,
        };
        self.for_each_child::<RHO>(cell, record, |spot, record| {
            let Some((view, attribute)) = below.faced(cell, &spot) else {
                return;
            };
            let normals = around.normals(view);
            let facing = match self.plan.faces {
                true => normals.facing(record.flags, attribute),
                false => Facing::Toward,
            };
            if facing == Facing::Away {
                output.stats.nodes_back_facing += 1;
                return;
            }
            let Some(centre) = below.centre(cell, &spot) else {
                return;
            };
            subtree.spot = spot;
            subtree.record.set(record);
            subtree.normals = normals;
            subtree.facing = facing;
            let place = match octave.place(centre) {
                Some(place) => place,
                None => Place::of(self.projection, centre, reciprocal(centre.w as u32)),
            };
            let stops = centre.w >= stop && (SPAN == 1 || centre.w < above);
            if !stops || !affine.reach.fits_depth(&place) {
                return self.alone::<RHO>(cell, &subtree, output);
            }
            if !cell.inside && !self.is_near_strip(&place, output) {
                output.stats.nodes_outside += 1;
                return;
            }
            // One block costs little more than to ask.
            if SPAN > 1 && self.is_hidden(&place, &affine, output.canvas) {
                output.stats.nodes_hidden += 1;
                return;
            }
            self.subtree::<RHO, SPAN>(&subtree, &place, output);
        });
        true
    }

    /// Visits a child that cannot share the map: out of the way of those that
    /// do.
    #[inline(never)]
    fn alone<const RHO: u8>(
        &self,
        cell: &Cell,
        subtree: &Subtree<'_, 'a, RHO>,
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        // It is counted again.
        output.stats.nodes_visited -= 1;
        if let Some((child, attribute)) = self.child(cell, &subtree.spot) {
            self.node::<RHO>(&child, &subtree.record, attribute, output);
        }
    }
}
