//! Geometry that needs no file: the demo scene and small shapes for tests.
//!
//! The demo is an ammonite on a fluted column, wreathed in gold, on a plinth
//! carved with Sierpinski carpets. All of it is computed with operations that
//! IEEE 754 defines exactly, so that every machine makes the same bits.

mod blocks;
mod column;
mod elementary;
mod jet;
mod knot;
mod lathe;
mod plinth;
mod rings;
pub mod shapes;
mod shell;
mod tree;

use glam::DVec3;

use crate::geometry::{Material, Mesh};

use rings::Builder;

const IVORY: u8 = 0;
const TERRACOTTA: u8 = 1;
const GOLD: u8 = 2;
const VERDIGRIS: u8 = 3;
const SLATE: u8 = 4;

/// Names and colours in the order of the constants above.
const PALETTE: [(&str, [u8; 3]); 5] = [
    ("ivory", [244, 232, 206]),
    ("terracotta", [196, 92, 52]),
    ("gold", [236, 182, 62]),
    ("verdigris", [104, 164, 144]),
    ("slate", [104, 112, 132]),
];

/// The demo scene, standing on y = 0: closed parts that overlap.
pub fn demo() -> Mesh {
    let mut builder = Builder::default();
    plinth::plinth(&mut builder, 0.022);
    let wreath = knot::Knot {
        height: 0.93,
        radii: [0.82, 0.14, 0.13],
        turns: [3, 10],
        bar: 0.085,
        knurls: [150, 6],
        knurl_height: 0.28,
        material: GOLD,
    };
    wreath.build(&mut builder);
    column::shaft(&mut builder, [0.70, 0.72], [0.54, 1.48]);
    column::capital(&mut builder, 1.45, 0.54);
    let placement = shell::Placement {
        centre: DVec3::new(0.0, 2.98, 0.0),
        size: 1.18,
        roll: 0.6,
        turn: 0.5,
    };
    shell::ammonite(&mut builder, &placement);
    painted(builder, &PALETTE)
}

/// Names of models that are built in.
pub const NAMES: [&str; 3] = ["demo", "tree-broad", "tree-willow"];

/// A model of [`NAMES`]; trees have leaves of one sheet and are seen from both
/// sides.
pub fn built_in(name: &str) -> Option<Mesh> {
    let grow = match name {
        "demo" => return Some(demo()),
        "tree-broad" => tree::broad,
        "tree-willow" => tree::willow,
        _ => return None,
    };
    let mut builder = Builder::default();
    grow(&mut builder);
    Some(Mesh {
        two_sided: true,
        ..painted(builder, &tree::PALETTE)
    })
}

fn painted(builder: Builder, palette: &[(&str, [u8; 3])]) -> Mesh {
    let material = |&(name, diffuse): &(&str, [u8; 3])| Material {
        name: name.to_owned(),
        diffuse,
    };
    Mesh {
        materials: palette.iter().map(material).collect(),
        ..builder.mesh
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;
    use std::time::{Duration, Instant};

    use super::*;

    /// Position indices with bit-identical positions made one.
    fn welded(mesh: &Mesh) -> Vec<usize> {
        let mut first = HashMap::new();
        let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
        mesh.positions
            .iter()
            .enumerate()
            .map(|(i, p)| *first.entry(bits(p)).or_insert(i))
            .collect()
    }

    /// The representative of a set, with its path halved on the way.
    fn root(parents: &mut [usize], mut i: usize) -> usize {
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    }

    /// Signed volumes of the connected parts.
    fn volumes(mesh: &Mesh) -> Vec<f64> {
        let mut parents = welded(mesh);
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.positions.map(|i| root(&mut parents, i as usize));
            parents[b] = a;
            let c = root(&mut parents, c);
            parents[c] = a;
        }
        let mut volumes = HashMap::new();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.positions.map(|i| mesh.positions[i as usize]);
            let part = root(&mut parents, triangle.positions[0] as usize);
            *volumes.entry(part).or_insert(0.0) += a.cross(b).dot(c) / 6.0;
        }
        volumes.into_values().collect()
    }

    /// What holds for every mesh: indices, finite numbers, unit normals that
    /// look to the front of their triangle, no degenerate triangles.
    fn check(mesh: &Mesh) {
        assert!((1..=8).contains(&mesh.materials.len()));
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
        for normal in &mesh.normals {
            let length = normal.as_dvec3().length();
            assert!((length - 1.0).abs() < 1e-6, "normal {normal}");
        }
        for triangle in &mesh.triangles {
            assert!(usize::from(triangle.material) < mesh.materials.len());
            let [a, b, c] = triangle.positions.map(|i| mesh.positions[i as usize]);
            let front = (b - a).cross(c - a);
            let longest = [b - a, c - b, a - c]
                .map(DVec3::length)
                .into_iter()
                .fold(0.0, f64::max);
            assert!(
                front.length() > 1e-4 * longest * longest,
                "degenerate at {a} {b} {c}"
            );
            for normal in triangle.normals {
                let normal = mesh.normals[normal as usize];
                assert!(
                    front.dot(normal.as_dvec3()) > 0.0,
                    "normal {normal} at {a} {b} {c}"
                );
            }
        }
    }

    /// Every edge has exactly one triangle on either side.
    fn check_closed(mesh: &Mesh) {
        let welded = welded(mesh);
        let mut edges: HashMap<(usize, usize), u32> = HashMap::new();
        for triangle in &mesh.triangles {
            let corners = triangle.positions.map(|i| welded[i as usize]);
            for i in 0..3 {
                *edges.entry((corners[i], corners[(i + 1) % 3])).or_default() += 1;
            }
        }
        for (&(from, to), &count) in &edges {
            let place = mesh.positions[from];
            assert_eq!(count, 1, "edge used twice at {place}");
            assert!(edges.contains_key(&(to, from)), "open edge at {place}");
        }
    }

    /// CRC-32/ISO-HDLC of every number in the mesh, little-endian.
    fn fingerprint(mesh: &Mesh) -> u32 {
        let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
        let mut digest = crc.digest();
        for number in mesh.positions.iter().flat_map(|p| p.to_array()) {
            digest.update(&number.to_le_bytes());
        }
        for number in mesh.normals.iter().flat_map(|n| n.to_array()) {
            digest.update(&number.to_le_bytes());
        }
        for triangle in &mesh.triangles {
            for index in triangle.positions.iter().chain(&triangle.normals) {
                digest.update(&index.to_le_bytes());
            }
            digest.update(&[triangle.material]);
        }
        for material in &mesh.materials {
            digest.update(&material.diffuse);
        }
        digest.finalize()
    }

    #[test]
    fn demo_is_sound_and_closed() {
        let mesh = demo();
        check(&mesh);
        check_closed(&mesh);
        // Plinth, wreath, shaft, capital, 40 beads, shell, its eye.
        let volumes = volumes(&mesh);
        assert_eq!(volumes.len(), 46);
        assert!(volumes.iter().all(|volume| *volume > 0.0), "{volumes:?}");
    }

    #[test]
    fn demo_uses_every_material() {
        let mesh = demo();
        for material in 0..mesh.materials.len() {
            let uses = |t: &&crate::geometry::Triangle| usize::from(t.material) == material;
            let count = mesh.triangles.iter().filter(uses).count();
            assert!(count > 1000, "material {material}: {count}");
        }
    }

    #[test]
    fn demo_stands_upright_in_a_portrait() {
        let mesh = demo();
        let bounds = crate::geometry::Geometry::Mesh(mesh).bounds().unwrap();
        let size = bounds.max - bounds.min;
        assert_eq!(bounds.min.y, 0.0);
        assert!(size.x / size.y > 0.6 && size.x / size.y < 0.8, "{size}");
        assert!(size.z / size.y > 0.6 && size.z / size.y < 0.8, "{size}");
    }

    /// Frames and counts pinned elsewhere rest on these bits.
    #[test]
    fn demo_has_the_same_bits_everywhere() {
        assert_eq!(fingerprint(&demo()), 0x4421_5C04);
    }

    #[test]
    fn demo_takes_well_under_a_second() {
        let start = Instant::now();
        let mesh = demo();
        // Ten times the usual time: only a blunder is caught, not a busy host.
        assert!(start.elapsed() < Duration::from_secs(2));
        assert!(
            (100_000..300_000).contains(&mesh.triangles.len()),
            "{}",
            mesh.triangles.len()
        );
    }

    /// Limbs are solid, leaves single sheets, and everything stands on y = 0.
    #[test]
    fn trees_are_sound() {
        for (name, print, leaves) in [
            ("tree-broad", 0xA863_C528, 26_244),
            ("tree-willow", 0x1844_80FF, 26_730),
        ] {
            let mesh = built_in(name).expect(name);
            check(&mesh);
            let of = |material: u8| {
                let triangles = mesh.triangles.iter().filter(|t| t.material == material);
                Mesh {
                    triangles: triangles.cloned().collect(),
                    ..mesh.clone()
                }
            };
            check_closed(&of(0));
            assert_eq!(of(1).triangles.len(), 2 * leaves, "{name}");
            let lowest = mesh.positions.iter().map(|p| p.y).fold(f64::MAX, f64::min);
            assert!((-0.05..=0.0).contains(&lowest), "{name}: {lowest}");
            assert_eq!(fingerprint(&mesh), print, "{name}");
        }
        assert!(built_in("tree").is_none());
    }

    #[test]
    fn shapes_are_sound() {
        let volume = |mesh: &Mesh| volumes(mesh).iter().sum::<f64>();
        for (mesh, triangles, about) in [
            (
                shapes::sphere(24),
                4 * 24 * 23,
                4.0 / 3.0 * std::f64::consts::PI,
            ),
            (
                shapes::torus(48, 24),
                2 * 48 * 24,
                0.32 * std::f64::consts::PI.powi(2),
            ),
            (shapes::cube(), 12, 8.0),
        ] {
            check(&mesh);
            check_closed(&mesh);
            assert_eq!(mesh.triangles.len(), triangles);
            let ratio = volume(&mesh) / about;
            assert!(ratio > 0.97 && ratio < 1.0 + 1e-12, "{ratio}");
        }
        let quad = shapes::quad();
        check(&quad);
        assert_eq!((quad.positions.len(), quad.triangles.len()), (4, 2));
    }
}
