//! Import of files of every odd kind: right geometry or an error with its
//! place, and never a panic.

mod colours;
mod dispatch;
mod mtl;
mod mutation;
mod obj;
mod odd;
mod ply;

use std::path::Path;

use glam::{DVec3, Vec3};
use rhogrid::geometry::{Cloud, Geometry, Mesh};
use rhogrid::import::{Imported, parse};

/// Reads `bytes` as a file of that name.
fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<Imported, String> {
    parse(Path::new(name), bytes.as_ref()).map_err(|error| error.to_string())
}

fn mesh(imported: Imported) -> Mesh {
    match imported.geometry {
        Geometry::Mesh(mesh) => mesh,
        Geometry::Cloud(_) => panic!("a cloud"),
    }
}

fn cloud(imported: Imported) -> Cloud {
    match imported.geometry {
        Geometry::Cloud(cloud) => cloud,
        Geometry::Mesh(_) => panic!("a mesh"),
    }
}

fn obj_mesh(text: impl AsRef<[u8]>) -> Mesh {
    mesh(read("a.obj", text).unwrap())
}

fn area(mesh: &Mesh) -> f64 {
    let corners = |i: usize| {
        mesh.triangles[i]
            .positions
            .map(|i| mesh.positions[i as usize])
    };
    let double = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length();
    (0..mesh.triangles.len())
        .map(|i| double(corners(i)) / 2.0)
        .sum()
}

/// The three normals of a triangle.
fn normals(mesh: &Mesh, triangle: usize) -> [Vec3; 3] {
    mesh.triangles[triangle]
        .normals
        .map(|i| mesh.normals[i as usize])
}

#[track_caller]
fn assert_fails(name: &str, bytes: impl AsRef<[u8]>, expected: &str) {
    match read(name, bytes) {
        Ok(imported) => panic!("loads as {:?}", imported.geometry),
        Err(error) => assert_eq!(error, expected),
    }
}

#[track_caller]
fn assert_fails_at(name: &str, bytes: impl AsRef<[u8]>, start: &str) {
    match read(name, bytes) {
        Ok(imported) => panic!("loads as {:?}", imported.geometry),
        Err(error) => assert!(error.starts_with(start), "{error}"),
    }
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

const CUBE_POSITIONS: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];

const CUBE_FACES: [[i32; 4]; 6] = [
    [3, 2, 1, 0],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// A cube whose vertices carry a list and a colour between the coordinates.
fn cube_ply(format: &str, body: &[u8]) -> Vec<u8> {
    let header = format!(
        "ply\r\nformat {format} 1.0\ncomment made by hand\nobj_info 1\nelement vertex 8\n\
         property float x\nproperty list uint16 double extra\nproperty float32 y\n\
         property uchar red\nproperty float z\nelement range 2\nproperty list uchar short ids\n\
         element face 6\nproperty float quality\nproperty list int8 int vertex_index\nend_header\r\n"
    );
    [header.as_bytes(), body].concat()
}

fn cube_ascii() -> Vec<u8> {
    let mut body = String::new();
    for [x, y, z] in CUBE_POSITIONS {
        body += &format!("{x} 2 0.5 nan {y} 200 {z} \r\n");
    }
    body += "0\n\n2 7 8\n";
    for [a, b, c, d] in CUBE_FACES {
        body += &format!("0.5 4 {a} {b}\t{c} {d}\n");
    }
    body.into_bytes()
}

fn cube_binary(big: bool) -> Vec<u8> {
    let mut body = Vec::new();
    let mut push = |little: &[u8]| {
        let start = body.len();
        body.extend_from_slice(little);
        if big {
            body[start..].reverse();
        }
    };
    for [x, y, z] in CUBE_POSITIONS {
        push(&x.to_le_bytes());
        push(&1u16.to_le_bytes());
        push(&f64::NAN.to_le_bytes());
        push(&y.to_le_bytes());
        push(&[200]);
        push(&z.to_le_bytes());
    }
    push(&[0]);
    push(&[1]);
    push(&7i16.to_le_bytes());
    for face in CUBE_FACES {
        push(&0.5f32.to_le_bytes());
        push(&[4]);
        face.iter().for_each(|index| push(&index.to_le_bytes()));
    }
    body
}

/// An ascii PLY of three vertices and more.
fn ply(vertex_properties: &str, vertices: &str, rest_of_header: &str, rest: &str) -> String {
    let properties: String = vertex_properties
        .split_whitespace()
        .map(|name| format!("property float {name}\n"))
        .collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex {}\n{properties}{rest_of_header}end_header\n{vertices}{rest}",
        vertices.lines().count()
    )
}

const FACE_LIST: &str = "element face 1\nproperty list uchar int vertex_indices\n";
const THREE: &str = "0 0 0\n1 0 0\n0 1 0\n";
