//! PLY: the three formats, and each error with its line or byte.

use glam::{DVec3, Vec3};

use super::{
    FACE_LIST, THREE, area, assert_fails, assert_fails_at, cloud, cube_ascii, cube_binary,
    cube_ply, mesh, normals, ply, read,
};

#[test]
fn the_three_formats_give_equal_meshes() {
    let ascii = read("a.ply", cube_ply("ascii", &cube_ascii())).unwrap();
    assert_eq!(ascii.notes, ["element `range` not used"]);
    let ascii = mesh(ascii);
    assert_eq!(
        (ascii.triangles.len(), ascii.normals.len(), area(&ascii)),
        (12, 24, 6.0)
    );
    for (format, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let binary = mesh(read("a.ply", cube_ply(format, &cube_binary(big))).unwrap());
        assert_eq!(binary.positions, ascii.positions);
        assert_eq!(binary.triangles, ascii.triangles);
        assert_eq!(binary.normals, ascii.normals);
    }
}

#[test]
fn strips_alternate_and_restart() {
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let vertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 0 0\n3 0 0\n2 1 0\n";
    let text = ply("x y z", vertices, strips, "10 0 1 2 3 3 -1 4 5 6 6\n");
    let mesh = mesh(read("a.ply", text).unwrap());
    let corners: Vec<[u32; 3]> = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.positions)
        .collect();
    assert_eq!(corners, [[0, 1, 2], [2, 1, 3], [4, 5, 6]]);
    assert!((0..3).all(|i| normals(&mesh, i) == [Vec3::Z; 3]));
}

#[test]
fn vertex_normals_are_used() {
    let vertices = "0 0 0 0 0 -2\n1 0 0 0 3 4\n0 1 0 0 0 0\n";
    let text = ply("x y z nx ny nz", vertices, FACE_LIST, "3 0 1 2\n");
    let imported = read("a.ply", text).unwrap();
    assert_eq!(
        imported.notes,
        ["1 corner with a zero normal: implied by the faces"]
    );
    assert_eq!(
        normals(&mesh(imported), 0),
        [Vec3::NEG_Z, Vec3::new(0.0, 0.6, 0.8), Vec3::Z]
    );
}

#[test]
fn clouds_keep_their_normals() {
    let points = "0 0 0 0 0 2\n1 0 0 0 3 4\n";
    for faces in [
        "",
        "element face 0\nproperty list uchar int vertex_indices\n",
    ] {
        let cloud = cloud(read("a.ply", ply("x y z nx ny nz", points, faces, "")).unwrap());
        let normals: Vec<Vec3> = cloud.points.iter().map(|point| point.normal).collect();
        assert_eq!(normals, [Vec3::Z, Vec3::new(0.0, 0.6, 0.8)]);
        assert_eq!(cloud.points[1].position, DVec3::X);
    }
    let remedy = "remove the point, or the properties nx, ny and nz: normals are estimated then";
    let zero = ply("x y z nx ny nz", "0 0 0 0 0 1\n1 0 0 0 0 0\n", "", "");
    assert_fails(
        "a.ply",
        zero,
        &format!("a.ply:12: the normal of point 1 is zero; {remedy}"),
    );
    let same = ply("x y z nx ny nz", "1 2 3 0 0 1\n1 2 3 0 0 1\n", "", "");
    assert_fails_at(
        "a.ply",
        same,
        "a.ply: nothing to draw: 2 points at one place;",
    );
}

#[test]
fn clouds_without_normals_get_them() {
    let octahedron = |count: i32| -> String {
        let place = |i: i32| {
            let (x, y) = (i % count, i / count);
            let z = count / 2 - (x - count / 2).abs() - (y - count / 2).abs();
            (z >= 0).then(|| format!("{x} {y} {z}\n{x} {y} {}\n", -z))
        };
        (0..count * count).filter_map(place).collect()
    };
    let solid = read("a.ply", ply("x y z", &octahedron(32), "", "")).unwrap();
    assert_eq!(solid.notes, ["no normals: estimated, looking outwards"]);
    let solid = cloud(solid);
    assert!(!solid.two_sided);
    for point in solid.points.iter().filter(|p| p.position.z.abs() > 4.0) {
        assert!(
            f64::from(point.normal.z) * point.position.z > 0.0,
            "{point:?}"
        );
    }
    let flat = read("a.ply", ply("x y z", THREE, "", "")).unwrap();
    let note = "no normals: estimated, but 100% of the points are on open sheets: \
        drawn from both sides";
    assert_eq!(flat.notes, [note]);
    let flat = cloud(flat);
    assert!(flat.two_sided && flat.points.iter().all(|p| p.normal.z.abs() == 1.0));
}

#[test]
fn clouds_without_normals_need_a_plane() {
    let remedy = "give normals (nx ny nz in PLY), or check the coordinates";
    for (points, number) in [
        ("0 0 0\n1 2 3\n", 2),
        ("0 0 0\n1 2 3\n0.5 1 1.5\n-2 -4 -6\n", 4),
        ("1e30 0 0\n-1e30 0 0\n1e30 0 0\n", 3),
    ] {
        let expected = format!(
            "a.ply: no normals, and none to be estimated: {number} points on one line; {remedy}"
        );
        assert_fails("a.ply", ply("x y z", points, "", ""), &expected);
    }
    let same = ply("x y z", "1 2 3\n1 2 3\n", "", "");
    assert_fails_at(
        "a.ply",
        same,
        "a.ply: nothing to draw: 2 points at one place;",
    );
    let one = ply("x y z", "1 2 3\n", "", "");
    assert_fails_at(
        "a.ply",
        one,
        "a.ply: nothing to draw: 1 point at one place;",
    );
    let nan = ply("x y z", "1 2 3\n1 nan 3\n", "", "");
    assert_fails_at(
        "a.ply",
        nan,
        "a.ply:9: the coordinate NaN is not a finite number;",
    );
}

#[test]
fn bad_ascii_ply_lines_are_named() {
    let with_face = |face: &str| ply("x y z", THREE, FACE_LIST, face);
    let cases = [
        (
            with_face("3 0 1 3\n"),
            "13: vertex index 3 where the last vertex is 2; indices count from 0",
        ),
        (
            with_face("3 0 1 -1\n"),
            "13: vertex index -1 where the last vertex is 2; indices count from 0",
        ),
        (
            with_face("3 0 1 0.5\n"),
            "13: vertex index 0.5 where the last vertex is 2; indices count from 0",
        ),
        (
            with_face("2 0 1 \n"),
            "13: a face of 2 corners; a face needs 3 or more",
        ),
        (
            with_face("-3 0 1 2\n"),
            "13: a list of -3 items; counts are whole numbers",
        ),
        (
            with_face("4 0 1\n"),
            "13: a list of 4 items ends early, in entry 1 of element `face`; is the file complete?",
        ),
        (
            with_face("3 0 1 x\n"),
            "13: `x` is not a number; write plain numbers",
        ),
        (
            with_face("3 0 0 0\n"),
            "13: nothing to draw: none of 1 face has an area; check the scale and the export of the model",
        ),
        (
            with_face("\n\n"),
            "14: the file ends before the end of entry 1 of element `face`; is the file complete?",
        ),
        (
            ply("x y z", "0 0 0\n1 nan 0\n0 1 0\n", FACE_LIST, "3 0 1 2\n"),
            "11: the coordinate NaN is not a finite number; remove the vertex, or repair the scan",
        ),
        (
            ply("x y z", "0 0 0\n1 0 1e39\n0 1 0\n", FACE_LIST, "3 0 1 2\n"),
            "11: the coordinate 1e39 is beyond the range of 32-bit floats; remove the vertex, or repair the scan",
        ),
        (
            ply("x y z", "0 0 0\n1 0\n0 1 0\n", FACE_LIST, "3 0 1 2\n"),
            "11: the line ends within entry 2 of element `vertex`; write every entry on one line of its own",
        ),
        (
            ply("x y", "0 0\n", FACE_LIST, "3 0 0 0\n"),
            "3: the vertices lack a coordinate; declare scalar properties x, y and z",
        ),
        (
            ply(
                "x y z",
                THREE,
                "element face 1\nproperty int vertex_indices\n",
                "3\n",
            ),
            "7: element `face` has no list of vertex indices; declare `property list uchar int vertex_indices`",
        ),
        (
            ply("x y z", "", FACE_LIST, "3 0 1 2\n"),
            "3: nothing to draw: no vertices; is the file complete?",
        ),
    ];
    for (text, expected) in cases {
        assert_fails("a.ply", text, &format!("a.ply:{expected}"));
    }
}

#[test]
fn bad_binary_ply_bytes_are_named() {
    let whole = cube_ply("binary_little_endian", &cube_binary(false));
    let body = whole.len() - cube_binary(false).len();
    let vertex = 23;
    let faces = body + 8 * vertex + 4;
    let changed = |at: usize, bytes: &[u8]| {
        let mut changed = whole.clone();
        changed[at..at + bytes.len()].copy_from_slice(bytes);
        changed
    };
    let at = body + 2 * vertex + 14;
    assert_fails_at(
        "a.ply",
        changed(at, &f32::NAN.to_le_bytes()),
        &format!("a.ply:byte {at}: the coordinate NaN is"),
    );
    let at = faces + 5 + 4;
    assert_fails_at(
        "a.ply",
        changed(at, &8i32.to_le_bytes()),
        &format!("a.ply:byte {at}: vertex index 8 where"),
    );
    assert_fails_at(
        "a.ply",
        changed(at, &(-1i32).to_le_bytes()),
        &format!("a.ply:byte {at}: vertex index -1 where"),
    );
    let at = faces + 4;
    assert_fails_at(
        "a.ply",
        changed(at, &[0xff]),
        &format!("a.ply:byte {at}: a list of -1 items;"),
    );
    assert_fails_at(
        "a.ply",
        changed(at, &[1]),
        &format!("a.ply:byte {at}: a face of 1 corner;"),
    );
    // The last list's count stays, two of its indices go.
    let at = whole.len() - 17;
    assert_fails_at(
        "a.ply",
        &whole[..whole.len() - 8],
        &format!("a.ply:byte {at}: a list of 4 items ends early"),
    );
    assert_fails_at(
        "a.ply",
        &whole[..body + 100],
        "a.ply:5: element `vertex` declares 8 entries, 120 bytes or more, but 100",
    );
}

#[test]
fn every_truncation_fails_with_a_place() {
    for (format, cube) in [
        ("ascii", cube_ascii()),
        ("binary_little_endian", cube_binary(false)),
    ] {
        let whole = cube_ply(format, &cube);
        // Without its last line end, or its last digit, ascii is whole.
        for length in 4..whole.len() - 2 {
            let error = read("a.ply", &whole[..length]).unwrap_err();
            let place = error
                .strip_prefix("a.ply:")
                .unwrap_or_else(|| panic!("{length}: {error}"));
            assert!(
                place.starts_with(|c: char| c.is_ascii_digit()) || place.starts_with("byte "),
                "{error}"
            );
        }
    }
}

#[test]
fn absurd_counts_fail_at_once() {
    for format in ["ascii", "binary_little_endian"] {
        for count in ["4000000000", "18446744073709551615"] {
            for (element, property) in [
                ("vertex", "float"),
                ("face", "list uchar int"),
                ("other", "double"),
            ] {
                let vertex =
                    "element vertex 1\nproperty char x\nproperty char y\nproperty char z\n";
                let vertex = if element == "vertex" {
                    &format!(
                        "element vertex {count}\nproperty float x\nproperty float y\nproperty float z\n"
                    )
                } else {
                    vertex
                };
                let other =
                    format!("element {element} {count}\nproperty {property} vertex_index\n");
                let other = if element == "vertex" { "" } else { &other };
                let text =
                    format!("ply\nformat {format} 1.0\n{vertex}{other}end_header\n0 0 0\n0 0 0\n");
                let error = read("a.ply", text).unwrap_err();
                let line = if element == "vertex" { 3 } else { 7 };
                assert!(error.starts_with(&format!("a.ply:{line}: ")), "{error}");
            }
        }
    }
    // No bytes at all, however many.
    let nothing = format!("element nothing 18446744073709551615\n{FACE_LIST}");
    assert!(read("a.ply", ply("x y z", THREE, &nothing, "3 0 1 2\n")).is_ok());
    let list = cube_ply("ascii", b"0 65535 1\n");
    assert!(read("a.ply", list).is_err());
}

#[test]
fn surplus_and_trailing_data_are_noted() {
    let vertices = format!("9 9 9\n{THREE}");
    let text = ply("x y z", &vertices, FACE_LIST, "3 1 2 3 255 0 0\n \n1 2\n");
    let imported = read("a.ply", text).unwrap();
    assert_eq!(
        imported.notes,
        [
            "line 14 holds more values than the header declares",
            "3 bytes behind the last element not used",
            "1 vertex without a face not used"
        ],
    );
    assert_eq!(
        imported.geometry.bounds().unwrap().max,
        DVec3::new(1.0, 1.0, 0.0)
    );
}

#[test]
fn concave_polygons_of_ply_are_cut_along_their_inside() {
    let text = ply(
        "x y z",
        "0 0 0\n2 0 1\n0 0 2\n1 0 1\n",
        FACE_LIST,
        "4 0 1 2 3\n",
    );
    assert_eq!(area(&mesh(read("a.ply", text).unwrap())), 1.0);
}
