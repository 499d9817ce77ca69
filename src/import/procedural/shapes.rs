//! Small exact meshes for tests: their counts and bounds are easy to work out
//! by hand.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, IVec3};

use crate::geometry::{Material, Mesh};

use super::blocks::boundary;
use super::elementary::sin_cos;
use super::rings::{Builder, End, Vertex, angle};

/// A closed unit sphere around the origin, cut into `subdivision` bands from
/// pole to pole and twice as many segments: `4 * subdivision * (subdivision -
/// 1)` triangles with exact normals.
///
/// # Panics
///
/// If `subdivision` is below 2.
pub fn sphere(subdivision: u32) -> Mesh {
    assert!(subdivision >= 2, "a sphere has at least two bands");
    let mut builder = Builder::default();
    ball(&mut builder, DVec3::ZERO, 1.0, subdivision, 0);
    white(builder)
}

/// Adds a small sphere for ornaments: 120 triangles.
pub(super) fn bead(builder: &mut Builder, centre: DVec3, radius: f64, material: u8) {
    ball(builder, centre, radius, 6, material);
}

fn ball(builder: &mut Builder, centre: DVec3, radius: f64, bands: u32, material: u8) {
    let vertex = |normal: DVec3| Vertex {
        position: centre + normal * radius,
        normal,
    };
    let ring = |builder: &mut Builder, band: u32| {
        let (outward, down) = sin_cos(PI * f64::from(band) / f64::from(bands));
        builder.ring(2 * bands, |i| {
            let (sine, cosine) = sin_cos(angle(i, 2 * bands));
            vertex(DVec3::new(outward * cosine, -down, outward * sine))
        })
    };
    let mut from = ring(builder, 1);
    builder.fan(from, End::First, vertex(DVec3::NEG_Y), material);
    for band in 2..bands {
        let to = ring(builder, band);
        builder.join(from, to, material);
        from = to;
    }
    builder.fan(from, End::Last, vertex(DVec3::Y), material);
}

/// A closed torus around the y axis, radii 1 and 0.4, of `2 * rows * columns`
/// triangles with exact normals.
///
/// # Panics
///
/// If `rows` (around the axis) or `columns` (around the tube) is below 3.
pub fn torus(rows: u32, columns: u32) -> Mesh {
    assert!(rows >= 3 && columns >= 3, "a loop has at least three parts");
    let mut builder = Builder::default();
    let ring = |builder: &mut Builder, row: u32| {
        let (sin_phi, cos_phi) = sin_cos(TAU * f64::from(row) / f64::from(rows));
        builder.ring(columns, |i| {
            let (sine, cosine) = sin_cos(angle(i, columns));
            let normal = DVec3::new(cosine * cos_phi, -sine, cosine * sin_phi);
            Vertex {
                position: DVec3::new(cos_phi, 0.0, sin_phi) + normal * 0.4,
                normal,
            }
        })
    };
    let first = ring(&mut builder, 0);
    let mut from = first;
    for row in 1..rows {
        let to = ring(&mut builder, row);
        builder.join(from, to, 0);
        from = to;
    }
    builder.join(from, first, 0);
    white(builder)
}

/// A closed cube of side 2 around the origin: 8 positions, 6 normals, 12
/// triangles.
pub fn cube() -> Mesh {
    let mut builder = Builder::default();
    boundary(
        &mut builder,
        IVec3::ONE,
        |_| true,
        |corner| corner.as_dvec3() * 2.0 - 1.0,
        |normal| normal,
        |_, _| Some(0),
    );
    white(builder)
}

/// A one-sided square sheet of side 2 in the plane z = 0, its front to +z:
/// two triangles.
pub fn quad() -> Mesh {
    let mut builder = Builder::default();
    let normal = builder.normal(DVec3::Z);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| (builder.position(DVec3::new(x, y, 0.0)), normal));
    builder.triangle([corners[0], corners[1], corners[2]], 0);
    builder.triangle([corners[0], corners[2], corners[3]], 0);
    white(builder)
}

/// The finished mesh with one white material.
fn white(builder: Builder) -> Mesh {
    Mesh {
        materials: vec![Material::white()],
        ..builder.mesh
    }
}
