//! A mesh as a surface: triangles in the cube's coordinates.

use glam::{DVec3, Vec3};
use rhogrid_core::asset::Rgb;

use super::Cube;
use super::overlap::triangle_touches;
use super::surface::{Aabb, Sample, Surface};
use crate::geometry::Mesh;

struct Face {
    corners: [DVec3; 3],
    normals: [Vec3; 3],
    facing: Option<Vec3>,
    material: u8,
    colours: [Rgb; 3],
}

/// The triangles of a mesh.
pub(super) struct MeshSurface {
    faces: Vec<Face>,
}

impl MeshSurface {
    /// Moves a mesh into the cube.
    pub fn new(mesh: &Mesh, cube: &Cube) -> Self {
        let faces = mesh.triangles.iter().zip(0..).map(|(triangle, index)| {
            let own: Option<&[Rgb; 3]> = mesh.colours.get(index);
            let material = &mesh.materials[usize::from(triangle.material)];
            let corners = triangle
                .positions
                .map(|index| (mesh.positions[index as usize] - cube.centre) / cube.half_side);
            let normals = triangle.normals.map(|index| mesh.normals[index as usize]);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            Face {
                corners,
                normals,
                facing: normal.try_normalize().map(|normal| normal.as_vec3()),
                material: triangle.material,
                colours: own.copied().unwrap_or([material.diffuse; 3]),
            }
        });
        Self {
            faces: faces.collect(),
        }
    }

    fn face(&self, primitive: u32) -> &Face {
        &self.faces[primitive as usize]
    }
}

impl Surface for MeshSurface {
    fn count(&self) -> u32 {
        self.faces.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Aabb {
        let [a, b, c] = self.face(primitive).corners;
        Aabb {
            min: a.min(b).min(c),
            max: a.max(b).max(c),
        }
    }

    fn touches(&self, primitive: u32, cell: &Aabb) -> bool {
        triangle_touches(&self.face(primitive).corners, cell)
    }

    fn sample_at(&self, primitive: u32, point: DVec3) -> Sample {
        let face = self.face(primitive);
        let weights = nearest_weights(&face.corners, point);
        let mix = |of: [DVec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
        let nearest = mix(face.corners);
        let normal = mix(face.normals.map(Vec3::as_dvec3));
        let normal = normal
            .try_normalize()
            .map_or(face.normals[0], |normal| normal.as_vec3());
        Sample {
            point: nearest,
            distance_squared: (nearest - point).length_squared(),
            normal,
            material: face.material,
            colour: mixed(&face.colours, weights),
        }
    }

    fn facing(&self, primitive: u32) -> Option<Vec3> {
        self.face(primitive).facing
    }
}

/// Corners' colours by their weights.
fn mixed(colours: &[Rgb; 3], weights: [f64; 3]) -> Rgb {
    let [a, b, c] = colours.map(|colour| DVec3::from_array(colour.map(f64::from)));
    let mixed = a * weights[0] + b * weights[1] + c * weights[2];
    mixed.round().to_array().map(|channel| channel as u8)
}

/// Triangles lower than this, relative to their longest edge, count as their
/// edges: what rounding leaves of their barycentric weights tells nothing.
const NEEDLE: f64 = 1e-6;

/// Barycentric weights of a triangle's point nearest to `point`: the regions
/// of corners, edges and the face are told apart by projections on the edges.
fn nearest_weights(corners: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    let [a, b, c] = *corners;
    let (ab, ac) = (b - a, c - a);
    let longest = [ab, ac, c - b].map(DVec3::length_squared);
    let longest = longest.into_iter().fold(0.0, f64::max);
    if ab.cross(ac).length_squared() <= (NEEDLE * longest).powi(2) {
        return nearest_on_edges(corners, point);
    }
    let from_a = point - a;
    let (d1, d2) = (ab.dot(from_a), ac.dot(from_a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let from_b = point - b;
    let (d3, d4) = (ab.dot(from_b), ac.dot(from_b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let on_ab = d1 * d4 - d3 * d2;
    if on_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0];
    }
    let from_c = point - c;
    let (d5, d6) = (ab.dot(from_c), ac.dot(from_c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let on_ca = d5 * d2 - d1 * d6;
    if on_ca <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t];
    }
    let on_bc = d3 * d6 - d5 * d4;
    if on_bc <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - t, t];
    }
    let sum = on_ab + on_ca + on_bc;
    [on_bc / sum, on_ca / sum, on_ab / sum]
}

/// Weights of the nearest point of the three edges.
fn nearest_on_edges(corners: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    let mut best = (f64::INFINITY, [1.0, 0.0, 0.0]);
    for (from, to) in [(0, 1), (1, 2), (2, 0)] {
        let (start, edge) = (corners[from], corners[to] - corners[from]);
        let along = (point - start).dot(edge) / edge.length_squared();
        // Not a number where the corners are one.
        let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
        let distance = (start + edge * along - point).length_squared();
        if distance < best.0 {
            let mut weights = [0.0; 3];
            weights[from] = 1.0 - along;
            weights[to] = along;
            best = (distance, weights);
        }
    }
    best.1
}
