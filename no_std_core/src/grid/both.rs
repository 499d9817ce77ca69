//! Drawing a rho-grid into the picture and into a shadow map in one traversal.
//!
//! Source: Duguet and Drettakis 2003, 5.3 (single pass). The paper's pass
//! orders cells along the light, so that a sample finds the map complete in
//! front of it. Here it is pixels that look the map up, after the grid's last
//! cell, and cells keep the eye's order, which hides what is behind. Culling
//! for the eye stops drawing, not casting, and the other way round.

use super::blocks::Queue;
use super::cast::{self, Caster, with_caster};
use super::record::Record;
use super::samples::Block;
use super::traverse::{Cell, Frame, Output, with_frame};
use crate::asset::Grid;
use crate::canvas::{Canvas, Pixel};
use crate::numbers::Length;
use crate::plan::Plan;
use crate::projection::Projection;
use crate::shadow::{CastForms, Map};
use crate::stats::Stats;

/// Draws a grid on a clear canvas and into a map: see
/// [`traverse`](super::traverse) and [`cast`](super::cast()).
pub(crate) fn traverse_and_cast<'a, P: Pixel>(
    grid: &'a Grid<'a>,
    view: ([Length; 3], &Projection, &Plan),
    light: (&CastForms, Option<[i32; 3]>, &mut Map<'_>),
    canvas: &mut Canvas<'_, P>,
    stats: &mut Stats,
) {
    match grid.rho() {
        #[cfg(feature = "rho-2")]
        2 => run::<2, 8, 15, P>(grid, view, light, canvas, stats),
        #[cfg(feature = "rho-3")]
        3 => run::<3, 27, 9, P>(grid, view, light, canvas, stats),
        #[cfg(feature = "rho-4")]
        4 => run::<4, 64, 7, P>(grid, view, light, canvas, stats),
        #[cfg(feature = "rho-5")]
        5 => run::<5, 125, 6, P>(grid, view, light, canvas, stats),
        // None opens.
        _ => {}
    }
}

#[inline(never)]
fn run<'a, const RHO: u8, const CELLS: usize, const LEVELS: usize, P: Pixel>(
    grid: &'a Grid<'a>,
    view: ([Length; 3], &Projection, &Plan),
    (forms, away, map): (&CastForms, Option<[i32; 3]>, &mut Map<'_>),
    canvas: &mut Canvas<'_, P>,
    stats: &mut Stats,
) {
    let mut casting = Stats::default();
    let strip = canvas.strip;
    with_frame::<RHO, CELLS, LEVELS, P>(grid, view, strip, |frame, root| {
        let mut output = Output {
            canvas,
            stats,
            queue: Queue {
                places: &mut [0; CELLS],
                blocks: &mut [Block::none(); CELLS],
            },
        };
        let light = (map, &mut casting);
        with_caster::<RHO, CELLS, LEVELS>(grid, forms, away, light, |caster| {
            let cast_root = caster.root();
            match caster.first::<RHO>() {
                Some((record, attribute)) if frame.plan.depth > 0 => {
                    let cells = (root, &cast_root);
                    node::<RHO, _, _, _>(frame, caster, cells, (&record, attribute), &mut output);
                }
                first => {
                    frame.start::<RHO>(root, &mut output);
                    caster.start::<RHO>(first);
                }
            }
        });
    });
    stats.casters_visited += casting.casters_visited;
    stats.casters_drawn += casting.casters_drawn;
}

/// Visits an intermediate cell, as the eye and as the light see it.
fn node<'a, const RHO: u8, const CELLS: usize, const LEVELS: usize, P: Pixel>(
    frame: &Frame<'a, CELLS, LEVELS, P>,
    caster: &mut Caster<'_, '_, '_, CELLS, LEVELS>,
    (cell, cast_cell): (&Cell, &cast::Cell),
    (record, attribute): (&Record<RHO>, u16),
    output: &mut Output<'_, '_, 'a, P>,
) {
    let seen = frame.seen(cell, record, attribute, output.stats);
    let is_lit = caster.is_lit(record.flags, attribute);
    let Some((cell, normals)) = seen else {
        if is_lit {
            caster.below(cast_cell, record);
        }
        return;
    };
    if !is_lit {
        return frame.visit_below(&cell, record, attribute, &normals, output);
    }
    if !caster.goes_beyond(cast_cell) {
        caster.below(cast_cell, record);
        return frame.visit_below(&cell, record, attribute, &normals, output);
    }
    if frame.draws_below::<RHO>(&cell, record, attribute, &normals, output) {
        return caster.below(cast_cell, record);
    }
    frame.for_each_spot_nearest_first::<RHO>(&cell, record, |spot, record| {
        let child = frame.child(&cell, spot);
        if let (Some((child, attribute)), Some(centre)) =
            (child, caster.child_centre(cast_cell, spot.at))
        {
            let cast_child = cast::Cell {
                depth: child.depth,
                index: child.index,
                first_child: child.first_child,
                centre,
            };
            let cells = (&child, &cast_child);
            node::<RHO, _, _, _>(frame, caster, cells, (record, attribute), output);
        }
    });
}
