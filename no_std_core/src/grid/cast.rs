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
use crate::shadow::{CastForms, DEPTH_BITS, Map, PITCH, TEXEL_BITS, WINDOW, WINDOW_SIDE};
use crate::stats::Stats;

/// Fraction bits of texels beyond a step's.
const FRACTION: i32 = TEXEL_BITS - SCREEN_BITS;

/// A cell in light space.
pub(super) struct Cell {
    pub depth: u8,
    pub index: usize,
    pub first_child: usize,
    pub centre: Point,
}

/// A grid on its way into a map.
pub(super) struct Caster<'t, 'm, 'a, const CELLS: usize, const LEVELS: usize> {
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
    with_caster::<RHO, CELLS, LEVELS>(grid, forms, away, (map, stats), |caster| {
        let first = caster.first::<RHO>();
        caster.start::<RHO>(first);
    });
}

/// Sets a grid's way into a map up.
#[inline(always)]
pub(super) fn with_caster<const RHO: u8, const CELLS: usize, const LEVELS: usize>(
    grid: &Grid<'_>,
    forms: &CastForms,
    away: Option<[i32; 3]>,
    (map, stats): (&mut Map<'_>, &mut Stats),
    visit: impl FnOnce(&mut Caster<'_, '_, '_, CELLS, LEVELS>),
) {
    let mut tables = Tables::EMPTY;
    tables.fill(RHO, forms.bottom, &forms.forms, 0);
    let mut subcells = Subcells::blank();
    let steps = tables.extents(forms.bottom).half_edges.map(step);
    let fits =
        map.has_windows() && forms.side <= WINDOW_SIDE && fits_window::<RHO>(&steps, forms.side);
    if fits {
        subcells.fill::<RHO>(&steps);
    }
    visit(&mut Caster {
        grid,
        tables: &tables,
        normals: away.map(|away| Normals::new(away, 0)),
        bottom: forms.bottom,
        side: forms.side,
        packed: fits.then_some(&subcells),
        map,
        stats,
    });
}

impl<const CELLS: usize, const LEVELS: usize> Caster<'_, '_, '_, CELLS, LEVELS> {
    pub fn root(&self) -> Cell {
        Cell {
            depth: 0,
            index: 0,
            first_child: 0,
            centre: self.tables.centre,
        }
    }

    /// The root's record and attribute, unless the root itself is drawn.
    pub fn first<const RHO: u8>(&self) -> Option<(Record<RHO>, u16)> {
        let levels = self.grid.levels();
        let record = record_of::<RHO>(levels.get(1)?, coding::<RHO>(self.grid, 1), 0)?;
        let attribute = *levels.first()?.attributes.first()?;
        (self.bottom > 0).then_some((record, attribute))
    }

    /// Draws all of it, given what [`Caster::first`] gives.
    pub fn start<const RHO: u8>(&mut self, first: Option<(Record<RHO>, u16)>) {
        let root = self.root();
        match first {
            Some((record, attribute)) => self.node::<RHO>(&root, &record, attribute),
            None => self.square(root.centre),
        }
    }

    fn node<const RHO: u8>(&mut self, cell: &Cell, record: &Record<RHO>, attribute: u16) {
        if self.is_lit(record.flags, attribute) {
            self.below(cell, record);
        }
    }

    /// Draws what lies below a cell that faces the light.
    pub fn below<const RHO: u8>(&mut self, cell: &Cell, record: &Record<RHO>) {
        match (self.bottom - cell.depth, self.packed) {
            (1, None) => self.squares(cell.centre, record.drawn),
            (1, Some(subcells)) => self.block(cell.centre, record.drawn, subcells),
            (2, Some(subcells)) => self.blocks(cell, record, subcells),
            _ => self.children(cell, record),
        }
    }

    /// Whether some of a cell may face the light.
    #[inline(always)]
    pub fn is_lit(&mut self, flags: Flags, attribute: u16) -> bool {
        self.stats.casters_visited += 1;
        let normals = self.normals.as_ref();
        normals.is_none_or(|normals| !normals.is_away(flags, attribute))
    }

    /// The centre of a cell's child, given its subcell.
    #[inline(always)]
    pub fn child_centre(&self, cell: &Cell, at: usize) -> Option<Point> {
        let below = self.tables.below(cell.depth);
        Some(cell.centre.plus(*below.displacements.get(at)?))
    }

    /// Whether the children of a cell have children that are not drawn.
    pub fn goes_beyond(&self, cell: &Cell) -> bool {
        self.bottom > cell.depth + 2
    }

    fn children<const RHO: u8>(&mut self, cell: &Cell, record: &Record<RHO>) {
        let grid = self.grid;
        let Some(level) = grid.levels().get(usize::from(cell.depth) + 1) else {
            return;
        };
        let visit = |spot: Spot, record: Record<RHO>| {
            if let (Some(centre), Some(&attribute)) = (
                self.child_centre(cell, spot.at),
                level.attributes.get(spot.index),
            ) {
                let child = Cell {
                    depth: cell.depth + 1,
                    index: spot.index,
                    first_child: spot.first_child,
                    centre,
                };
                self.node::<RHO>(&child, &record, attribute);
            }
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
                    let record = record_of::<RHO>(next, coding, index);
                    if let (Some(record), Some(&step)) = (record, steps.get(bit))
                        && self.is_lit(record.flags, attribute)
                    {
                        self.block(cell.centre.plus(step), record.drawn, subcells);
                    }
                }
            }
        }
    }

    /// Draws cells around the centre of their parent, by one addition each, in a
    /// window of the map.
    fn block<const RHO: u8>(&mut self, centre: Point, cells: Mask<RHO>, subcells: &Subcells) {
        match self.side {
            1 => self.block_of::<RHO, 1>(centre, cells, subcells),
            2 => self.block_of::<RHO, 2>(centre, cells, subcells),
            _ => self.block_of::<RHO, 3>(centre, cells, subcells),
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

#[cfg(test)]
mod tests;
