//! Figures 5 and 6: pictures.

use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::SplatPx;
use rhogrid_core::shadow::{Method, Shadows};

use super::subject::{Subject, Subjects};
use super::{Comparison, asset_file};
use crate::bake::GridOptions;
use crate::cli::{core_camera, draw_shadowed, float_view};
use crate::error::Error;
use crate::measure::against_reference;
use crate::picture::Picture;
use crate::reference::{DEFAULT_SAMPLES_PER_AXIS, Scene, render};
use crate::report::make_folder;
use crate::report::model::{bright, light};
use crate::report::page::Table;
use crate::view;

/// A picture of a figure.
struct Panel {
    file: &'static str,
    /// What the paper says of it.
    name: &'static str,
    level: u8,
    /// All leaves, or cells as large as a splat.
    points: bool,
    /// View of `targets/run`, and its distance in radii.
    view: (&'static str, f64),
    /// The paper's frames a second.
    paper: Option<f64>,
}

const fn panel(
    file: &'static str,
    name: &'static str,
    level: u8,
    points: bool,
    view: (&'static str, f64),
    paper: Option<f64>,
) -> Panel {
    Panel {
        file,
        name,
        level,
        points,
        view,
        paper,
    }
}

const FAR: (&str, f64) = ("0,15,2.6", 2.6);
const NEAR: (&str, f64) = ("0,15,1.4", 1.4);

const FIGURE_5: [Panel; 6] = [
    panel(
        "5-far-points-4.png",
        "far, points, level 4",
        4,
        true,
        FAR,
        Some(4.15),
    ),
    panel(
        "5-far-points-5.png",
        "far, points, level 5",
        5,
        true,
        FAR,
        Some(0.63),
    ),
    panel(
        "5-far-splats-5.png",
        "far, splats, level 5",
        5,
        false,
        FAR,
        Some(2.85),
    ),
    panel(
        "5-near-points-4.png",
        "near, points, level 4",
        4,
        true,
        NEAR,
        Some(4.15),
    ),
    panel(
        "5-near-points-5.png",
        "near, points, level 5",
        5,
        true,
        NEAR,
        Some(0.63),
    ),
    panel(
        "5-near-splats-5.png",
        "near, splats, level 5",
        5,
        false,
        NEAR,
        Some(1.42),
    ),
];
const FIGURE_6: [Panel; 2] = [
    panel("6-points.png", "points, level 5", 5, true, FAR, None),
    panel(
        "6-multi-level.png",
        "multi-level, level 5",
        5,
        false,
        FAR,
        None,
    ),
];

/// Writes the pictures, and gives what there is to say of them.
///
/// # Errors
/// When a model cannot be read, a picture cannot be written, or the machine
/// cannot be run.
pub fn write(comparison: &Comparison<'_>, subjects: &Subjects) -> Result<String, Error> {
    make_folder(comparison.out)?;
    let mut text = String::from(
        "\n## Figures 5 and 6\n\n\
        All with shadows, drawn in one pass. Points are drawn as pixels or small squares here, too, \
        and holes between them are closed. PSNR is that of the pixels that the model covers, \
        against traced rays.\n",
    );
    let figures: [(&str, &Subject, &[Panel]); 2] = [
        ("Figure 5", &subjects.buddha, &FIGURE_5),
        ("Figure 6", &subjects.dragon, &FIGURE_6),
    ];
    for (title, subject, panels) in figures {
        let (table, pictures) = figure(comparison, subject, panels)?;
        text += &format!(
            "\n### {title}: {} ({})\n\n{table}",
            subject.name, subject.ours
        );
        if let [points, splats] = &pictures[..] {
            let share = 100.0 * differing(points, splats);
            text += &format!("\n{share:.1}% of the drawn pixels differ by more than a tenth.\n");
        }
    }
    Ok(text)
}

/// A figure's table, and its pictures, if the model is there.
fn figure(
    comparison: &Comparison<'_>,
    subject: &Subject,
    panels: &[Panel],
) -> Result<(Table, Vec<Picture>), Error> {
    let mut table = Table::new(&[
        "picture",
        "frames a second, the paper",
        "ours",
        "psnr inside, dB",
    ]);
    let mut pictures = Vec::new();
    let model = subject.load(comparison)?;
    let scene = model
        .as_ref()
        .map(|model| Scene::new(&model.geometry, false));
    for panel in panels {
        let (Some(model), Some(scene)) = (&model, &scene) else {
            table.line(
                format!("{}, needs --models", panel.name),
                [panel.paper, None, None],
                2,
            );
            continue;
        };
        let level = match comparison.quick {
            true => comparison.levels().last().copied().unwrap_or(0),
            false => panel.level,
        };
        let options = GridOptions {
            level,
            ..GridOptions::default()
        };
        let baked = model.baked(options, comparison.progress)?;
        let asset = &baked.asset;
        let mut view = model.views[0].clone();
        view.distance = panel.view.1;
        let camera = core_camera(&view, asset.grid().radius(), &asset.cube());
        let splat = if panel.points {
            SplatPx::ZERO
        } else {
            Quality::SPLAT
        };
        let quality = Quality {
            splat,
            ..Quality::default()
        };
        let shadows = Shadows {
            method: Method::OnePass,
            ..Shadows::default()
        };
        let frame = draw_shadowed(&asset.grid(), &camera, &light(), &quality, &shadows, 1);
        let picture = frame.picture();
        picture.save_png(&comparison.out.join(panel.file))?;
        let lighting = view::Light {
            casts: true,
            ..bright()
        };
        let reference = render(
            scene,
            &float_view(&view, &asset.cube()),
            &lighting.into(),
            DEFAULT_SAMPLES_PER_AXIS,
            &|_| {},
        );
        // Sizes are the view's.
        let measures = against_reference(&picture, None, &reference).ok();
        let psnr = measures.and_then(|measures| measures.psnr_inside);
        let file = asset_file(asset.bytes())?;
        let splat = splat.to_string();
        let options = ["--splat", &splat, "--shadows", "one-pass"];
        let rate = comparison.rate((subject.name, file.path()), panel.view.0, &options)?;
        let name = format!("[{}]({})", panel.name, panel.file);
        table.line(name, [panel.paper, rate, psnr], 2);
        pictures.push(picture);
    }
    Ok((table, pictures))
}

/// The share of pixels that either picture shows in which a channel differs by
/// more than a tenth of full.
fn differing(a: &Picture, b: &Picture) -> f64 {
    let pixels = (0..a.rgb.len()).filter(|&at| a.drawn[at] || b.drawn[at]);
    let pixels: Vec<usize> = pixels.collect();
    let differs = |&&at: &&usize| {
        let channels = a.rgb[at].iter().zip(b.rgb[at]);
        { channels }.any(|(a, b)| a.abs_diff(b) > 25)
    };
    pixels.iter().filter(differs).count() as f64 / pixels.len().max(1) as f64
}
