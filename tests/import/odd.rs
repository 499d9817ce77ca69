//! Files of other projects, in the folder `odd` of the one that the environment
//! variable `RHOGRID_MODELS` names.

use std::fs;
use std::path::Path;

use rhogrid::geometry::Geometry;
use rhogrid::import::load;

use super::area;

/// What a file must come to.
enum Outcome {
    /// Triangles and their area.
    Mesh(usize, f64),
    /// Points.
    Cloud(usize),
    /// The error after the folder's path begins so.
    Fails(&'static str),
}

/// Areas of planar faces are their shoelace areas; the faces of `suzanne`,
/// the torus, the boxes and `polygonfaces` are not planar, so that their cut
/// decides.
const ODD: [(&str, Outcome); 16] = [
    ("beetle_open.obj", Outcome::Mesh(2053, 0.535129202417)),
    (
        "concave_polygon.mtl",
        Outcome::Fails("concave_polygon.mtl: is of an unknown kind;"),
    ),
    ("concave_polygon.obj", Outcome::Mesh(64, 0.2454966872)),
    (
        "cornell_box.mtl",
        Outcome::Fails("cornell_box.mtl: is of an unknown kind;"),
    ),
    (
        "cube_binary_header_with_RN_newline.ply",
        Outcome::Mesh(12, 6.0),
    ),
    ("cube_with_vertexcolors.obj", Outcome::Mesh(12, 6.0)),
    (
        "malformed.obj",
        Outcome::Fails("malformed.obj:23: vertex index 12 where the file has 8;"),
    ),
    ("points.ply", Outcome::Cloud(4)),
    ("suzanne_quads.obj", Outcome::Mesh(968, 12.468539112387)),
    (
        "tinyobj_catmark_torus_creases0.obj",
        Outcome::Mesh(64, 16.659119519766),
    ),
    (
        "tinyobj_cornell_box.obj",
        Outcome::Mesh(36, 1989605.2080997),
    ),
    (
        "tinyobj_issue-140-zero-face-idx.obj",
        Outcome::Fails("tinyobj_issue-140-zero-face-idx.obj:16: vertex index 0;"),
    ),
    (
        "tinyobj_issue-161-inconsistent-f.obj",
        Outcome::Mesh(12, 6.0),
    ),
    (
        "tinyobj_missing_material_file.obj",
        Outcome::Mesh(36, 1989605.2080997),
    ),
    ("trimesh_negative_indices.obj", Outcome::Mesh(12, 24.0)),
    ("trimesh_polygonfaces.obj", Outcome::Mesh(3, 1162570.384968)),
];

#[test]
fn odd_files_of_other_projects() {
    let Some(models) = std::env::var_os("RHOGRID_MODELS") else {
        println!("RHOGRID_MODELS not set: odd files not run");
        return;
    };
    let folder = Path::new(&models).join("odd");
    for entry in fs::read_dir(&folder).unwrap() {
        let name = entry.unwrap().file_name();
        assert!(
            ODD.iter().any(|(known, _)| *known == name),
            "{name:?} has no expected outcome"
        );
    }
    for (name, expected) in &ODD {
        let path = folder.join(name);
        match (load(&path).map(|imported| imported.geometry), expected) {
            (Ok(Geometry::Mesh(mesh)), Outcome::Mesh(triangles, expected)) => {
                assert_eq!(mesh.triangles.len(), *triangles, "{name}");
                let area = area(&mesh);
                assert!((area - expected).abs() <= 1e-9 * expected, "{name}: {area}");
            }
            (Ok(Geometry::Cloud(cloud)), Outcome::Cloud(points)) => {
                assert_eq!(cloud.points.len(), *points, "{name}");
            }
            (Err(error), Outcome::Fails(start)) => {
                let error = error.to_string();
                let place = error
                    .strip_prefix(folder.join("").to_str().unwrap())
                    .unwrap();
                assert!(place.starts_with(start), "{error}");
            }
            (result, _) => panic!("{name}: {result:?}"),
        }
    }
}
