//! The cells of an asset with their places, read from its node records.

use rhogrid_core::asset::Grid;
use rhogrid_core::asset::node::{Flags, halves};

/// A cell of some depth.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Column, row and slice, from 0.
    pub place: [u32; 3],
    pub attribute: u16,
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
    for level in grid.levels() {
        let mut places = Vec::new();
        match depths.last_mut() {
            None => places.push([0; 3]),
            Some(parents) => {
                let records = level.nodes.chunks_exact(halves(grid.rho()));
                assert_eq!(records.len(), parents.len());
                for (parent, record) in parents.iter_mut().zip(records) {
                    let first = places.len();
                    for bit in (0..rho.pow(3))
                        .filter(|bit| record[*bit as usize / 16] >> (bit % 16) & 1 == 1)
                    {
                        let within = [bit % rho, bit / rho % rho, bit / (rho * rho)];
                        places.push([0, 1, 2].map(|axis| parent.place[axis] * rho + within[axis]));
                    }
                    parent.children = first..places.len();
                    parent.record = record.to_vec();
                }
            }
        }
        assert_eq!(places.len(), level.attributes.len());
        let own = places.iter().zip(level.attributes);
        depths.push(
            own.map(|(&place, &attribute)| Cell {
                place,
                attribute,
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
    let sorted = |depth: &Vec<Cell>| {
        let mut places: Vec<[u32; 3]> = depth.iter().map(|cell| cell.place).collect();
        places.sort_unstable();
        places
    };
    cells(grid).iter().map(sorted).collect()
}
