//! Drawing a rho-grid into a shadow map.
//!
//! Source: Duguet and Drettakis 2003, 5.3. A parallel light sees all cells of a
//! depth at one size, so that they are drawn at one depth, and their places add
//! up from the root to the last cell: nothing is divided. Cells whose surfaces
//! face away from the light are left out, as in the picture.

use super::children::{Spot, children, coding};
use super::mask::{self, Mask, SLOTS, Walk};
use super::normals::Normals;
use super::packed::{Step, Subcells};
use super::record::{Record, record_of};
use super::tables::{Point, Tables};
use crate::asset::Grid;
use crate::asset::node::Flags;
use crate::numbers::SCREEN_BITS;
use crate::shadow::{CastForms, DEPTH_BITS, Map, PITCH, TEXEL_BITS, WINDOW};
use crate::stats::Stats;

/// Fraction bits of texels beyond a step's.
const FRACTION: i32 = TEXEL_BITS - SCREEN_BITS;

/// A cell in light space.
struct Cell {
    depth: u8,
    index: usize,
    first_child: usize,
    centre: Point,
}

/// A grid on its way into a map.
struct Caster<'t, 'm, 'a, const CELLS: usize, const LEVELS: usize> {
    grid: &'t Grid<'a>,
    tables: &'t Tables<CELLS, LEVELS>,
    /// How cells face the light; `None` where all cast.
    normals: Option<Normals>,
    bottom: u8,
    side: usize,
    /// From a block's centre to its children, where they fit a window.
    packed: Option<&'t Subcells>,
    map: &'t mut Map<'m>,
    stats: &'t mut Stats,
}

/// Draws a grid into a map. `away` leads away from the light, model space,
/// components below 2^15; `None` if cells that face away cast, too.
pub(crate) fn cast(
    grid: &Grid<'_>,
    forms: &CastForms,
    away: Option<[i32; 3]>,
    map: &mut Map<'_>,
    stats: &mut Stats,
) {
    match grid.rho() {
        #[cfg(feature = "rho-2")]
        2 => run::<2, 8, 15>(grid, forms, away, map, stats),
        #[cfg(feature = "rho-3")]
        3 => run::<3, 27, 9>(grid, forms, away, map, stats),
        #[cfg(feature = "rho-4")]
        4 => run::<4, 64, 7>(grid, forms, away, map, stats),
        #[cfg(feature = "rho-5")]
        5 => run::<5, 125, 6>(grid, forms, away, map, stats),
        // None opens.
        _ => {}
    }
}

#[inline(never)]
fn run<const RHO: u8, const CELLS: usize, const LEVELS: usize>(
    grid: &Grid<'_>,
    forms: &CastForms,
    away: Option<[i32; 3]>,
    map: &mut Map<'_>,
    stats: &mut Stats,
) {
    let mut tables = Tables::EMPTY;
    tables.fill(RHO, forms.bottom, &forms.forms, 0);
    let root = Cell {
        depth: 0,
        index: 0,
        first_child: 0,
        centre: tables.centre,
    };
    let mut subcells = Subcells::blank();
    let steps = tables.extents(forms.bottom).half_edges.map(step);
    let fits = map.has_windows() && forms.side <= 2 && fits_window::<RHO>(&steps, forms.side);
    if fits {
        subcells.fill::<RHO>(&steps);
    }
    let mut caster = Caster::<CELLS, LEVELS> {
        grid,
        tables: &tables,
        normals: away.map(|away| Normals::new(away, 0)),
        bottom: forms.bottom,
        side: forms.side,
        packed: fits.then_some(&subcells),
        map,
        stats,
    };
    caster.start::<RHO>(&root);
}

impl<const CELLS: usize, const LEVELS: usize> Caster<'_, '_, '_, CELLS, LEVELS> {
    fn start<const RHO: u8>(&mut self, root: &Cell) {
        let levels = self.grid.levels();
        let (Some(top), Some(next)) = (levels.first(), levels.get(1)) else {
            return self.square(root.centre);
        };
        let record = record_of::<RHO>(next, coding::<RHO>(self.grid, 1), 0);
        if let (Some(record), Some(&attribute)) = (record, top.attributes.first()) {
            match self.bottom {
                0 => self.square(root.centre),
                _ => self.node::<RHO>(root, &record, attribute),
            }
        }
    }

    fn node<const RHO: u8>(&mut self, cell: &Cell, record: &Record<RHO>, attribute: u16) {
        self.stats.casters_visited += 1;
        if self.is_away(record.flags, attribute) {
            return;
        }
        match (self.bottom - cell.depth, self.packed) {
            (1, None) => self.squares(cell.centre, record.drawn),
            (1, Some(subcells)) => self.block(cell.centre, record.drawn, subcells),
            (2, Some(subcells)) => self.blocks(cell, record, subcells),
            _ => self.children(cell, record),
        }
    }

    fn children<const RHO: u8>(&mut self, cell: &Cell, record: &Record<RHO>) {
        let (grid, below) = (self.grid, self.tables.below(cell.depth));
        let Some(level) = grid.levels().get(usize::from(cell.depth) + 1) else {
            return;
        };
        let visit = |spot: Spot, record: Record<RHO>| {
            let (Some(&step), Some(&attribute)) = (
                below.displacements.get(spot.at),
                level.attributes.get(spot.index),
            ) else {
                return;
            };
            let child = Cell {
                depth: cell.depth + 1,
                index: spot.index,
                first_child: spot.first_child,
                centre: cell.centre.plus(step),
            };
            self.node::<RHO>(&child, &record, attribute);
        };
        let place = (cell.depth, cell.index, cell.first_child);
        children::<RHO>(grid, place, record, visit);
    }

    /// The children of a cell whose own children are drawn: of those nothing but
    /// their places is asked for.
    fn blocks<const RHO: u8>(&mut self, cell: &Cell, record: &Record<RHO>, subcells: &Subcells) {
        let depth = usize::from(cell.depth);
        let levels = (
            self.grid.levels().get(depth + 1),
            self.grid.levels().get(depth + 2),
        );
        let (Some(own), Some(next)) = levels else {
            return;
        };
        let coding = coding::<RHO>(self.grid, cell.depth + 2);
        let table = &self.tables.below(cell.depth).displacements;
        let attributes = own.attributes.get(cell.first_child..).unwrap_or(&[]);
        let mut children = attributes.iter().zip(cell.first_child..);
        for mask in mask::in_file_order(record) {
            for (word, steps) in mask.words().zip(table.chunks(mask::cells(RHO))) {
                for (bit, (&attribute, index)) in mask::bits(word).zip(children.by_ref()) {
                    self.stats.casters_visited += 1;
                    let record = record_of::<RHO>(next, coding, index);
                    if let (Some(record), Some(&step)) = (record, steps.get(bit))
                        && !self.is_away(record.flags, attribute)
                    {
                        self.block(cell.centre.plus(step), record.drawn, subcells);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn is_away(&self, flags: Flags, attribute: u16) -> bool {
        let normals = self.normals.as_ref();
        normals.is_some_and(|normals| normals.is_away(flags, attribute))
    }

    /// Draws cells around the centre of their parent, by one addition each, in a
    /// window of the map.
    fn block<const RHO: u8>(&mut self, centre: Point, cells: Mask<RHO>, subcells: &Subcells) {
        match self.side {
            1 => self.block_of::<RHO, 1>(centre, cells, subcells),
            _ => self.block_of::<RHO, 2>(centre, cells, subcells),
        }
    }

    #[inline(always)]
    fn block_of<const RHO: u8, const SIDE: usize>(
        &mut self,
        Point { x, y, w }: Point,
        cells: Mask<RHO>,
        subcells: &Subcells,
    ) {
        let Some(([column, row], window)) = self.map.window([x, y]) else {
            return;
        };
        let start = Step {
            x: (x >> FRACTION) - (column << SCREEN_BITS),
            y: (y >> FRACTION) - (row << SCREEN_BITS),
            depth: w >> DEPTH_BITS,
        };
        // To the middle of the square's first texel.
        let back = (SIDE as u32 - 1) * (8 << 24 | 8 << 16);
        let start = start.packed().wrapping_sub(back);
        let walk = Walk::new();
        for (word, &middle) in cells.words().zip(&subcells.words) {
            let middle = start.wrapping_add(middle);
            let mut slots = word;
            while slots != 0 {
                let slot = walk.lowest(&mut slots);
                let place = middle.wrapping_add(subcells.cells[slot % SLOTS]);
                let first = (place >> 20 & 0xf0f) as usize;
                for row in 0..SIDE {
                    for column in 0..SIDE {
                        let texel = &mut window[first + row * PITCH + column];
                        if place as u16 > *texel {
                            *texel = place as u16;
                        }
                    }
                }
            }
        }
        self.stats.casters_drawn += cells.count() as u32;
    }

    /// The same one by one.
    fn squares<const RHO: u8>(&mut self, centre: Point, cells: Mask<RHO>) {
        let table = &self.tables.below(self.bottom - 1).displacements;
        for (word, steps) in cells.words().zip(table.chunks(mask::cells(RHO))) {
            for bit in mask::bits(word) {
                if let Some(&step) = steps.get(bit) {
                    self.square(centre.plus(step));
                }
            }
        }
    }

    #[inline(always)]
    fn square(&mut self, Point { x, y, w }: Point) {
        self.stats.casters_drawn += 1;
        self.map.square([x, y, w], self.side);
    }
}

/// The step between neighbours, of which half an edge is given.
fn step(half: Point) -> Step {
    Step {
        x: half.x >> (FRACTION - 1),
        y: half.y >> (FRACTION - 1),
        depth: half.w >> (DEPTH_BITS - 1),
    }
}

/// Whether squares around the children of a block lie in a window whose middle
/// texel holds the block's centre. A quarter is for rounding.
fn fits_window<const RHO: u8>(steps: &[Step; 3], side: usize) -> bool {
    let reach = |of: fn(&Step) -> i32| {
        let sum: i32 = steps
            .iter()
            .map(|step| of(step).saturating_abs().min(1 << 20))
            .sum();
        sum * (i32::from(RHO) - 1) / 2 + (side as i32 + 1) * (1 << SCREEN_BITS) / 2
    };
    let limit = ((WINDOW / 2 - 1) << SCREEN_BITS) - (1 << SCREEN_BITS) / 4;
    reach(|step| step.x) <= limit && reach(|step| step.y) <= limit
}
