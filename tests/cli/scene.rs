//! Scenes and shadows, from files to pictures.

use rhogrid::picture::Picture;

use super::{Folder, png};

/// A box over a ground, and one light.
const BOXES: &str = r#"
[ground]
size = 3.0
colour = [200, 180, 160]
[[instance]]
model = "cube.obj"
size = 0.8
stand = true
position = [-0.8, 0.5, 0.2]
rotation = [30, 0, 0]
materials = [[250, 60, 60]]
[[instance]]
model = "cube.obj"
size = 0.5
position = [1.0, 0.9, -0.4]
rotation = [10, 40, 20]
[[light]]
towards = [1, 2, 1.5]
"#;

const VIEW: &str = "--distance 1.8 --pitch 30 --frames 1 --size 160x160";

#[test]
fn shadows_are_those_of_traced_rays() {
    let folder = Folder::new();
    folder.write("boxes.toml", BOXES);
    for yaw in [0, 130, 250] {
        let render = |options: &str| {
            folder.json(&format!(
                "render boxes.toml -o out.png {VIEW} --yaw {yaw} --compare {options}"
            ))
        };
        let [one, two] = ["one-pass", "two-pass"].map(|way| render(&format!("--shadows {way}")));
        assert_eq!(one["frame_hash"], two["frame_hash"], "yaw {yaw}");
        assert_eq!(one["shadow_passes"], 0, "yaw {yaw}: the ground comes last");
        assert_eq!(two["shadow_passes"], 1, "yaw {yaw}");
        let errors = one["shadow_errors"].as_f64().expect("a share");
        assert!(errors <= 0.02, "yaw {yaw}: {errors}");
        let off = render("--shadows off");
        assert_ne!(off["frame_hash"], one["frame_hash"], "yaw {yaw}");
        assert!(off["shadow_errors"].is_null());
        for report in [&one, &off] {
            // Hard edges of shadows and of boxes: exact projection has no more.
            let psnr = report["psnr_inside"].as_f64().expect("differs");
            assert!(psnr > 23.0, "yaw {yaw}: {psnr} dB");
        }
    }
}

#[test]
fn what_interpenetrates_takes_two_passes() {
    let folder = Folder::new();
    let text = BOXES.replace("position = [1.0, 0.9, -0.4]", "position = [-0.6, 0.9, 0.2]");
    folder.write("boxes.toml", text);
    let report = folder.json(&format!(
        "render boxes.toml -o out.png {VIEW} --shadows one-pass"
    ));
    assert_eq!(report["shadow_passes"], 1);
}

#[test]
fn a_model_alone_in_a_scene_is_the_model() {
    let folder = Folder::new();
    folder.write(
        "alone.toml",
        "[[instance]]\nmodel = \"cube.obj\"\nlevel = 3\n",
    );
    let options = "-o out.png --level 3 --frames 1 --size 100x100 --yaw 30 --json";
    folder.done(&format!("render cube.obj {options}"));
    let model = png(&folder.path("out.png"));
    let options = options.replace("--level 3 ", "");
    folder.done(&format!("render alone.toml --shadows off {options}"));
    let scene = png(&folder.path("out.png"));
    assert_eq!(model.drawn, scene.drawn);
    let pairs = model.rgb.iter().zip(&scene.rgb);
    let is_step = |(a, b): (&[u8; 3], &[u8; 3])| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 9);
    assert!({ pairs }.all(is_step), "more than a step of 5 bits apart");
}

/// Red, green, blue and white from above and the sides, one with shadows.
#[test]
fn lamps_and_matcaps_are_those_of_the_reference() {
    let folder = Folder::new();
    let lamps = BOXES.to_owned()
        + "colour = [255, 90, 60]\nintensity = 0.5\n[[light]]\ntowards = [-1, 1, 2]\n\
        colour = [60, 255, 90]\nintensity = 0.4\nshadows = false\n\
        [[light]]\ntowards = [0, 0.1, 1]\ncolour = [60, 90, 255]\nshadows = false\n";
    folder.write("lamps.toml", lamps);
    let sphere: Vec<[u8; 3]> = (0..16u8).map(|i| [i * 16, 255 - i * 9, i * 7]).collect();
    let picture = Picture {
        width: 4,
        height: 4,
        drawn: vec![true; sphere.len()],
        rgb: sphere,
    };
    picture.save_png(&folder.path("sphere.png")).unwrap();
    let (without_light, _) = BOXES.split_once("[[light]]").expect("a light");
    let matcap = |more: &str| format!("matcap = \"sphere.png\"\n{more}{without_light}");
    folder.write("matcap.toml", matcap(""));
    folder.write("dim.toml", matcap("ambient = 0.5\n"));
    let psnr = |scene: &str| {
        let report = folder.json(&format!(
            "render {scene} -o a.png {VIEW} --yaw 30 --compare"
        ));
        let psnr = report["psnr_inside"].as_f64().expect("differs");
        assert!(psnr > 23.0, "{scene}: {psnr} dB");
        report
    };
    assert!(
        psnr("lamps.toml")["shadow_errors"]
            .as_f64()
            .expect("one casts")
            <= 0.02
    );
    assert!(psnr("matcap.toml")["shadow_errors"].is_null());
    assert_ne!(
        psnr("matcap.toml")["frame_hash"],
        psnr("dim.toml")["frame_hash"]
    );
}

#[test]
fn matcaps_are_square_pictures() {
    let folder = Folder::new();
    let picture = Picture {
        width: 3,
        height: 2,
        rgb: vec![[1; 3]; 6],
        drawn: vec![true; 6],
    };
    picture.save_png(&folder.path("wide.png")).unwrap();
    folder.write("text.png", "no picture");
    for (name, wanted) in [
        (
            "wide.png",
            "bad.toml:1: a matcap of 3 by 2 pixels; give a square",
        ),
        ("text.png", "text.png: not a picture"),
        ("none.png", "none.png: cannot be read"),
    ] {
        folder.write(
            "bad.toml",
            format!("matcap = \"{name}\"\n[ground]\nsize = 1\n"),
        );
        let run = folder.run("render bad.toml -o a.png");
        assert_eq!(run.code, 1, "{}", run.stderr);
        assert!(run.stderr.contains(wanted), "{name}: {}", run.stderr);
    }
}

#[test]
fn wrong_scenes_are_named() {
    let folder = Folder::new();
    folder.write("empty.obj", "");
    for (text, wanted) in [
        ("", "bad.toml:1: the scene is empty; add an [[instance]]"),
        ("x = 1", "bad.toml:1: unknown field `x`"),
        ("[[instance]]\nmodel = 3", "bad.toml:2: invalid type"),
        ("[[instance]]\n", "bad.toml:1: missing field `model`"),
        (
            "\n[[instance]]\nmodel = \"no.obj\"",
            "bad.toml:2: there is no no.obj",
        ),
        ("[[instance]]\nmodel = \"empty.obj\"", "empty.obj"),
        ("[[instance]]\nmodel = \"builtin:no\"", "builtin:no"),
        (
            "[[instance]]\nmodel = \"cube.obj\"\nscale = 0",
            "bad.toml:1: the scale",
        ),
        (
            "[[instance]]\nmodel = \"cube.obj\"\nscale = nan",
            "bad.toml:1: the scale",
        ),
        (
            "[[instance]]\nmodel = \"cube.obj\"\nscale = 1\nsize = 1",
            "bad.toml:1: scale and size",
        ),
        (
            "[[instance]]\nmodel = \"cube.obj\"\nposition = [inf, 0, 0]",
            "bad.toml:1: the position",
        ),
        (
            "[[instance]]\nmodel = \"cube.obj\"\nrho = 9",
            "bad.toml:1: rho is 9",
        ),
        ("[[instance]]\nmodel = \"cube.obj\"\nlevel = 99", "cube.obj"),
        ("[ground]\nsize = 0", "bad.toml:1: the ground has no size"),
        (
            "[ground]\nsize = 1\n[[light]]\ntowards = [0, 0, 0]",
            "bad.toml:3: the light",
        ),
        (
            "[ground]\nsize = 1\n[[light]]\ntowards = [0, 1, 0]\nintensity = 2",
            "bad.toml:3: intensity",
        ),
        ("ambient = -1\n[ground]\nsize = 1", "bad.toml:1: ambient"),
        ("[[instance]", "bad.toml:1: "),
    ] {
        folder.write("bad.toml", text);
        let run = folder.run("render bad.toml -o a.png");
        assert_eq!(run.code, 1, "{text:?}: {}", run.stderr);
        assert!(run.stderr.contains(wanted), "{text:?}: {}", run.stderr);
        assert!(!folder.path("a.png").exists());
    }
    let light = "[[light]]\ntowards = [0, 1, 0]\n";
    folder.write(
        "bad.toml",
        format!("[ground]\nsize = 1\n{}", light.repeat(4)),
    );
    let run = folder.run("render bad.toml -o a.png");
    assert!(
        run.stderr
            .contains("bad.toml:9: there are more than three lights"),
        "{}",
        run.stderr
    );
}
