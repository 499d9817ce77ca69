//! `rhogrid report paper`, small, and without models.

use std::path::Path;
use std::process::{Command, Output};
use std::sync::OnceLock;

use rhogrid::bake::{self, GridOptions};
use rhogrid::geometry::Geometry;
use rhogrid::import::procedural::built_in;
use rhogrid::picture::Picture;
use rhogrid_core::asset::Shell;
use tempfile::TempDir;

fn paper(folder: &Path, options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rhogrid"))
        .args(["report", "paper"])
        .args(options)
        .current_dir(folder)
        .output()
        .expect("runs")
}

/// One page for all tests, and the folder it was made in.
fn quick() -> &'static (TempDir, String) {
    static PAGE: OnceLock<(TempDir, String)> = OnceLock::new();
    PAGE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let output = paper(folder.path(), &["--quick"]);
        assert!(output.status.success(), "{output:?}");
        let page = String::from_utf8(output.stdout).unwrap();
        (folder, page)
    })
}

/// The numbers of the table's line that begins so, after its first cell; `None`
/// where a cell is empty.
#[track_caller]
fn numbers(line: &str) -> Vec<Option<f64>> {
    let (_, page) = quick();
    let found = page.lines().find(|own| own.starts_with(line));
    let found = found.unwrap_or_else(|| panic!("no {line} in {page}"));
    let cells = found.trim_matches('|').split('|').skip(1);
    cells
        .map(|cell| match cell.trim() {
            "" => None,
            number => Some(number.parse().unwrap_or_else(|_| panic!("{found}"))),
        })
        .collect()
}

#[test]
fn every_table_and_figure_is_there() {
    let (_, page) = quick();
    for heading in [
        "## Table 1",
        "## Table 2",
        "## Table 3",
        "## Table 4",
        "## Table 5",
        "### Figure 5",
        "### Figure 6",
    ] {
        assert!(page.contains(&format!("\n{heading}")), "{heading}");
    }
    // The page is in nobody's working copy.
    let made = "commit unknown: `rhogrid report paper --quick --out rhogrid-paper`";
    assert!(page.contains(made), "{page}");
}

#[test]
fn normals_are_as_exact_as_the_papers() {
    for level in 3..=7 {
        let values = numbers(&format!("| {level} | "));
        let [Some(normals), Some(paper), Some(largest), Some(mean)] = values[..] else {
            panic!("{values:?}");
        };
        assert_eq!(normals, f64::from(8 << (2 * level)));
        assert!(largest < 1.5 * paper && paper < 1.5 * largest, "{values:?}");
        assert!(mean < largest / 4.0, "{values:?}");
    }
}

#[test]
fn alpha_is_the_samples_of_a_level_over_those_above() {
    for (tree, name) in [("Arbre", "tree-broad"), ("Saule", "tree-willow")] {
        let values = numbers(&format!("| {tree} (builtin:{name}), 3 |"));
        let values: Vec<f64> = values.into_iter().map(|value| value.unwrap()).collect();
        let [_, polygons, paper, fat, thin, alpha_paper, alphas @ ..] = &values[..] else {
            panic!("{values:?}");
        };
        // Of the paper's sizes, and of its shape.
        assert!(*polygons > 50.0 && thin < fat);
        assert!((0.6..1.5).contains(&(fat / paper)), "{values:?}");
        assert!(
            (0.6..1.5).contains(&(alphas[0] / alpha_paper)),
            "{values:?}"
        );
        let geometry = Geometry::Mesh(built_in(name).expect("a tree"));
        let above = GridOptions {
            level: 2,
            shell: Shell::Fat,
            ..GridOptions::default()
        };
        let above = bake::grid(&geometry, &above, &|_| {}).unwrap();
        let above = above.levels.last().expect("a level").attributes.len();
        let alpha = fat * 1e3 / above as f64;
        assert!((alpha - alphas[0]).abs() < 0.02, "{alpha}, {values:?}");
    }
}

#[test]
fn speeds_are_of_the_host_and_say_so() {
    let (_, page) = quick();
    assert!(page.contains("which needs --machine sa1110"), "{page}");
    let values = numbers("| Arbre (builtin:tree-broad), 3 |  |");
    assert_eq!(values.len(), 10);
    for (at, value) in values.iter().enumerate() {
        // The paper has no rates of its trees.
        assert_eq!(value.is_some(), at % 2 == 1, "{values:?}");
        assert!(value.is_none_or(|time| time > 0.0), "{values:?}");
    }
}

#[test]
fn what_needs_models_says_so() {
    for line in [
        "| Bunny (bunny.ply), 3, needs --models |",
        "| Big Scene (its five models), 3, needs --models |",
        "| Buddha (buddha_100k.ply), 5, needs --models |",
        "| Big Scene (scenes/big.toml), 4, needs --models |",
    ] {
        let values = numbers(line);
        assert!(values[0].is_some(), "{line}: the paper's number");
        assert!(values.iter().any(Option::is_none), "{line}: ours");
    }
}

#[test]
fn pictures_are_there_and_good() {
    let (folder, page) = quick();
    let pictures = page.lines().filter_map(|line| {
        let (_, rest) = line.strip_prefix("| [")?.split_once("](")?;
        let (file, cells) = rest.split_once(')')?;
        Some((file, cells.rsplit('|').nth(1)?.trim().parse::<f64>().ok()?))
    });
    let pictures: Vec<(&str, f64)> = pictures.collect();
    assert_eq!(pictures.len(), 6, "{page}");
    for (file, psnr) in pictures {
        let path = folder.path().join("rhogrid-paper").join(file);
        let picture = Picture::load(&path).unwrap();
        assert_eq!((picture.width, picture.height), (240, 320), "{file}");
        assert!(picture.drawn.iter().any(|&drawn| drawn), "{file}");
        assert!(psnr > 10.0, "{file}: {psnr} dB");
    }
    assert!(page.contains("are in shadow in one of them alone"));
}

#[test]
fn what_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    for (options, status, wanted) in [
        (
            &["--models", "empty"][..],
            1,
            "empty: holds none of the paper's models; give a folder",
        ),
        (&["--out", "file"], 1, "file: "),
        (&["--machine", "sa1110"], 1, "--machine needs targets/run"),
        (&["--quick", "--models", "empty"], 2, "cannot be used with"),
    ] {
        let output = paper(folder.path(), options);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{options:?}: {told}");
        assert!(told.contains(wanted), "{options:?}: {told}");
        assert!(output.stdout.is_empty());
    }
}
