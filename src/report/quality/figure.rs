//! `quality.svg`: a panel for each model, cost against quality.

use super::super::models_of;
use super::super::plot::{Across, Curve, Figure, Marker, Note, Panel, Style};
use super::super::row::{Row, Subject};
use super::tables::Figures;
use super::{DEFAULT, INSTRUCTIONS, VARIANTS};

/// A colour for each level, told apart by colour-blind readers, too (Okabe and
/// Ito, Color Universal Design, 2008).
const COLOURS: [[u8; 3]; 4] = [[230, 159, 0], [213, 94, 0], [0, 158, 115], [0, 114, 178]];
const BLACK: [u8; 3] = [0; 3];
const GREY: [u8; 3] = [130; 3];

/// How a variant is drawn: dash, marker, stroke.
const LOOKS: [(Option<[u32; 2]>, Marker, u32); VARIANTS.len()] = [
    (None, Marker::Circle, 2),
    (Some([7, 4]), Marker::Square, 1),
    (Some([2, 3]), Marker::Triangle, 1),
    (Some([12, 3]), Marker::Cross, 1),
];

fn colour(at: usize) -> [u8; 3] {
    COLOURS[at % COLOURS.len()]
}

fn style(variant: usize, colour: [u8; 3]) -> Style {
    let (dash, marker, stroke_px) = LOOKS[variant];
    Style {
        colour,
        dash,
        marker,
        stroke_px,
    }
}

pub(super) fn draw(rows: &[&Row]) -> String {
    let models = models_of(rows);
    let levels = Figures(rows).levels();
    let key = |(at, level): (usize, &u8)| {
        let plain = Style {
            marker: Marker::None,
            ..style(0, colour(at))
        };
        (format!("level {level}"), plain)
    };
    let looks = |(at, variant): (usize, &super::Variant)| (variant.name.into(), style(at, GREY));
    let panel = |model: &str| {
        let own = rows.iter().filter(|row| row.model == model);
        let own: Vec<&Row> = own.copied().collect();
        panel(model, &Figures(&own))
    };
    let figure = Figure {
        legend: vec![
            levels.iter().enumerate().map(key).collect(),
            VARIANTS.iter().enumerate().map(looks).collect(),
        ],
        panels: models.into_iter().map(panel).collect(),
    };
    figure.svg()
}

fn panel(model: &str, figures: &Figures<'_>) -> Panel {
    let mut curves = Vec::new();
    let levels = figures.levels();
    // The defaults last: on top.
    for (variant, own) in VARIANTS.iter().enumerate().rev() {
        for (at, &level) in levels.iter().enumerate() {
            let points = figures.curve(*own, level);
            curves.push(Curve {
                points: points
                    .iter()
                    .map(|point| (point.cost * 1e-6, point.psnr))
                    .collect(),
                style: style(variant, colour(at)),
            });
        }
    }
    let finest = levels.last().map(|&level| figures.curve(DEFAULT, level));
    let note = |point: super::tables::Point| Note {
        at: (point.cost * 1e-6, point.psnr),
        text: point.splat.to_string(),
    };
    let cost = match figures.cost_measure() {
        INSTRUCTIONS => "million instructions of the draw call",
        _ => "host milliseconds of the draw call",
    };
    Panel {
        title: format!("{model}, full view"),
        x_label: format!("{cost}; numbers at points: --splat, px"),
        y_label: "psnr_inside, dB".into(),
        curves,
        across: across(figures),
        notes: finest.into_iter().flatten().map(note).collect(),
    }
}

/// The ceiling, and what positions inside the cell would reach.
fn across(figures: &Figures<'_>) -> Vec<Across> {
    let line = |y: f64, label: String, colour, dash| Across {
        y,
        label: format!("{y:.1} dB: {label}"),
        style: Style {
            colour,
            dash,
            marker: Marker::None,
            stroke_px: 2,
        },
    };
    let mut lines = Vec::new();
    if let Some(y) = figures.plain(Subject::Mesh) {
        lines.push(line(
            y,
            "ceiling: mesh, 1 sample a pixel".into(),
            BLACK,
            None,
        ));
    }
    for (subject, what, dash) in [
        (Subject::Points, "points inside cells", [10, 4]),
        (Subject::Centres, "cell centres", [3, 3]),
    ] {
        if let Some((y, level, _)) = figures.best_in_float(subject) {
            let label = format!("{what} (float, level {level})");
            lines.push(line(y, label, GREY, Some(dash)));
        }
    }
    lines
}
