//! Meshes from rings: closed loops of vertices, joined one to the next and
//! shut by fans. Every procedural part but the plinth is made this way.
//!
//! ```text
//!   fan      join      join     fan        u: from ring to ring
//!    .-- ring --- ring --- ring --.        v: around a ring
//!  apex   |  /|   |  /|   |       apex     outside: du x dv
//!    '---- ------- ------- ------'
//! ```

use std::f64::consts::TAU;

use glam::DVec3;

use crate::geometry::{Mesh, Triangle};

/// A position with its unit normal.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    pub position: DVec3,
    pub normal: DVec3,
}

/// A loop of vertices inside a [`Builder`]'s mesh.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    first_position: u32,
    first_normal: u32,
    count: u32,
}

impl Ring {
    /// Position and normal index of the i-th vertex, counted around.
    fn corner(self, i: u32) -> (u32, u32) {
        let i = i % self.count;
        (self.first_position + i, self.first_normal + i)
    }
}

/// On which side of a ring, along u, a fan's apex lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    First,
    Last,
}

/// A mesh under construction.
#[derive(Default)]
pub struct Builder {
    pub mesh: Mesh,
}

/// The angle of the i-th of `count` vertices around a ring, in radians.
pub fn angle(i: u32, count: u32) -> f64 {
    TAU * f64::from(i) / f64::from(count)
}

impl Builder {
    pub fn position(&mut self, position: DVec3) -> u32 {
        self.mesh.positions.push(position);
        self.mesh.positions.len() as u32 - 1
    }

    pub fn normal(&mut self, normal: DVec3) -> u32 {
        self.mesh.normals.push(normal.as_vec3());
        self.mesh.normals.len() as u32 - 1
    }

    /// Adds a triangle of (position, normal) corners.
    pub fn triangle(&mut self, corners: [(u32, u32); 3], material: u8) {
        self.mesh.triangles.push(Triangle {
            positions: corners.map(|corner| corner.0),
            normals: corners.map(|corner| corner.1),
            material,
        });
    }

    /// Adds a ring of `count` vertices.
    pub fn ring(&mut self, count: u32, vertex: impl Fn(u32) -> Vertex) -> Ring {
        let ring = Ring {
            first_position: self.mesh.positions.len() as u32,
            first_normal: self.mesh.normals.len() as u32,
            count,
        };
        for i in 0..count {
            let Vertex { position, normal } = vertex(i);
            self.position(position);
            self.normal(normal);
        }
        ring
    }

    /// The same positions with other normals, for a sharp edge.
    pub fn crease(&mut self, ring: Ring, normal: impl Fn(u32) -> DVec3) -> Ring {
        let first_normal = self.mesh.normals.len() as u32;
        for i in 0..ring.count {
            self.normal(normal(i));
        }
        Ring {
            first_normal,
            ..ring
        }
    }

    /// Joins two rings of equal count, each quadrilateral cut along its
    /// shorter diagonal.
    pub fn join(&mut self, from: Ring, to: Ring, material: u8) {
        let gap = |a: (u32, u32), b: (u32, u32), mesh: &Mesh| {
            mesh.positions[a.0 as usize].distance_squared(mesh.positions[b.0 as usize])
        };
        for i in 0..from.count {
            let quad = [
                from.corner(i),
                to.corner(i),
                to.corner(i + 1),
                from.corner(i + 1),
            ];
            let straight = gap(quad[0], quad[2], &self.mesh) <= gap(quad[1], quad[3], &self.mesh);
            let halves = if straight {
                [[0, 1, 2], [0, 2, 3]]
            } else {
                [[0, 1, 3], [1, 2, 3]]
            };
            for half in halves {
                self.triangle(half.map(|corner: usize| quad[corner]), material);
            }
        }
    }

    /// Shuts a ring with triangles to one apex.
    pub fn fan(&mut self, ring: Ring, end: End, apex: Vertex, material: u8) {
        let apex = (self.position(apex.position), self.normal(apex.normal));
        for i in 0..ring.count {
            let (here, next) = (ring.corner(i), ring.corner(i + 1));
            let corners = match end {
                End::First => [apex, here, next],
                End::Last => [here, apex, next],
            };
            self.triangle(corners, material);
        }
    }

    /// Shuts a ring with a flat lid: a fan behind a sharp edge.
    pub fn lid(&mut self, ring: Ring, end: End, apex: Vertex, material: u8) {
        let flat = self.crease(ring, |_| apex.normal);
        self.fan(flat, end, apex, material);
    }
}
