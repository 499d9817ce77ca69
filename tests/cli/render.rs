//! `rhogrid render`.

use serde_json::Value;

use super::{Folder, assert_keys, png};

const SMALL: &str = "--level 2 --size 48x64";

fn hash(folder: &Folder, line: &str) -> String {
    let value = folder.json(line);
    let hash = value["frame_hash"].as_str().unwrap().to_owned();
    assert_eq!(hash.len(), 8);
    assert!(
        hash.chars()
            .all(|digit| matches!(digit, '0'..='9' | 'a'..='f'))
    );
    hash
}

#[test]
fn json_has_the_stable_keys() {
    let folder = Folder::new();
    let report = folder.json(&format!("render cube.obj -o a.png {SMALL}"));
    let keys = [
        "frame_hash",
        "nodes_visited",
        "samples_drawn",
        "pixels_written",
        "time_ns",
    ];
    assert_keys(&report, &keys);
    for key in &keys[1..] {
        assert!(report[key].as_u64().unwrap() > 0, "{key}: {report}");
    }
    assert!(report.get("psnr").is_none());
    let report = folder.json(&format!("render cube.obj -o a.png {SMALL} --compare"));
    assert_keys(&report, &keys);
    let measures = [
        "psnr_inside",
        "psnr",
        "ssim",
        "rmse",
        "max_error",
        "holes",
        "see_through",
    ];
    assert_keys(&report, &measures);
    assert_eq!(
        (&report["holes"], &report["see_through"]),
        (&Value::from(0), &Value::from(0))
    );
    assert!(report["psnr_inside"].as_f64().unwrap() > 20.0, "{report}");
}

#[test]
fn assets_draw_like_their_meshes() {
    let folder = Folder::new();
    for options in [
        "--rho 2 --level 4",
        "--rho 3 --level 2",
        "--rho 4 --level 1 --two-sided",
        "--rho 5 --level 1 --up z",
        "--rho 3 --level 0 --up x",
    ] {
        folder.done(&format!("bake cube.obj -o a.rho {options}"));
        for view in [
            "--yaw 40",
            "--yaw -77.5 --pitch -90 --distance 1",
            "--eye 5,6,7 --splat 3",
        ] {
            let view = format!("{view} --size 48x64");
            let mesh = hash(
                &folder,
                &format!("render cube.obj -o m.png {options} {view}"),
            );
            assert_eq!(
                hash(&folder, &format!("render a.rho -o a.png {view}")),
                mesh,
                "{options} {view}"
            );
            let read = |name| std::fs::read(folder.path(name)).unwrap();
            assert!(read("a.png") == read("m.png"), "{options} {view}");
        }
    }
}

#[test]
fn the_hash_is_that_of_the_written_pixels() {
    let folder = Folder::new();
    let told = hash(&folder, &format!("render cube.obj -o a.png {SMALL}"));
    let frame: Vec<u16> = png(&folder.path("a.png"))
        .rgb
        .iter()
        .map(|&[red, green, blue]| {
            u16::from(red >> 3) << 11 | u16::from(green >> 2) << 5 | u16::from(blue >> 3)
        })
        .collect();
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let bytes: Vec<u8> = frame.iter().flat_map(|pixel| pixel.to_le_bytes()).collect();
    assert_eq!(format!("{:08x}", crc.checksum(&bytes)), told);
}

#[test]
fn undrawn_pixels_are_transparent() {
    let folder = Folder::new();
    for more in ["", "--reference"] {
        folder.done(&format!(
            "render cube.obj -o a.png {SMALL} --distance 9 {more}"
        ));
        let file = image::open(folder.path("a.png")).unwrap().into_rgba8();
        assert_eq!(file.dimensions(), (48, 64));
        assert_eq!(file.get_pixel(0, 0).0, [0; 4]);
        assert_eq!(file.get_pixel(24, 32).0[3], 255);
        let drawn = file.pixels().filter(|pixel| pixel.0[3] == 255).count();
        let undrawn = file.pixels().filter(|pixel| pixel.0 == [0; 4]).count();
        assert_eq!(drawn + undrawn, 48 * 64, "{more}");
        assert!(drawn > 20 && undrawn > 2000, "{more}: {drawn} drawn");
    }
}

#[test]
fn an_orbit_is_numbered_pictures() {
    let folder = Folder::new();
    let text = folder.done(&format!(
        "render cube.obj -o turn.png {SMALL} --orbit 4 --yaw 10 --json"
    ));
    let reports: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(reports.len(), 4);
    let names = [
        "cube.obj",
        "turn-000.png",
        "turn-001.png",
        "turn-002.png",
        "turn-003.png",
    ];
    assert_eq!(folder.names(), names);
    for (index, report) in reports.iter().enumerate() {
        assert_eq!(report["output"], names[index + 1]);
        let line = format!(
            "render cube.obj -o one.png {SMALL} --yaw {}",
            10 + 90 * index
        );
        assert_eq!(hash(&folder, &line), report["frame_hash"].as_str().unwrap());
    }
    folder.done(&format!(
        "render cube.obj -o ref {SMALL} --orbit 2 --reference"
    ));
    assert!(folder.names().contains(&"ref-001.png".to_owned()));
}

#[test]
fn an_eye_looks_as_the_angles_do() {
    let folder = Folder::new();
    // The cube's centre and radius.
    let (centre, radius) = ([2.0, 3.5, 3.5], (1.0f64 + 1.5 * 1.5 + 0.25).sqrt());
    for (yaw, pitch, distance) in [
        (0.0f64, 15.0f64, 2.6),
        (37.0, -20.0, 1.8),
        (-100.0, 60.0, 9.0),
    ] {
        let (sin_yaw, cos_yaw) = yaw.to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = pitch.to_radians().sin_cos();
        let back = [sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch];
        let eye = [0, 1, 2].map(|axis| centre[axis] + distance * radius * back[axis]);
        let options = "--level 3 --size 120x160";
        let angles = format!("--yaw {yaw} --pitch {pitch} --distance {distance}");
        folder.done(&format!("render cube.obj -o a.png {options} {angles}"));
        let eye = format!("--eye {},{},{}", eye[0], eye[1], eye[2]);
        for at in ["", "--look-at 2,3.5,3.5"] {
            folder.done(&format!("render cube.obj -o b.png {options} {eye} {at}"));
            let apart = folder.json("compare a.png b.png")["differing_pixels"]
                .as_u64()
                .unwrap();
            assert!(apart <= 8, "{angles}: {apart} pixels differ");
        }
        folder.done(&format!(
            "render cube.obj -o a.png --reference {options} {angles}"
        ));
        folder.done(&format!(
            "render cube.obj -o b.png --reference {options} {eye}"
        ));
        let apart = folder.json("compare a.png b.png")["differing_pixels"]
            .as_u64()
            .unwrap();
        assert!(
            apart <= 8,
            "{angles}: {apart} pixels of the reference differ"
        );
    }
}

/// The paths are the ends of the bound, and one pixel is what it is by
/// default.
#[test]
fn distortion_chooses_between_the_paths() {
    let folder = Folder::new();
    let drawn = |knobs: &str| {
        hash(
            &folder,
            &format!("render cube.obj -o a.png {SMALL} {knobs}"),
        )
    };
    let [exact, affine, default] = ["--path exact", "--path affine", ""].map(drawn);
    assert_eq!(drawn("--distortion 0"), exact);
    assert_eq!(drawn("--distortion 4096"), affine);
    assert_eq!(drawn("--distortion 1"), default);
    assert_ne!(exact, affine);
}

/// No eye is special: on the surface, at the centre, far off, along y.
#[test]
fn extreme_views_are_drawn() {
    let folder = Folder::new();
    for view in [
        "--distance 0",
        "--distance 0.3",
        "--distance 100000000",
        "--pitch 90",
        "--pitch -90",
        "--yaw 1e300 --pitch 1e10",
        "--eye 2,3.5,4",
        "--eye 2,3.5,4 --look-at 2,3.5,4",
        "--eye 2,9,3.5",
        "--eye 1e30,0,0",
        "--eye 1,2,3",
        "--fov 0.1",
        "--fov 179.5",
        "--splat 0",
        "--splat 4096",
        "--distortion 4096",
        "--light 0,-1,0",
        "--light 1e-200,0,0 --light 1,0,0",
        "--size 1x1",
        "--size 4096x1",
        "--size 1x4096",
    ] {
        let run = folder.run(&format!(
            "render cube.obj -o a.png --level 2 --frames 1 {view}"
        ));
        // Repeating an option is wrong usage; every other line draws.
        let expected = if view.matches("--light").count() > 1 {
            2
        } else {
            0
        };
        assert_eq!(run.code, expected, "{view}: {}", run.stderr);
    }
}

#[test]
fn verbose_text_says_more() {
    let folder = Folder::new();
    let text = folder.done(&format!("render cube.obj -o a.png {SMALL} --compare -v"));
    let plan = [
        "draws cells of depth",
        "part     columns",
        "sides",
        "facing",
        "hidden",
        "few pixels",
        "stops from",
    ];
    let work = [
        "a.png",
        "48x64",
        "nodes",
        "facing tests",
        "side tests",
        "holes",
    ];
    for part in plan.into_iter().chain(work) {
        assert!(text.contains(part), "no {part} in {text}");
    }
}
