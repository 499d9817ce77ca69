//! What a leaf sample costs to draw, by rho.
//!
//! Source: Duguet and Drettakis 2003, 5.4 and table 2, which is computed: T =
//! (3 rho^d + rho^3) / (rho^d - 1) operations, with d = 2: three additions for
//! each cell below the root and a shift for each bit of a mask. Their one-pass
//! shadows make six additions of three. Here cells are counted: all of a baked
//! shell, and those that frames visit.

use rhogrid_core::asset::Shell;
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::SplatPx;

use super::memory::{RHOS, bake_at};
use super::page::Table;
use super::row::{Row, Setting, Subject};
use super::timing::medians;
use super::{Chapter, Means, Model};
use crate::bake::GridOptions;
use crate::cli::{Description, Frame};
use crate::error::Error;

pub(super) const CHAPTER: Chapter = Chapter {
    name: NAME,
    title: "Operations a leaf sample (the paper's table 2)",
    measure,
    write,
    introduction: "\
*Paper* is its table 2, computed for alpha = rho^2; *counted* is the paper's sum over all cells
of the baked fat shell: three additions (six with its one-pass shadows, which are counted, not
drawn) a cell below the root and a shift a bit of a mask, a leaf sample. *Every leaf* are frames
of the fat shell down to its leaves (`--splat 0`), as the paper's table has them, but without
what faces away; *exact* projects every cell, *auto* walks the last levels by additions of one
word. Their *operations* are the paper's sum over the nodes and samples of the frame; *centres*
are displacement steps: nodes and samples. *Default* is what `rhogrid render` draws of the thin
shell, with its quality: cells are drawn as samples where their edges are at most 1.25 pixels, so
that a step between levels costs rho^2 samples.
",
    plot: None,
};

const NAME: &str = "operations";
/// Table 2: basic, with shadows.
const TABLE_2: [(&str, f64, [f64; RHOS.len()]); 2] = [
    (BASIC, 3.0, [6.6, 6.7, 7.5, 8.4]),
    (SHADOWS, 6.0, [10.7, 10.1, 10.6, 11.5]),
];
const BASIC: &str = "operations_per_leaf_sample";
const SHADOWS: &str = "operations_per_leaf_sample_with_shadows";

/// The frames that are counted: their name on the page, shell, quality.
const FRAMES: [(&str, Shell, Quality); 3] = [
    (
        "every leaf, exact",
        Shell::Fat,
        Quality {
            splat: SplatPx::ZERO,
            distortion: SplatPx::ZERO,
            repair: true,
            culling: true,
        },
    ),
    (
        "every leaf, auto",
        Shell::Fat,
        Quality {
            splat: SplatPx::ZERO,
            distortion: Quality::DISTORTION,
            repair: true,
            culling: true,
        },
    ),
    (
        "default",
        Shell::Thin,
        Quality {
            splat: Quality::SPLAT,
            distortion: Quality::DISTORTION,
            repair: true,
            culling: true,
        },
    ),
];

fn measure(model: &Model, means: Means<'_>) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for (at, rho) in RHOS.into_iter().enumerate() {
        let bake = bake_at(rho, Shell::Fat, means.effort.cells);
        let baked = model.baked(bake, means.progress)?;
        rows.extend(counted(model, bake, &Description::of(&baked.asset), at));
    }
    for (_, shell, quality) in FRAMES {
        rows.extend(frames(model, shell, quality, means)?);
    }
    Ok(rows)
}

/// The paper's sums over all cells of a file.
fn counted(model: &Model, bake: GridOptions, description: &Description, at: usize) -> Vec<Row> {
    let cells: usize = description.cells_per_depth.iter().sum();
    let leaves = description.cells_per_depth.last().copied().unwrap_or(1);
    let sum = |additions: f64| {
        let nodes = (cells - leaves) as f64;
        operations(additions, bake.rho, (cells - 1) as f64, nodes) / leaves as f64
    };
    let row = |(measure, additions, paper): (&'static str, f64, [f64; RHOS.len()])| Row {
        chapter: NAME,
        model: model.name.clone(),
        view: "",
        setting: Setting::file(bake),
        measure,
        value: sum(additions),
        unit: "operations",
        paper: Some(paper[at]),
    };
    TABLE_2.map(row).to_vec()
}

/// So many additions for each centre, a shift for each bit of the nodes'
/// masks.
fn operations(additions: f64, rho: u8, centres: f64, nodes: f64) -> f64 {
    additions * centres + f64::from(rho).powi(3) * nodes
}

/// Draws assets of every rho in the same way.
fn frames(
    model: &Model,
    shell: Shell,
    quality: Quality,
    means: Means<'_>,
) -> Result<Vec<Row>, Error> {
    let bakes = RHOS.map(|rho| bake_at(rho, shell, means.effort.cells));
    let baked = bakes.map(|bake| model.baked(bake, means.progress));
    let baked: Vec<_> = baked.into_iter().collect::<Result<_, _>>()?;
    let mut calls = Vec::new();
    for own in &baked {
        calls.extend(model.calls(&own.asset, quality));
    }
    let times = medians(&calls, means.effort.rounds);
    let mut rows = Vec::new();
    let views = model.views.len();
    for ((bake, own), times) in bakes.into_iter().zip(&baked).zip(times.chunks(views)) {
        let drawn = model.frames(&own.asset, &quality);
        let pictures: Vec<_> = drawn.iter().map(Frame::picture).collect();
        let mut figures = work(bake.rho, &drawn, times);
        figures.push((
            "psnr_inside",
            model.score(&pictures, means.progress).psnr_inside,
            "dB",
        ));
        if let Some(machine) = means.machine {
            let instructions = machine.instructions(&own.asset, &quality)?;
            let samples = mean(&drawn, |frame| frame.stats.samples_drawn);
            figures.push(("instructions", instructions, "instructions"));
            figures.push((
                "instructions_per_sample",
                instructions / samples,
                "instructions",
            ));
        }
        rows.extend(figures.into_iter().map(|(measure, value, unit)| Row {
            chapter: NAME,
            model: model.name.clone(),
            view: "full",
            setting: Setting::drawn(Subject::Core, bake, quality),
            measure,
            value,
            unit,
            paper: None,
        }));
    }
    Ok(rows)
}

fn mean(frames: &[Frame], of: impl Fn(&Frame) -> u32) -> f64 {
    frames.iter().map(|frame| f64::from(of(frame))).sum::<f64>() / frames.len().max(1) as f64
}

/// What frames did, in the mean, and how long it took.
fn work(rho: u8, drawn: &[Frame], times: &[f64]) -> Vec<(&'static str, f64, &'static str)> {
    let nodes = mean(drawn, |frame| frame.stats.nodes_visited);
    let samples = mean(drawn, |frame| frame.stats.samples_drawn);
    let centres = nodes + samples;
    let time = times.iter().sum::<f64>() / times.len().max(1) as f64;
    vec![
        ("nodes_visited", nodes, "nodes"),
        ("samples_drawn", samples, "samples"),
        ("nodes_per_sample", nodes / samples, "nodes"),
        ("centres_per_sample", centres / samples, "centres"),
        (
            "operations_per_sample",
            operations(3.0, rho, centres, nodes) / samples,
            "operations",
        ),
        ("time_ns", time, "ns"),
        ("time_ns_per_sample", time / samples, "ns"),
    ]
}

/// What of a frame is shown: measure, name, digits, factor.
const SHOWN: [(&str, &str, usize, f64); 9] = [
    ("samples_drawn", "samples", 0, 1.0),
    ("nodes_per_sample", "nodes a sample", 3, 1.0),
    ("centres_per_sample", "centres a sample", 3, 1.0),
    ("operations_per_sample", "operations a sample", 2, 1.0),
    ("time_ns_per_sample", "host ns a sample", 1, 1.0),
    ("instructions_per_sample", "instructions a sample", 1, 1.0),
    ("time_ns", "host ms", 2, 1e-6),
    ("instructions", "million instructions", 2, 1e-6),
    ("psnr_inside", "psnr_inside, dB", 2, 1.0),
];

fn write(rows: &[&Row]) -> String {
    let find = |rho: u8, quality: Option<Quality>, measure: &str| {
        rows.iter().find(|row| {
            let is_own = row.setting.bake.is_some_and(|bake| bake.rho == rho);
            is_own && row.setting.quality == quality && row.measure == measure
        })
    };
    let mut table = Table::new(&["", "rho = 2", "rho = 3", "rho = 4", "rho = 5"]);
    for (measure, additions, paper) in TABLE_2 {
        let counted = RHOS.map(|rho| find(rho, None, measure).map(|row| row.value));
        table.line(format!("paper ({additions})"), paper.map(Some), 1);
        table.line(format!("counted, fat ({additions})"), counted, 2);
    }
    for (name, _, quality) in FRAMES {
        for (measure, what, digits, factor) in SHOWN {
            let value = |rho| find(rho, Some(quality), measure).map(|row| row.value * factor);
            let values = RHOS.map(value);
            if values.iter().any(Option::is_some) {
                table.line(format!("{name}: {what}"), values, digits);
            }
        }
    }
    table.to_string()
}
