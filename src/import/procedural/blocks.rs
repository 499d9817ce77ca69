//! The boundary of a set of equal cubic cells, in flat-shaded squares.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

use super::rings::Builder;

/// The six sides of a cell: outward normal, then two axes with
/// `first x second = normal`.
const SIDES: [[IVec3; 3]; 6] = [
    [IVec3::X, IVec3::Y, IVec3::Z],
    [IVec3::Y, IVec3::Z, IVec3::X],
    [IVec3::Z, IVec3::X, IVec3::Y],
    [IVec3::NEG_X, IVec3::Z, IVec3::Y],
    [IVec3::NEG_Y, IVec3::X, IVec3::Z],
    [IVec3::NEG_Z, IVec3::Y, IVec3::X],
];

/// Adds the squares between solid and empty cells of a grid of `size` cells.
/// The surface is closed; its edges are shared by exactly two triangles if no
/// two solid cells touch along an edge or corner only.
///
/// `place` maps cell corners, 0 to `size` in each axis, and must be a
/// similarity without reflection; `turn` is its rotation, for the normals.
/// `material` sees a cell and its side's normal; sides where it says `None`
/// stay open. Returns the position indices of the cell corners in use.
pub fn boundary(
    builder: &mut Builder,
    size: IVec3,
    solid: impl Fn(IVec3) -> bool,
    place: impl Fn(IVec3) -> DVec3,
    turn: impl Fn(DVec3) -> DVec3,
    material: impl Fn(IVec3, IVec3) -> Option<u8>,
) -> HashMap<IVec3, u32> {
    let inside = |cell: IVec3| cell.cmpge(IVec3::ZERO).all() && cell.cmplt(size).all();
    let normals = SIDES.map(|[normal, ..]| builder.normal(turn(normal.as_dvec3())));
    let mut corners = HashMap::new();
    for z in 0..size.z {
        for y in 0..size.y {
            for x in 0..size.x {
                let cell = IVec3::new(x, y, z);
                if !solid(cell) {
                    continue;
                }
                for ([normal, first, second], normal_index) in SIDES.into_iter().zip(normals) {
                    let neighbour = cell + normal;
                    if inside(neighbour) && solid(neighbour) {
                        continue;
                    }
                    let Some(material) = material(cell, normal) else {
                        continue;
                    };
                    // The cell's corner that is least along both axes.
                    let base = cell + normal.max(IVec3::ZERO);
                    let quad =
                        [base, base + first, base + first + second, base + second].map(|corner| {
                            let index = *corners
                                .entry(corner)
                                .or_insert_with(|| builder.position(place(corner)));
                            (index, normal_index)
                        });
                    builder.triangle([quad[0], quad[1], quad[2]], material);
                    builder.triangle([quad[0], quad[2], quad[3]], material);
                }
            }
        }
    }
    corners
}
