//! The leaves of a block: the children of one cell, projected one by one.

use super::facing::{along, horizon, turned};
use super::footprint::{Place, extent};
use super::tables::{LevelTable, Point};
use super::traverse::{Cell, Frame, Output};
use crate::asset::node::Flags;
use crate::reciprocal::reciprocal;
use crate::splat::{Extent, Splat, draw};

/// What all leaves of a block share.
struct Block<'a> {
    half_edges: &'a [Point; 3],
    /// `None` where the block reaches behind the near plane: each leaf has an
    /// extent of its own.
    extent: Option<Extent>,
}

impl<const CELLS: usize, const LEVELS: usize> Frame<'_, CELLS, LEVELS> {
    /// Draws the children of a cell, all of which are leaves.
    pub(super) fn leaves(
        &self,
        cell: &Cell,
        record: &[u16],
        flags: Flags,
        table: &LevelTable<CELLS>,
        output: &mut Output<'_, '_>,
    ) {
        let below = usize::from(cell.depth) + 1;
        let Some(level) = self.grid.levels().get(below) else {
            return;
        };
        let mut attributes = level.attributes.iter().skip(cell.first_child);
        let (_, half_w, radius) = self.extents(cell.depth);
        let limit = horizon(cell.view, radius);
        let block = self.block(cell.centre, half_w, &table.half_edges);
        for (&half, displacements) in record.iter().zip(table.displacements.chunks(16)) {
            let mut bits = half;
            for displacement in displacements {
                if bits & 1 != 0 {
                    let Some(&attribute) = attributes.next() else {
                        return;
                    };
                    let seen = match along(attribute, cell.view) > limit {
                        false => Some(attribute),
                        true => flags.two_sided.then(|| turned(attribute, cell.view)),
                    };
                    if let Some(attribute) = seen {
                        let centre = cell.centre.plus(*displacement);
                        self.leaf(centre, &block, attribute, output);
                    }
                }
                bits >>= 1;
            }
        }
    }

    /// The block's nearest corner bounds every leaf's size.
    fn block<'e>(&self, centre: Point, half_w: i32, half_edges: &'e [Point; 3]) -> Block<'e> {
        let nearest = centre.w - half_w;
        let in_front = nearest >= self.projection.near;
        let shared = in_front.then(|| {
            let inverse = reciprocal(centre.w as u32);
            extent(self.projection, centre, inverse, half_edges, nearest)
        });
        Block {
            half_edges,
            extent: shared,
        }
    }

    /// Draws the root where there is nothing below it.
    pub(super) fn root_leaf(&self, root: &Cell, attribute: u16, output: &mut Output<'_, '_>) {
        let block = Block {
            half_edges: &self.tables.root.half_edges,
            extent: None,
        };
        self.leaf(root.centre, &block, turned(attribute, root.view), output);
    }

    fn leaf(&self, centre: Point, block: &Block<'_>, attribute: u16, output: &mut Output<'_, '_>) {
        if centre.w < self.projection.near {
            return;
        }
        let inverse = reciprocal(centre.w as u32);
        let place = Place::of(self.projection, centre, inverse);
        let own = match block.extent {
            Some(shared) => shared,
            None => {
                let half_w: i32 = block.half_edges.iter().map(|edge| edge.w.abs() + 1).sum();
                let nearest = (centre.w - half_w).max(self.projection.near);
                extent(self.projection, centre, inverse, block.half_edges, nearest)
            }
        };
        self.splat(place, &own, attribute, output);
    }

    /// Hands a sample to the splatter.
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
