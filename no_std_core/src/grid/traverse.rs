//! Multi-level traversal: from the root down to cells that are small enough,
//! or to leaves.
//!
//! Source: Duguet and Drettakis 2003, 5.1 (centres by additions) and 5.2
//! (multi-level stop, culling). Changes here: the cell above decides for its
//! children, by its distance alone; what is inside the picture is not tested
//! again below; the last one or two levels are walked in screen space
//! ([`super::packed`]) where that is exact enough; above them what is nearest
//! to the eye comes first, and what it hides is [not visited](super::hidden).

use core::marker::PhantomData;

use super::blocks::Queue;
use super::children::coding;
use super::clip::{Clip, Side};
use super::facing::EyeSpace;
use super::footprint::{Place, is_beside, near_limit};
use super::normals::Normals;
use super::record::{Record, record_of};
use super::samples::Block;
use super::tables::{Point, Tables};
use crate::asset::Grid;
use crate::asset::coded::Coding;
use crate::canvas::{Canvas, Pixel};
use crate::numbers::Length;
use crate::plan::Plan;
use crate::projection::Projection;
use crate::stats::Stats;
use crate::target::Rect;

/// Everything that a strip's traversal reads.
pub(super) struct Frame<'a, const CELLS: usize, const LEVELS: usize, P> {
    pub grid: &'a Grid<'a>,
    pub projection: &'a Projection,
    pub plan: &'a Plan,
    pub tables: &'a Tables<CELLS, LEVELS>,
    pub clip: &'a Clip<LEVELS>,
    /// What is drawn on.
    pub pixels: PhantomData<P>,
}

/// What a strip's traversal writes.
pub(super) struct Output<'t, 'c, 'a, P: Pixel> {
    pub canvas: &'t mut Canvas<'c, P>,
    pub stats: &'t mut Stats,
    pub queue: Queue<'t, 'a, P>,
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
    /// Whether all of it is known to lie inside the strip.
    pub inside: bool,
}

/// Draws a grid on a clear canvas, seen by an eye in model space.
pub(crate) fn traverse<P: Pixel>(
    grid: &Grid<'_>,
    eye: [Length; 3],
    projection: &Projection,
    plan: &Plan,
    canvas: &mut Canvas<'_, P>,
    stats: &mut Stats,
) {
    match grid.rho() {
        #[cfg(feature = "rho-2")]
        2 => run::<2, 8, 15, P>(grid, eye, projection, plan, canvas, stats),
        #[cfg(feature = "rho-3")]
        3 => run::<3, 27, 9, P>(grid, eye, projection, plan, canvas, stats),
        #[cfg(feature = "rho-4")]
        4 => run::<4, 64, 7, P>(grid, eye, projection, plan, canvas, stats),
        #[cfg(feature = "rho-5")]
        5 => run::<5, 125, 6, P>(grid, eye, projection, plan, canvas, stats),
        // None opens.
        _ => {}
    }
}

#[inline(never)]
fn run<const RHO: u8, const CELLS: usize, const LEVELS: usize, P: Pixel>(
    grid: &Grid<'_>,
    eye: [Length; 3],
    projection: &Projection,
    plan: &Plan,
    canvas: &mut Canvas<'_, P>,
    stats: &mut Stats,
) {
    let view = (eye, projection, plan);
    with_frame::<RHO, CELLS, LEVELS, P>(grid, view, canvas.strip, |frame, root| {
        let mut output = Output {
            canvas,
            stats,
            queue: Queue {
                places: &mut [0; CELLS],
                blocks: &mut [Block::none(); CELLS],
            },
        };
        frame.start::<RHO>(root, &mut output);
    });
}

/// Sets a strip's traversal up.
#[inline(always)]
pub(super) fn with_frame<'a, const RHO: u8, const CELLS: usize, const LEVELS: usize, P>(
    grid: &'a Grid<'a>,
    (eye, projection, plan): ([Length; 3], &Projection, &Plan),
    strip: Rect,
    visit: impl FnOnce(&Frame<'_, CELLS, LEVELS, P>, &Cell),
) {
    let eye_space = EyeSpace::new(eye);
    let mut tables = Tables::EMPTY;
    tables.fill(RHO, plan.depth, &projection.forms, eye_space.unit);
    let clip = Clip::new(projection, &tables, plan.depth, strip);
    let root = Cell {
        depth: 0,
        index: 0,
        first_child: 0,
        centre: tables.centre,
        view: eye_space.centre,
        inside: projection.holds_cube(strip),
    };
    let frame = Frame::<CELLS, LEVELS, P> {
        grid,
        projection,
        plan,
        tables: &tables,
        clip: &clip,
        pixels: PhantomData,
    };
    visit(&frame, &root);
}

impl<'a, const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'a, CELLS, LEVELS, P> {
    pub(super) fn start<const RHO: u8>(&self, root: &Cell, output: &mut Output<'_, '_, 'a, P>) {
        let levels = self.grid.levels();
        let (Some(top), next) = (levels.first(), levels.get(1)) else {
            return;
        };
        let Some(&attribute) = top.attributes.first() else {
            return;
        };
        match next {
            Some(next) if self.plan.depth > 0 => {
                if let Some(record) = record_of::<RHO>(next, self.coding::<RHO>(1), 0) {
                    self.node::<RHO>(root, &record, attribute, output);
                }
            }
            _ => self.lone_root(root, attribute, output),
        }
    }

    /// Visits an intermediate cell: skips it, draws its children, or visits
    /// them.
    pub(super) fn node<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        attribute: u16,
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        if let Some((cell, normals)) = self.seen(cell, record, attribute, output.stats) {
            self.visit_below(&cell, record, attribute, &normals, output);
        }
    }

    /// A cell, with what is known of its place, and how its children face,
    /// unless all of it faces away or lies outside.
    #[inline(always)]
    pub(super) fn seen<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        attribute: u16,
        stats: &mut Stats,
    ) -> Option<(Cell, Normals)> {
        stats.nodes_visited += 1;
        let normals = Normals::new(cell.view, self.tables.extents(cell.depth).eye_radius);
        if self.plan.faces {
            stats.facing_tests += 1;
            if normals.is_away(record.flags, attribute) {
                stats.nodes_back_facing += 1;
                return None;
            }
        }
        let side = if cell.inside {
            Side::Inside
        } else {
            stats.side_tests += 1;
            self.side(cell)
        };
        if side == Side::Outside {
            stats.nodes_outside += 1;
            return None;
        }
        let cell = Cell {
            inside: side == Side::Inside,
            ..*cell
        };
        Some((cell, normals))
    }

    /// Draws or visits the children of a cell that is seen.
    #[inline(always)]
    pub(super) fn visit_below<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        attribute: u16,
        normals: &Normals,
        output: &mut Output<'_, '_, 'a, P>,
    ) {
        if !self.draws_below::<RHO>(cell, record, attribute, normals, output) {
            self.for_each_child_nearest_first::<RHO>(cell, record, |child, record, attribute| {
                self.node::<RHO>(child, record, attribute, output);
            });
        }
    }

    /// Draws what lies below a cell, as packed subtrees where the plan allows
    /// that. `false`, with nothing done, where its children are to be visited.
    #[inline(always)]
    pub(super) fn draws_below<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        attribute: u16,
        normals: &Normals,
        output: &mut Output<'_, '_, 'a, P>,
    ) -> bool {
        let w = cell.centre.w;
        let stops = |levels| w >= self.plan.stop(cell.depth + levels);
        let packs =
            |levels: u8| w >= self.plan.level(cell.depth + levels).packed[levels as usize - 1];
        let shares = |levels: u8| {
            w >= self.plan.level(cell.depth + levels + 1).siblings[levels as usize - 1]
        };
        if stops(1) {
            let is_drawn =
                packs(1) && self.packed::<RHO, 1>(cell, record, attribute, normals, output);
            if !is_drawn {
                self.leaves::<RHO>(cell, record, attribute, output);
            }
            return true;
        }
        if stops(2) {
            packs(2) && self.packed::<RHO, 2>(cell, record, attribute, normals, output)
                || shares(1) && self.siblings::<RHO, 1>(cell, record, normals, output)
        } else {
            stops(3) && shares(2) && self.siblings::<RHO, 2>(cell, record, normals, output)
        }
    }

    /// Where a cell lies. Of cells next to the eye the strip tells nothing, but
    /// the picture does: see [`is_beside`].
    fn side(&self, cell: &Cell) -> Side {
        let extents = self.tables.extents(cell.depth);
        let (near, w) = (self.projection.near, cell.centre.w);
        if w - extents.half_w < near_limit(near, w)
            && is_beside(self.projection, cell.centre, extents.half_edges)
        {
            return Side::Outside;
        }
        self.clip.side(cell.depth, cell.centre)
    }

    /// How the level of a depth is coded, if it is a tri-grid's and is.
    #[inline(always)]
    pub(super) fn coding<const RHO: u8>(&self, depth: u8) -> Option<&'a Coding<'a>> {
        coding::<RHO>(self.grid, depth)
    }

    /// Whether a subtree centred at a place may touch the strip or what counts
    /// around it.
    #[inline(always)]
    pub(super) fn is_near_strip(&self, place: &Place, output: &Output<'_, '_, 'a, P>) -> bool {
        use crate::canvas::REACH;
        use crate::numbers::SCREEN_BITS;
        let strip = output.canvas.strip;
        let within = |at: i32, low: u16, high: u16, reach: i32| {
            let pixel = at >> SCREEN_BITS;
            pixel >= i32::from(low) - reach && pixel < i32::from(high) + reach
        };
        let [columns, rows] = REACH;
        within(place.x, strip.left, strip.right, columns)
            && within(place.y, strip.top, strip.bottom, rows)
    }
}
