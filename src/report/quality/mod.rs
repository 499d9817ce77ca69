//! How near frames come to the mesh itself, and what the last decibels cost.
//!
//! The ceiling is the mesh drawn with one sample a pixel, in the frame's own
//! RGB565: no renderer of one sample a pixel does better but by luck.

mod ceiling;
mod figure;
mod tables;

use rhogrid_core::asset::Shell;
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::SplatPx;

use super::float::{Cells, Place, draw};
use super::row::{Row, Setting, Subject};
use super::timing::medians;
use super::{Chapter, Means, Model, Plot};
use crate::bake::{GridOptions, Normals};
use crate::cli::Frame;
use crate::error::Error;

pub(super) const CHAPTER: Chapter = Chapter {
    name: NAME,
    title: "How near the ceiling is, and what the last decibels cost",
    measure,
    write: tables::write,
    introduction: "\
The ceiling is the mesh itself, drawn by the reference with one sample a pixel and rounded to
RGB565, against the reference with 4x4 samples. Each curve is a level's, its points are splat
sizes. *Positions inside the cell* are an experiment in float on the host: the samples of the
same frames are drawn at the surface's points nearest to their cells' centres, with the same
colours, point sizes and closing of holes; no asset stores such points, so that they have a
quality and no cost. *Float, centres* draws them at the centres and tells how well the experiment
stands in for the core.
",
    plot: Some(Plot {
        file: "quality.svg",
        draw: figure::draw,
    }),
};

const NAME: &str = "quality";
const PSNR: &str = "psnr_inside";
const TIME: &str = "time_ns";
const INSTRUCTIONS: &str = "instructions";

/// One way to bake and draw.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variant {
    /// What pages and plots call it.
    pub name: &'static str,
    shell: Shell,
    normals: Normals,
    distortion: SplatPx,
}

/// What the sweep is over, besides levels and splat sizes: the defaults first,
/// then one change at a time.
pub(super) const VARIANTS: [Variant; 4] = [
    DEFAULT,
    Variant {
        name: "exact path",
        distortion: SplatPx::ZERO,
        ..DEFAULT
    },
    Variant {
        name: "fat shell",
        shell: Shell::Fat,
        ..DEFAULT
    },
    Variant {
        name: "nearest normals",
        normals: Normals::Nearest,
        ..DEFAULT
    },
];

const DEFAULT: Variant = Variant {
    name: "thin shell, filtered normals, path auto",
    shell: Shell::Thin,
    normals: Normals::Filtered,
    distortion: Quality::DISTORTION,
};

impl Variant {
    fn bake(self, level: u8) -> GridOptions {
        GridOptions {
            level,
            shell: self.shell,
            normals: self.normals,
            ..GridOptions::default()
        }
    }

    fn quality(self, splat: f64) -> Quality {
        Quality {
            splat: SplatPx::from_num(splat),
            distortion: self.distortion,
            repair: true,
            culling: true,
        }
    }

    /// Whether a row's asset was baked and drawn in this way.
    fn is_of(self, setting: &Setting) -> bool {
        let is_baked = |bake: GridOptions| (bake.shell, bake.normals) == (self.shell, self.normals);
        let is_drawn = |quality: Quality| quality.distortion == self.distortion;
        setting.bake.is_some_and(is_baked) && setting.quality.is_some_and(is_drawn)
    }
}

fn measure(model: &Model, means: Means<'_>) -> Result<Vec<Row>, Error> {
    let mut rows = ceiling::measure(model, means);
    rows.extend(frames(model, means)?);
    rows.extend(positions(model, means)?);
    Ok(rows)
}

/// The settings of a variant: by level, then by splat size.
fn settings(variant: Variant, means: Means<'_>) -> impl Iterator<Item = (GridOptions, Quality)> {
    let effort = *means.effort;
    let of = move |&level| {
        let splats = effort.splats.iter();
        splats.map(move |&splat| (variant.bake(level), variant.quality(splat)))
    };
    effort.levels.iter().flat_map(of)
}

/// Draws every setting of every variant.
fn frames(model: &Model, means: Means<'_>) -> Result<Vec<Row>, Error> {
    let settings = || {
        VARIANTS
            .into_iter()
            .flat_map(|variant| settings(variant, means))
    };
    let assets = settings().map(|(bake, _)| model.baked(bake, means.progress));
    let assets: Vec<_> = assets.collect::<Result<_, _>>()?;
    (means.progress)(&format!("{}: draws {} settings", model.name, assets.len()));
    let mut calls = Vec::new();
    for ((_, quality), own) in settings().zip(&assets) {
        calls.extend(model.calls(&own.asset, quality));
    }
    let times = medians(&calls, means.effort.rounds);
    let mut rows = Vec::new();
    let times = times.chunks(model.views.len());
    for (((bake, quality), own), times) in settings().zip(&assets).zip(times) {
        let setting = Setting::drawn(Subject::Core, bake, quality);
        let drawn = model.frames(&own.asset, &quality);
        let pictures: Vec<_> = drawn.iter().map(Frame::picture).collect();
        let score = model.score(&pictures, means.progress);
        let mut add = |measure, value, unit| rows.push(row(model, setting, measure, value, unit));
        add(PSNR, score.psnr_inside, "dB");
        add("holes", score.holes, "pixels");
        add(TIME, times.iter().sum::<f64>() / times.len() as f64, "ns");
        if let Some(machine) = means.machine {
            let instructions = machine.instructions(&own.asset, &quality)?;
            add(INSTRUCTIONS, instructions, "instructions");
        }
    }
    Ok(rows)
}

/// Draws the default variant's settings in float.
fn positions(model: &Model, means: Means<'_>) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for &level in means.effort.levels {
        (means.progress)(&format!("{}: draws level {level} in float", model.name));
        let baked = model.baked(DEFAULT.bake(level), means.progress)?;
        let cells = Cells::of(&baked.grid, &model.geometry);
        for &splat in means.effort.splats {
            for (subject, place) in [
                (Subject::Centres, Place::Centre),
                (Subject::Points, Place::Surface),
            ] {
                let picture = |view| draw(&cells, place, splat, &model.float_view(view));
                let pictures: Vec<_> = model.views.iter().map(picture).collect();
                let score = model.score(&pictures, means.progress);
                let setting = Setting::drawn(subject, DEFAULT.bake(level), DEFAULT.quality(splat));
                rows.push(row(model, setting, PSNR, score.psnr_inside, "dB"));
            }
        }
    }
    Ok(rows)
}

fn row(
    model: &Model,
    setting: Setting,
    measure: &'static str,
    value: f64,
    unit: &'static str,
) -> Row {
    Row {
        chapter: NAME,
        model: model.name.clone(),
        view: "full",
        setting,
        measure,
        value,
        unit,
        paper: None,
    }
}
