//! Scales, places and shapes at the edge of what there is.

use std::collections::BTreeSet;

use glam::DVec3;
use rhogrid::bake;
use rhogrid::geometry::{Cloud, Geometry, Mesh, OrientedPoint};
use rhogrid::import::procedural::shapes;

use super::cells::{cells, places};
use super::{Random, baked, moved, options, soup, sphere_of_points, thin};

/// A shape on a lattice of 2^-20, so that moving it far away is exact.
fn lattice_torus() -> Mesh {
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 0.2);
    let step = f64::from(1 << 20);
    moved(&shapes::torus(24, 12), |position| {
        ((turn * position) * step).round() / step
    })
}

#[test]
fn scale_and_place_do_not_matter() {
    let mesh = lattice_torus();
    for (rho, level) in [(2, 5), (3, 3), (4, 2), (5, 1)] {
        let asset = baked(&mesh, &options(rho, level));
        let own = places(&asset.grid());
        let attributes = |mesh: &Mesh| -> Vec<Vec<u16>> {
            let asset = baked(mesh, &options(rho, level));
            assert_eq!(places(&asset.grid()), own, "rho {rho}");
            asset
                .grid()
                .levels()
                .iter()
                .map(|level| level.attributes.to_vec())
                .collect()
        };
        let there = attributes(&mesh);
        for factor in [1e6, 1e-6, 1e30, 1e-30] {
            attributes(&moved(&mesh, |position| position * factor));
        }
        // Exact in doubles: not even a normal code may change.
        for offset in [
            DVec3::splat(1e6),
            DVec3::new(-1e6, 1e6, 0.0),
            DVec3::splat(1024.0),
        ] {
            assert_eq!(
                attributes(&moved(&mesh, |position| position + offset)),
                there
            );
        }
        assert_eq!(
            attributes(&moved(&mesh, |position| position * 1024.0)),
            there
        );
    }
}

#[test]
fn one_triangle_of_any_shape_makes_an_asset() {
    let (a, b, c) = (
        DVec3::ZERO,
        DVec3::new(1.0, 0.3, -0.2),
        DVec3::new(0.2, 1.0, 0.7),
    );
    for (name, triangle) in [
        ("plain", [a, b, c]),
        ("sliver", [a, b, b * 0.5 + c * 1e-9]),
        ("needle", [a, b, b * (1.0 + 1e-15)]),
        ("line", [a, b, b * 0.5]),
        ("point and line", [a, a, b]),
        ("along an axis", [a, DVec3::X, DVec3::X * 2.0]),
        ("diagonal", [DVec3::NEG_ONE, DVec3::ZERO, DVec3::ONE]),
    ] {
        for (rho, level) in [(2, 6), (3, 4), (4, 3), (5, 2)] {
            let asset = baked(&soup(&[triangle]), &options(rho, level));
            let axis = usize::from(rho).pow(u32::from(level) + 1);
            let leaves = asset.grid().levels().last().unwrap().cells();
            assert!(
                leaves >= axis,
                "{name}, rho {rho}: {leaves} leaves across {axis}"
            );
            // Thin shells are as long, from end to end.
            let asset = baked(&soup(&[triangle]), &thin(rho, level));
            let leaves = asset.grid().levels().last().unwrap().cells();
            assert!(
                leaves >= axis,
                "{name}, rho {rho}: {leaves} thin leaves across {axis}"
            );
        }
    }
}

/// A diagonal through the corners of cells touches, at each corner, all eight
/// cells around it.
#[test]
fn diagonals_touch_the_cells_around_their_corners() {
    let line = soup(&[[DVec3::NEG_ONE, DVec3::ZERO, DVec3::ONE]]);
    for (rho, level) in [(2u8, 3u8), (3, 2), (4, 1), (5, 1)] {
        let asset = baked(&line, &options(rho, level));
        let axis = i64::from(rho).pow(u32::from(level) + 1);
        // The diagonal cells, and six more around each inner corner.
        let expected = axis + 6 * (axis - 1);
        assert_eq!(
            asset.grid().levels().last().unwrap().cells() as i64,
            expected,
            "rho {rho}"
        );
    }
}

#[test]
fn nothing_without_extent_is_baked() {
    let point = soup(&[[DVec3::ONE; 3]]);
    let message = bake::grid(&Geometry::Mesh(point), &options(3, 1), &|_| {})
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("no extent") && message.contains("give"),
        "{message}"
    );
    let none = Geometry::Cloud(Cloud::default());
    assert!(bake::grid(&none, &options(3, 1), &|_| {}).is_err());
}

#[test]
fn options_out_of_range_are_refused() {
    let mesh = Geometry::Mesh(shapes::cube());
    for (rho, level) in [
        (0, 1),
        (1, 1),
        (6, 1),
        (255, 1),
        (2, 15),
        (3, 9),
        (4, 7),
        (5, 6),
        (2, 255),
    ] {
        let message = bake::grid(&mesh, &options(rho, level), &|_| {})
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("--rho") && message.contains("give"),
            "{message}"
        );
    }
}

/// Rounding never leaves an intermediate cell without children: opening would
/// refuse such an asset.
#[test]
fn random_triangles_open_at_every_depth() {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    for round in 0..80 {
        let count = 1 + round % 3;
        let triangles: Vec<[DVec3; 3]> = (0..count)
            .map(|_| {
                let (a, b, c) = (random.point(), random.point(), random.point());
                match round % 4 {
                    0 => [a, b, b + (c - b) * 1e-3],
                    1 => [a, b, a.lerp(b, 0.5) + c * 10f64.powi(-6 - round / 8)],
                    // Corners on the sides of cells.
                    2 => [a, b, c].map(|corner| (corner * 8.0).round() / 8.0),
                    _ => [a, b * 1e-3, a * 0.5],
                }
            })
            .collect();
        let (rho, level) = [(2, 7), (3, 4), (4, 3), (5, 2)][round as usize / 4 % 4];
        let mesh = soup(&triangles);
        let extent = mesh
            .positions
            .iter()
            .any(|position| *position != mesh.positions[0]);
        if extent {
            let asset = baked(&mesh, &options(rho, level));
            let depths = cells(&asset.grid());
            assert!(
                depths
                    .iter()
                    .flatten()
                    .all(|cell| cell.record.is_empty() || !cell.children.is_empty())
            );
            let asset = baked(&mesh, &thin(rho, level));
            let leaves = cells(&asset.grid()).pop().unwrap();
            assert!(!leaves.is_empty() && leaves.iter().all(|leaf| leaf.is_drawn));
        }
    }
}

/// A point belongs at least to the cell that it lies in.
#[test]
fn clouds_fill_the_cells_of_their_points() {
    let mut random = Random(0x1234_5678_9abc_def1);
    let mut points: Vec<OrientedPoint> = (0..200)
        .map(|_| OrientedPoint {
            position: random.point(),
            normal: random.point().normalize().as_vec3(),
        })
        .collect();
    // Opposite corners make the cube that of the coordinates.
    points[0].position = DVec3::NEG_ONE;
    points[1].position = DVec3::ONE;
    for (rho, level) in [(2u8, 4u8), (3, 2), (4, 1), (5, 1)] {
        let cloud = Geometry::Cloud(Cloud {
            points: points.clone(),
            colours: Vec::new(),
            two_sided: false,
        });
        let grid = bake::grid(&cloud, &options(rho, level), &|_| {}).unwrap();
        let bytes = bake::writer::to_bytes(&grid).unwrap();
        let asset = rhogrid::asset_file::AssetFile::new(&bytes).unwrap();
        let axis = u32::from(rho).pow(u32::from(level) + 1);
        let mut expected: Vec<[u32; 3]> = points
            .iter()
            .map(|point| {
                let at = (point.position + 1.0) / 2.0 * f64::from(axis);
                at.to_array().map(|c| (c as u32).min(axis - 1))
            })
            .collect();
        expected.sort_unstable();
        expected.dedup();
        let found = places(&asset.grid()).pop().unwrap();
        let absent = expected.iter().find(|place| !found.contains(place));
        assert_eq!(absent, None, "rho {rho}");
    }
}

/// Points of a sphere close it, however fine the cells.
#[test]
fn clouds_close_the_surface_between_their_points() {
    let cloud = Geometry::Cloud(sphere_of_points());
    let cells = |geometry: &Geometry| {
        let grid = bake::grid(geometry, &options(3, 3), &|_| {}).unwrap();
        let bytes = bake::writer::to_bytes(&grid).unwrap();
        let asset = rhogrid::asset_file::AssetFile::new(&bytes).unwrap();
        places(&asset.grid())
            .pop()
            .unwrap()
            .into_iter()
            .collect::<BTreeSet<_>>()
    };
    let mesh = Geometry::Mesh(shapes::sphere(100));
    let (tiles, triangles) = (cells(&cloud), cells(&mesh));
    let missing = triangles.difference(&tiles).count();
    assert!(
        missing * 50 < triangles.len(),
        "{missing} of {} cells are missing",
        triangles.len()
    );
}
