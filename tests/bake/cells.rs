//! The cells of an asset with their places, read from its node records.

use rhogrid_core::asset::node::Flags;
use rhogrid_core::asset::{Grid, Rgb};

/// A cell of some depth.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Column, row and slice, from 0.
    pub place: [u32; 3],
    pub attribute: u16,
    pub colour: Option<Rgb>,
    /// Whether it is drawn where drawing stops at its depth.
    pub is_drawn: bool,
    /// The node record that subdivides it; none at the last depth.
    pub record: Vec<u16>,
    /// Its children's indices in the next depth.
    pub children: std::ops::Range<usize>,
}

impl Cell {
    pub fn flags(&self, rho: u8) -> Flags {
        Flags::from_last(rho, self.record[self.record.len() - 1])
    }
}

/// The cells of every depth, in file order.
pub fn cells(grid: &Grid<'_>) -> Vec<Vec<Cell>> {
    let rho = u32::from(grid.rho());
    let mut depths: Vec<Vec<Cell>> = Vec::new();
    for (depth, level) in grid.levels().iter().enumerate() {
        let mut places = Vec::new();
        let mut are_drawn = Vec::new();
        match depths.last_mut() {
            None => {
                places.push([0; 3]);
                are_drawn.push(true);
            }
            Some(parents) => {
                let records = grid.node_records(depth);
                let drawn = grid.drawn_records(depth);
                assert_eq!(records.len(), parents.len());
                assert_eq!(drawn.len(), parents.len());
                for ((parent, record), drawn) in parents.iter_mut().zip(records).zip(drawn) {
                    let (record, drawn) = (record.halves(), drawn.halves());
                    let first = places.len();
                    let has = |of: &[u16], bit: u32| of[bit as usize / 16] >> (bit % 16) & 1 == 1;
                    // Drawn children come first.
                    for is_drawn in [true, false] {
                        for bit in (0..rho.pow(3))
                            .filter(|&bit| has(record, bit) && has(drawn, bit) == is_drawn)
                        {
                            let within = [bit % rho, bit / rho % rho, bit / (rho * rho)];
                            places.push(
                                [0, 1, 2].map(|axis| parent.place[axis] * rho + within[axis]),
                            );
                            are_drawn.push(is_drawn);
                        }
                    }
                    parent.children = first..places.len();
                    parent.record = record.to_vec();
                }
            }
        }
        assert_eq!(places.len(), level.attributes.len());
        let own = places.iter().zip(level.attributes).zip(are_drawn).zip(0..);
        depths.push(
            own.map(|(((&place, &attribute), is_drawn), index)| Cell {
                place,
                attribute,
                colour: level.colours.get(index),
                is_drawn,
                record: Vec::new(),
                children: 0..0,
            })
            .collect(),
        );
    }
    depths
}

/// The places of every depth, sorted.
pub fn places(grid: &Grid<'_>) -> Vec<Vec<[u32; 3]>> {
    sorted(grid, |_| true)
}

/// The places of the cells that are drawn where drawing stops at their depth,
/// of every depth, sorted.
pub fn drawn_places(grid: &Grid<'_>) -> Vec<Vec<[u32; 3]>> {
    sorted(grid, |cell| cell.is_drawn)
}

fn sorted(grid: &Grid<'_>, which: impl Fn(&Cell) -> bool) -> Vec<Vec<[u32; 3]>> {
    let sorted = |depth: &Vec<Cell>| {
        let chosen = depth.iter().filter(|cell| which(cell));
        let mut places: Vec<[u32; 3]> = chosen.map(|cell| cell.place).collect();
        places.sort_unstable();
        places
    };
    cells(grid).iter().map(sorted).collect()
}
