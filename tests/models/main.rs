//! Real scans and models, where `RHOGRID_MODELS` names their folder. They are
//! not part of the repository.

mod clouds;

use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

/// The folder of models; says so where there is none.
fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("RHOGRID_MODELS").map(PathBuf::from);
    if folder.is_none() {
        println!("RHOGRID_MODELS not set: models not run");
    }
    folder
}

/// Runs the command on a model and gives its JSON objects.
#[track_caller]
fn run(command: &str, model: &str, options: &str) -> Option<Vec<Value>> {
    let input = folder()?.join(model);
    let work = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_rhogrid"))
        .arg(command)
        .arg(input)
        .args(["-o", "out", "--json"])
        .args(options.split_whitespace())
        .current_dir(work.path())
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{model} {options}: {stderr}");
    let text = String::from_utf8(output.stdout).unwrap();
    let objects = text.lines().map(|line| serde_json::from_str(line).unwrap());
    Some(objects.collect())
}

fn numbers(of: &[Value], key: &str) -> Vec<f64> {
    of.iter()
        .map(|report| report[key].as_f64().unwrap())
        .collect()
}

fn mean(of: &[f64]) -> f64 {
    of.iter().sum::<f64>() / of.len() as f64
}

/// Draws the four standard full views and prints how good they are.
fn full_views(model: &str, options: &str) -> Option<Vec<Value>> {
    let reports = run(
        "render",
        model,
        &format!("--orbit 4 --compare --frames 1 {options}"),
    )?;
    assert_eq!(reports.len(), 4);
    println!(
        "{model} {options}: holes {:?}, see-through {:?}, psnr_inside {:.2} dB",
        numbers(&reports, "holes"),
        numbers(&reports, "see_through"),
        mean(&numbers(&reports, "psnr_inside"))
    );
    Some(reports)
}

#[test]
fn bunny_has_the_cells_of_an_independent_voxelization() {
    // Counts of an independent voxelization over the tight centred cube.
    let expected = [1.0, 22.0, 235.0, 2453.0, 22459.0, 202_421.0, 1_820_696.0];
    let level = 5;
    let Some(reports) = run("bake", "bunny.ply", &format!("--level {level} --shell fat")) else {
        return;
    };
    let cells: Vec<f64> = serde_json::from_value(reports[0]["cells_per_depth"].clone()).unwrap();
    println!("bunny: cells {cells:?}, alpha {}", reports[0]["alpha"]);
    assert_eq!(cells.len(), level + 2);
    for (depth, (cells, expected)) in cells.iter().zip(expected).enumerate() {
        let apart = (cells - expected).abs() / expected;
        assert!(apart <= 0.005, "depth {depth}: {cells}, not {expected}");
    }
    let alpha = reports[0]["alpha"].as_f64().unwrap();
    assert!((8.5..=10.5).contains(&alpha), "alpha {alpha}");
}

/// Everything counted, a dictionary of masks takes two bits of 22.4 off.
#[test]
fn a_dictionary_takes_bits_off_the_bunny() {
    for (options, most) in [("--shell fat", 20.5), ("--shell thin", 23.2)] {
        let options = format!("--level 5 --masks dictionary {options}");
        let Some(reports) = run("bake", "bunny.ply", &options) else {
            return;
        };
        let bits = reports[0]["bits_per_leaf_sample"].as_f64().unwrap();
        println!("bunny {options}: {bits:.2} bits a leaf sample");
        assert!(bits <= most, "{bits}");
    }
}

#[test]
fn bunny_has_no_holes() {
    let Some(reports) = full_views("bunny.ply", "--level 5") else {
        return;
    };
    assert!(numbers(&reports, "holes").iter().all(|&holes| holes == 0.0));
    assert!(
        numbers(&reports, "see_through")
            .iter()
            .all(|&pixels| pixels == 0.0)
    );
    let psnr = mean(&numbers(&reports, "psnr_inside"));
    assert!(psnr >= 26.0, "{psnr} dB");
}

/// Thin, open, self-intersecting: all are drawn. Points leave at most 0.02% of
/// the object's pixels open, also where the leaves are larger than pixels.
#[test]
fn odd_models_are_drawn() {
    for (model, options) in [
        ("buddha_100k.ply", "--level 4 --up z"),
        ("buddha_100k.ply", "--level 4 --up z --shell fat"),
        ("fracttree.ply", "--level 3"),
        ("fracttree.ply", "--level 3 --two-sided"),
        ("cow.ply", "--level 4"),
        ("cow.ply", "--level 4 --shell fat"),
        ("teapot.ply", "--level 3"),
        ("teapot.ply", "--level 3 --two-sided"),
    ] {
        let Some(reports) = full_views(model, options) else {
            return;
        };
        let holes = numbers(&reports, "holes");
        let inside = numbers(&reports, "inside_pixels");
        assert!(
            holes
                .iter()
                .zip(inside)
                .all(|(&holes, inside)| holes <= 2e-4 * inside),
            "{model} {options}: {holes:?}"
        );
        let written = numbers(&reports, "pixels_written");
        assert!(
            written.iter().all(|&pixels| pixels > 1000.0),
            "{model}: {written:?}"
        );
    }
}

/// A cut file of a real model has the cells of a bake of that level, with their
/// materials; normals and cones are those of its finest samples.
#[test]
fn prefixes_of_the_cow_are_coarser_cows() {
    let Some(folder) = folder() else {
        return;
    };
    let imported = rhogrid::import::load(&folder.join("cow.ply")).unwrap();
    let bake = |level: u8| {
        let options = rhogrid::bake::GridOptions {
            level,
            shell: rhogrid_core::asset::Shell::Fat,
            ..Default::default()
        };
        let grid = rhogrid::bake::grid(&imported.geometry, &options, &|_| {}).unwrap();
        rhogrid::bake::writer::to_bytes(&grid).unwrap()
    };
    let whole = bake(4);
    for level in 0..4u8 {
        // Materials, then the levels of depth 0 to 5.
        let entry = 64 + 16 * (usize::from(level) + 3);
        let end = u32::from_le_bytes(whole[entry + 4..entry + 8].try_into().unwrap()) as usize;
        let cut = rhogrid::asset_file::AssetFile::new(&whole[..end]).unwrap();
        let coarse = rhogrid::asset_file::AssetFile::new(&bake(level)).unwrap();
        assert_eq!(cut.grid().depth(), level + 1);
        for (a, b) in cut.grid().levels().iter().zip(coarse.grid().levels()) {
            let materials = |of: &[u16]| -> Vec<u16> { of.iter().map(|own| own >> 13).collect() };
            let occupancy = |of: &[u16]| -> Vec<[u16; 2]> {
                let (records, _) = of.as_chunks();
                records
                    .iter()
                    .map(|&[low, high]| [low, high & 0x7ff])
                    .collect()
            };
            assert_eq!(
                materials(a.attributes),
                materials(b.attributes),
                "level {level}"
            );
            assert_eq!(a.links, b.links, "level {level}");
            assert_eq!(occupancy(a.nodes), occupancy(b.nodes), "level {level}");
        }
    }
}

#[test]
fn the_big_scene_has_true_shadows() {
    let Some(models) = folder() else { return };
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let scene = root.join("scenes/big.toml");
    let options = format!(
        "--models {} --distance 1.7 --orbit 2 --frames 1 --compare",
        models.display()
    );
    // An absolute path stays as it is when it is joined.
    let reports = run("render", &scene.to_string_lossy(), &options).expect("there are models");
    let errors = numbers(&reports, "shadow_errors");
    println!("big scene: shadow errors {errors:?}");
    assert!(errors.iter().all(|&share| share <= 0.02), "{errors:?}");
    let passes = numbers(&reports, "shadow_passes");
    assert_eq!(passes, [0.0, 0.0], "one pass");
}
