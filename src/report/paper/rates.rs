//! Table 5: frames a second.

use std::path::Path;

use rhogrid_core::numbers::Length;

use super::Comparison;
use super::drawing::{Content, Sight, WAYS};
use super::subject::{Subject, Subjects, line};
use crate::bake::GridOptions;
use crate::cli::{core_camera, load_scene};
use crate::error::Error;
use crate::report::Model;
use crate::report::page::Table;

/// Table 5, a row: numbers by way.
type Speeds = [Option<f64>; WAYS.len()];

const fn printed(speeds: [f64; WAYS.len()]) -> Speeds {
    let [a, b, c, d, e] = speeds;
    [Some(a), Some(b), Some(c), Some(d), Some(e)]
}

const BUDDHA: [(u8, Speeds); 2] = [
    (4, printed([5.49, 4.15, 3.47, 2.65, 2.99])),
    (5, printed([0.91, 0.63, 3.33, 2.46, 2.85])),
];
const BLADE: [(u8, Speeds); 2] = [
    (4, printed([4.71, 3.30, 2.63, 1.99, 2.32])),
    (5, printed([0.67, 0.47, 2.40, 1.89, 2.21])),
];
const BIG_SCENE: Speeds = printed([0.62, 0.30, 2.38, 1.83, 2.11]);
const NONE: Speeds = [None; WAYS.len()];

/// Where the Big Scene is, seen from the project's folder.
const SCENE: &str = "scenes/big.toml";
/// The level of its models.
const SCENE_LEVEL: u8 = 4;
/// View of `targets/run`.
const VIEW: &str = "full";

/// The table.
///
/// # Errors
/// When a model cannot be read or baked, or the machine cannot be run.
pub fn table(comparison: &Comparison<'_>, subjects: &Subjects) -> Result<String, Error> {
    let unit = comparison.unit();
    let mut columns = vec!["model, level".to_owned()];
    columns.extend(WAYS.iter().flat_map(|way| {
        let paper = format!("{}, the paper, frames/s", way.name);
        [paper, format!("ours, {unit}")]
    }));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let mut table = Table::new(&columns);
    let mut put = |name: String, (paper, ours): (Speeds, Speeds)| {
        let pairs = paper.into_iter().zip(ours);
        table.line(name, pairs.flat_map(|(paper, ours)| [paper, ours]), 2);
    };
    // The paper has no rates of its trees; ours are always there.
    let tree = [(comparison.levels()[comparison.levels().len() / 2], NONE)];
    let cases: [(&Subject, &[(u8, Speeds)]); 3] = [
        (&subjects.buddha, &BUDDHA),
        (&subjects.blade, &BLADE),
        (&subjects.arbre, &tree),
    ];
    for (subject, levels) in cases {
        for &(level, paper) in levels {
            let ours = of_model(comparison, subject, level)?;
            put(subject.line(level), (paper, ours));
        }
    }
    let (name, ours) = of_scene(comparison, subjects)?;
    put(name, (BIG_SCENE, ours));
    Ok(format!(
        "\n## Table 5: how fast\n\n\
        {} Means of the four *{VIEW}* views (2.6 radii away, pitch 15 degrees, yaw 0, 90, 180 and \
        270), which show all of the model, as the paper's far view of figure 5 does. Thin shells. \
        *Points* are all leaves, whatever they face (`--splat 0 --culling off`); theirs with \
        shadows, in two passes, are the paper's numbers in parentheses. The Big Scene has its \
        lamp's shadows.\n\n{table}",
        comparison.about_speed()
    ))
}

fn of_model(comparison: &Comparison<'_>, subject: &Subject, level: u8) -> Result<Speeds, Error> {
    let Some(model) = subject.load(comparison)? else {
        return Ok(NONE);
    };
    let options = GridOptions {
        level,
        ..GridOptions::default()
    };
    let baked = model.baked(options, comparison.progress)?;
    let sight = Sight {
        name: subject.name,
        content: Content::Asset(&baked.asset),
        view: VIEW,
        cameras: model.cameras(&baked.asset),
    };
    speeds(comparison, &sight)
}

/// The row's name, and what is in it if all of the scene's models are there.
fn of_scene(comparison: &Comparison<'_>, subjects: &Subjects) -> Result<(String, Speeds), Error> {
    let file = Path::new(SCENE);
    let away = || {
        let away = "not here: start from the project's folder";
        (!file.is_file()).then(|| away.to_owned())
    };
    let absence = subjects.absence_from_big_scene().or_else(away);
    let is_absent = absence.is_some();
    let name = line(&format!("Big Scene ({SCENE})"), SCENE_LEVEL, absence);
    if is_absent {
        return Ok((name, NONE));
    }
    (comparison.progress)(&format!("bakes {SCENE}"));
    let scene = load_scene(file, comparison.models)?;
    let views = Model::full_views();
    let camera = |view| core_camera(view, Length::ONE, &scene.cube);
    let sight = Sight {
        name: SCENE,
        content: Content::Scene(&scene, file),
        view: VIEW,
        cameras: views.iter().map(camera).collect(),
    };
    Ok((name, speeds(comparison, &sight)?))
}

fn speeds(comparison: &Comparison<'_>, sight: &Sight<'_>) -> Result<Speeds, Error> {
    let mut speeds = NONE;
    for (speed, way) in speeds.iter_mut().zip(&WAYS) {
        *speed = comparison.speed(sight, way)?;
    }
    Ok(speeds)
}
