//! `rhogrid bake` and `rhogrid info`.

use rhogrid::asset_file::AssetFile;
use serde_json::{Value, json};

use super::{Folder, assert_keys};

#[test]
fn info_tells_what_bake_told() {
    let folder = Folder::new();
    let told = folder.json("bake cube.obj -o a.rho --rho 2 --level 3 --shell fat");
    let info = folder.json("info a.rho");
    assert_eq!(told, info);
    assert_eq!(info["shell"], "fat");
    assert_eq!(info["drawn_cells_per_depth"], info["cells_per_depth"]);
    let keys = [
        "kind",
        "rho",
        "level",
        "cells_per_depth",
        "alpha",
        "bytes_total",
        "bits_per_leaf_sample",
    ];
    assert_keys(&info, &keys);
    assert_eq!(info["kind"], "grid");
    assert_eq!(info["rho"], 2);
    assert_eq!(info["level"], 3);
    assert_eq!(info["two_sided"], false);
    let bytes = std::fs::read(folder.path("a.rho")).unwrap();
    assert_eq!(info["bytes_total"], bytes.len());
    let cells: Vec<u64> = serde_json::from_value(info["cells_per_depth"].clone()).unwrap();
    assert_eq!(cells.len(), 5);
    assert_eq!(cells[0], 1);
    let all: u64 = cells.iter().sum();
    let intermediate = all - cells[4];
    let alpha = info["alpha"].as_f64().unwrap();
    assert!((alpha - (all - 1) as f64 / intermediate as f64).abs() < 1e-12);
    let bits = info["bits_per_leaf_sample"].as_f64().unwrap();
    assert!((bits - 8.0 * bytes.len() as f64 / cells[4] as f64).abs() < 1e-9);
    // The box of the cube's vertices: centre, half of the longest side.
    assert_eq!(info["centre"], json!([2.0, 3.5, 3.5]));
    assert_eq!(info["half_side"], 1.5);
    let radius = (1.0f64 + 1.5 * 1.5 + 0.25).sqrt();
    assert!((info["radius"].as_f64().unwrap() - radius).abs() < 1e-6);
    assert!(AssetFile::new(&bytes).is_ok());
}

#[test]
fn thin_is_the_default_and_counted_in_full() {
    let folder = Folder::new();
    let info = folder.json("bake builtin:demo -o a.rho --level 2");
    folder.done("bake builtin:demo -o thin.rho --level 2 --shell thin");
    let fat = folder.json("bake builtin:demo -o fat.rho --level 2 --shell fat");
    let bytes = std::fs::read(folder.path("a.rho")).unwrap();
    assert!(bytes == std::fs::read(folder.path("thin.rho")).unwrap());
    assert_eq!(
        (&info["shell"], &fat["shell"]),
        (&json!("thin"), &json!("fat"))
    );
    let numbers =
        |of: &Value, key: &str| -> Vec<u64> { serde_json::from_value(of[key].clone()).unwrap() };
    let cells = numbers(&info, "cells_per_depth");
    let drawn = numbers(&info, "drawn_cells_per_depth");
    let all = numbers(&fat, "cells_per_depth");
    assert!(
        drawn[1..]
            .iter()
            .zip(&all[1..])
            .all(|(drawn, all)| drawn < all)
    );
    assert_eq!((drawn[0], drawn[3]), (1, cells[3]));
    assert!(
        drawn
            .iter()
            .zip(&cells)
            .all(|(drawn, cells)| drawn <= cells)
    );
    let bits = info["bits_per_leaf_sample"].as_f64().unwrap();
    assert!((bits - 8.0 * bytes.len() as f64 / drawn[3] as f64).abs() < 1e-9);
    // Links, masks, drawn masks of depths 1 and 2, attributes.
    let parts = |of: &Value| -> [u64; 5] {
        ["links", "masks", "drawn_masks", "attributes", "rest"]
            .map(|part| of["bytes"][part].as_u64().unwrap())
    };
    let [links, masks, drawn_masks, attributes, rest] = parts(&info);
    assert_eq!(links, 4 * (1 + cells[0] + cells[1]));
    assert_eq!(masks, 4 * (cells[0] + cells[1] + cells[2]));
    assert_eq!(drawn_masks, 4 * (cells[0] + cells[1]));
    assert_eq!(attributes, 2 * cells.iter().sum::<u64>());
    assert_eq!(
        links + masks + drawn_masks + attributes + rest,
        bytes.len() as u64
    );
    assert_eq!(parts(&fat)[2], 0);
    // Where the file is cut, cells that are not drawn are no leaf samples.
    folder.write("cut.rho", &bytes[..level_end(&bytes, 2)]);
    let cut = folder.json("info cut.rho");
    assert_eq!(numbers(&cut, "drawn_cells_per_depth"), drawn[..3]);
    let bits = cut["bits_per_leaf_sample"].as_f64().unwrap();
    assert!((bits - cut["bytes_total"].as_f64().unwrap() * 8.0 / drawn[2] as f64).abs() < 1e-9);
    let text = folder.done("info a.rho");
    assert!(
        text.contains("thin shell") && text.contains("drawn masks"),
        "{text}"
    );
}

/// Corners of a square, each with a colour.
const COLOURED: &str = "v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 1 1 0 0 0 1\nv -1 1 0 1 1 1\n";

#[test]
fn colours_make_attributes_wider() {
    let folder = Folder::new();
    folder.write("square.obj", format!("{COLOURED}f 1 2 3 4\n"));
    let mut sizes = Vec::new();
    for (options, bits) in [
        ("--attributes 16", 16),
        ("", 32),
        ("--attributes 32", 32),
        ("--attributes 48", 48),
    ] {
        let info = folder.json(&format!("bake square.obj -o a.rho --level 2 {options}"));
        assert_eq!(info["attribute_bits"], bits, "{options}");
        assert_eq!(info, folder.json("info a.rho"));
        let cells: Vec<u64> = serde_json::from_value(info["cells_per_depth"].clone()).unwrap();
        let attributes = cells.iter().sum::<u64>() * bits / 8;
        assert_eq!(info["bytes"]["attributes"], attributes);
        sizes.push(info["bytes_total"].as_u64().unwrap());
    }
    assert!(sizes[0] < sizes[1] && sizes[1] == sizes[2] && sizes[2] < sizes[3]);
    let late = folder.run("render a.rho -o a.png --attributes 16");
    assert_eq!(late.code, 2);
    assert!(
        late.stderr.contains("--attributes is for baking"),
        "{}",
        late.stderr
    );
}

#[test]
fn coloured_pictures_are_those_of_the_reference() {
    let folder = Folder::new();
    folder.write("square.obj", format!("{COLOURED}f 1 2 3 4\n"));
    folder.write(
        "scene.toml",
        "[[instance]]\nmodel = \"square.obj\"\n[[instance]]\nmodel = \"square.obj\"\n\
        position = [0.5, 0.0, 1.0]\nscale = 0.5\nmaterials = [[250, 60, 60]]\n",
    );
    let view = "--size 120x120 --pitch 5 --yaw 10 --light 0,0,1 --frames 1 --compare";
    for line in [
        format!("render square.obj -o a.png {view}"),
        format!("render square.obj -o a.png --attributes 48 {view}"),
        format!(
            "render scene.toml -o a.png {}",
            view.replace("--light 0,0,1 ", "")
        ),
    ] {
        let report = folder.json(&line);
        let psnr = report["psnr_inside"].as_f64().unwrap();
        assert!(psnr > 27.0, "{line}: {psnr} dB");
    }
    let grey = folder.json(&format!(
        "render square.obj -o a.png --attributes 16 {view}"
    ));
    assert!(grey["psnr_inside"].as_f64().unwrap() < 15.0);
}

#[test]
fn a_dictionary_of_masks_saves_bytes_and_is_told() {
    let folder = Folder::new();
    let plain = folder.json("bake builtin:demo -o plain.rho --level 4 --masks plain");
    folder.json("bake builtin:demo -o default.rho --level 4");
    let info = folder.json("bake builtin:demo -o a.rho --level 4 --masks dictionary");
    assert_eq!(info, folder.json("info a.rho"));
    let read = |name: &str| std::fs::read(folder.path(name)).unwrap();
    assert!(read("plain.rho") == read("default.rho"));
    assert_eq!(
        (&plain["masks"], &plain["coded"]),
        (&json!("plain"), &Value::Null)
    );
    assert_eq!(plain["bytes"]["dictionary"], 0);
    assert_eq!(plain["bytes"]["escapes"], 0);
    assert_eq!(info["masks"], "dictionary");
    let bytes = read("a.rho");
    assert_eq!(info["bytes_total"], bytes.len());
    assert!(bytes.len() < read("plain.rho").len());
    let number = |of: &Value| of.as_u64().unwrap();
    let coded = &info["coded"];
    assert_eq!(
        number(&info["bytes"]["dictionary"]),
        4 * number(&coded["dictionary"])
    );
    assert_eq!(
        number(&info["bytes"]["escapes"]),
        4 * number(&coded["escapes"])
    );
    assert!(number(&coded["escapes"]) < number(&coded["records"]));
    assert!(coded["levels"].as_array().unwrap().contains(&json!(4)));
    let parts: u64 = info["bytes"]
        .as_object()
        .unwrap()
        .values()
        .map(number)
        .sum();
    assert_eq!(parts, bytes.len() as u64);
    assert_eq!(info["cells_per_depth"], plain["cells_per_depth"]);
    let text = folder.done("info a.rho");
    assert!(text.contains("masks      dictionary of "), "{text}");
    assert!(folder.done("info plain.rho").contains("masks      plain"));
    // The picture is the same.
    folder.done("render a.rho -o a.png");
    folder.done("render plain.rho -o plain.png");
    assert!(read("a.png") == read("plain.png"));
}

#[test]
fn a_dictionary_is_for_tri_grids_and_for_baking() {
    let folder = Folder::new();
    let wrong = folder.run("bake cube.obj -o a.rho --rho 4 --masks dictionary");
    assert_eq!(wrong.code, 2);
    assert!(wrong.stderr.contains("give --rho 3"), "{}", wrong.stderr);
    folder.done("bake cube.obj -o a.rho --level 1");
    let late = folder.run("render a.rho -o a.png --masks dictionary");
    assert_eq!(late.code, 2);
    assert!(
        late.stderr.contains("--masks is for baking"),
        "{}",
        late.stderr
    );
}

/// Where the level of a depth ends; materials stand before the levels.
fn level_end(bytes: &[u8], depth: usize) -> usize {
    let entry = 64 + 16 * (depth + 1);
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    word(entry + 4) + word(entry + 8)
}

#[test]
fn text_for_people_goes_to_stdout() {
    let folder = Folder::new();
    let text = folder.done("bake cube.obj -o a.rho --level 1");
    assert!(
        text.contains("a.rho") && text.contains("rho 3 level 1"),
        "{text}"
    );
    let text = folder.done("info a.rho");
    assert!(
        text.contains("alpha") && text.contains("half side"),
        "{text}"
    );
}

#[test]
fn baking_twice_gives_the_same_bytes() {
    let folder = Folder::new();
    folder.done("bake builtin:demo -o a.rho --level 2");
    folder.done("bake builtin:demo -o b.rho --level 2");
    let read = |name| std::fs::read(folder.path(name)).unwrap();
    assert!(read("a.rho") == read("b.rho"));
}

#[test]
fn up_turns_the_source_and_is_remembered() {
    let folder = Folder::new();
    // (x, y, z) of the z-up file is (x, z, -y) with y up.
    let z_up: String = super::CUBE
        .lines()
        .map(
            |line| match line.split_whitespace().collect::<Vec<_>>()[..] {
                ["v", x, y, z] => format!("v {x} -{z} {y}\n"),
                _ => format!("{line}\n"),
            },
        )
        .collect();
    folder.write("z-up.obj", z_up);
    let (a, b) = (
        folder.json("bake cube.obj -o a.rho --level 2"),
        folder.json("bake z-up.obj -o b.rho --level 2 --up z"),
    );
    assert_eq!((&a["up"], &b["up"]), (&json!("y"), &json!("z")));
    assert_eq!(a["cells_per_depth"], b["cells_per_depth"]);
    assert_eq!(a["centre"], b["centre"]);
    let hash = |line: &str| folder.json(line)["frame_hash"].clone();
    let size = "--level 2 --size 48x48";
    let upright = hash(&format!("render cube.obj -o a.png {size}"));
    assert_eq!(
        hash(&format!("render z-up.obj -o a.png --up z {size}")),
        upright
    );
    assert_eq!(hash("render b.rho -o a.png --size 48x48"), upright);
    assert_ne!(hash(&format!("render z-up.obj -o a.png {size}")), upright);
}

#[test]
fn max_bytes_lowers_the_level() {
    let folder = Folder::new();
    let sizes: Vec<u64> = (0..4)
        .map(|level| {
            let info = folder.json(&format!("bake cube.obj -o a.rho --level {level}"));
            info["bytes_total"].as_u64().unwrap()
        })
        .collect();
    for (level, pair) in sizes.windows(2).enumerate() {
        for limit in [pair[0], pair[1] - 1] {
            let line = format!("bake cube.obj -o b.rho --level 3 --max-bytes {limit}");
            let info = folder.json(&line);
            assert_eq!(info["level"], level);
            assert_eq!(info["bytes_total"], pair[0]);
        }
    }
    let info = folder.json(&format!(
        "bake cube.obj -o b.rho --level 3 --max-bytes {}",
        sizes[3]
    ));
    assert_eq!(info["level"], 3);
}

#[test]
fn a_prefix_is_a_coarser_model() {
    let folder = Folder::new();
    let whole = folder.json("bake cube.obj -o whole.rho --level 2");
    let bytes = std::fs::read(folder.path("whole.rho")).unwrap();
    folder.write("cut.rho", &bytes[..level_end(&bytes, 2)]);
    let cut = folder.json("info cut.rho");
    assert_eq!(
        (&cut["level"], &cut["stored_level"]),
        (&json!(1), &json!(2))
    );
    assert_eq!(
        cut["cells_per_depth"].as_array().unwrap()[..],
        whole["cells_per_depth"].as_array().unwrap()[..3]
    );
    assert!(folder.done("info cut.rho").contains("cut: "));
    folder.done("render cut.rho -o a.png --size 32x32");
}

#[test]
fn two_sided_is_stored_and_obeyed() {
    let folder = Folder::new();
    folder.write(
        "sheet.obj",
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n",
    );
    folder.json("bake sheet.obj -o one.rho --level 2");
    let both = folder.json("bake sheet.obj -o both.rho --level 2 --two-sided");
    assert_eq!(both["two_sided"], true);
    let pixels = |name: &str, yaw: u32| {
        let line = format!("render {name} -o a.png --size 48x48 --yaw {yaw}");
        folder.json(&line)["pixels_written"].as_u64().unwrap()
    };
    assert!(pixels("one.rho", 0) > 100);
    assert_eq!(pixels("one.rho", 180), 0);
    assert!(pixels("both.rho", 0) > 100 && pixels("both.rho", 180) > 100);
}

/// A plate that coarse leaves hold both sides of, but fine ones do not.
#[test]
fn a_prefix_of_a_plate_draws_like_its_coarse_bake() {
    let folder = Folder::new();
    let corner = |index: u32| {
        let side = |bit: u32, half: f64| if index >> bit & 1 == 0 { -half } else { half };
        format!("v {} {} {}\n", side(0, 1.0), side(1, 1.0), side(2, 0.02))
    };
    let corners: String = (0..8).map(corner).collect();
    let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    folder.write("plate.obj", corners + faces);
    for shell in ["fat", "thin"] {
        folder.done(&format!(
            "bake plate.obj -o fine.rho --level 4 --shell {shell}"
        ));
        folder.done(&format!(
            "bake plate.obj -o coarse.rho --level 1 --shell {shell}"
        ));
        let fine = std::fs::read(folder.path("fine.rho")).unwrap();
        folder.write("cut.rho", &fine[..level_end(&fine, 2)]);
        for yaw in [0, 90, 150, 180, 270] {
            let hash = |name: &str| {
                let line = format!("render {name} -o a.png --size 60x80 --yaw {yaw}");
                folder.json(&line)["frame_hash"].clone()
            };
            assert_eq!(hash("cut.rho"), hash("coarse.rho"), "{shell}, yaw {yaw}");
        }
    }
}
