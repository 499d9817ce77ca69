//! Multi-level traversal: from the root down to cells that are small enough
//! to be one splat, or to leaves.
//!
//! Source: Duguet and Drettakis 2003, 5.1 (centres by additions) and 5.2
//! (multi-level stop, bounds of a projected cell).

use super::facing::{EyeSpace, Facing, along, cone};
use super::tables::{LevelTable, Point, Tables};
use crate::asset::Grid;
use crate::asset::node::{Flags, halves, occupied};
use crate::camera::Camera;
use crate::draw::Quality;
use crate::normal::OPPOSITE;
use crate::projection::Projection;
use crate::reciprocal::{Reciprocal, reciprocal};
use crate::shade::Shader;
use crate::splat::{Extent, Splat, draw};
use crate::stats::Stats;
use crate::target::Target;

/// Half sides of rectangles saturate here, at 2^17 px: a place is at most 2^30
/// and half a picture from zero, so that it and a half side add up.
const HALF_LIMIT: i32 = 1 << 29;

/// Everything that a frame's traversal reads.
struct Frame<'a, const CELLS: usize, const LEVELS: usize> {
    grid: &'a Grid<'a>,
    projection: &'a Projection,
    shader: &'a Shader<'a>,
    tables: Tables<CELLS, LEVELS>,
    /// Longest side of a cell's rectangle that is one splat, Q20.12 pixels.
    splat_side: i32,
}

/// What a frame's traversal writes.
struct Output<'t, 'b> {
    target: &'t mut Target<'b>,
    stats: Stats,
}

/// A cell on the way down.
#[derive(Clone, Copy)]
struct Cell {
    depth: u8,
    /// Index in its level.
    index: usize,
    /// Index of its first child in the next level.
    first_child: usize,
    centre: Point,
    /// From the eye to the centre, eye space.
    view: [i32; 3],
}

/// A cell's projection.
struct Footprint {
    /// Centre, Q20.12 pixels from the top left corner.
    x: i32,
    y: i32,
    depth: u16,
    extent: Extent,
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
            None => self.leaf(root, self.tables.root.half_edges, attribute, None, output),
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
        let mut footprint = None;
        if nearest >= self.projection.near {
            let print = self.footprint(cell.centre, &half_edges, nearest);
            if self.is_outside(&print, output) {
                output.stats.nodes_outside += 1;
                return;
            }
            if 2 * print.extent.half[0].max(print.extent.half[1]) <= self.splat_side {
                let attribute = turned(attribute, cell.view, flags);
                self.splat(&print, print.depth, (print.x, print.y), attribute, output);
                return;
            }
            footprint = Some(print);
        }
        let table = self.tables.below(cell.depth);
        let leaves = cell.depth + 1 == self.grid.depth();
        if leaves {
            self.leaves(cell, record, flags, table, footprint, output);
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

    /// Draws the children of a cell, all of which are leaves.
    fn leaves(
        &self,
        cell: &Cell,
        record: &[u16],
        flags: Flags,
        table: &LevelTable<CELLS>,
        footprint: Option<Footprint>,
        output: &mut Output<'_, '_>,
    ) {
        let below = usize::from(cell.depth) + 1;
        let Some(level) = self.grid.levels().get(below) else {
            return;
        };
        let mut attributes = level.attributes.iter().skip(cell.first_child);
        // The block's nearest corner bounds every leaf's size.
        let extent = footprint.map(|_| {
            let nearest = cell.centre.w - self.extents(cell.depth).1;
            self.footprint(cell.centre, &table.half_edges, nearest)
                .extent
        });
        let limit = facing_limit(cell.view, self.extents(cell.depth).2);
        for (&half, displacements) in record.iter().zip(table.displacements.chunks(16)) {
            let mut bits = half;
            for displacement in displacements {
                if bits & 1 != 0 {
                    let Some(&attribute) = attributes.next() else {
                        return;
                    };
                    let behind = along(attribute, cell.view) > limit;
                    if !behind || flags.two_sided {
                        let leaf = Cell {
                            centre: cell.centre.plus(*displacement),
                            ..*cell
                        };
                        let attribute = turned(attribute, cell.view, flags);
                        self.leaf(&leaf, table.half_edges, attribute, extent, output);
                    }
                }
                bits >>= 1;
            }
        }
    }

    /// Draws one leaf, of a given extent or its own.
    fn leaf(
        &self,
        leaf: &Cell,
        half_edges: [Point; 3],
        attribute: u16,
        extent: Option<Extent>,
        output: &mut Output<'_, '_>,
    ) {
        let w = leaf.centre.w;
        if w < self.projection.near {
            return;
        }
        let inverse = reciprocal(w as u32);
        let (x, y) = self.place(leaf.centre, inverse);
        let depth = self.projection.depth(inverse);
        let print = match extent {
            Some(extent) => Footprint {
                x,
                y,
                depth,
                extent,
            },
            None => {
                let half_w: i32 = half_edges.iter().map(|edge| edge.w.abs() + 1).sum();
                self.footprint(
                    leaf.centre,
                    &half_edges,
                    (w - half_w).max(self.projection.near),
                )
            }
        };
        self.splat(&print, depth, (x, y), attribute, output);
    }

    fn splat(
        &self,
        print: &Footprint,
        depth: u16,
        (x, y): (i32, i32),
        attribute: u16,
        output: &mut Output<'_, '_>,
    ) {
        output.stats.samples_drawn += 1;
        let splat = Splat {
            x,
            y,
            depth,
            colour: self.shader.colour(attribute),
        };
        draw(output.target, &mut output.stats, &splat, &print.extent);
    }

    /// Extents of cells of a depth: half edges, half extent in w, radius.
    #[inline(always)]
    fn extents(&self, depth: u8) -> ([Point; 3], i32, i32) {
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

    /// Pixel position of a point with its reciprocal w.
    #[inline(always)]
    fn place(&self, point: Point, inverse: Reciprocal) -> (i32, i32) {
        let scale = self.projection.screen_scale + crate::numbers::SCREEN_BITS;
        let [middle_x, middle_y] = self.projection.middle;
        (
            inverse.times(point.x, scale) + middle_x.to_bits(),
            inverse.times(point.y, scale) + middle_y.to_bits(),
        )
    }

    /// Projects a cell. For a corner c + d: (X + dX) / (w + dw) - X / w =
    /// (dX - X / w dw) / (w + dw), so half the rectangle's sides are at most
    /// the sum over the half edges of |dX - X / w dw|, over the nearest w.
    fn footprint(&self, centre: Point, half_edges: &[Point; 3], nearest: i32) -> Footprint {
        let inverse = reciprocal(centre.w as u32);
        let nearest_inverse = reciprocal(nearest as u32);
        let (mut sum_x, mut sum_y) = (0i32, 0i32);
        for edge in half_edges {
            // dw / w, Q2.30; saturates at one, which only a leaf that reaches
            // behind the eye exceeds: no rectangle bounds that one.
            let ratio = i64::from(inverse.times(edge.w, 30));
            let shear = |value: i32| ((i64::from(value) * ratio) >> 30) as i32;
            sum_x = sum_x.saturating_add((edge.x - shear(centre.x)).saturating_abs());
            sum_y = sum_y.saturating_add((edge.y - shear(centre.y)).saturating_abs());
        }
        let scale = self.projection.screen_scale + crate::numbers::SCREEN_BITS;
        let (x, y) = self.place(centre, inverse);
        let depth = self.projection.depth(inverse);
        // The rim lies a cell's diagonal deeper, at least one step.
        let diagonal: i32 = half_edges.iter().map(|edge| edge.w.abs()).sum();
        let rim = reciprocal((centre.w.saturating_add(2 * diagonal)) as u32);
        Footprint {
            x,
            y,
            depth,
            extent: Extent {
                half: [sum_x, sum_y]
                    .map(|sum| (nearest_inverse.times(sum, scale) + 1).min(HALF_LIMIT)),
                rim_drop: (depth - self.projection.depth(rim).min(depth)).saturating_add(1),
            },
        }
    }

    /// Whether a projected cell lies wholly beside the band; a saturated half
    /// side reaches anywhere.
    fn is_outside(&self, print: &Footprint, output: &Output<'_, '_>) -> bool {
        let band = output.target.band;
        let pixel = |bound: u16| i32::from(bound) << crate::numbers::SCREEN_BITS;
        let is_beside = |at: i32, half: i32, low: u16, high: u16| {
            half < HALF_LIMIT && (at + half < pixel(low) || at - half > pixel(high))
        };
        let [half_x, half_y] = print.extent.half;
        is_beside(print.x, half_x, band.left, band.right)
            || is_beside(print.y, half_y, band.top, band.bottom)
    }
}

/// A two-sided sample that faces away shows its other side.
#[inline(always)]
fn turned(attribute: u16, view: [i32; 3], flags: Flags) -> u16 {
    if flags.two_sided && along(attribute, view) > 0 {
        attribute ^ OPPOSITE
    } else {
        attribute
    }
}

/// How far along its normal a leaf may lie behind the eye's horizon and still
/// be drawn: the block's radius (the view vector is the block's) and
/// 1/16 of the distance, for the 2.5 degrees of the code and the bend of the
/// surface inside the cell.
#[inline(always)]
fn facing_limit(view: [i32; 3], radius: i32) -> i32 {
    let [x, y, z] = view.map(i32::abs);
    let longest = x.max(y).max(z);
    radius + longest / 16
}
