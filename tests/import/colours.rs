//! Colours of vertices.

use super::{FACE_LIST, assert_fails, cloud, mesh, obj_mesh, read};

const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 255, 0];
const HALF: [u8; 3] = [128, 128, 128];

/// Three vertices with colours of a type, and what stands for full and half.
fn coloured(kind: &str, full: &str, half: &str, faces: &str) -> String {
    let properties = |kind: &str, names: &str| -> String {
        let names = names.split(' ');
        names
            .map(|name| format!("property {kind} {name}\n"))
            .collect()
    };
    let (places, channels) = (
        properties("float", "x y z"),
        properties(kind, "red green blue"),
    );
    format!(
        "ply\nformat ascii 1.0\nelement vertex 3\n{places}{channels}{faces}end_header\n\
        0 0 0 {full} 0 0\n1 0 0 0 {full} 0\n0 1 0 {half} {half} {half}\n"
    )
}

#[test]
fn ply_colours_are_shares_of_what_is_full() {
    for (kind, full, half) in [
        ("uchar", "255", "128"),
        ("ushort", "65535", "32896"),
        ("float", "1.0", "0.502"),
        ("double", "7", "0.502"),
        ("char", "127", "64"),
    ] {
        let points = cloud(read("a.ply", coloured(kind, full, half, "")).unwrap());
        let [red, green, grey] = points.colours[..] else {
            panic!("three colours");
        };
        assert_eq!((red, green), (RED, GREEN), "{kind}");
        assert!(
            grey.into_iter().all(|channel| channel.abs_diff(128) <= 1),
            "{kind}"
        );
    }
    let text = coloured("uchar", "255", "128", FACE_LIST) + "3 0 1 2\n";
    let imported = read("a.ply", text).unwrap();
    assert!(imported.notes.is_empty(), "{:?}", imported.notes);
    assert_eq!(mesh(imported).colours, [[RED, GREEN, HALF]]);
}

#[test]
fn ply_colours_must_be_numbers() {
    assert_fails(
        "a.ply",
        coloured("float", "nan", "0.5", ""),
        "a.ply:11: the colour NaN is not a finite number; \
            remove the colours, or export the model again",
    );
    // Two channels are no colour.
    let text = coloured("uchar", "255", "128", "").replace("uchar blue", "uchar alpha");
    assert!(cloud(read("a.ply", text).unwrap()).colours.is_empty());
}

/// Corners keep colours of their own where vertices at one place differ.
#[test]
fn seams_stay() {
    let text = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n\
        property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
        element face 2\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n\
        1 0 0 0 255 0\n1 1 0 0 255 0\n0 1 0 0 255 0\n3 0 1 2\n3 3 4 5\n";
    let mesh = mesh(read("a.ply", text).unwrap());
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(mesh.colours, [[RED; 3], [GREEN; 3]]);
}

#[test]
fn obj_colours_are_of_one_or_of_255() {
    let faces = "f 1 2 3\nf 3 2 1\n";
    for vertices in [
        "v 0 0 0 1 0 0\nv 1 0 0 0 1 0 1\nv 0 1 0 .5 .5 .5\n",
        "v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 128 128 128\n",
    ] {
        let mesh = obj_mesh(format!("{vertices}{faces}"));
        let colours = [[RED, GREEN, HALF], [HALF, GREEN, RED]];
        assert_eq!(mesh.colours, colours, "{vertices}");
        let points = cloud(read("a.obj", vertices).unwrap());
        assert_eq!(points.colours, [RED, GREEN, HALF]);
    }
}

#[test]
fn some_colours_of_an_obj_are_none() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 .5 .5 .5\nf 1 2 3\n";
    let imported = read("a.obj", text).unwrap();
    assert_eq!(
        imported.notes,
        ["vertex colours not used: 1 vertex without"]
    );
    assert!(mesh(imported).colours.is_empty());
}
