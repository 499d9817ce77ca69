//! Materials of OBJ files.

use std::fs;

use rhogrid::geometry::Material;
use rhogrid::import::{Imported, MAX_MATERIALS, load};
use tempfile::TempDir;

use super::{TRIANGLE, mesh};

/// Loads `main` from a folder of files.
fn load_folder(files: &[(&str, &str)], main: &str) -> (Result<Imported, String>, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    (
        load(&folder.path().join(main)).map_err(|error| error.to_string()),
        folder,
    )
}

#[test]
fn diffuse_colours_become_materials() {
    let obj = format!(
        "mtllib sub\\my colours.mtl\nmtllib b.mtl c.mtl\n{TRIANGLE}usemtl red one\nf 1 2 3\n\
         usemtl half\nf 1 2 3\nusemtl missing\nf 1 2 3\nusemtl bright\nf 1 2 3\nf 1 2 3\n"
    );
    let files = [
        ("a.obj", obj.as_str()),
        (
            "sub/my colours.mtl",
            "newmtl red one\r\nKd 1 0 0\r\nmap_Kd x.png\r\nnewmtl unused\nKd 0 0 1\n",
        ),
        ("b.mtl", "newmtl half\nKa 1\nKd 0.5 0.5\\\n 0.25 # c\n"),
        ("c.mtl", "newmtl bright\nKd 20 -1 0\n"),
    ];
    let imported = load_folder(&files, "a.obj").0.unwrap();
    assert_eq!(
        imported.notes,
        [
            "1 texture of my colours.mtl not used",
            "1 material not defined, the first `missing` on line 10: white"
        ],
    );
    let mesh = mesh(imported);
    let materials: Vec<_> = mesh
        .materials
        .iter()
        .map(|m| (m.name.as_str(), m.diffuse))
        .collect();
    assert_eq!(
        materials,
        [
            ("red one", [255, 0, 0]),
            ("half", [128, 128, 64]),
            ("", [255; 3])
        ]
    );
    let of_triangles: Vec<u8> = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.material)
        .collect();
    assert_eq!(of_triangles, [0, 1, 2, 0, 0]);
}

#[test]
fn a_missing_material_file_is_a_note() {
    let obj = format!("mtllib gone.mtl\n{TRIANGLE}f 1 2 3\n");
    let imported = load_folder(&[("a.obj", &obj)], "a.obj").0.unwrap();
    assert_eq!(
        imported.notes,
        ["line 1: material file `gone.mtl` not found: white"]
    );
    assert_eq!(mesh(imported).materials, [Material::white()]);
}

#[test]
fn a_bad_colour_names_its_file_and_line() {
    let obj = format!("mtllib m.mtl\n{TRIANGLE}f 1 2 3\n");
    let (result, folder) = load_folder(
        &[("a.obj", &obj), ("m.mtl", "newmtl a\nKd 1 nan 1\n")],
        "a.obj",
    );
    let file = folder.path().join("m.mtl");
    let expected = format!(
        "{}:2: `nan` is not a finite number; write a colour as Kd and three numbers from 0 to 1",
        file.display()
    );
    assert_eq!(result.unwrap_err(), expected);
}

#[test]
fn more_than_eight_colours_are_reduced() {
    let (mut mtl, mut obj) = (String::new(), format!("mtllib m.mtl\n{TRIANGLE}"));
    for i in 0..10 {
        mtl += &format!("newmtl m{i}\nKd {} 0 0\n", f64::from(i) / 10.0);
        obj += &format!(
            "usemtl m{i}\n{}",
            "f 1 2 3\n".repeat(if i == 5 || i == 8 { 1 } else { 2 })
        );
    }
    let imported = load_folder(&[("a.obj", &obj), ("m.mtl", &mtl)], "a.obj")
        .0
        .unwrap();
    assert_eq!(
        imported.notes,
        ["more than 8 colours: 2 colours replaced by the nearest of the 8 most used"]
    );
    let mesh = mesh(imported);
    assert_eq!(mesh.materials.len(), MAX_MATERIALS);
    assert!(
        mesh.materials
            .iter()
            .all(|material| !["m5", "m8"].contains(&material.name.as_str()))
    );
}
