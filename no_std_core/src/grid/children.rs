//! The children of a cell, all of which are intermediate, one after the other.

use super::mask;
use super::record::{Record, link_of, record_of};
use super::traverse::{Cell, Frame};
use crate::asset::Level;

/// No child.
const NONE: u32 = u32::MAX;

impl<'a, const CELLS: usize, const LEVELS: usize> Frame<'a, CELLS, LEVELS> {
    /// Visits the children of a cell with their records and attributes: in file
    /// order, first those that are drawn at their depth, then the others.
    #[inline(always)]
    pub(super) fn for_each_child<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        mut visit: impl FnMut(Cell, Record<RHO>, u16),
    ) {
        let Some(levels) = self.levels_below(cell) else {
            return;
        };
        let coding = self.coding::<RHO>(cell.depth + 2);
        let mut first_child = link_of(levels[1], coding, cell.index);
        let mut children = cell.first_child..;
        for mask in mask::in_file_order(record) {
            for (word, offset) in mask.words().zip((0..).step_by(mask::cells(RHO))) {
                for (bit, index) in mask::bits(word).zip(children.by_ref()) {
                    let found = self.child::<RHO>(cell, levels, offset + bit, index);
                    let Some((child, record, attribute)) = found else {
                        return;
                    };
                    let child = Cell {
                        first_child,
                        ..child
                    };
                    first_child += record.children.count();
                    visit(child, record, attribute);
                }
            }
        }
    }

    /// The same, nearest first: no child hides one that is visited before it.
    #[inline(always)]
    pub(super) fn for_each_child_nearest_first<const RHO: u8>(
        &self,
        cell: &Cell,
        record: &Record<RHO>,
        mut visit: impl FnMut(Cell, Record<RHO>, u16),
    ) {
        let Some(levels) = self.levels_below(cell) else {
            return;
        };
        // By subcell.
        let (mut indices, mut first_children) = ([NONE; CELLS], [0; CELLS]);
        let coding = self.coding::<RHO>(cell.depth + 2);
        let mut first_child = link_of(levels[1], coding, cell.index);
        let mut children = cell.first_child..;
        for mask in mask::in_file_order(record) {
            for (word, offset) in mask.words().zip((0..).step_by(mask::cells(RHO))) {
                for (bit, index) in mask::bits(word).zip(children.by_ref()) {
                    let at = (offset + bit) % CELLS;
                    indices[at] = index as u32;
                    first_children[at] = first_child;
                    let Some(record) = record_of::<RHO>(levels[1], coding, index) else {
                        return;
                    };
                    first_child += record.children.count();
                }
            }
        }
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
                    let at = at % CELLS;
                    if indices[at] == NONE {
                        continue;
                    }
                    let found = self.child::<RHO>(cell, levels, at, indices[at] as usize);
                    if let Some((child, record, attribute)) = found {
                        let child = Cell {
                            first_child: first_children[at],
                            ..child
                        };
                        visit(child, record, attribute);
                    }
                }
            }
        }
    }

    /// The levels of a cell's children and of theirs.
    #[inline(always)]
    fn levels_below(&self, cell: &Cell) -> Option<[&'a Level<'a>; 2]> {
        let below = usize::from(cell.depth) + 1;
        let levels = self.grid.levels();
        Some([levels.get(below)?, levels.get(below + 1)?])
    }

    /// A cell's child in a subcell, but for its first child.
    #[inline(always)]
    fn child<const RHO: u8>(
        &self,
        cell: &Cell,
        [level, next]: [&'a Level<'a>; 2],
        at: usize,
        index: usize,
    ) -> Option<(Cell, Record<RHO>, u16)> {
        let table = self.tables.below(cell.depth);
        let record = record_of::<RHO>(next, self.coding::<RHO>(cell.depth + 2), index)?;
        let attribute = *level.attributes.get(index)?;
        let (displacement, step) = (
            table.displacements.get(at)?,
            table.eye_displacements.get(at)?,
        );
        let child = Cell {
            depth: cell.depth + 1,
            index,
            first_child: 0,
            centre: cell.centre.plus(*displacement),
            view: [0, 1, 2].map(|axis| cell.view[axis] + step[axis]),
            inside: cell.inside,
        };
        Some((child, record, attribute))
    }
}
