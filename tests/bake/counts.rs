//! Cells of built-in geometry at every depth, pinned.

use rhogrid::geometry::Mesh;
use rhogrid::import::procedural::{demo, shapes};

use super::{baked, options};

#[track_caller]
fn check(name: &str, mesh: &Mesh, rho: u8, expected: &[usize]) {
    let level = expected.len() as u8 - 2;
    let asset = baked(mesh, &options(rho, level));
    let cells: Vec<usize> = asset
        .grid()
        .levels()
        .iter()
        .map(|level| level.cells())
        .collect();
    assert_eq!(cells, expected, "{name}, rho {rho}");
}

#[test]
fn quads_fill_the_slices_that_they_touch() {
    // With rho odd the sheet cuts the middle slice; with rho even it lies
    // between two and touches both.
    check("quad", &shapes::quad(), 3, &[1, 9, 81, 729]);
    check("quad", &shapes::quad(), 5, &[1, 25, 625]);
    check("quad", &shapes::quad(), 2, &[1, 8, 32, 128, 512]);
    check("quad", &shapes::quad(), 4, &[1, 32, 512]);
}

#[test]
fn cubes_fill_the_outermost_cells() {
    let shell = |axis: usize| axis.pow(3) - (axis - 2).pow(3);
    check(
        "cube",
        &shapes::cube(),
        3,
        &[1, shell(3), shell(9), shell(27)],
    );
    check(
        "cube",
        &shapes::cube(),
        2,
        &[1, shell(2), shell(4), shell(8), shell(16)],
    );
    check("cube", &shapes::cube(), 4, &[1, shell(4), shell(16)]);
    check("cube", &shapes::cube(), 5, &[1, shell(5), shell(25)]);
}

#[test]
fn curved_shapes_have_the_pinned_counts() {
    let (sphere, torus) = (shapes::sphere(24), shapes::torus(48, 24));
    check("sphere", &sphere, 2, &[1, 8, 56, 272, 1160, 4760, 19184]);
    check("sphere", &sphere, 3, &[1, 26, 362, 3362, 30706]);
    check("sphere", &sphere, 4, &[1, 56, 1160, 19184, 307808]);
    check("sphere", &sphere, 5, &[1, 98, 2906, 73274]);
    check("torus", &torus, 2, &[1, 8, 32, 192, 752, 2928, 12144]);
    check("torus", &torus, 3, &[1, 9, 192, 2124, 19336]);
    check("torus", &torus, 4, &[1, 32, 752, 12144, 190488]);
    check("torus", &torus, 5, &[1, 72, 1880, 45568]);
}

#[test]
fn the_demo_has_the_pinned_counts() {
    check("demo", &demo(), 3, &[1, 23, 204, 2429, 28918, 304658]);
}
