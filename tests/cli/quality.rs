//! Pictures against the reference, where a mistake would show as wrong light
//! and not as a hash.

use super::Folder;

/// psnr_inside of one view, after checking that nothing is missing.
fn inside(folder: &Folder, options: &str) -> f64 {
    let line = format!("render {options} -o out.png --compare --frames 1");
    let report = folder.json(&line);
    assert_eq!(report["holes"], 0, "{line}");
    assert_eq!(report["see_through"], 0, "{line}");
    report["psnr_inside"].as_f64().unwrap_or(f64::INFINITY)
}

const QUAD: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";

const PLATE: &str = "v -1 -1 .0005\nv 1 -1 .0005\nv 1 1 .0005\nv -1 1 .0005
v -1 -1 -.0005\nv 1 -1 -.0005\nv 1 1 -.0005\nv -1 1 -.0005
f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

#[test]
fn thin_sheets_are_lit_on_the_side_that_is_seen() {
    let folder = Folder::new();
    folder.write("quad.obj", QUAD);
    folder.write("plate.obj", PLATE);
    for yaw in [0, 45, 60, 70, 80, 120, 180, 240, 300] {
        for model in ["quad.obj --two-sided", "plate.obj"] {
            let line = format!("{model} --level 3 --yaw {yaw}");
            let psnr = inside(&folder, &line);
            assert!(psnr > 35.0, "{line}: {psnr} dB");
        }
    }
}

#[test]
fn an_eye_inside_sees_the_walls() {
    let folder = Folder::new();
    // Behind the eye and beside it are most of the cells.
    for distance in ["0.3", "0.1"] {
        let line = format!("cube.obj --two-sided --level 3 --distance {distance} --yaw 40");
        let psnr = inside(&folder, &line);
        assert!(psnr > 25.0, "{line}: {psnr} dB");
    }
}
