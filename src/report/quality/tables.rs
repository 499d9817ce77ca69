//! The chapter's tables.

use rhogrid_core::draw::Quality;

use super::super::page::Table;
use super::super::row::{Row, Subject, splat_of};
use super::{DEFAULT, INSTRUCTIONS, PSNR, TIME, VARIANTS, Variant};

/// What less does not make a setting better than a cheaper one, dB.
const LEAST_GAIN: f64 = 0.05;

/// The rows of one model.
pub(super) struct Figures<'a>(pub &'a [&'a Row]);

/// A drawn setting, with what it costs.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub variant: Variant,
    pub level: u8,
    pub splat: f64,
    /// Instructions where they were counted, else nanoseconds.
    pub cost: f64,
    pub psnr: f64,
}

impl Figures<'_> {
    /// A subject's quality that has no options.
    pub fn plain(&self, subject: Subject) -> Option<f64> {
        let row = self
            .0
            .iter()
            .find(|row| row.setting.subject == subject && row.measure == PSNR);
        row.map(|row| row.value)
    }

    /// What is measured of a drawn setting.
    fn drawn(
        &self,
        subject: Subject,
        variant: Variant,
        level: u8,
        splat: f64,
        measure: &str,
    ) -> Option<f64> {
        let row = self.0.iter().find(|row| {
            let setting = &row.setting;
            let is_size = |quality: Quality| splat_of(&quality) == splat;
            setting.subject == subject
                && row.measure == measure
                && variant.is_of(setting)
                && setting.bake.is_some_and(|bake| bake.level == level)
                && setting.quality.is_some_and(is_size)
        });
        row.map(|row| row.value)
    }

    /// Levels and splat sizes, each once, in order.
    pub fn levels(&self) -> Vec<u8> {
        let mut levels: Vec<u8> = self
            .0
            .iter()
            .filter_map(|row| Some(row.setting.bake?.level))
            .collect();
        levels.sort_unstable();
        levels.dedup();
        levels
    }

    /// Splat sizes, each once, in order.
    pub fn splats(&self) -> Vec<f64> {
        let sizes = self
            .0
            .iter()
            .filter_map(|row| Some(splat_of(&row.setting.quality?)));
        let mut sizes: Vec<f64> = sizes.collect();
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        sizes
    }

    /// What cost is measured by.
    pub fn cost_measure(&self) -> &'static str {
        match self.0.iter().any(|row| row.measure == INSTRUCTIONS) {
            true => INSTRUCTIONS,
            false => TIME,
        }
    }

    /// The settings of a variant and a level, by splat size.
    pub fn curve(&self, variant: Variant, level: u8) -> Vec<Point> {
        let point = |splat| {
            Some(Point {
                variant,
                level,
                splat,
                cost: self.drawn(Subject::Core, variant, level, splat, self.cost_measure())?,
                psnr: self.drawn(Subject::Core, variant, level, splat, PSNR)?,
            })
        };
        self.splats().into_iter().filter_map(point).collect()
    }

    /// The best of a float subject: quality, level, splat size.
    pub fn best_in_float(&self, subject: Subject) -> Option<(f64, u8, f64)> {
        let all = self.levels().into_iter().flat_map(|level| {
            self.splats().into_iter().filter_map(move |splat| {
                Some((
                    self.drawn(subject, DEFAULT, level, splat, PSNR)?,
                    level,
                    splat,
                ))
            })
        });
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The settings that no cheaper one equals in quality, cheapest first.
    pub fn front(&self) -> Vec<Point> {
        let levels = self.levels();
        let curves = VARIANTS.iter().flat_map(|&variant| {
            levels
                .iter()
                .flat_map(move |&level| self.curve(variant, level))
        });
        let mut points: Vec<Point> = curves.collect();
        points.sort_by(|a, b| a.cost.total_cmp(&b.cost).then(b.psnr.total_cmp(&a.psnr)));
        let mut best = f64::NEG_INFINITY;
        points.retain(|point| {
            let is_better = point.psnr > best + LEAST_GAIN;
            if is_better {
                best = point.psnr;
            }
            is_better
        });
        points
    }
}

pub(super) fn write(rows: &[&Row]) -> String {
    let figures = Figures(rows);
    let tables = [bounds, changes, by_level, front];
    tables.map(|table| table(&figures)).join("\n")
}

/// The ceiling, and the best that was drawn.
fn bounds(figures: &Figures<'_>) -> String {
    let ceiling = figures.plain(Subject::Mesh);
    let mut table = Table::new(&["", "psnr_inside, dB", "below the ceiling, dB"]);
    let mut line = |name: String, value: Option<f64>| {
        let below = ceiling.zip(value).map(|(ceiling, value)| ceiling - value);
        table.line(name, [value, below], 2);
    };
    for subject in [Subject::Rgb565, Subject::MeshTrueColour, Subject::Mesh] {
        line(subject.name().into(), figures.plain(subject));
    }
    if let Some(best) = figures.front().last() {
        line(format!("the grid's best: {}", name(best)), Some(best.psnr));
    }
    for subject in [Subject::Centres, Subject::Points] {
        if let Some((psnr, level, splat)) = figures.best_in_float(subject) {
            line(
                format!("{}, best: level {level}, splat {splat}", subject.name()),
                Some(psnr),
            );
        }
    }
    table.to_string()
}

/// The default splat size, or what is nearest to it.
fn default_splat(figures: &Figures<'_>) -> f64 {
    let default = splat_of(&Quality::default());
    let distance = |size: &f64| (size - default).abs();
    let sizes = figures.splats().into_iter();
    let nearest = sizes.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.unwrap_or(default)
}

/// What single changes to one setting buy: the finest level but one, at the
/// default splat size.
fn changes(figures: &Figures<'_>) -> String {
    let (levels, splat) = (figures.levels(), default_splat(figures));
    let Some(&level) = levels.iter().rev().nth(1).or(levels.first()) else {
        return String::new();
    };
    let core = |variant, level, splat| {
        let mut curve = figures.curve(variant, level).into_iter();
        curve.find(|point| point.splat == splat)
    };
    let Some(base) = core(DEFAULT, level, splat) else {
        return String::new();
    };
    let heading = format!("changed from: {}", name(&base));
    let mut table = Table::new(&[&heading, "psnr_inside, dB", "dB gained", "cost, times"]);
    let mut line = |name: String, point: Option<Point>| {
        let Some(Point { psnr, cost, .. }) = point else {
            return;
        };
        let values = [psnr, psnr - base.psnr, cost / base.cost];
        table.line(name, values.map(Some), 2);
    };
    line("nothing".into(), Some(base));
    for &other in levels.iter().filter(|&&other| other != level) {
        line(format!("level {other}"), core(DEFAULT, other, splat));
    }
    for other in figures.splats().into_iter().filter(|&other| other != splat) {
        line(format!("splat {other}"), core(DEFAULT, level, other));
    }
    for variant in &VARIANTS[1..] {
        line(variant.name.into(), core(*variant, level, splat));
    }
    for subject in [Subject::Centres, Subject::Points] {
        let psnr = figures.drawn(subject, DEFAULT, level, splat, PSNR);
        let gained = psnr.map(|psnr| psnr - base.psnr);
        table.line(subject.name().into(), [psnr, gained, None], 2);
    }
    table.to_string()
}

/// Quality of every level at the default splat size.
fn by_level(figures: &Figures<'_>) -> String {
    let (levels, splat) = (figures.levels(), default_splat(figures));
    let mut columns = vec![format!("psnr_inside at splat {splat}, dB")];
    columns.extend(levels.iter().map(|level| format!("level {level}")));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let mut table = Table::new(&columns);
    let mut line = |name: &str, subject, variant| {
        let of = |&level| figures.drawn(subject, variant, level, splat, PSNR);
        table.line(name.into(), levels.iter().map(of), 2);
    };
    for variant in VARIANTS {
        line(variant.name, Subject::Core, variant);
    }
    line(Subject::Centres.name(), Subject::Centres, DEFAULT);
    line(Subject::Points.name(), Subject::Points, DEFAULT);
    table.to_string()
}

fn name(point: &Point) -> String {
    format!(
        "level {}, splat {}, {}",
        point.level, point.splat, point.variant.name
    )
}

/// What each further decibel costs.
fn front(figures: &Figures<'_>) -> String {
    let (unit, factor) = match figures.cost_measure() {
        INSTRUCTIONS => ("million instructions", 1e-6),
        _ => ("host ms", 1e-6),
    };
    let ceiling = figures.plain(Subject::Mesh);
    let gained = "gained on the line above, dB";
    let mut table = Table::new(&[
        "better than all that is cheaper",
        unit,
        "psnr_inside, dB",
        "below the ceiling, dB",
        gained,
        "at a cost of, times",
    ]);
    let mut before: Option<Point> = None;
    for point in figures.front() {
        let below = ceiling.map(|ceiling| ceiling - point.psnr);
        let gain = before.map(|before| point.psnr - before.psnr);
        let times = before.map(|before| point.cost / before.cost);
        let values = [
            Some(point.cost * factor),
            Some(point.psnr),
            below,
            gain,
            times,
        ];
        table.line(name(&point), values, 2);
        before = Some(point);
    }
    table.to_string()
}
