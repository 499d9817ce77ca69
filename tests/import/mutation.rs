//! Any bytes: thousands of damaged files, from fixed seeds.

use glam::Vec3;
use rhogrid::geometry::Geometry;
use rhogrid::import::{Imported, MAX_MATERIALS, load};

use super::{CUBE, cube_ascii, cube_binary, cube_ply, ply, read};

/// Marsaglia's xorshift64.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit as u64) as usize
    }
}

const PIECES: [&[u8]; 24] = [
    b"nan",
    b"1e39",
    b"-1",
    b"0",
    b"\\\n",
    b"//",
    b"f ",
    b"\r",
    b"\n",
    b" ",
    b"-9223372036854775808",
    b"4000000000",
    b"18446744073709551615",
    b"v 1 1 1\n",
    b"f 1 2 3\n",
    b"element vertex 3\n",
    b"\xff\xff\xff\xff",
    b"property list char double vertex_index\n",
    b"1e-300",
    b"#",
    b"f 1 2 3 4 1 2 5\n",
    b"usemtl a\n",
    b"double",
    b"\0",
];

/// Cuts, overwrites, inserts and repeats a few places.
fn mutate(seed: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() + 1);
        let end = (at + random.below(9)).min(bytes.len());
        match random.below(6) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].iter().copied())),
            3 => drop(bytes.splice(at..end, PIECES[random.below(PIECES.len())].iter().copied())),
            4 => bytes[at..end]
                .iter_mut()
                .for_each(|byte| *byte ^= 1 << random.below(8)),
            _ => bytes.extend_from_within(at..end),
        }
    }
    bytes
}

/// What [`Geometry`] promises.
fn assert_sound(imported: &Imported) {
    assert!(
        imported
            .notes
            .iter()
            .all(|note| !note.is_empty() && !note.contains('\n'))
    );
    let bounds = imported.geometry.bounds().expect("bounds");
    assert!(bounds.radius > 0.0 && bounds.radius.is_finite() && bounds.min.is_finite());
    let is_unit = |normal: &Vec3| (normal.length() - 1.0).abs() < 1e-5;
    match &imported.geometry {
        Geometry::Cloud(cloud) => assert!(cloud.points.iter().all(|point| is_unit(&point.normal))),
        Geometry::Mesh(mesh) => {
            assert!(mesh.normals.iter().all(is_unit));
            assert!(mesh.positions.iter().all(|position| position.is_finite()));
            assert!((1..=MAX_MATERIALS).contains(&mesh.materials.len()));
            for triangle in &mesh.triangles {
                assert!(
                    triangle
                        .positions
                        .iter()
                        .all(|&i| (i as usize) < mesh.positions.len())
                );
                assert!(
                    triangle
                        .normals
                        .iter()
                        .all(|&i| (i as usize) < mesh.normals.len())
                );
                assert!((triangle.material as usize) < mesh.materials.len());
            }
        }
    }
}

#[test]
fn no_mutation_panics_or_breaks_a_promise() {
    let rich = format!(
        "mtllib none.mtl\nvn 0 0 1\nvt 0 0\n{CUBE}usemtl b\nf -1/1/1 -2/1/1 -3/1/1 -4/1/1\nf 1//1 2//1 3//1\n"
    );
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let seeds: [(&str, Vec<u8>); 6] = [
        ("a.obj", CUBE.into()),
        ("a.obj", rich.into()),
        ("a.ply", cube_ply("ascii", &cube_ascii())),
        (
            "a.ply",
            cube_ply("binary_little_endian", &cube_binary(false)),
        ),
        ("a.ply", cube_ply("binary_big_endian", &cube_binary(true))),
        (
            "a.ply",
            ply(
                "x y z nx ny nz",
                "0 0 0 0 0 1\n1 0 0 0 1 0\n0 1 0 1 0 0\n",
                strips,
                "5 0 1 2 -1 0\n",
            )
            .into(),
        ),
    ];
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut loaded = 0;
    for round in 0..3000 {
        for (name, seed) in &seeds {
            let bytes = mutate(seed, &mut random);
            let result = std::panic::catch_unwind(|| match read(name, &bytes) {
                Ok(imported) => {
                    assert_sound(&imported);
                    true
                }
                Err(error) => {
                    assert!(error.starts_with(name), "{error}");
                    false
                }
            });
            let case = || format!("round {round}, {name}: {}", bytes.escape_ascii());
            loaded += usize::from(result.unwrap_or_else(|_| panic!("{}", case())));
        }
    }
    // Not all mutations may fail in the header, or the test shows little.
    assert!(loaded > 1000, "{loaded}");
}

#[test]
fn no_mutated_material_file_panics() {
    let folder = tempfile::tempdir().unwrap();
    let (obj, mtl) = (folder.path().join("a.obj"), folder.path().join("m.mtl"));
    std::fs::write(
        &obj,
        format!("mtllib m.mtl\nusemtl a\n{CUBE}usemtl b\nf 1 2 3\n"),
    )
    .unwrap();
    let seed =
        b"newmtl a\nKd 1 0.5 0\nmap_Kd x.png\nnewmtl b\nKa 1 1\nKd 0.25\nKd spectral x\nillum 2\n";
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut loaded = 0;
    for round in 0..1000 {
        let bytes = mutate(seed, &mut random);
        std::fs::write(&mtl, &bytes).unwrap();
        let result = std::panic::catch_unwind(|| match load(&obj) {
            Ok(imported) => {
                assert_sound(&imported);
                true
            }
            Err(error) => {
                assert_eq!(error.file.as_ref(), Some(&mtl));
                false
            }
        });
        let case = || format!("round {round}: {}", bytes.escape_ascii());
        loaded += usize::from(result.unwrap_or_else(|_| panic!("{}", case())));
    }
    assert!(loaded > 100, "{loaded}");
}
