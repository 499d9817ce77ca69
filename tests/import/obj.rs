//! OBJ: each gap of the parser behind, and each error with its line.

use glam::{DVec3, Vec3};

use super::{
    CUBE, TRIANGLE, area, assert_fails, assert_fails_at, cloud, mesh, normals, obj_mesh, read,
};

#[test]
fn a_shared_cube_is_flat() {
    let cube = obj_mesh(CUBE);
    assert_eq!(
        (
            cube.positions.len(),
            cube.triangles.len(),
            cube.normals.len()
        ),
        (8, 12, 24)
    );
    assert_eq!(area(&cube), 6.0);
    for (i, triangle) in cube.triangles.iter().enumerate() {
        let [a, b, c] = triangle.positions.map(|i| cube.positions[i as usize]);
        let face = (b - a).cross(c - a).normalize().as_vec3();
        assert_eq!(normals(&cube, i), [face; 3]);
    }
}

#[test]
fn a_fine_sphere_is_smooth() {
    // Rings of 64 quads; the poles are fans.
    let mut text = "v 0 0 1\nv 0 0 -1\n".to_owned();
    let (rings, sides) = (31, 64);
    for ring in 1..=rings {
        let (sine, cosine) = (f64::from(ring) / 32.0 * std::f64::consts::PI).sin_cos();
        for side in 0..sides {
            let (y, x) = (f64::from(side) / 32.0 * std::f64::consts::PI).sin_cos();
            text += &format!("v {} {} {cosine}\n", x * sine, y * sine);
        }
    }
    for side in 0..sides {
        let at = |ring: i32, side: i32| 3 + ring * sides + side % sides;
        text += &format!("f 1 {} {}\n", at(0, side), at(0, side + 1));
        text += &format!("f 2 {} {}\n", at(30, side + 1), at(30, side));
        for ring in 0..30 {
            let [a, b] = [side, side + 1];
            text += &format!(
                "f {} {} {} {}\n",
                at(ring, a),
                at(ring + 1, a),
                at(ring + 1, b),
                at(ring, b)
            );
        }
    }
    let sphere = obj_mesh(text);
    assert_eq!(sphere.normals.len(), sphere.positions.len());
    for triangle in &sphere.triangles {
        for (position, normal) in triangle.positions.iter().zip(triangle.normals) {
            let out = sphere.positions[*position as usize].as_vec3();
            assert!(sphere.normals[normal as usize].dot(out) > 0.999);
        }
    }
}

#[test]
fn concave_polygons_are_cut_along_their_inside() {
    let arrow = obj_mesh("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n");
    assert_eq!((arrow.triangles.len(), area(&arrow)), (2, 1.0));
}

#[test]
fn line_ends_continuations_comments_and_odd_bytes_are_read() {
    let text = b"\xef\xbb\xbf# caf\xe9\r\no n\xe9\r\nv\t0 0 0 \r\nv 1 \\\r\n 0 0 # right\r\n\r\n  v 0 1 0\r\nf 1 2 \\\r\n3\r\n";
    assert_eq!(area(&obj_mesh(text)), 0.5);
    let mac = text
        .iter()
        .filter(|&&byte| byte != b'\n')
        .copied()
        .collect::<Vec<u8>>();
    assert_eq!(area(&obj_mesh(mac)), 0.5);
}

#[test]
fn negative_indices_count_back_from_their_line() {
    let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nvn 0 0 1\nf -4//-1 -3//-1 -2//-1\n";
    let mesh = obj_mesh(text);
    assert_eq!(
        (mesh.positions.len(), mesh.triangles.len(), area(&mesh)),
        (3, 2, 1.0)
    );
    assert_fails(
        "a.obj",
        "v 0 0 0\nf -1 -2 -3\nv 1 0 0\nv 0 1 0\n",
        "a.obj:2: vertex index -2 where the file has 1 so far; \
         indices count from 1, or back from the last one with -1",
    );
}

#[test]
fn faces_may_name_later_vertices_and_lack_normals_that_others_have() {
    let mesh = obj_mesh(
        "vn 0 0 -1\nf 1//1 2//1 3//1\nusemtl a\nf 1// 2// 3//\nv 0 0 0\nv 1 0 0\nv 0 1 0\n",
    );
    assert_eq!(normals(&mesh, 0), [Vec3::NEG_Z; 3]);
    assert_eq!(normals(&mesh, 1), [Vec3::Z; 3]);
}

#[test]
fn models_and_groups_join_to_one_mesh() {
    let text = format!("o a\n{TRIANGLE}f 1 2 3\no b\nv 1 1 0\ng c\ns 1\nf 2 4 3\n");
    let mesh = obj_mesh(text);
    assert_eq!(
        (mesh.positions.len(), mesh.triangles.len(), area(&mesh)),
        (4, 2, 1.0)
    );
}

#[test]
fn colours_and_weights_of_vertices_are_read_over() {
    let mesh = obj_mesh("v 0 0 0 .1 .2 .3\nv 2 0 0 2\nv 0 1 0 1 1 1 1\nf 1 2 3\n");
    assert_eq!(area(&mesh), 0.5);
    assert_fails_at(
        "a.obj",
        "v 0 0 0 0\n",
        "a.obj:1: the weight `0` is too small;",
    );
}

#[test]
fn positions_far_from_the_origin_keep_their_digits() {
    let text = "v 1000000000.001 0 0\nv 1000000000.002 0 0\nv 1000000000.001 0.001 0\nf 1 2 3\n";
    let mesh = obj_mesh(text);
    assert_eq!(mesh.positions[1].x, 1000000000.002);
}

#[test]
fn bad_obj_lines_are_named() {
    let cases = [
        (
            "v 0 nan 0",
            "4: `nan` is not a finite number; write plain finite numbers",
        ),
        (
            "v 0 1e39 0",
            "4: `1e39` is beyond the range of 32-bit floats; write plain finite numbers",
        ),
        (
            "v 0 inf 0",
            "4: `inf` is beyond the range of 32-bit floats; write plain finite numbers",
        ),
        (
            "v 0 1,5 0",
            "4: `1,5` is not a number; write plain finite numbers",
        ),
        (
            "v 0 1",
            "4: a vertex of 2 numbers; write 3, or 4 with a weight, or 6 with a colour",
        ),
        ("vn 0 1", "4: a normal of 2 numbers; write 3"),
        (
            "vn 0 1 nan",
            "4: `nan` is not a finite number; write plain finite numbers",
        ),
        (
            "\nf 1 2",
            "5: a face of 2 corners; a face needs 3 or more; write edges as `l`, points as `p`",
        ),
        (
            "f",
            "4: a face of 0 corners; a face needs 3 or more; write edges as `l`, points as `p`",
        ),
        (
            "f 1 2 4",
            "4: vertex index 4 where the file has 3; indices count from 1, or back from the last one with -1",
        ),
        (
            "f 0 1 2",
            "4: vertex index 0; indices count from 1, or back from the last one with -1",
        ),
        (
            "f 1 \\\n2 x",
            "4: vertex index `x` is not an integer of 64 bits; indices count from 1, or back from the last one with -1",
        ),
        (
            "vt 0 0\nf 1/1 2/1 3",
            "5: corners `1/1` and `3` differ in form; write every corner of a face as v, v/vt, v//vn or v/vt/vn",
        ),
        (
            "f /1 2 3",
            "4: corner `/1` names no vertex; write every corner of a face as v, v/vt, v//vn or v/vt/vn",
        ),
        (
            "f 1/1//1 2 3",
            "4: corner `1/1//1` has more than 3 indices; write every corner of a face as v, v/vt, v//vn or v/vt/vn",
        ),
        (
            "vt 0 0\nf 1/2 2/2 3/2",
            "5: texture coordinate index 2 where the file has 1; indices count from 1, or back from the last one with -1",
        ),
        (
            "usemtl",
            "4: `usemtl` without a name; name a material or its file",
        ),
        (
            "f 1 1 1\nf 2 3 3",
            "4: nothing to draw: none of 2 faces has an area; check the scale and the export of the model",
        ),
    ];
    for (line, expected) in cases {
        let expected = format!("a.obj:{expected}");
        assert_fails("a.obj", format!("{TRIANGLE}{line}\n"), &expected);
    }
}

#[test]
fn the_first_bad_line_counts() {
    // Line 4 is only known to be wrong when all vertices are counted.
    assert_fails_at(
        "a.obj",
        format!("{TRIANGLE}f 1 2 9\nv nan 0 0\n"),
        "a.obj:4: vertex index 9",
    );
    assert_fails_at(
        "a.obj",
        format!("{TRIANGLE}v nan 0 0\nf 1 2 9\n"),
        "a.obj:4: `nan`",
    );
}

#[test]
fn files_without_faces_are_not_silently_empty() {
    assert_fails(
        "a.obj",
        format!("{TRIANGLE}vn 0 0 1\nl 1 2 3\np 1\n"),
        "a.obj:5: nothing to draw: lines but no faces; \
            export faces, or the vertices alone: a point cloud",
    );
    assert_fails_at(
        "a.obj",
        "v 1 2 3\n",
        "a.obj: nothing to draw: 1 point at one place;",
    );
    assert_fails_at("a.obj", "hello\n", "a.obj: no vertices and no faces;");
    assert_fails_at("a.obj", "", "a.obj: the file is empty;");
}

#[test]
fn vertices_alone_are_a_cloud() {
    let points = "v 0 0 0\nv 2 0 0 2\nv 0 1 0 0.5 0.5 0.5\nv -0 1 0\n";
    let imported = read("a.obj", format!("{points}vn 0 0 1\np 1 2\n")).unwrap();
    assert_eq!(
        imported.notes,
        [
            "vertex colours not used: 3 vertices without",
            "1 statement `p` not used, the first on line 6",
            "1 normal not used: OBJ does not pair them with points; PLY does (nx ny nz)",
            "no normals: estimated, but 100% of the points are on open sheets: \
                drawn from both sides",
        ]
    );
    let cloud = cloud(imported);
    let positions = cloud.points.iter().map(|point| point.position);
    let expected = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Y];
    assert_eq!(positions.collect::<Vec<_>>(), expected);
    assert!(cloud.points.iter().all(|point| point.normal.z.abs() == 1.0));
}

#[test]
fn lines_and_unknown_statements_are_noted() {
    let imported = read(
        "a.obj",
        format!("{TRIANGLE}l 1 2 3\nf 1 2 3\nl 2 3\ncurv 1\n"),
    )
    .unwrap();
    assert_eq!(
        imported.notes,
        [
            "1 statement `curv` not used, the first on line 7",
            "2 statements `l` not used, the first on line 4"
        ],
    );
    assert_eq!(mesh(imported).triangles.len(), 1);
}

#[test]
fn indices_into_lists_that_are_missing_are_noted() {
    let imported = read("a.obj", format!("{TRIANGLE}f 1/1/7 2/2/8 3/3/9\n")).unwrap();
    assert_eq!(
        imported.notes,
        [
            "line 4: a face names texture coordinates, but the file has none",
            "line 4: a face names normals, but the file has none",
        ],
    );
    assert_eq!(normals(&mesh(imported), 0), [Vec3::Z; 3]);
}

#[test]
fn polygons_without_area_are_dropped_with_a_note() {
    let imported = read(
        "a.obj",
        format!("{TRIANGLE}f 1 2 3\nf 1 2 1 2\nf 1 1 1 2\n"),
    )
    .unwrap();
    assert_eq!(
        imported.notes,
        ["2 polygons without area dropped, the first at line 5"]
    );
    assert_eq!(mesh(imported).triangles.len(), 1);
}

#[test]
fn degenerate_triangles_stay_and_leave_normals_alone() {
    let mesh = obj_mesh(format!("{TRIANGLE}v 0.5 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n"));
    assert_eq!(mesh.triangles.len(), 3);
    // No face with an area gives the fourth vertex a direction.
    let expected = [[Vec3::Z; 3], [Vec3::Z, Vec3::Z, Vec3::Y], [Vec3::Z; 3]];
    assert_eq!([0, 1, 2].map(|i| normals(&mesh, i)), expected);
}

#[test]
fn zero_normals_become_implied_and_others_unit() {
    let text = format!("{TRIANGLE}vn 0 0 0\nvn 0 3 4\nvn 0 0 -1e-30\nf 1//1 2//2 3//3\n");
    let imported = read("a.obj", text).unwrap();
    assert_eq!(
        imported.notes,
        ["1 corner with a zero normal: implied by the faces"]
    );
    assert_eq!(
        normals(&mesh(imported), 0),
        [Vec3::Z, Vec3::new(0.0, 0.6, 0.8), Vec3::NEG_Z]
    );
}

#[test]
fn coinciding_vertices_share_their_normals() {
    // A ridge of 40 degrees whose sides do not share vertices.
    let text = "v 0 0 0\nv 0 0 1\nv 1 -0.36397 0\nv -0.0 0 0\nv 0 0 1\nv -1 -0.36397 0\n\
        f 1 2 3\nf 5 4 6\n";
    let mesh = obj_mesh(text);
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(normals(&mesh, 0)[0], normals(&mesh, 1)[1]);
    assert!(normals(&mesh, 0)[0].abs_diff_eq(Vec3::Y, 1e-6));
}
