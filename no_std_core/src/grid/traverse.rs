//! Multi-level traversal: from the root down to cells that are small enough
//! to be one splat, or to leaves.
//!
//! Source: Duguet and Drettakis 2003, 5.1 (centres by additions) and 5.2
//! (multi-level stop, bounds of a projected cell).

use super::facing::{EyeSpace, Facing, cone};
use super::footprint::{Projected, is_beside, near_limit, rim_drop};
use super::leaves::Seen;
use super::tables::{Point, Tables};
use crate::asset::Grid;
use crate::asset::node::{APERTURE_ALL, Flags, halves, occupied};
use crate::camera::Camera;
use crate::draw::Quality;
use crate::numbers::{SCREEN_BITS, SplatPx};
use crate::projection::Projection;
use crate::shade::Shader;
use crate::splat::Extent;
use crate::stats::Stats;
use crate::target::Target;

/// Everything that a frame's traversal reads.
pub(super) struct Frame<'a, const CELLS: usize, const LEVELS: usize> {
    pub grid: &'a Grid<'a>,
    pub projection: &'a Projection,
    pub shader: &'a Shader<'a>,
    pub tables: &'a Tables<CELLS, LEVELS>,
    /// Longest side of a cell's rectangle that is one splat, Q20.12 pixels.
    pub splat_side: i32,
    /// Largest error of an affine block, Q20.12 pixels.
    pub distortion: i32,
}

/// What a frame's traversal writes.
pub(super) struct Output<'t, 'b> {
    pub target: &'t mut Target<'b>,
    pub stats: Stats,
}

/// A cell on the way down.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub depth: u8,
    /// Index in its level.
    pub index: usize,
    /// Index of its first child in the next level.
    pub first_child: usize,
    pub centre: Point,
    /// From the eye to the centre, eye space.
    pub view: [i32; 3],
    /// Whether it is drawn where drawing stops at its depth.
    pub is_drawn: bool,
}

/// The two records of a cell: see [the format](crate::asset).
#[derive(Clone, Copy)]
struct Record<'a> {
    node: &'a [u16],
    drawn: &'a [u16],
}

/// Q16.16 to Q20.12 pixels; the largest values saturate.
fn screen(length: SplatPx) -> i32 {
    (length.to_bits() >> (16 - SCREEN_BITS)) as i32
}

/// Draws a grid; the target is already clear.
pub(crate) fn traverse(
    grid: &Grid<'_>,
    camera: &Camera,
    quality: &Quality,
    shader: &Shader<'_>,
    target: &mut Target<'_>,
) -> Stats {
    match grid.rho() {
        2 => run::<2, 8, 15>(grid, camera, quality, shader, target),
        3 => run::<3, 27, 9>(grid, camera, quality, shader, target),
        4 => run::<4, 64, 7>(grid, camera, quality, shader, target),
        _ => run::<5, 125, 6>(grid, camera, quality, shader, target),
    }
}

#[inline(never)]
fn run<const RHO: u8, const CELLS: usize, const LEVELS: usize>(
    grid: &Grid<'_>,
    camera: &Camera,
    quality: &Quality,
    shader: &Shader<'_>,
    target: &mut Target<'_>,
) -> Stats {
    let projection = Projection::new(camera);
    let eye_space = EyeSpace::new(camera);
    let tables = Tables::new(RHO, grid.depth(), &projection, eye_space.unit);
    let root = Cell {
        depth: 0,
        index: 0,
        first_child: 0,
        centre: tables.centre,
        view: eye_space.centre,
        is_drawn: true,
    };
    let frame = Frame::<CELLS, LEVELS> {
        grid,
        projection: &projection,
        shader,
        tables: &tables,
        splat_side: screen(quality.splat),
        distortion: screen(quality.distortion),
    };
    let mut output = Output {
        target,
        stats: Stats::default(),
    };
    frame.start::<RHO>(&root, &mut output);
    output.stats
}

impl<const CELLS: usize, const LEVELS: usize> Frame<'_, CELLS, LEVELS> {
    fn start<const RHO: u8>(&self, root: &Cell, output: &mut Output<'_, '_>) {
        let levels = self.grid.levels();
        let (Some(top), next) = (levels.first(), levels.get(1)) else {
            return;
        };
        let Some(&attribute) = top.attributes.first() else {
            return;
        };
        match next {
            Some(next) => {
                let record = Record {
                    node: next.nodes.get(..halves(RHO)).unwrap_or(&[]),
                    drawn: next.drawn.get(..halves(RHO)).unwrap_or(&[]),
                };
                self.node::<RHO>(root, record, attribute, output);
            }
            None => {
                let extents = self.tables.extents(0);
                // Nothing tells what else it holds.
                let flags = Flags {
                    aperture: APERTURE_ALL,
                    two_sided: true,
                };
                let seen = Seen::new(root.view, extents.eye_radius, flags, Facing::Maybe);
                self.near_leaf(root.centre, extents.half_edges, seen.own(attribute), output);
            }
        }
    }

    /// Visits an intermediate cell: skips it, draws it, or descends.
    fn node<const RHO: u8>(
        &self,
        cell: &Cell,
        record: Record<'_>,
        attribute: u16,
        output: &mut Output<'_, '_>,
    ) {
        output.stats.nodes_visited += 1;
        let Some(&last) = record.node.last() else {
            return;
        };
        let flags = Flags::from_last(RHO, last);
        let extents = self.tables.extents(cell.depth);
        let facing = cone(flags, attribute, cell.view, extents.eye_radius);
        if facing == Facing::Away {
            output.stats.nodes_back_facing += 1;
            return;
        }
        let seen = Seen::new(cell.view, extents.eye_radius, flags, facing);
        let (near, w) = (self.projection.near, cell.centre.w);
        let nearest = w - extents.half_w;
        if nearest < near_limit(near, w) {
            let is_behind = w + extents.half_w < near;
            if is_behind || is_beside(self.projection, cell.centre, extents.half_edges) {
                output.stats.nodes_outside += 1;
            } else {
                self.descend::<RHO>(cell, record, seen, None, output);
            }
            return;
        }
        let half_edges = &self.tables.below(cell.depth).half_edges;
        let projected = Projected::new(self.projection, cell.centre, nearest, half_edges, RHO);
        if projected
            .place
            .is_outside(projected.half, output.target.band)
        {
            output.stats.nodes_outside += 1;
        } else if 2 * projected.half[0].max(projected.half[1]) <= self.splat_side {
            if cell.is_drawn {
                self.node_splat(cell, &projected, seen.own(attribute), output);
            }
        } else {
            self.descend::<RHO>(cell, record, seen, Some(&projected), output);
        }
    }

    fn descend<const RHO: u8>(
        &self,
        cell: &Cell,
        record: Record<'_>,
        seen: Seen,
        projected: Option<&Projected>,
        output: &mut Output<'_, '_>,
    ) {
        if cell.depth + 1 == self.grid.depth() {
            self.leaves::<RHO>(cell, record.drawn, seen, projected, output);
        } else {
            self.children::<RHO>(cell, record, output);
        }
    }

    /// Draws an intermediate cell as one splat.
    fn node_splat(
        &self,
        cell: &Cell,
        projected: &Projected,
        attribute: u16,
        output: &mut Output<'_, '_>,
    ) {
        let half_edges = self.tables.extents(cell.depth).half_edges;
        let w = cell.centre.w;
        let extent = Extent {
            half: projected.half,
            rim_drop: rim_drop(self.projection, w, projected.inverse, half_edges),
        };
        self.splat(projected.place, &extent, attribute, output);
    }

    /// Visits the children of a cell, all of which are intermediate: in file
    /// order, first those that are drawn at their depth, then the others.
    fn children<const RHO: u8>(
        &self,
        cell: &Cell,
        record: Record<'_>,
        output: &mut Output<'_, '_>,
    ) {
        let table = self.tables.below(cell.depth);
        let below = usize::from(cell.depth) + 1;
        let levels = self.grid.levels();
        let (Some(level), Some(next)) = (levels.get(below), levels.get(below + 1)) else {
            return;
        };
        let size = halves(RHO);
        let attributes = level.attributes.get(cell.first_child..).unwrap_or(&[]);
        let first_word = cell.first_child * size;
        let mut children = attributes
            .iter()
            .zip(
                next.nodes
                    .get(first_word..)
                    .unwrap_or(&[])
                    .chunks_exact(size),
            )
            .zip(
                next.drawn
                    .get(first_word..)
                    .unwrap_or(&[])
                    .chunks_exact(size),
            )
            .zip(cell.first_child..);
        let mut first_child = next.links.get(cell.index).copied().unwrap_or(0) as usize;
        for is_drawn in [true, false] {
            let displacements = table
                .displacements
                .chunks(16)
                .zip(table.eye_displacements.chunks(16));
            let masks = record.node.iter().zip(record.drawn);
            for ((&node, &drawn), (displacements, eye_displacements)) in masks.zip(displacements) {
                let mut bits = if is_drawn { drawn } else { node & !drawn };
                for (displacement, eye_displacement) in displacements.iter().zip(eye_displacements)
                {
                    if bits & 1 != 0 {
                        let Some((((&attribute, node), drawn), index)) = children.next() else {
                            return;
                        };
                        let [x, y, z] = cell.view;
                        let child = Cell {
                            depth: cell.depth + 1,
                            index,
                            first_child,
                            centre: cell.centre.plus(*displacement),
                            view: [
                                x + eye_displacement[0],
                                y + eye_displacement[1],
                                z + eye_displacement[2],
                            ],
                            is_drawn,
                        };
                        first_child += occupied(RHO, node) as usize;
                        self.node::<RHO>(&child, Record { node, drawn }, attribute, output);
                    }
                    bits >>= 1;
                }
            }
        }
    }
}
