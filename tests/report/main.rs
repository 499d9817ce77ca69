//! The report, small: its rows are there, say what other ways of asking say,
//! and are what its files show.

mod paper;

use std::process::Command;
use std::sync::OnceLock;

use rhogrid::bake::{self, GridOptions, Normals, writer};
use rhogrid::geometry::Geometry;
use rhogrid::import::procedural::demo;
use rhogrid::report::{Effort, Means, Report, Row, Subject, measure, models};
use rhogrid_core::asset::Shell;
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::SplatPx;
use serde_json::Value;

const SMALL: Effort = Effort {
    width: 48,
    height: 64,
    cells: 27,
    levels: &[2, 3],
    splats: &[1.25, 3.5],
    rounds: 1,
};
const NAME: &str = "builtin:demo";

/// One report for all tests.
fn report() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| {
        let means = Means {
            effort: &SMALL,
            machine: None,
            progress: &|_| {},
        };
        measure(&models(None, &SMALL).unwrap(), means).unwrap()
    })
}

fn rows(measure: &str) -> impl Iterator<Item = &'static Row> {
    report()
        .rows()
        .iter()
        .filter(move |row| row.measure == measure)
}

/// The one figure that a file with these options has.
#[track_caller]
fn of_file(measure: &str, rho: u8, shell: Shell, bits: Option<u8>) -> f64 {
    let is_asked = |row: &&Row| {
        let bake = row.setting.bake.unwrap();
        (bake.rho, bake.shell, row.setting.attribute_bits) == (rho, shell, bits)
    };
    let found: Vec<&Row> = rows(measure).filter(is_asked).collect();
    assert_eq!(found.len(), 1, "{measure}, rho {rho}, {shell:?}, {bits:?}");
    found[0].value
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{a} is not {b}");
}

/// Cells of each depth, drawn leaves, and bytes of all and of attributes alone.
struct Counts {
    cells: Vec<f64>,
    leaves: f64,
    bytes: f64,
    attributes: f64,
}

fn counts(rho: u8, level: u8, shell: Shell) -> Counts {
    let options = GridOptions {
        rho,
        level,
        shell,
        ..GridOptions::default()
    };
    let grid = bake::grid(&Geometry::Mesh(demo()), &options, &|_| {}).unwrap();
    let cells: Vec<f64> = grid
        .levels
        .iter()
        .map(|own| own.attributes.len() as f64)
        .collect();
    Counts {
        // The last level holds drawn cells alone.
        leaves: *cells.last().unwrap(),
        attributes: 2.0 * cells.iter().sum::<f64>(),
        cells,
        bytes: writer::to_bytes(&grid).unwrap().len() as f64,
    }
}

/// The level at which a rho has about 27 cells on an axis.
const LEVELS: [(u8, u8); 4] = [(2, 4), (3, 2), (4, 1), (5, 1)];

#[test]
fn memory_is_what_the_baked_files_hold() {
    for (rho, level) in LEVELS {
        for shell in [Shell::Fat, Shell::Thin] {
            let counts = counts(rho, level, shell);
            let above: f64 = counts.cells[..counts.cells.len() - 1].iter().sum();
            let alpha = (counts.cells.iter().sum::<f64>() - 1.0) / above;
            close(of_file("leaf_samples", rho, shell, None), counts.leaves);
            close(of_file("alpha", rho, shell, None), alpha);
            for bits in [0, 4, 8, 12, 16, 32, 48] {
                let structure = 8.0 * (counts.bytes - counts.attributes);
                let file = (structure + f64::from(bits) * above) / counts.leaves;
                close(
                    of_file("file_bits_per_leaf_sample", rho, shell, Some(bits)),
                    file,
                );
            }
            let whole = of_file("whole_file_bits_per_leaf_sample", rho, shell, Some(16));
            close(whole, 8.0 * counts.bytes / counts.leaves);
        }
    }
    assert_eq!(rows("file_bits_per_leaf_sample").count(), 4 * 2 * 7);
}

/// The paper's sums over counted cells. A plane's alpha gives the paper's own
/// figures, whose last decimals are cut off or rounded.
#[test]
fn the_papers_sums_are_counted_and_its_figures_kept() {
    for (rho, level) in LEVELS {
        let counts = counts(rho, level, Shell::Fat);
        let above: f64 = counts.cells[..counts.cells.len() - 1].iter().sum();
        let below = counts.cells.iter().sum::<f64>() - 1.0;
        let cube = f64::from(rho).powi(3);
        for bits in [0u8, 48] {
            let counted = (cube + f64::from(bits)) * above / counts.leaves;
            close(
                of_file("counted_bits_per_leaf_sample", rho, Shell::Fat, Some(bits)),
                counted,
            );
        }
        let additions = of_file("operations_per_leaf_sample", rho, Shell::Fat, None);
        close(additions, (3.0 * below + cube * above) / counts.leaves);
    }
    for row in report().rows().iter().filter(|row| row.paper.is_some()) {
        let rho = f64::from(row.setting.bake.unwrap().rho);
        let (alpha, bits) = (rho * rho, row.setting.attribute_bits.map(f64::from));
        let computed = match row.measure {
            "alpha" | "alpha_of_last_level" => alpha,
            "operations_per_leaf_sample" => (3.0 * alpha + rho * alpha) / (alpha - 1.0),
            "operations_per_leaf_sample_with_shadows" => {
                (6.0 * alpha + rho * alpha) / (alpha - 1.0)
            }
            _ => (bits.unwrap() + rho * alpha) / (alpha - 1.0),
        };
        let paper = row.paper.unwrap();
        assert!((paper - computed).abs() < 0.1, "{row:?}: {computed}");
    }
}

#[test]
fn every_setting_has_its_rows() {
    let variants = [
        (Shell::Thin, Normals::Filtered, Quality::DISTORTION),
        (Shell::Thin, Normals::Filtered, SplatPx::ZERO),
        (Shell::Fat, Normals::Filtered, Quality::DISTORTION),
        (Shell::Thin, Normals::Nearest, Quality::DISTORTION),
    ];
    for (shell, normals, distortion) in variants {
        for &level in SMALL.levels {
            for &splat in SMALL.splats {
                for measure in ["psnr_inside", "holes", "time_ns"] {
                    let own = rows(measure).filter(|row| {
                        let (Some(bake), Some(quality)) = (row.setting.bake, row.setting.quality)
                        else {
                            return false;
                        };
                        row.chapter == "quality"
                            && row.setting.subject == Subject::Core
                            && (bake.level, bake.shell, bake.normals) == (level, shell, normals)
                            && quality.distortion == distortion
                            && quality.splat == SplatPx::from_num(splat)
                    });
                    let own: Vec<f64> = own.map(|row| row.value).collect();
                    assert_eq!(own.len(), 1, "{measure} of level {level}, splat {splat}");
                    assert!(own[0].is_finite() && own[0] >= 0.0);
                }
            }
        }
    }
}

fn psnr(subject: Subject, level: Option<u8>, splat: f64) -> f64 {
    let found = rows("psnr_inside").find(|row| {
        let setting = row.setting;
        let is_default = setting.bake.is_none_or(|bake| {
            (bake.shell, bake.normals) == (Shell::Thin, Normals::Filtered)
                && Some(bake.level) == level
        });
        let quality = Quality {
            splat: SplatPx::from_num(splat),
            ..Quality::default()
        };
        row.chapter == "quality"
            && setting.subject == subject
            && is_default
            && setting.quality.is_none_or(|own| own == quality)
    });
    found.unwrap().value
}

#[test]
fn quality_is_what_render_tells() {
    let folder = tempfile::tempdir().unwrap();
    for (level, splat) in [(2, 1.25), (3, 3.5)] {
        let output = Command::new(env!("CARGO_BIN_EXE_rhogrid"))
            .args([
                "render", NAME, "-o", "a.png", "--size", "48x64", "--orbit", "4",
            ])
            .args(["--level", &level.to_string(), "--splat", &splat.to_string()])
            .args(["--compare", "--frames", "1", "--json"])
            .current_dir(&folder)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let told = text.lines().map(|line| {
            let report: Value = serde_json::from_str(line).unwrap();
            report["psnr_inside"].as_f64().unwrap()
        });
        close(
            psnr(Subject::Core, Some(level), splat),
            told.sum::<f64>() / 4.0,
        );
    }
}

/// Float at cells' centres stands in for the core; the mesh is the ceiling.
#[test]
fn float_stands_in_for_the_core_below_the_ceiling() {
    let ceiling = psnr(Subject::Mesh, None, 0.0);
    assert!(ceiling < psnr(Subject::MeshTrueColour, None, 0.0) + 0.1);
    assert!(ceiling < psnr(Subject::Rgb565, None, 0.0));
    for &level in SMALL.levels {
        for &splat in SMALL.splats {
            let core = psnr(Subject::Core, Some(level), splat);
            let float = psnr(Subject::Centres, Some(level), splat);
            let points = psnr(Subject::Points, Some(level), splat);
            println!("level {level}, splat {splat}: {core} dB, float {float}, points {points}");
            assert!(
                (core - float).abs() < 0.5,
                "level {level}, splat {splat}: {core}, {float}"
            );
            assert!(core < ceiling && points < ceiling);
        }
    }
}

#[test]
fn files_show_all_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let files = report().write(folder.path()).unwrap();
    assert_eq!(files.len(), 3);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let data = read("data.csv");
    assert_eq!(data.lines().count(), report().rows().len() + 1);
    for (line, row) in data.lines().skip(1).zip(report().rows()) {
        let fields: Vec<&str> = line.split(',').collect();
        assert!(
            line.starts_with(&format!("{},{NAME},", row.chapter)),
            "{line}"
        );
        let value = fields.iter().rev().nth(2).unwrap();
        assert_eq!(value.parse(), Ok(row.value), "{line}");
    }
    let page = read("report.md");
    for part in [
        "table 1",
        "table 2",
        "ceiling",
        "quality.svg",
        NAME,
        "sigma = 48",
    ] {
        assert!(page.contains(part), "no {part}");
    }
    let plot = read("quality.svg");
    assert!(plot.starts_with("<svg ") && plot.ends_with("</svg>\n"));
    assert!(!plot.contains("href") && !plot.contains("NaN") && !plot.contains("inf"));
    // A circle for each setting of the defaults, and one in the legend.
    let circles = plot
        .lines()
        .filter(|line| line.starts_with("<circle"))
        .count();
    assert_eq!(circles, SMALL.levels.len() * SMALL.splats.len() + 1);
}
