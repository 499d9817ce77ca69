//! The grid baker against a slow, obvious twin, on hand-made surfaces, and
//! through its file format.

mod cells;
mod colours;
mod cones;
mod counts;
mod dictionary;
mod extremes;
mod filter;
mod prefix;
mod thin;
mod twin;

use glam::{DVec3, Vec3};
use rhogrid::asset_file::AssetFile;
use rhogrid::bake::{self, GridOptions, writer};
use rhogrid::geometry::{Cloud, Geometry, Material, Mesh, OrientedPoint, Triangle};
use rhogrid_core::asset::Shell;

/// A fat shell.
fn options(rho: u8, level: u8) -> GridOptions {
    GridOptions {
        rho,
        level,
        shell: Shell::Fat,
        ..GridOptions::default()
    }
}

fn thin(rho: u8, level: u8) -> GridOptions {
    GridOptions {
        shell: Shell::Thin,
        ..options(rho, level)
    }
}

/// Bakes, writes and opens.
#[track_caller]
fn baked(mesh: &Mesh, options: &GridOptions) -> AssetFile {
    let grid = bake::grid(&Geometry::Mesh(mesh.clone()), options, &|_| {}).unwrap();
    AssetFile::new(&writer::to_bytes(&grid).unwrap()).unwrap()
}

/// A mesh of separate triangles with their face normals; degenerate ones get
/// the normal +y.
fn soup(triangles: &[[DVec3; 3]]) -> Mesh {
    let mut mesh = Mesh {
        materials: vec![Material::white()],
        ..Mesh::default()
    };
    for &[a, b, c] in triangles {
        let (first, normal) = (mesh.positions.len() as u32, mesh.normals.len() as u32);
        mesh.positions.extend([a, b, c]);
        let front = (b - a).cross(c - a).try_normalize();
        mesh.normals
            .push(front.map_or(Vec3::Y, |front| front.as_vec3()));
        mesh.triangles.push(Triangle {
            positions: [first, first + 1, first + 2],
            normals: [normal; 3],
            material: 0,
        });
    }
    mesh
}

/// The same mesh somewhere else.
fn moved(mesh: &Mesh, to: impl Fn(DVec3) -> DVec3) -> Mesh {
    Mesh {
        positions: mesh
            .positions
            .iter()
            .map(|&position| to(position))
            .collect(),
        ..mesh.clone()
    }
}

/// Two sheets back to back, `gap` apart in z, sides 2.
fn plate(gap: f64) -> Mesh {
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let front =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| at(x, y, gap / 2.0));
    let back = front.map(|corner| at(corner.x, corner.y, -gap / 2.0));
    soup(&[
        [front[0], front[1], front[2]],
        [front[0], front[2], front[3]],
        [back[0], back[2], back[1]],
        [back[0], back[3], back[2]],
    ])
}

/// An ordinary triangle, three of no area, a needle and a tiny one.
fn slivers(random: &mut Random) -> Vec<[DVec3; 3]> {
    let triangle = |index| {
        let (a, b, c) = (random.point(), random.point(), random.point());
        match index {
            0 => [a, b, c],
            1 => [a, b, a.lerp(b, 0.4)],
            2 => [a, b, a.lerp(b, 0.4) + c * 1e-5],
            3 => [a, a, b],
            4 => [a, a, a],
            _ => [a, a + b * 1e-4, a + c * 1e-4],
        }
    };
    (0..6).map(triangle).collect()
}

/// 4000 points on a sphere, on a spiral that gives each the same share of it.
fn sphere_of_points() -> Cloud {
    let points = (0..4000).map(|index| {
        let height = 1.0 - (f64::from(index) + 0.5) / 2000.0;
        let (sin, cos) = (f64::from(index) * 2.399_963_229_728_653).sin_cos();
        let around = (1.0 - height * height).sqrt();
        let position = DVec3::new(around * cos, height, around * sin);
        OrientedPoint {
            position,
            normal: position.as_vec3(),
        }
    });
    Cloud {
        points: points.collect(),
        colours: Vec::new(),
        two_sided: false,
    }
}

/// Marsaglia's xorshift64, as numbers in [-1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}
