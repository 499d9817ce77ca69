//! Which reader a file gets.

use rhogrid::import::load;

use super::{CUBE, assert_fails, assert_fails_at, cube_ascii, cube_ply, mesh, read};

#[test]
fn content_counts_before_the_extension() {
    let ply = cube_ply("ascii", &cube_ascii());
    for name in ["cube.ply", "cube.PLY", "cube.obj", "cube"] {
        assert_eq!(mesh(read(name, &ply).unwrap()).triangles.len(), 12);
    }
    assert_eq!(mesh(read("cube.OBJ", CUBE).unwrap()).triangles.len(), 12);
    let readable = "Wavefront OBJ (.obj) and PLY (.ply, ascii or binary) can be read";
    assert_fails(
        "cube.stl",
        CUBE,
        &format!("cube.stl: is of an unknown kind; {readable}"),
    );
    assert_fails_at("cube.ply", CUBE, "cube.ply:1: the first line is not `ply`;");
}

#[test]
fn files_that_cannot_be_read_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let gone = folder.path().join("gone.obj");
    for path in [gone.as_path(), folder.path()] {
        let error = load(path).unwrap_err().to_string();
        assert!(
            error.starts_with(&format!("{}: cannot be read: ", path.display())),
            "{error}"
        );
    }
}
