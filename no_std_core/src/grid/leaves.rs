//! The leaves of a block: the children of one cell, each projected exactly and
//! drawn as a splat that covers its cell.

use super::facing::{Facing, along, cone, horizon, turned};
use super::footprint::{Place, Slopes, extent, is_beside, near_limit, rim_drop};
use super::mask::{self, Mask};
use super::record::Record;
use super::tables::Point;
use super::traverse::{Cell, Frame, Output};
use crate::asset::node::{APERTURE_ALL, Flags};
use crate::canvas::Pixel;
use crate::reciprocal::reciprocal;
use crate::splat::{Extent, Splat, draw};

impl<'a, const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'a, CELLS, LEVELS, P> {
    /// Draws the children of a cell as splats of their own size.
    #[inline(never)]
    pub(super) fn leaves<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        attribute: u16,
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        let below = usize::from(cell.depth) + 1;
        let level = self.grid.levels().get(below);
        let Some(attributes) = level.and_then(|level| level.attributes.get(cell.first_child..))
        else {
            return;
        };
        let extents = self.tables.extents(cell.depth);
        let facing = match self.plan.shows_all {
            true => Facing::Toward,
            false => cone(record.flags, attribute, cell.view, extents.eye_radius),
        };
        if facing == Facing::Away {
            return;
        }
        let seen = Seen::new(cell.view, extents.eye_radius, record.flags, facing);
        let leaves = Leaves {
            attributes,
            first: P::sample(cell.depth + 1, cell.first_child),
            seen,
        };
        let (near, w) = (self.projection.near, cell.centre.w);
        let nearest = w - extents.half_w;
        if nearest < near_limit(near, w) {
            if !is_beside(self.projection, cell.centre, extents.half_edges) {
                self.near_leaves::<RHO>(cell, record.drawn, &leaves, output);
            }
            return;
        }
        let inverse = reciprocal(w as u32);
        if self.plan.hides && self.hides_block(cell, inverse, nearest, output.canvas) {
            output.stats.nodes_hidden += 1;
            return;
        }
        let table = self.tables.below(cell.depth);
        let slopes = Slopes::at(cell.centre, inverse, &table.half_edges);
        let extent = Extent {
            half: slopes.half(self.projection, reciprocal(nearest as u32), 1),
            rim_drop: rim_drop(self.projection, w, inverse, &table.half_edges),
        };
        leaves.for_each(record.drawn, &table.displacements, |displacement, shown| {
            let centre = cell.centre.plus(displacement);
            let place = Place::of(self.projection, centre, reciprocal(centre.w as u32));
            splat(place, &extent, shown, output);
        });
    }

    /// Leaves of a near block: each has an extent of its own.
    #[inline(never)]
    fn near_leaves<const RHO: u8>(
        &self,
        cell: &Cell,
        drawn: Mask<RHO>,
        leaves: &Leaves<'_, P>,
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        let table = self.tables.below(cell.depth);
        leaves.for_each(drawn, &table.displacements, |displacement, shown| {
            let centre = cell.centre.plus(displacement);
            self.near_leaf(centre, &table.half_edges, shown, output);
        });
    }

    /// Draws the root alone, of which nothing tells what else it holds.
    pub(super) fn lone_root(
        &self,
        root: &Cell,
        attribute: u16,
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        let extents = self.tables.extents(0);
        let flags = Flags {
            aperture: APERTURE_ALL,
            two_sided: true,
        };
        let seen = Seen::new(root.view, extents.eye_radius, flags, Facing::Maybe);
        let shown = (seen.own(attribute), P::sample(0, 0));
        self.near_leaf(root.centre, extents.half_edges, shown, output);
    }

    /// Draws a leaf that may be near, unless its centre is behind the near
    /// plane.
    fn near_leaf(
        &self,
        centre: Point,
        half_edges: &[Point; 3],
        shown: (u16, P::Sample),
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        let near = self.projection.near;
        if centre.w < near {
            return;
        }
        let half_w: i32 = half_edges.iter().map(|edge| edge.w.abs() + 1).sum();
        let nearest = centre.w - half_w;
        if nearest < near_limit(near, centre.w) && is_beside(self.projection, centre, half_edges) {
            return;
        }
        let inverse = reciprocal(centre.w as u32);
        let place = Place::of(self.projection, centre, inverse);
        let extent = extent(
            self.projection,
            centre,
            inverse,
            half_edges,
            nearest.max(near),
        );
        splat(place, &extent, shown, output);
    }
}

/// Hands a sample to the splatter.
#[inline(always)]
fn splat<P: Pixel>(
    place: Place,
    extent: &Extent,
    (attribute, sample): (u16, P::Sample),
    output: &mut Output<'_, '_, '_, P>,
) {
    output.stats.samples_drawn += 1;
    output.stats.splats_drawn += 1;
    let splat = Splat {
        x: place.x,
        y: place.y,
        depth: place.depth as u16,
        attribute,
        sample,
    };
    draw(output.canvas, &splat, extent);
}

/// Which leaves of a block are seen.
pub(super) struct Seen {
    view: [i32; 3],
    limit: i32,
    flags: Flags,
    /// The block's cone faces the eye, and all leaves with it.
    all: bool,
}

impl Seen {
    /// For the leaves of a cell with its view vector, radius and cone.
    pub fn new(view: [i32; 3], radius: i32, flags: Flags, facing: Facing) -> Self {
        Self {
            view,
            limit: horizon(view, radius),
            flags,
            all: facing == Facing::Toward,
        }
    }

    /// A leaf's attribute as it is seen, if it is.
    #[inline(always)]
    fn leaf(&self, attribute: u16) -> Option<u16> {
        if self.all || along(attribute, self.view) <= self.limit {
            Some(attribute)
        } else if self.flags.two_sided {
            Some(turned(attribute, self.flags))
        } else {
            None
        }
    }

    /// The cell's own attribute as it is seen, where the cell is one splat:
    /// something in it may face the eye, whatever its sample does.
    pub fn own(&self, attribute: u16) -> u16 {
        if along(attribute, self.view) <= self.limit {
            attribute
        } else {
            turned(attribute, self.flags)
        }
    }
}

/// A block's leaves in mask order.
struct Leaves<'a, P: Pixel> {
    attributes: &'a [u16],
    /// The first of them.
    first: P::Sample,
    seen: Seen,
}

impl<P: Pixel> Leaves<'_, P> {
    /// Visits the displacements of the leaves that are seen, with what they show:
    /// an attribute, and the sample.
    #[inline(always)]
    fn for_each<const RHO: u8>(
        &self,
        drawn: Mask<RHO>,
        displacements: &[Point],
        mut visit: impl FnMut(Point, (u16, P::Sample)),
    ) {
        let mut attributes = self.attributes.iter();
        let mut next = self.first;
        for (word, displacements) in drawn.words().zip(displacements.chunks(mask::cells(RHO))) {
            for (bit, &attribute) in mask::bits(word).zip(attributes.by_ref()) {
                let sample = next;
                next = P::ahead(sample, 1);
                if let (Some(&displacement), Some(attribute)) =
                    (displacements.get(bit), self.seen.leaf(attribute))
                {
                    visit(displacement, (attribute, sample));
                }
            }
        }
    }
}
