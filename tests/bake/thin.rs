//! Thin shells: against a slow twin, and by what they are for.

use std::collections::HashSet;

use glam::DVec3;
use rhogrid::asset_file::AssetFile;
use rhogrid::bake::{self, writer};
use rhogrid::geometry::{Geometry, Mesh};
use rhogrid::import::procedural::{demo, shapes};
use rhogrid_core::asset::{Grid, Shell};

use super::cells::{cells, drawn_places, places};
use super::twin::{
    Face, LEVELS, TIE, TOUCH, bounds, check_material, check_sample, faces, nearest, torus, touches,
};
use super::{Random, baked, moved, options, plate, slivers, soup, sphere_of_points, thin};

type Place = [u32; 3];

/// The segment of a cell's cross-hair along an axis, as a box.
fn segment(place: Place, axis: u32, along: usize) -> (DVec3, DVec3) {
    let (min, max) = bounds(place, axis);
    let (mut from, mut to) = ((min + max) / 2.0, (min + max) / 2.0);
    (from[along], to[along]) = (min[along], max[along]);
    (from, to)
}

fn crosses(faces: &[Face], place: Place, axis: u32, along: usize) -> bool {
    let segment = segment(place, axis, along);
    faces
        .iter()
        .any(|face| touches(&face.corners, segment, TOUCH))
}

/// The axes that the surface nearest to a cell's centre may count as facing
/// most.
fn columns(faces: &[Face], place: Place, axis: u32) -> Vec<usize> {
    let (min, max) = bounds(place, axis);
    let all: Vec<(f64, DVec3)> = faces
        .iter()
        .map(|face| {
            let (distance, shading) = nearest(face, (min + max) / 2.0);
            let [a, b, c] = face.corners;
            let front = (b - a).cross(c - a).try_normalize();
            (distance, front.unwrap_or(shading))
        })
        .collect();
    let least = all.iter().map(|face| face.0).fold(f64::INFINITY, f64::min);
    let mut columns = Vec::new();
    for (_, front) in all.iter().filter(|face| face.0 <= least + TIE) {
        let front = front.abs();
        columns.extend((0..3).filter(|&i| front[i] >= front.max_element() - 1e-6));
    }
    columns
}

/// Whether a touched cell is in the thin subset; `None` where two axes are
/// equally right.
fn is_thin(faces: &[Face], place: Place, axis: u32) -> Option<bool> {
    if (0..3).any(|along| crosses(faces, place, axis, along)) {
        return Some(true);
    }
    let stands_in = |column: usize| {
        [1, u32::MAX].into_iter().any(|step| {
            let mut other = place;
            other[column] = other[column].wrapping_add(step);
            other[column] < axis && crosses(faces, other, axis, column)
        })
    };
    let answers: HashSet<bool> = columns(faces, place, axis)
        .into_iter()
        .map(|column| !stands_in(column))
        .collect();
    (answers.len() == 1).then(|| answers.contains(&true))
}

/// Stored are the drawn cells and what leads to finer ones, and no others.
fn check_stored(grid: &Grid<'_>) {
    let (stored, drawn) = (places(grid), drawn_places(grid));
    let mut expected: HashSet<Place> = HashSet::new();
    for (stored, drawn) in stored.iter().zip(&drawn).rev() {
        expected = expected
            .into_iter()
            .map(|place: Place| place.map(|index| index / u32::from(grid.rho())))
            .chain(drawn.iter().copied())
            .collect();
        let mut expected: Vec<Place> = expected.iter().copied().collect();
        expected.sort_unstable();
        assert!(*stored == expected);
    }
}

/// Gives how many cells the twin leaves open, of how many.
fn check(name: &str, mesh: &Mesh, rho: u8, level: u8) -> (usize, usize) {
    let asset = baked(mesh, &thin(rho, level));
    let grid = asset.grid();
    assert_eq!(grid.shell(), Shell::Thin);
    check_stored(&grid);
    let faces = faces(mesh);
    let touched = places(&baked(mesh, &options(rho, level)).grid());
    let (mut open, mut all) = (0, 0);
    for (depth, (own, touched)) in cells(&grid).iter().zip(&touched).enumerate().skip(1) {
        let axis = u32::from(rho).pow(depth as u32);
        let drawn: HashSet<Place> = own
            .iter()
            .filter(|cell| cell.is_drawn)
            .map(|cell| cell.place)
            .collect();
        assert!(drawn.iter().all(|place| touched.contains(place)));
        for &place in touched {
            let expected = is_thin(&faces, place, axis);
            open += usize::from(expected.is_none());
            all += 1;
            assert!(
                expected.is_none_or(|expected| drawn.contains(&place) == expected),
                "{name}, rho {rho}: cell {place:?} of {axis}, thin {expected:?}"
            );
        }
        for cell in own {
            match cell.record.is_empty() {
                true => check_sample(&faces, cell.place, axis, cell.attribute),
                false => check_material(&faces, cell.place, axis, cell.attribute),
            }
        }
    }
    (open, all)
}

#[test]
fn curved_shapes_have_the_twins_thin_subset() {
    for (rho, level) in LEVELS {
        let (open, all) = check("torus", &torus(), rho, level);
        assert!(10 * open < all, "rho {rho}: {open} of {all} cells open");
        check("sphere", &shapes::sphere(6), rho, level);
    }
}

/// Faces that lie exactly on the sides of cells count in both neighbours.
#[test]
fn flat_shapes_on_boundaries_have_the_twins_thin_subset() {
    for (rho, level) in LEVELS {
        check("cube", &shapes::cube(), rho, level);
        check("quad", &shapes::quad(), rho, level);
        check("plate", &plate(0.01), rho, level);
    }
}

#[test]
fn slivers_and_degenerate_triangles_have_the_twins_thin_subset() {
    let mut random = Random(0x6a09_e667_f3bc_c908);
    for round in 0..12 {
        let triangles = slivers(&mut random);
        let (rho, level) = LEVELS[round % 4];
        check(
            &format!("soup {round}"),
            &soup(&triangles),
            rho,
            level.min(2),
        );
    }
}

/// A cell that is touched and not drawn has a neighbour that is.
#[test]
fn drawn_cells_are_never_farther_than_a_neighbour() {
    let mut random = Random(0xbb67_ae85_84ca_a73b);
    for round in 0..24 {
        let triangles: Vec<[DVec3; 3]> = (0..1 + round % 3)
            .map(|_| {
                let (a, b, c) = (random.point(), random.point(), random.point());
                match round % 4 {
                    0 => [a, b, c],
                    // A ribbon narrower than a cell, a wire, corners on sides.
                    1 => [a, b, a.lerp(b, 0.5) + c * 0.02],
                    2 => [a, b, b],
                    _ => [a, b, c].map(|corner| (corner * 8.0).round() / 8.0),
                }
            })
            .collect();
        let mesh = soup(&triangles);
        let (rho, level) = [(2, 5), (3, 3), (4, 2), (5, 1)][round / 4 % 4];
        let drawn = drawn_places(&baked(&mesh, &thin(rho, level)).grid());
        let touched = places(&baked(&mesh, &options(rho, level)).grid());
        for (drawn, touched) in drawn.iter().zip(&touched) {
            let drawn: HashSet<&Place> = drawn.iter().collect();
            for place in touched.iter().filter(|place| !drawn.contains(place)) {
                let has_neighbour = (0..3).any(|axis| {
                    [1, u32::MAX].into_iter().any(|step| {
                        let mut other = *place;
                        other[axis] = other[axis].wrapping_add(step);
                        drawn.contains(&other)
                    })
                });
                assert!(has_neighbour, "round {round}: {place:?}");
            }
        }
    }
}

/// How often the surface winds around a point: the sum of the solid angles of
/// its faces (van Oosterom and Strackee, 1983), over 4 pi.
fn winding(faces: &[Face], point: DVec3) -> f64 {
    let angles = faces.iter().map(|face| {
        let [a, b, c] = face.corners.map(|corner| corner - point);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let flat = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(flat)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// The cells that a path through faces reaches from outside the cube without
/// entering a barrier, and those behind it.
fn flood(barrier: &[Place], axis: u32) -> (Vec<Place>, Vec<Place>) {
    // One layer of cells around the cube.
    let side = axis as usize + 2;
    let index = |at: [usize; 3]| at[0] + side * (at[1] + side * at[2]);
    let mut is_closed = vec![false; side.pow(3)];
    for place in barrier {
        is_closed[index(place.map(|c| c as usize + 1))] = true;
    }
    let barrier = is_closed.clone();
    let mut next = vec![[0; 3]];
    is_closed[0] = true;
    let mut reached = vec![false; side.pow(3)];
    while let Some(at) = next.pop() {
        reached[index(at)] = true;
        for axis in 0..3 {
            for step in [1, usize::MAX] {
                let mut to: [usize; 3] = at;
                to[axis] = to[axis].wrapping_add(step);
                if to[axis] < side && !std::mem::replace(&mut is_closed[index(to)], true) {
                    next.push(to);
                }
            }
        }
    }
    let (mut outside, mut inside) = (Vec::new(), Vec::new());
    for flat in 0..axis.pow(3) {
        let place = [flat % axis, flat / axis % axis, flat / axis / axis];
        let at = index(place.map(|c| c as usize + 1));
        match (reached[at], barrier[at]) {
            (true, _) => outside.push(place),
            (false, false) => inside.push(place),
            (false, true) => {}
        }
    }
    (outside, inside)
}

/// No flood from outside reaches a cell whose centre the surface encloses;
/// gives how many cells lie behind it on the finest level.
fn check_separation(name: &str, mesh: &Mesh, rho: u8, level: u8) -> usize {
    let asset = baked(mesh, &thin(rho, level));
    let faces = faces(mesh);
    let mut behind = 0;
    for (depth, drawn) in drawn_places(&asset.grid()).iter().enumerate() {
        let axis = u32::from(rho).pow(depth as u32);
        let (outside, inside) = flood(drawn, axis);
        let centre = |place: Place| {
            let (min, max) = bounds(place, axis);
            (min + max) / 2.0
        };
        // Beside the surface alone something can have slipped through.
        let drawn: HashSet<&Place> = drawn.iter().collect();
        let is_beside = |place: &Place| {
            (0..27).any(|i| {
                let step = [i % 3, i / 3 % 3, i / 9].map(|c: u32| c.wrapping_sub(1));
                drawn.contains(&[0, 1, 2].map(|axis| place[axis].wrapping_add(step[axis])))
            })
        };
        for &place in outside.iter().filter(|place| is_beside(place)) {
            let winding = winding(&faces, centre(place));
            assert!(
                winding.abs() < 0.5,
                "{name}, rho {rho}: cell {place:?} of {axis} is inside, {winding}"
            );
        }
        behind = inside.len();
    }
    behind
}

#[test]
fn nothing_slips_through_closed_surfaces() {
    for (rho, level) in [(2, 4), (3, 2), (4, 1), (5, 1)] {
        for (name, mesh) in [
            ("sphere", shapes::sphere(8)),
            ("torus", shapes::torus(16, 9)),
            ("turned torus", torus()),
            ("cube", shapes::cube()),
        ] {
            let behind = check_separation(name, &mesh, rho, level);
            assert!(behind > 50, "{name}, rho {rho}: {behind} cells behind it");
        }
    }
}

/// Corners of a sphere pushed in and out at random.
#[test]
fn nothing_slips_through_random_closed_surfaces() {
    let mut random = Random(0x3c6e_f372_fe94_f82b);
    for round in 0..16 {
        let turn = glam::DQuat::from_rotation_arc(DVec3::Y, random.point().normalize());
        let mut mesh = moved(&shapes::sphere(3 + round % 5), |position| turn * position);
        for position in &mut mesh.positions {
            *position *= 1.0 + 0.4 * random.next();
        }
        let (rho, level) = [(2, 4), (3, 2), (4, 1), (5, 1)][round as usize % 4];
        check_separation(&format!("round {round}"), &mesh, rho, level);
    }
}

#[test]
fn nothing_slips_through_the_demo() {
    assert!(check_separation("demo", &demo(), 3, 2) > 50);
}

/// Tiles of a dense cloud are closed, too.
#[test]
fn nothing_slips_through_a_cloud() {
    let cloud = Geometry::Cloud(sphere_of_points());
    let baked = |options| {
        let grid = bake::grid(&cloud, &options, &|_| {}).unwrap();
        AssetFile::new(&writer::to_bytes(&grid).unwrap()).unwrap()
    };
    for (rho, level) in [(2, 4), (3, 2), (4, 1), (5, 1)] {
        let (own, all) = (baked(thin(rho, level)), baked(options(rho, level)));
        check_stored(&own.grid());
        let axis = u32::from(rho).pow(u32::from(level) + 1);
        let leaves = places(&own.grid()).pop().unwrap();
        let all = places(&all.grid()).pop().unwrap().len();
        assert!(leaves.len() * 4 < all * 3, "{} of {all}", leaves.len());
        let (outside, inside) = flood(&leaves, axis);
        let radius = |place: Place| {
            let (min, max) = bounds(place, axis);
            ((min + max) / 2.0).length()
        };
        assert!(outside.iter().all(|&place| radius(place) > 0.99));
        assert!(inside.len() > 50);
    }
}

/// The finest level stores thin cells alone; those above are thin or lead to
/// some.
#[test]
fn shells_have_the_pinned_counts() {
    let check = |name: &str, mesh: &Mesh, rho: u8, drawn: &[usize], stored: &[usize]| {
        let asset = baked(mesh, &thin(rho, drawn.len() as u8 - 2));
        let grid = asset.grid();
        let count = |of: Vec<Vec<Place>>| -> Vec<usize> { of.iter().map(Vec::len).collect() };
        assert_eq!(
            count(drawn_places(&grid)),
            drawn,
            "{name}, rho {rho}: drawn"
        );
        assert_eq!(count(places(&grid)), stored, "{name}, rho {rho}: stored");
    };
    // Flat on the middles or the sides of cells: as fat.
    let quad = [1, 9, 81, 729];
    check("quad", &shapes::quad(), 3, &quad, &quad);
    let quad = [1, 8, 32, 128, 512];
    check("quad", &shapes::quad(), 2, &quad, &quad);
    let cube = [1, 26, 9 * 9 * 9 - 7 * 7 * 7];
    check("cube", &shapes::cube(), 3, &cube, &cube);
    let (sphere, torus) = (shapes::sphere(24), shapes::torus(48, 24));
    check(
        "sphere",
        &sphere,
        2,
        &[1, 8, 56, 168, 656, 2664, 10704],
        &[1, 8, 56, 272, 1104, 3808, 10704],
    );
    check(
        "sphere",
        &sphere,
        3,
        &[1, 18, 218, 1902, 17110],
        &[1, 26, 362, 2910, 17110],
    );
    check(
        "sphere",
        &sphere,
        4,
        &[1, 56, 656, 10704, 170704],
        &[1, 56, 1160, 16912, 170704],
    );
    check(
        "sphere",
        &sphere,
        5,
        &[1, 54, 1626, 40666],
        &[1, 98, 2746, 40666],
    );
    check(
        "torus",
        &torus,
        3,
        &[1, 8, 144, 1228, 11328],
        &[1, 9, 192, 1876, 11328],
    );
    check(
        "demo",
        &demo(),
        3,
        &[1, 18, 162, 1774, 20487, 196937],
        &[1, 23, 203, 2387, 26684, 196937],
    );
}
