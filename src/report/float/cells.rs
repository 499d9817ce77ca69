//! A grid's cells with the surface's points that they were sampled at.

use glam::DVec3;
use rayon::prelude::*;
use rhogrid_core::asset::node::{Flags, halves};

use crate::bake::{Aabb, BakedGrid, BakedLevel, Surface, surface};
use crate::geometry::Geometry;

/// A stored cell.
pub struct Cell {
    /// Which cell of its depth it is, along x, y and z.
    pub place: [u16; 3],
    /// Its sample's attribute.
    pub attribute: u16,
    /// The surface's point nearest to its centre, in the cube's coordinates.
    pub point: [f32; 3],
    /// Its first child in the next depth, its children, and how many of them
    /// are drawn where drawing stops there: the first.
    pub first: u32,
    pub children: u8,
    pub drawn: u8,
    /// Of an intermediate cell.
    pub flags: Flags,
}

/// All cells of a grid, in file order.
pub struct Cells {
    pub rho: u8,
    pub is_thin: bool,
    pub materials: Vec<[u8; 3]>,
    pub depths: Vec<Vec<Cell>>,
}

/// The primitives near a cell.
type Near = Vec<u32>;

impl Cells {
    /// Walks a grid down with the geometry that it was baked from.
    pub fn of(grid: &BakedGrid, geometry: &Geometry) -> Self {
        let surface = surface(geometry, &grid.cube);
        let mut parents: Vec<Near> = vec![(0..surface.count()).collect()];
        let mut depths: Vec<Vec<Cell>> = Vec::new();
        for (depth, level) in grid.levels.iter().enumerate() {
            let Some(above) = depths.last_mut() else {
                let places = vec![[0; 3]];
                depths.push(cells(&places, &level.attributes, &[DVec3::ZERO]));
                continue;
            };
            let places = places(grid.rho, level, above);
            let is_last = depth + 1 == grid.levels.len();
            let axis = u32::from(grid.rho).pow(depth as u32);
            let ranges: Vec<&[[u16; 3]]> = above
                .iter()
                .map(|cell| &places[cell.first as usize..][..usize::from(cell.children)])
                .collect();
            let found: Vec<(DVec3, Near)> = parents
                .par_iter()
                .zip(ranges)
                .flat_map_iter(|(parent, children)| {
                    below(surface.as_ref(), parent, children, axis, is_last)
                })
                .collect();
            let points: Vec<DVec3> = found.iter().map(|(point, _)| *point).collect();
            depths.push(cells(&places, &level.attributes, &points));
            parents = found.into_iter().map(|(_, near)| near).collect();
        }
        Self {
            rho: grid.rho,
            is_thin: grid.shell == rhogrid_core::asset::Shell::Thin,
            materials: grid.materials.clone(),
            depths,
        }
    }

    /// The edge of a depth's cells.
    pub fn edge(&self, depth: usize) -> f64 {
        2.0 / f64::from(self.rho).powi(depth as i32)
    }

    /// The centre of a cell of a depth.
    pub fn centre(&self, depth: usize, cell: &Cell) -> DVec3 {
        let place = cell.place.map(f64::from);
        (DVec3::from_array(place) + 0.5) * self.edge(depth) - 1.0
    }
}

/// The cells of a depth; nothing is known yet of what is below them.
fn cells(places: &[[u16; 3]], attributes: &[u16], points: &[DVec3]) -> Vec<Cell> {
    let own = places.iter().zip(attributes).zip(points);
    own.map(|((&place, &attribute), point)| Cell {
        place,
        attribute,
        point: point.as_vec3().to_array(),
        first: 0,
        children: 0,
        drawn: 0,
        flags: Flags::from_last(3, 0),
    })
    .collect()
}

/// The places of a level's cells, from its records; the cells above learn
/// what their children are.
fn places(rho: u8, level: &BakedLevel, above: &mut [Cell]) -> Vec<[u16; 3]> {
    let size = halves(rho);
    let mut places = Vec::new();
    let drawn = if level.drawn.is_empty() {
        &level.nodes
    } else {
        &level.drawn
    };
    let records = level.nodes.chunks_exact(size).zip(drawn.chunks_exact(size));
    for (cell, (node, drawn)) in above.iter_mut().zip(records) {
        let has = |record: &[u16], bit: usize| record[bit / 16] >> (bit % 16) & 1 != 0;
        let subcells = usize::from(rho).pow(3);
        let first = (0..subcells).filter(|&bit| has(drawn, bit));
        let others = (0..subcells).filter(|&bit| has(node, bit) && !has(drawn, bit));
        cell.first = places.len() as u32;
        cell.drawn = first.clone().count() as u8;
        for bit in first.chain(others) {
            let rho = usize::from(rho);
            let within = [bit % rho, bit / rho % rho, bit / (rho * rho)];
            places.push([0, 1, 2].map(|i| cell.place[i] * rho as u16 + within[i] as u16));
        }
        cell.children = (places.len() - cell.first as usize) as u8;
        cell.flags = Flags::from_last(rho, node.last().copied().unwrap_or(0));
    }
    places
}

/// The points of a cell's children, and what is near them.
fn below(
    surface: &dyn Surface,
    parent: &Near,
    children: &[[u16; 3]],
    axis: u32,
    is_last: bool,
) -> Vec<(DVec3, Near)> {
    let bounded: Vec<(u32, Aabb)> = parent
        .iter()
        .map(|&primitive| (primitive, surface.bounds(primitive)))
        .collect();
    let child = |&place: &[u16; 3]| {
        let half = 1.0 / f64::from(axis);
        let at = place.map(|index| f64::from(2 * i32::from(index) + 1) * half - 1.0);
        let centre = DVec3::from_array(at);
        // The nearest point is within half a diagonal.
        let ball = Aabb::cube(centre, half * 3f64.sqrt() * (1.0 + 1e-9));
        let near = bounded.iter().filter(|(_, bounds)| bounds.meets(&ball));
        let point = nearest(surface, near.clone(), centre);
        let near = if is_last {
            Vec::new()
        } else {
            near.map(|(primitive, _)| *primitive).collect()
        };
        (point, near)
    };
    children.iter().map(child).collect()
}

fn nearest<'a>(
    surface: &dyn Surface,
    near: impl Iterator<Item = &'a (u32, Aabb)>,
    centre: DVec3,
) -> DVec3 {
    let mut found = (f64::INFINITY, centre);
    for (primitive, bounds) in near {
        if bounds.distance_squared(centre) < found.0 {
            let sample = surface.sample_at(*primitive, centre);
            if sample.distance_squared < found.0 {
                found = (sample.distance_squared, sample.point);
            }
        }
    }
    found.1
}
