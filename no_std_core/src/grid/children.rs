//! The children of a cell, all of which are intermediate, one after the other.

use super::mask;
use super::record::{Record, link_of, record_of};
use super::tables::{LevelTable, Point};
use super::traverse::{Cell, Frame};
use crate::asset::coded::Coding;
use crate::asset::{Grid, Level};
use crate::canvas::Pixel;

/// Where a child is: in its parent and in its level.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    /// Its subcell.
    pub at: usize,
    /// Its index in its level.
    pub index: usize,
    /// Index of its first child in the next level.
    pub first_child: usize,
}

impl Spot {
    /// Of no child: with an index that none has.
    pub const NONE: Self = Self {
        at: 0,
        index: usize::MAX,
        first_child: 0,
    };
}

/// Visits the children of a cell, given its depth, its index in its level and
/// that of its first child, with their records: in file order, first those that
/// are drawn at their depth, then the others.
#[inline(always)]
pub(super) fn children<const RHO: u8>(
    grid: &Grid<'_>,
    (depth, index, first_child): (u8, usize, usize),
    record: &Record<RHO>,
    mut visit: impl FnMut(Spot, Record<RHO>),
) {
    let Some(next) = grid.levels().get(usize::from(depth) + 2) else {
        return;
    };
    let coding = coding::<RHO>(grid, depth + 2);
    let mut first_child_of = link_of(next, coding, index);
    let mut children = first_child..;
    for mask in mask::in_file_order(record) {
        for (word, offset) in mask.words().zip((0..).step_by(mask::cells(RHO))) {
            for (bit, index) in mask::bits(word).zip(children.by_ref()) {
                let Some(record) = record_of::<RHO>(next, coding, index) else {
                    return;
                };
                let spot = Spot {
                    at: offset + bit,
                    index,
                    first_child: first_child_of,
                };
                first_child_of += record.children.count();
                visit(spot, record);
            }
        }
    }
}

/// How the level of a depth is coded, if it is a tri-grid's and is.
#[inline(always)]
pub(super) fn coding<'a, const RHO: u8>(grid: &'a Grid<'_>, depth: u8) -> Option<&'a Coding<'a>> {
    match RHO {
        3 => grid.coding(usize::from(depth)),
        _ => None,
    }
}

impl<'a, const CELLS: usize, const LEVELS: usize, P: Pixel> Frame<'a, CELLS, LEVELS, P> {
    /// Visits the children of a cell with their records: see [`children`].
    #[inline(always)]
    pub(super) fn for_each_child<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        visit: impl FnMut(Spot, Record<RHO>),
    ) {
        let place = (cell.depth, cell.index, cell.first_child);
        children::<RHO>(self.grid, place, record, visit);
    }

    /// Visits the children of a cell with their records and attributes, nearest
    /// first: none hides one that is visited before it.
    #[inline(always)]
    pub(super) fn for_each_child_nearest_first<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        mut visit: impl FnMut(&Cell, &Record<RHO>, u16),
    ) {
        self.for_each_spot_nearest_first::<RHO>(cell, record, |spot, record| {
            if let Some((child, attribute)) = self.child(cell, spot) {
                visit(&child, record, attribute);
            }
        });
    }

    /// The same with their spots alone.
    #[inline(always)]
    pub(super) fn for_each_spot_nearest_first<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        mut visit: impl FnMut(&Spot, &Record<RHO>),
    ) {
        let Some(next) = self.level(cell.depth + 2) else {
            return;
        };
        let coding = self.coding::<RHO>(cell.depth + 2);
        // By subcell.
        let mut spots = [Spot::NONE; CELLS];
        self.for_each_child::<RHO>(cell, record, |spot, _| {
            if let Some(own) = spots.get_mut(spot.at) {
                *own = spot;
            }
        });
        let rho = usize::from(RHO);
        // The eye lies on the side from which a coordinate begins.
        let along = |axis: usize, step: usize| match cell.view[axis] < 0 {
            true => rho - 1 - step,
            false => step,
        };
        for z in 0..rho {
            for y in 0..rho {
                for x in 0..rho {
                    let at = along(0, x) + rho * (along(1, y) + rho * along(2, z));
                    if let Some(spot) = spots.get(at)
                        && spot.index != Spot::NONE.index
                        && let Some(record) = record_of::<RHO>(next, coding, spot.index)
                    {
                        visit(spot, &record);
                    }
                }
            }
        }
    }

    /// A cell's child and its attribute.
    #[inline(always)]
    pub(super) fn child(&self, cell: &Cell, spot: &Spot) -> Option<(Cell, u16)> {
        let below = self.below(cell)?;
        let (view, attribute) = below.faced(cell, spot)?;
        let child = Cell {
            depth: cell.depth + 1,
            index: spot.index,
            first_child: spot.first_child,
            centre: below.centre(cell, spot)?,
            view,
            inside: cell.inside,
        };
        Some((child, attribute))
    }

    /// What a cell's children are found from.
    #[inline(always)]
    pub(super) fn below(&self, cell: &Cell) -> Option<Below<'_, CELLS>> {
        Some(Below {
            attributes: self.level(cell.depth + 1)?.attributes,
            table: self.tables.below(cell.depth),
        })
    }

    #[inline(always)]
    pub(super) fn level(&self, depth: u8) -> Option<&'a Level<'a>> {
        self.grid.levels().get(usize::from(depth))
    }
}

/// Attributes and displacements of the level below a cell's.
pub(super) struct Below<'f, const CELLS: usize> {
    attributes: &'f [u16],
    table: &'f LevelTable<CELLS>,
}

impl<const CELLS: usize> Below<'_, CELLS> {
    /// The view and the attribute of a cell's child: how it faces.
    #[inline(always)]
    pub fn faced(&self, cell: &Cell, spot: &Spot) -> Option<([i32; 3], u16)> {
        let step = *self.table.eye_displacements.get(spot.at)?;
        let view = [0, 1, 2].map(|axis| cell.view[axis] + step[axis]);
        Some((view, *self.attributes.get(spot.index)?))
    }

    /// The centre of a cell's child.
    #[inline(always)]
    pub fn centre(&self, cell: &Cell, spot: &Spot) -> Option<Point> {
        Some(cell.centre.plus(*self.table.displacements.get(spot.at)?))
    }
}
