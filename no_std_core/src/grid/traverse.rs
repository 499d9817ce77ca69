//! Multi-level traversal: from the root down to cells that are small enough
//! to be one splat, or to leaves.
//!
//! Source: Duguet and Drettakis 2003, 5.1 (centres by additions) and 5.2
//! (multi-level stop, bounds of a projected cell).

use super::facing::{EyeSpace, Facing, cone, turned};
use super::footprint::{Place, extent};
use super::tables::{LevelTable, Point, Tables};
use crate::asset::Grid;
use crate::asset::node::{Flags, halves, occupied};
use crate::camera::Camera;
use crate::draw::Quality;
use crate::projection::Projection;
use crate::reciprocal::reciprocal;
use crate::shade::Shader;
use crate::stats::Stats;
use crate::target::Target;

/// Everything that a frame's traversal reads.
pub(super) struct Frame<'a, const CELLS: usize, const LEVELS: usize> {
    pub grid: &'a Grid<'a>,
    pub projection: &'a Projection,
    pub shader: &'a Shader<'a>,
    pub tables: Tables<CELLS, LEVELS>,
    /// Longest side of a cell's rectangle that is one splat, Q20.12 pixels.
    pub splat_side: i32,
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
    };
    let frame = Frame::<CELLS, LEVELS> {
        grid,
        projection: &projection,
        shader,
        tables,
        splat_side: (quality.splat.to_bits() >> 4) as i32,
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
                let record = next.nodes.get(..halves(RHO)).unwrap_or(&[]);
                self.node::<RHO>(root, record, attribute, output);
            }
            None => self.root_leaf(root, attribute, output),
        }
    }

    /// Visits an intermediate cell: skips it, draws it, or descends.
    fn node<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &[u16],
        attribute: u16,
        output: &mut Output<'_, '_>,
    ) {
        output.stats.nodes_visited += 1;
        let Some(&last) = record.last() else { return };
        let flags = Flags::from_last(RHO, last);
        let (half_edges, half_w, radius) = self.extents(cell.depth);
        if cone(flags, attribute, cell.view, radius) == Facing::Away {
            output.stats.nodes_back_facing += 1;
            return;
        }
        if cell.centre.w + half_w < self.projection.near {
            output.stats.nodes_outside += 1;
            return;
        }
        let nearest = cell.centre.w - half_w;
        if nearest >= self.projection.near {
            let inverse = reciprocal(cell.centre.w as u32);
            let place = Place::of(self.projection, cell.centre, inverse);
            let extent = extent(self.projection, cell.centre, inverse, &half_edges, nearest);
            if place.is_outside(&extent, output.target.band) {
                output.stats.nodes_outside += 1;
                return;
            }
            if 2 * extent.half[0].max(extent.half[1]) <= self.splat_side {
                self.splat(place, &extent, turned(attribute, cell.view), output);
                return;
            }
        }
        let table = self.tables.below(cell.depth);
        let leaves = cell.depth + 1 == self.grid.depth();
        if leaves {
            self.leaves(cell, record, flags, table, output);
        } else {
            self.children::<RHO>(cell, record, table, output);
        }
    }

    /// Visits the children of a cell, all of which are intermediate.
    fn children<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &[u16],
        table: &LevelTable<CELLS>,
        output: &mut Output<'_, '_>,
    ) {
        let below = usize::from(cell.depth) + 1;
        let levels = self.grid.levels();
        let (Some(level), Some(next)) = (levels.get(below), levels.get(below + 1)) else {
            return;
        };
        let size = halves(RHO);
        let attributes = level.attributes.get(cell.first_child..).unwrap_or(&[]);
        let records = next.nodes.get(cell.first_child * size..).unwrap_or(&[]);
        let mut children = attributes
            .iter()
            .zip(records.chunks_exact(size))
            .zip(cell.first_child..);
        let mut first_child = next.links.get(cell.index).copied().unwrap_or(0) as usize;
        let displacements = table
            .displacements
            .chunks(16)
            .zip(table.eye_displacements.chunks(16));
        for (&half, (displacements, eye_displacements)) in record.iter().zip(displacements) {
            let mut bits = half;
            for (displacement, eye_displacement) in displacements.iter().zip(eye_displacements) {
                if bits & 1 != 0 {
                    let Some(((&attribute, record), index)) = children.next() else {
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
                    };
                    first_child += occupied(RHO, record) as usize;
                    self.node::<RHO>(&child, record, attribute, output);
                }
                bits >>= 1;
            }
        }
    }

    /// Extents of cells of a depth: half edges, half extent in w, radius.
    #[inline(always)]
    pub(super) fn extents(&self, depth: u8) -> ([Point; 3], i32, i32) {
        match depth.checked_sub(1) {
            None => (
                self.tables.root.half_edges,
                self.tables.root.half_w,
                self.tables.root.eye_radius,
            ),
            Some(above) => {
                let table = self.tables.below(above);
                (table.half_edges, table.half_w, table.eye_radius)
            }
        }
    }
}
