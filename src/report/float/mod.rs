//! The core's frames in float, to ask what it would gain from positions that
//! it does not have: the same cells, the same colours, point sizes and
//! closing of holes, but each sample at a place of one's choice.
//!
//! Source of the rules: `no_std_core/src/grid`, path auto. What differs, and
//! should not matter: places are not rounded, every sample is projected by
//! itself, and whether points or squares are drawn is asked of each block.

mod canvas;
mod cells;

use glam::DVec3;
use rhogrid_core::asset::node::{APERTURE_SINE, Flags};
use rhogrid_core::normal::{COMPONENT_BITS, OPPOSITE, decode};

use super::model::bright;
use crate::picture::Picture;
use crate::view::View;
use canvas::Canvas;
use cells::Cell;
pub(super) use cells::Cells;

/// Where samples are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// At their cells' centres, as the core does.
    Centre,
    /// At the surface's points nearest to the centres.
    Surface,
}

/// Edges up to which samples are one pixel, two, and four, pixels.
const POINT_PX: f64 = 18.0 / 16.0;
const WIDE_PX: f64 = 24.0 / 16.0;
const SQUARE_PX: f64 = 2.0;
/// Cells of the splat's size that a hole's neighbours are nearer.
const GAP_CELLS: f64 = 2.0;
/// How many cells deeper samples are drawn that face away.
const FAR_SIDE_CELLS: f64 = 2.0;
/// Least aperture of blocks of which single samples are tested.
const BOTH_WAYS: u8 = 13;
/// Sine that facing tests leave to doubt.
const DOUBT: f64 = 1.0 / 16.0;

/// Draws a frame with a splat size in pixels; the view is the cube's.
pub(super) fn draw(cells: &Cells, place: Place, splat: f64, view: &View) -> Picture {
    let mut frame = Frame {
        cells,
        place,
        splat,
        view,
        canvas: Canvas::new(view),
    };
    if let Some([root]) = cells.depths.first().map(Vec::as_slice) {
        frame.node(0, root);
    }
    let gap = GAP_CELLS * splat.max(1.0) / view.focal_px;
    frame.canvas.picture(&cells.materials, &bright(), gap)
}

struct Frame<'a> {
    cells: &'a Cells,
    place: Place,
    splat: f64,
    view: &'a View,
    canvas: Canvas,
}

/// What the samples of a block have in common.
struct Block {
    flags: Flags,
    /// An edge of a sample's cell.
    edge: f64,
    /// How large a sample is where it is no square of its own size.
    brush: Option<[i64; 2]>,
}

fn normal(attribute: u16) -> DVec3 {
    DVec3::from_array(decode(attribute).map(f64::from)) / f64::from(1 << COMPONENT_BITS)
}

impl<'a> Frame<'a> {
    /// Draws what is below a cell.
    fn node(&mut self, depth: usize, cell: &'a Cell) {
        let centre = self.cells.centre(depth, cell);
        let towards = centre - self.view.eye;
        let radius = self.cells.edge(depth) * 3f64.sqrt() / 2.0;
        if is_away(cell, towards, radius) {
            return;
        }
        let Some(below) = self.cells.depths.get(depth + 1) else {
            return;
        };
        let first = cell.first as usize;
        let w = towards.dot(self.view.forward);
        let edge = self.cells.edge(depth + 1);
        let stops = w * self.splat >= edge * self.view.focal_px;
        if stops || depth + 2 == self.cells.depths.len() {
            let block = Block {
                flags: cell.flags,
                edge,
                brush: self.brush(edge, w, towards),
            };
            for child in &below[first..first + usize::from(cell.drawn)] {
                self.sample(depth + 1, child, &block);
            }
        } else {
            for child in &below[first..first + usize::from(cell.children)] {
                self.node(depth + 1, child);
            }
        }
    }

    /// Columns and rows of a block's samples, where they are points.
    fn brush(&self, edge: f64, w: f64, towards: DVec3) -> Option<[i64; 2]> {
        let density = match self.cells.is_thin {
            true => towards.normalize_or_zero().abs().max_element(),
            false => 1.0,
        };
        let edge_px = edge * self.view.focal_px / w;
        match edge_px / density.sqrt() {
            _ if w <= 0.0 || edge_px > SQUARE_PX => None,
            size if size <= POINT_PX => Some([1, 1]),
            size if size <= WIDE_PX => Some([2, 1]),
            _ => Some([2, 2]),
        }
    }

    fn sample(&mut self, depth: usize, cell: &Cell, block: &Block) {
        let centre = self.cells.centre(depth, cell);
        let point = match self.place {
            Place::Centre => centre,
            Place::Surface => DVec3::from_array(cell.point.map(f64::from)),
        };
        let towards = point - self.view.eye;
        let w = towards.dot(self.view.forward);
        let Some((attribute, deeper)) = self.seen(cell.attribute, centre - self.view.eye, block)
        else {
            return;
        };
        if w <= block.edge {
            return;
        }
        let scale = self.view.focal_px / w;
        let x = f64::from(self.view.width) / 2.0 + towards.dot(self.view.right) * scale;
        let y = f64::from(self.view.height) / 2.0 - towards.dot(self.view.up) * scale;
        match block.brush {
            Some(brush) => {
                let first = |at: f64, size: i64| (at - (size - 1) as f64 / 2.0).floor() as i64;
                for row in 0..brush[1] {
                    for column in 0..brush[0] {
                        let (left, top) = (first(x, brush[0]), first(y, brush[1]));
                        self.canvas
                            .dab(left + column, top + row, w + deeper, attribute);
                    }
                }
            }
            None => self.square([x, y], w, towards, block.edge, attribute),
        }
    }

    /// How a sample shows, and how much deeper, if it is seen.
    fn seen(&self, attribute: u16, towards: DVec3, block: &Block) -> Option<(u16, f64)> {
        let along = normal(attribute).dot(towards);
        if block.brush.is_some() {
            if block.flags.aperture < BOTH_WAYS || along <= 0.0 {
                return Some((attribute, 0.0));
            }
            let across = block.edge * self.view.forward.abs().element_sum();
            let flip = if block.flags.is_sheet() { OPPOSITE } else { 0 };
            return Some((attribute ^ flip, FAR_SIDE_CELLS * across));
        }
        let radius = block.edge * f64::from(self.cells.rho) * 3f64.sqrt() / 2.0;
        if along <= radius + towards.length() * 3.0 / 64.0 {
            Some((attribute, 0.0))
        } else if block.flags.two_sided {
            let flip = if block.flags.is_sheet() { OPPOSITE } else { 0 };
            Some((attribute ^ flip, 0.0))
        } else {
            None
        }
    }

    /// Draws the rectangle that a cell around a point covers: its core at the
    /// point's w, its rim a diagonal deeper.
    fn square(&mut self, at: [f64; 2], w: f64, towards: DVec3, edge: f64, attribute: u16) {
        let view = self.view;
        let reach = view.forward.abs().element_sum() * edge / 2.0;
        let half = [view.right, view.up].map(|axis| {
            let slope = axis - view.forward * (towards.dot(axis) / w);
            slope.abs().element_sum() * edge / 2.0 * view.focal_px / (w - reach).max(w / 2.0)
        });
        let bounds = self.canvas.bounds();
        let span = |axis: usize, half: f64| {
            let home = at[axis].floor() as i64;
            let low = (at[axis] - half - 0.5).ceil() as i64;
            let high = (at[axis] + half - 0.5).ceil() as i64;
            low.min(home).max(bounds[axis][0])..high.max(home + 1).min(bounds[axis][1])
        };
        let core = [0, 1].map(|axis| span(axis, half[axis] / 2.0));
        for row in span(1, half[1]) {
            for column in span(0, half[0]) {
                let is_core = core[0].contains(&column) && core[1].contains(&row);
                let depth = if is_core { w } else { w + 2.0 * reach };
                self.canvas.dab(column, row, depth, attribute);
            }
        }
    }
}

/// Whether all of a cell faces away, by its cone.
fn is_away(cell: &Cell, towards: DVec3, radius: f64) -> bool {
    let Some(&sine) = APERTURE_SINE.get(usize::from(cell.flags.aperture)) else {
        return false;
    };
    let distance = towards.length();
    let along = normal(cell.attribute).dot(towards) / distance;
    along > f64::from(sine) / 32768.0 + DOUBT + radius / distance
}
