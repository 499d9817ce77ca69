//! The plinth: a block of cubic cells, each of its four sides carved with a
//! row of Sierpinski carpets, the flat cousin of a grid that divides by three
//! again and again.
//!
//! ```text
//!   # # # # # # # # #      Cells go three by three into squares, those into
//!   #   # #   # #   #      larger squares, and so on: of every nine, the one
//!   # # # # # # # # #      in the middle is carved away, the larger the
//!   # # #       # # #      deeper. (Two of the three levels are drawn.)
//!   #   #       #   #
//!   # # #       # # #
//!   # # # # # # # # #
//!   #   # #   # #   #
//!   # # # # # # # # #
//! ```

use glam::{DVec3, IVec3};

use super::blocks::boundary;
use super::rings::Builder;
use super::{GOLD, SLATE, VERDIGRIS};

/// Cells along the side of a carpet: three levels of three.
const CARPET: i32 = 27;
/// Cells of plain frame around the carpets.
const FRAME: i32 = 3;
/// Carpets along a side.
const CARPETS: i32 = 3;

/// Size of the plinth in cells.
pub const SIZE: IVec3 = IVec3::new(
    CARPETS * CARPET + 2 * FRAME,
    CARPET + 2 * FRAME,
    CARPETS * CARPET + 2 * FRAME,
);

/// Depth of the carving in cells at a place on a side, counted from the
/// carpets' lower left corner.
fn carving(along: i32, up: i32) -> i32 {
    if along < 0 || up < 0 || along >= CARPETS * CARPET || up >= CARPET {
        return 0;
    }
    // From the largest squares to the single cells.
    [(9, 3), (3, 2), (1, 1)]
        .into_iter()
        .find(|(side, _)| along / side % 3 == 1 && up / side % 3 == 1)
        .map_or(0, |(_, depth)| depth)
}

/// Whether a cell is stone.
fn solid(cell: IVec3) -> bool {
    let far = SIZE - 1 - cell;
    let up = cell.y - FRAME;
    // Distance to each side with the place along it.
    [
        (cell.x, cell.z),
        (far.x, cell.z),
        (cell.z, cell.x),
        (far.z, cell.x),
    ]
    .into_iter()
    .all(|(distance, along)| distance >= carving(along - FRAME, up))
}

/// Adds the plinth, standing on y = 0 with the axis in its middle. Its sides
/// are turned by the angle of the 3-4-5 triangle, whose sine and cosine are
/// short fractions.
pub fn plinth(builder: &mut Builder, cell_size: f64) {
    let turn = |v: DVec3| DVec3::new(0.8 * v.x + 0.6 * v.z, v.y, 0.8 * v.z - 0.6 * v.x);
    let middle = DVec3::new(f64::from(SIZE.x), 0.0, f64::from(SIZE.z)) / 2.0;
    let corners = boundary(
        builder,
        SIZE,
        solid,
        |corner| turn((corner.as_dvec3() - middle) * cell_size),
        turn,
        |cell, normal| match (normal.y, depth(cell, normal)) {
            (1 | -1, 0) => None,
            (0, 2) => Some(VERDIGRIS),
            (0, 3) => Some(GOLD),
            _ => Some(SLATE),
        },
    );
    // Top and bottom are fans, for the cells' squares there would all be alike.
    for (y, up) in [(SIZE.y, DVec3::Y), (0, DVec3::NEG_Y)] {
        let normal = builder.normal(up);
        let height = DVec3::Y * (f64::from(y) * cell_size);
        let apex = (builder.position(height), normal);
        let mut rim: Vec<_> = rim(y).map(|corner| (corners[&corner], normal)).collect();
        if y == 0 {
            rim.reverse();
        }
        for (i, &here) in rim.iter().enumerate() {
            builder.triangle([apex, here, rim[(i + 1) % rim.len()]], SLATE);
        }
    }
}

/// How many cells below the side of the plinth that faces along `normal`.
fn depth(cell: IVec3, normal: IVec3) -> i32 {
    let from_origin = (cell * normal.abs()).element_sum();
    if normal.min_element() < 0 {
        from_origin
    } else {
        ((SIZE - 1) * normal).element_sum() - from_origin
    }
}

/// The cell corners around the plinth at height `y`, counter-clockwise seen
/// from above.
fn rim(y: i32) -> impl Iterator<Item = IVec3> {
    let side = SIZE.x;
    (0..4 * side).map(move |i| {
        let (quarter, along) = (i / side, i % side);
        let (x, z) = match quarter {
            0 => (0, along),
            1 => (along, side),
            2 => (side, side - along),
            _ => (side - along, 0),
        };
        IVec3::new(x, y, z)
    })
}
