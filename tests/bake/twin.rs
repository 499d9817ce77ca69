//! The baker's twin: every cell against every triangle, by clipping polygons;
//! every sample by brute force over all triangles.

use glam::{DVec3, Vec3};
use rhogrid::bake::Cube;
use rhogrid::geometry::{Geometry, Material, Mesh};
use rhogrid::import::procedural::shapes;
use rhogrid_core::normal::{CODE_MASK, decode};

use super::cells::cells;
use super::{Random, baked, moved, options, plate, slivers, soup};

/// A surface that comes nearer to a cell than this touches it; the shapes
/// here leave nothing between this and rounding.
pub const TOUCH: f64 = 1e-9;
/// Nearest points that differ less are equally near.
pub const TIE: f64 = 1e-9;
/// The largest angle between a direction and its code's: 1 - cosine 9.7e-4.
pub const CODE_COSINE: f64 = 1.0 - 9.7e-4;

/// A triangle in the cube's coordinates.
pub struct Face {
    pub corners: [DVec3; 3],
    pub normals: [Vec3; 3],
    pub material: u8,
}

pub fn faces(mesh: &Mesh) -> Vec<Face> {
    let cube = Cube::of(&Geometry::Mesh(mesh.clone())).unwrap();
    mesh.triangles
        .iter()
        .map(|triangle| Face {
            corners: triangle
                .positions
                .map(|index| (mesh.positions[index as usize] - cube.centre) / cube.half_side),
            normals: triangle.normals.map(|index| mesh.normals[index as usize]),
            material: triangle.material,
        })
        .collect()
}

/// Smallest and largest corner of a cell.
pub fn bounds(place: [u32; 3], axis: u32) -> (DVec3, DVec3) {
    let side = |index: u32| 2.0 * f64::from(index) / f64::from(axis) - 1.0;
    (
        DVec3::from_array(place.map(side)),
        DVec3::from_array(place.map(|index| side(index + 1))),
    )
}

/// Whether something of the triangle is left after cutting it with the six
/// sides of a box.
pub fn touches(corners: &[DVec3; 3], (min, max): (DVec3, DVec3), grown: f64) -> bool {
    let mut polygon = corners.to_vec();
    for axis in 0..3 {
        for (sign, side) in [(1.0, max[axis] + grown), (-1.0, -(min[axis] - grown))] {
            let inside = |point: &DVec3| side - sign * point[axis];
            let mut cut = Vec::with_capacity(polygon.len() + 1);
            for (index, from) in polygon.iter().enumerate() {
                let to = &polygon[(index + 1) % polygon.len()];
                let (a, b) = (inside(from), inside(to));
                if a >= 0.0 {
                    cut.push(*from);
                }
                if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
                    cut.push(from.lerp(*to, a / (a - b)));
                }
            }
            if cut.is_empty() {
                return false;
            }
            polygon = cut;
        }
    }
    true
}

/// Distance of a face's nearest point, and the normal there.
pub fn nearest(face: &Face, point: DVec3) -> (f64, DVec3) {
    let [a, b, c] = face.corners;
    let area = |a: DVec3, b: DVec3, c: DVec3, normal: DVec3| (b - a).cross(c - a).dot(normal);
    let normal = (b - a).cross(c - a);
    let whole = normal.length_squared();
    let weights = if whole > 1e-24 {
        let at = point - normal * ((point - a).dot(normal) / whole);
        [
            area(b, c, at, normal),
            area(c, a, at, normal),
            area(a, b, at, normal),
        ]
        .map(|part| part / whole)
    } else {
        [-1.0; 3]
    };
    let mut best = (f64::INFINITY, [0.0; 3]);
    let mut offer = |weights: [f64; 3]| {
        let at = a * weights[0] + b * weights[1] + c * weights[2];
        let distance = at.distance(point);
        if distance < best.0 {
            best = (distance, weights);
        }
    };
    if weights.iter().all(|weight| *weight >= 0.0) {
        offer(weights);
    }
    let corners = [a, b, c];
    for (from, to) in [(0, 1), (1, 2), (2, 0)] {
        let edge = corners[to] - corners[from];
        let along = (point - corners[from]).dot(edge) / edge.length_squared();
        let along = if along.is_finite() {
            along.clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mut weights = [0.0; 3];
        weights[from] = 1.0 - along;
        weights[to] += along;
        offer(weights);
    }
    let mixed: DVec3 = (0..3).map(|i| face.normals[i].as_dvec3() * best.1[i]).sum();
    (
        best.0,
        mixed.try_normalize().unwrap_or(face.normals[0].as_dvec3()),
    )
}

pub fn decoded(attribute: u16) -> DVec3 {
    DVec3::from_array(decode(attribute & CODE_MASK).map(f64::from)).normalize()
}

/// Distances, normals and materials of the nearest points to a cell's centre.
fn nearest_points(faces: &[Face], place: [u32; 3], axis: u32) -> Vec<(f64, DVec3, u8)> {
    let (min, max) = bounds(place, axis);
    let centre = (min + max) / 2.0;
    let mut all: Vec<(f64, DVec3, u8)> = faces
        .iter()
        .map(|face| {
            let (distance, normal) = nearest(face, centre);
            (distance, normal, face.material)
        })
        .collect();
    let distances = all.iter().map(|candidate| candidate.0);
    let least = distances.fold(f64::INFINITY, f64::min);
    all.retain(|candidate| candidate.0 <= least + TIE);
    all
}

/// The attribute is that of one of the nearest points.
pub fn check_sample(faces: &[Face], place: [u32; 3], axis: u32, attribute: u16) {
    let own = decoded(attribute);
    let nearest = nearest_points(faces, place, axis);
    let is_right = nearest.iter().any(|&(_, normal, material)| {
        u16::from(material) == attribute >> 13 && normal.dot(own) >= CODE_COSINE
    });
    assert!(
        is_right,
        "cell {place:?} of {axis}: {own} with material {}, nearest {nearest:?}",
        attribute >> 13,
    );
}

/// The material is that of one of the nearest points; normals of intermediate
/// samples are [filtered](super::filter).
pub fn check_material(faces: &[Face], place: [u32; 3], axis: u32, attribute: u16) {
    let nearest = nearest_points(faces, place, axis);
    let own = attribute >> 13;
    assert!(
        nearest.iter().any(|point| u16::from(point.2) == own),
        "cell {place:?} of {axis}: material {own}, nearest {nearest:?}"
    );
}

fn check(name: &str, mesh: &Mesh, rho: u8, level: u8) {
    let asset = baked(mesh, &options(rho, level));
    let faces = faces(mesh);
    for (depth, own) in cells(&asset.grid()).iter().enumerate() {
        let axis = u32::from(rho).pow(depth as u32);
        let mut expected = Vec::new();
        for index in 0..axis.pow(3) {
            let place = [index % axis, index / axis % axis, index / axis / axis];
            let cell = bounds(place, axis);
            if faces.iter().any(|face| touches(&face.corners, cell, TOUCH)) {
                expected.push(place);
            }
        }
        let mut places: Vec<[u32; 3]> = own.iter().map(|cell| cell.place).collect();
        places.sort_unstable();
        expected.sort_unstable();
        let missing: Vec<_> = expected
            .iter()
            .filter(|place| places.binary_search(place).is_err())
            .collect();
        let extra: Vec<_> = places
            .iter()
            .filter(|place| expected.binary_search(place).is_err())
            .collect();
        assert!(
            missing.is_empty() && extra.is_empty(),
            "{name}, rho {rho}, depth {depth}: missing {missing:?}, extra {extra:?}"
        );
        for cell in own {
            match cell.record.is_empty() {
                true => check_sample(&faces, cell.place, axis, cell.attribute),
                false => check_material(&faces, cell.place, axis, cell.attribute),
            }
        }
    }
}

/// A torus of eight materials, turned so that nothing lies on a boundary.
pub fn torus() -> Mesh {
    let mut mesh = shapes::torus(10, 7);
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 0.2);
    mesh = moved(&mesh, |position| turn * position);
    for normal in &mut mesh.normals {
        *normal = (turn * normal.as_dvec3()).as_vec3();
    }
    mesh.materials = vec![Material::white(); 8];
    for (index, triangle) in mesh.triangles.iter_mut().enumerate() {
        triangle.material = (index % 8) as u8;
    }
    mesh
}

pub const LEVELS: [(u8, u8); 4] = [(2, 3), (3, 2), (4, 1), (5, 1)];

#[test]
fn curved_shapes_have_the_twins_cells_and_samples() {
    for (rho, level) in LEVELS {
        check("torus", &torus(), rho, level);
        check("sphere", &shapes::sphere(6), rho, level);
    }
}

/// Faces that lie exactly on the sides of cells touch both neighbours.
#[test]
fn flat_shapes_on_boundaries_have_the_twins_cells_and_samples() {
    for (rho, level) in LEVELS {
        check("cube", &shapes::cube(), rho, level);
        check("quad", &shapes::quad(), rho, level);
        check("plate", &plate(0.01), rho, level);
    }
}

#[test]
fn random_slivers_and_degenerate_triangles_have_the_twins_cells_and_samples() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
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
