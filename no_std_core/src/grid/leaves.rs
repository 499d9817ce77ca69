//! The leaves of a block: the children of one cell.
//!
//! Leaves are projected exactly, one by one, or in screen space by additions
//! alone: a leaf at the offset d from the block's centre lies at
//!
//! ```text
//! X / w + (dX - X / w dw) / (w + dw)        exact
//! X / w + (dX - X / w dw) / w               affine
//! ```
//!
//! # Error
//!
//! They differ by the affine offset times |dw| / (w + dw), at most the block's
//! largest offset times its half extent in w over its nearest w. Where that is
//! below the quality's distortion bound the block is affine. Rounding adds
//! less than 3 rho / 2 units of 2^-12 px. Depth moves linearly in 1/w to first
//! order: it errs by at most (1/w) (dw / w)^2 of its scale and 3 rho / 2 steps.

use super::facing::{Facing, along, horizon, turned};
use super::footprint::{Place, Projected, extent, is_beside, near_limit, rim_drop};
use super::tables::Point;
use super::traverse::{Cell, Frame, Output};
use crate::asset::node::Flags;
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::reciprocal;
use crate::splat::{Extent, Splat, draw, draw_point};

/// A position on the screen, or a step of one: Q20.12 pixels and depth.
#[derive(Clone, Copy)]
struct Step {
    x: i32,
    y: i32,
    depth: i32,
}

impl Step {
    #[inline(always)]
    fn place(self) -> Place {
        Place {
            x: self.x,
            y: self.y,
            depth: self.depth.clamp(1, 65535) as u16,
        }
    }

    #[inline(always)]
    fn plus(self, other: Self, times: i32) -> Self {
        Self {
            x: self.x + other.x * times,
            y: self.y + other.y * times,
            depth: self.depth + other.depth * times,
        }
    }
}

/// How the leaves of a block reach the screen.
enum Path {
    /// Additions: the first leaf, and the steps along x, y and z.
    Affine { first: Step, steps: [Step; 3] },
    /// A reciprocal each.
    Exact,
}

impl<const CELLS: usize, const LEVELS: usize> Frame<'_, CELLS, LEVELS> {
    /// Draws the children of a cell, all of which are leaves.
    pub(super) fn leaves<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &[u16],
        seen: Seen,
        projected: Option<&Projected>,
        output: &mut Output<'_, '_>,
    ) {
        let below = usize::from(cell.depth) + 1;
        let level = self.grid.levels().get(below);
        let Some(attributes) = level.and_then(|level| level.attributes.get(cell.first_child..))
        else {
            return;
        };
        let leaves = Leaves { attributes, seen };
        let Some(block) = projected else {
            return self.near_leaves(cell, record, &leaves, output);
        };
        let half_edges = &self.tables.below(cell.depth).half_edges;
        let extent = Extent {
            half: block.slopes.half(self.projection, block.nearest, 1),
            rim_drop: rim_drop(self.projection, cell.centre.w, block.inverse, half_edges),
        };
        match self.path::<RHO>(block, &extent) {
            Path::Exact => self.exact_leaves(cell, record, &leaves, &extent, output),
            Path::Affine { first, steps } => {
                let mut places = [Place::ORIGIN; CELLS];
                let count = affine_places::<RHO>(record, first, &steps, &mut places);
                let places = places.get(..count).unwrap_or(&[]);
                self.affine_leaves(places, &leaves, &extent, output);
            }
        }
    }

    /// Affine where its error is below the bound.
    fn path<const RHO: u8>(&self, block: &Projected, extent: &Extent) -> Path {
        let rho = i32::from(RHO);
        // The block's half extent in w over its w, Q2.30; one at most.
        let ratio: i64 = block
            .slopes
            .ratios
            .iter()
            .map(|ratio| i64::from(ratio.abs()))
            .sum();
        let ratio = ratio * i64::from(rho);
        let offset = i64::from(extent.half[0].max(extent.half[1])) * i64::from(rho - 1);
        let scaled = self.projection.depth_scaled(block.inverse);
        // A limited depth is no base for steps.
        let is_limited = block.place.depth == 1 || block.place.depth == u16::MAX;
        // Twice the ratio bounds |dw| / (w + dw) up to a half.
        if ratio > 1 << 29
            || scaled > 1 << 31
            || is_limited
            || (offset * ratio) >> 29 >= i64::from(self.distortion)
        {
            return Path::Exact;
        }
        let bits = self.projection.screen_scale + SCREEN_BITS;
        let [first, second, third] = block.slopes.along;
        let [dw_first, dw_second, dw_third] = block.slopes.ratios;
        // Two half edges from leaf to leaf.
        let step = |[x, y]: [i32; 2], ratio: i32| Step {
            x: 2 * block.inverse.times(x, bits),
            y: 2 * block.inverse.times(y, bits),
            depth: -(((scaled * i64::from(ratio)) >> 29) as i32),
        };
        let steps = [
            step(first, dw_first),
            step(second, dw_second),
            step(third, dw_third),
        ];
        // Half of the way back; the steps are even in x and y.
        let mut corner = Step {
            x: 2 * block.place.x,
            y: 2 * block.place.y,
            depth: 2 * i32::from(block.place.depth),
        };
        for step in steps {
            corner = corner.plus(step, 1 - rho);
        }
        let first = Step {
            x: corner.x >> 1,
            y: corner.y >> 1,
            depth: corner.depth >> 1,
        };
        Path::Affine { first, steps }
    }

    #[inline(never)]
    fn affine_leaves(
        &self,
        places: &[Place],
        leaves: &Leaves<'_>,
        extent: &Extent,
        output: &mut Output<'_, '_>,
    ) {
        if extent.is_point() {
            return self.points(places, leaves, output);
        }
        for (place, &attribute) in places.iter().zip(leaves.attributes) {
            if let Some(attribute) = leaves.seen.leaf(attribute) {
                self.splat(*place, extent, attribute, output);
            }
        }
    }

    /// Leaves that cover no pixel centre but, maybe, their home pixel's.
    #[inline(never)]
    fn points(&self, places: &[Place], leaves: &Leaves<'_>, output: &mut Output<'_, '_>) {
        for (place, &attribute) in places.iter().zip(leaves.attributes) {
            if let Some(attribute) = leaves.seen.leaf(attribute) {
                output.stats.samples_drawn += 1;
                let pixel = [place.x >> SCREEN_BITS, place.y >> SCREEN_BITS];
                let colour = || self.shader.colour(attribute);
                draw_point(output.target, &mut output.stats, pixel, place.depth, colour);
            }
        }
    }

    #[inline(never)]
    fn exact_leaves(
        &self,
        cell: &Cell,
        record: &[u16],
        leaves: &Leaves<'_>,
        extent: &Extent,
        output: &mut Output<'_, '_>,
    ) {
        let displacements = &self.tables.below(cell.depth).displacements;
        leaves.for_each(record, displacements, |displacement, attribute| {
            let centre = cell.centre.plus(displacement);
            let place = Place::of(self.projection, centre, reciprocal(centre.w as u32));
            self.splat(place, extent, attribute, output);
        });
    }

    /// Leaves of a near block: each has an extent of its own.
    #[inline(never)]
    fn near_leaves(
        &self,
        cell: &Cell,
        record: &[u16],
        leaves: &Leaves<'_>,
        output: &mut Output<'_, '_>,
    ) {
        let table = self.tables.below(cell.depth);
        leaves.for_each(record, &table.displacements, |displacement, attribute| {
            let centre = cell.centre.plus(displacement);
            self.near_leaf(centre, &table.half_edges, attribute, output);
        });
    }

    /// Draws a leaf that may be near, unless its centre is behind the near
    /// plane.
    pub(super) fn near_leaf(
        &self,
        centre: Point,
        half_edges: &[Point; 3],
        attribute: u16,
        output: &mut Output<'_, '_>,
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
        self.splat(place, &extent, attribute, output);
    }

    /// Hands a sample to the splatter.
    #[inline(always)]
    pub(super) fn splat(
        &self,
        place: Place,
        extent: &Extent,
        attribute: u16,
        output: &mut Output<'_, '_>,
    ) {
        output.stats.samples_drawn += 1;
        let splat = Splat {
            x: place.x,
            y: place.y,
            depth: place.depth,
            colour: self.shader.colour(attribute),
        };
        draw(output.target, &mut output.stats, &splat, extent);
    }
}

/// Walks the places of a block's leaves by additions; gives how many there
/// are.
#[inline(never)]
fn affine_places<const RHO: u8>(
    record: &[u16],
    first: Step,
    steps: &[Step; 3],
    places: &mut [Place],
) -> usize {
    let [along_x, along_y, along_z] = *steps;
    let rho = usize::from(RHO);
    let word = |index: usize| u32::from(record.get(index).copied().unwrap_or(0));
    let mut places = places.iter_mut();
    let all = places.len();
    let mut bit = 0;
    let mut slab = first;
    for _ in 0..rho {
        let mut row = slab;
        for _ in 0..rho {
            // A row's bits lie in one word or across two.
            let words = word(bit / 16) | word(bit / 16 + 1) << 16;
            let mut bits = words >> (bit % 16) & ((1 << rho) - 1);
            let mut at = row;
            while bits != 0 {
                if bits & 1 != 0
                    && let Some(place) = places.next()
                {
                    *place = at.place();
                }
                bits >>= 1;
                at = at.plus(along_x, 1);
            }
            bit += rho;
            row = row.plus(along_y, 1);
        }
        slab = slab.plus(along_z, 1);
    }
    all - places.len()
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
struct Leaves<'a> {
    attributes: &'a [u16],
    seen: Seen,
}

impl Leaves<'_> {
    /// Visits the displacements and attributes of the leaves that are seen.
    #[inline(always)]
    fn for_each(&self, record: &[u16], displacements: &[Point], mut visit: impl FnMut(Point, u16)) {
        let mut attributes = self.attributes.iter();
        for (&half, displacements) in record.iter().zip(displacements.chunks(16)) {
            let mut bits = half;
            for &displacement in displacements {
                if bits & 1 != 0 {
                    let Some(&attribute) = attributes.next() else {
                        return;
                    };
                    if let Some(attribute) = self.seen.leaf(attribute) {
                        visit(displacement, attribute);
                    }
                }
                bits >>= 1;
            }
        }
    }
}
