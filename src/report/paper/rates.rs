//! Table 5: frames a second.

use std::path::Path;

use super::subject::{Subject, Subjects};
use super::{Comparison, asset_file};
use crate::bake::GridOptions;
use crate::error::Error;
use crate::report::page::Table;

/// Table 5, a row: points, points with shadows, splats, two-pass, one-pass.
type Rates = [f64; WAYS.len()];

const BUDDHA: [(u8, Rates); 2] = [
    (4, [5.49, 4.15, 3.47, 2.65, 2.99]),
    (5, [0.91, 0.63, 3.33, 2.46, 2.85]),
];
const BLADE: [(u8, Rates); 2] = [
    (4, [4.71, 3.30, 2.63, 1.99, 2.32]),
    (5, [0.67, 0.47, 2.40, 1.89, 2.21]),
];
const BIG_SCENE: Rates = [0.62, 0.30, 2.38, 1.83, 2.11];

/// The table's columns, and how each is asked for.
const WAYS: [(&str, &[&str]); 5] = [
    ("points", &["--splat", "0", "--shadows", "off"]),
    (
        "points, shadows",
        &["--splat", "0", "--shadows", "two-pass"],
    ),
    ("splats", &["--shadows", "off"]),
    ("two passes", &["--shadows", "two-pass"]),
    ("one pass", &["--shadows", "one-pass"]),
];

/// Where the Big Scene is, seen from the project's folder.
const SCENE: &str = "scenes/big.toml";

/// The table.
///
/// # Errors
/// When a model cannot be read or baked, or the machine cannot be run.
pub fn table(comparison: &Comparison<'_>, subjects: &Subjects) -> Result<String, Error> {
    let mut text = String::from(
        "\n## Table 5: frames a second at 200 MHz\n\n\
        Ours: 200 MHz over the estimated cycles of an SA-1110 that QEMU plays, means of the four \
        full views, thin shells. *Points* are all leaves (`--splat 0`); the paper's view is the \
        far one of its figure 5, which shows all of the model.\n\n",
    );
    if comparison.machine.is_none() {
        text += "Needs --machine sa1110: what follows is the paper's alone.\n\n";
    }
    let mut columns = vec!["model, level"];
    columns.extend(WAYS.iter().flat_map(|(way, _)| [way, "ours"]));
    let mut table = Table::new(&columns);
    for (subject, cases) in [(&subjects.buddha, BUDDHA), (&subjects.blade, BLADE)] {
        for (level, paper) in cases {
            let ours = of_model(comparison, subject, level)?;
            let name = format!("{} ({}), {level}", subject.name, subject.ours);
            table.line(name, side_by_side(paper, ours), 2);
        }
    }
    let ours = match comparison.models.is_some() && Path::new(SCENE).is_file() {
        true => rates(comparison, (SCENE, Path::new(SCENE)))?,
        false => [None; WAYS.len()],
    };
    table.line(
        format!("Big Scene ({SCENE}), 4"),
        side_by_side(BIG_SCENE, ours),
        2,
    );
    Ok(text + &table.to_string())
}

fn side_by_side(paper: Rates, ours: [Option<f64>; WAYS.len()]) -> Vec<Option<f64>> {
    let pairs = paper.into_iter().zip(ours);
    pairs
        .flat_map(|(paper, ours)| [Some(paper), ours])
        .collect()
}

fn of_model(
    comparison: &Comparison<'_>,
    subject: &Subject,
    level: u8,
) -> Result<[Option<f64>; WAYS.len()], Error> {
    let model = match comparison.machine {
        Some(_) => subject.load(comparison)?,
        None => None,
    };
    let Some(model) = model else {
        return Ok([None; WAYS.len()]);
    };
    let options = GridOptions {
        level,
        ..GridOptions::default()
    };
    let baked = model.baked(options, comparison.progress)?;
    let file = asset_file(baked.asset.bytes())?;
    rates(comparison, (subject.name, file.path()))
}

fn rates(
    comparison: &Comparison<'_>,
    input: (&str, &Path),
) -> Result<[Option<f64>; WAYS.len()], Error> {
    let mut rates = [None; WAYS.len()];
    for (rate, (_, options)) in rates.iter_mut().zip(WAYS) {
        *rate = comparison.rate(input, "full", options)?;
    }
    Ok(rates)
}
