//! `rhogrid report paper`, small, and without models.

use std::path::Path;
use std::process::{Command, Output};

fn paper(folder: &Path, options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rhogrid"))
        .args(["report", "paper"])
        .args(options)
        .current_dir(folder)
        .output()
        .expect("runs")
}

/// The numbers of a table's line that begins so.
fn numbers(page: &str, line: &str) -> Vec<Option<f64>> {
    let found = page.lines().find(|own| own.starts_with(line));
    let line = found.unwrap_or_else(|| panic!("no {line}"));
    let cells = line.trim_matches('|').split('|').skip(1);
    cells.map(|cell| cell.trim().parse().ok()).collect()
}

#[test]
fn every_table_and_figure_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let output = paper(folder.path(), &["--quick"]);
    assert!(output.status.success());
    let page = String::from_utf8(output.stdout).unwrap();
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
    assert!(page.contains("at commit unknown"), "{page}");
    let [Some(paper), Some(ours)] = numbers(&page, "| 5 |")[..] else {
        panic!("two errors of normals");
    };
    assert!(ours < paper && ours > 0.8 * paper, "{ours}, {paper}");
    // Trees are built in: of the paper's sizes.
    for tree in ["Arbre", "Saule"] {
        let line = page
            .lines()
            .find(|line| line.starts_with(&format!("| {tree}")));
        let values = numbers(&page, line.expect("a tree"));
        let [_, Some(polygons), Some(paper), Some(fat), Some(thin), ..] = values[..] else {
            panic!("{values:?}");
        };
        assert!(polygons > 50.0 && thin < fat && fat > 0.6 * paper && fat < 1.5 * paper);
    }
    assert!(page.contains("Bunny (bunny.ply, not there), 3"));
    assert!(page.contains("Needs --machine sa1110"));
    assert!(page.contains("far, splats, level 5, needs --models"));
    assert!(folder.path().join("rhogrid-paper").is_dir());
}

#[test]
fn what_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    for (options, wanted) in [
        (
            &["--models", "empty"][..],
            "empty: holds none of the paper's models; give a folder",
        ),
        (&["--out", "file"], "file: "),
        (&["--machine", "sa1110"], "--machine needs targets/run"),
    ] {
        let output = paper(folder.path(), options);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{options:?}: {told}");
        assert!(told.contains(wanted), "{options:?}: {told}");
        assert!(output.stdout.is_empty());
    }
}
