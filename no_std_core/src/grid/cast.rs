//! Drawing a rho-grid into a shadow map.
//!
//! Source: Duguet and Drettakis 2003, 5.3. A parallel light sees all cells of a
//! depth at one size, so that they are drawn at one depth, and their places add
//! up from the root to the last cell: nothing is divided. Cells whose surfaces
//! face away from the light are left out, as in the picture.

use super::children::{Spot, children, coding};
use super::mask;
use super::normals::Normals;
use super::record::{Record, record_of};
use super::tables::{Point, Tables};
use crate::asset::Grid;
use crate::shadow::{CastForms, Map};
use crate::stats::Stats;

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
    let mut caster = Caster::<CELLS, LEVELS> {
        grid,
        tables: &tables,
        normals: away.map(|away| Normals::new(away, 0)),
        bottom: forms.bottom,
        side: forms.side,
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
        if let Some(normals) = &self.normals
            && normals.is_away(record.flags, attribute)
        {
            return;
        }
        if cell.depth + 1 >= self.bottom {
            return self.squares(cell, record);
        }
        let (grid, below) = (self.grid, self.tables.below(cell.depth));
        let attributes = match grid.levels().get(usize::from(cell.depth) + 1) {
            Some(level) => level.attributes,
            None => return,
        };
        let visit = |spot: Spot, record: Record<RHO>| {
            let (Some(&step), Some(&attribute)) =
                (below.displacements.get(spot.at), attributes.get(spot.index))
            else {
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

    /// Draws the children of a cell.
    fn squares<const RHO: u8>(&mut self, cell: &Cell, record: &Record<RHO>) {
        let table = &self.tables.below(cell.depth).displacements;
        for (word, steps) in record.drawn.words().zip(table.chunks(mask::cells(RHO))) {
            for bit in mask::bits(word) {
                if let Some(&step) = steps.get(bit) {
                    self.square(cell.centre.plus(step));
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
