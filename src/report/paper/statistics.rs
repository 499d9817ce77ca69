//! Table 4: samples, alpha and file sizes.

use std::iter::Sum;

use rhogrid_core::asset::Shell;

use super::Comparison;
use super::subject::{Subjects, line};
use crate::bake::GridOptions;
use crate::cli::Description;
use crate::error::Error;
use crate::geometry::Geometry;
use crate::report::Model;
use crate::report::page::Table;

/// Table 4, a model: thousand polygons; thousand samples, alpha and thousand
/// bytes at levels 3, 4 and 5.
struct Printed {
    polygons: f64,
    samples: [f64; 3],
    alpha: Option<[f64; 3]>,
    bytes: [f64; 3],
}

/// In the order of [`Subjects::all`].
#[rustfmt::skip]
const TABLE_4: [Printed; 6] = [
    Printed { polygons: 69.0, samples: [26.0, 230.0, 2100.0], alpha: Some([9.36, 9.03, 9.0]), bytes: [76.8, 698.0, 6280.0] },
    Printed { polygons: 870.0, samples: [18.0, 170.0, 1500.0], alpha: Some([9.75, 9.19, 9.04]), bytes: [54.5, 506.0, 4600.0] },
    Printed { polygons: 1080.0, samples: [14.0, 130.0, 1200.0], alpha: Some([10.3, 9.45, 9.07]), bytes: [41.5, 396.0, 3650.0] },
    Printed { polygons: 1760.0, samples: [17.0, 180.0, 1700.0], alpha: Some([13.19, 10.77, 9.26]), bytes: [46.2, 520.0, 5060.0] },
    Printed { polygons: 540.0, samples: [40.0, 370.0, 3200.0], alpha: Some([11.45, 9.18, 8.63]), bytes: [114.0, 1100.0, 9770.0] },
    Printed { polygons: 420.0, samples: [45.0, 430.0, 3400.0], alpha: Some([13.62, 9.62, 7.84]), bytes: [121.0, 1280.0, 10700.0] },
];
#[rustfmt::skip]
const BIG_SCENE: Printed =
    Printed { polygons: 4670.0, samples: [134.0, 1280.0, 11000.0], alpha: None, bytes: [377.0, 4500.0, 40000.0] };

/// The level of the first of three printed numbers.
const FIRST_LEVEL: u8 = 3;

const COLUMNS: [&str; 12] = [
    "model, level",
    "polygons, the paper",
    "ours",
    "samples, the paper",
    "fat",
    "thin",
    "alpha, the paper",
    "fat",
    "thin",
    "file, the paper",
    "fat",
    "thin",
];

/// The table.
///
/// # Errors
/// When a model cannot be read or baked.
pub fn table(comparison: &Comparison<'_>, subjects: &Subjects) -> Result<String, Error> {
    let mut table = Table::new(&COLUMNS);
    let levels = comparison.levels();
    let mut together: Vec<Vec<Counts>> = vec![Vec::new(); levels.len()];
    for (subject, printed) in subjects.all().into_iter().zip(&TABLE_4) {
        let is_in_scene = subjects
            .of_big_scene()
            .iter()
            .any(|own| own.name == subject.name);
        for (&level, together) in levels.iter().zip(&mut together) {
            let model = subject.load(comparison)?;
            let counts = model.map(|model| Counts::of(comparison, model, level));
            let counts = counts.transpose()?;
            table.line(
                subject.line(level),
                printed.beside(level, counts.as_ref()),
                2,
            );
            together.extend(counts.filter(|_| is_in_scene));
        }
    }
    for (&level, together) in levels.iter().zip(together) {
        let absence = subjects.absence_from_big_scene();
        let sum = absence
            .is_none()
            .then(|| together.into_iter().sum::<Counts>());
        let name = line("Big Scene (its five models)", level, absence);
        table.line(name, BIG_SCENE.beside(level, sum.as_ref()), 2);
    }
    Ok(format!(
        "\n## Table 4: the models\n\n\
        Thousands of polygons and leaf samples; alpha, the samples of a level over those of the \
        level before it, which is the mean number of non-empty subcells there; files in thousand \
        bytes, with all that they hold, 16 bits an attribute. The paper's cells are those that the \
        surface touches: our fat shell. Thin ones are the default. The Big Scene is the sum of all \
        but the bunny, as the paper's samples are; without the ground. No view.\n\n{table}"
    ))
}

impl Printed {
    /// The cells of a level's line.
    fn beside(&self, level: u8, ours: Option<&Counts>) -> Vec<Option<f64>> {
        let at = usize::from(level - FIRST_LEVEL);
        let shells = |of: fn(&Shelled) -> Option<f64>| {
            let shells = |ours: &Counts| [of(&ours.fat), of(&ours.thin)];
            ours.map_or([None; 2], shells)
        };
        let mut cells = vec![Some(self.polygons), ours.map(|ours| ours.polygons / 1e3)];
        cells.push(Some(self.samples[at]));
        cells.extend(shells(|shell| Some(shell.samples / 1e3)));
        cells.push(self.alpha.map(|alpha| alpha[at]));
        cells.extend(shells(|shell| shell.alpha));
        cells.push(Some(self.bytes[at]));
        cells.extend(shells(|shell| Some(shell.bytes / 1e3)));
        cells
    }
}

/// What a model is baked into.
#[derive(Clone)]
struct Counts {
    polygons: f64,
    fat: Shelled,
    thin: Shelled,
}

/// What an asset holds.
#[derive(Clone)]
struct Shelled {
    samples: f64,
    /// `None` for several assets.
    alpha: Option<f64>,
    bytes: f64,
}

impl Counts {
    fn of(comparison: &Comparison<'_>, model: &Model, level: u8) -> Result<Self, Error> {
        // Thin ones last: frames may be drawn of them.
        model.forget();
        let own = |shell| {
            let options = GridOptions {
                level,
                shell,
                ..GridOptions::default()
            };
            let baked = model.baked(options, comparison.progress)?;
            Ok(Shelled::of(&Description::of(&baked.asset)))
        };
        let fat = own(Shell::Fat)?;
        model.forget();
        Ok(Self {
            polygons: match &model.geometry {
                Geometry::Mesh(mesh) => mesh.triangles.len() as f64,
                Geometry::Cloud(_) => 0.0,
            },
            fat,
            thin: own(Shell::Thin)?,
        })
    }
}

impl Shelled {
    fn of(description: &Description) -> Self {
        let samples = |above: usize| {
            let drawn = description.drawn_cells_per_depth.iter().rev().nth(above);
            drawn.map_or(1.0, |&drawn| drawn as f64)
        };
        Self {
            samples: samples(0),
            alpha: Some(samples(0) / samples(1)),
            bytes: description.bytes_total as f64,
        }
    }
}

impl Sum for Counts {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        let all: Vec<Self> = all.collect();
        let shells = |of: fn(&Self) -> &Shelled| Shelled {
            samples: all.iter().map(|own| of(own).samples).sum(),
            alpha: None,
            bytes: all.iter().map(|own| of(own).bytes).sum(),
        };
        Self {
            polygons: all.iter().map(|own| own.polygons).sum(),
            fat: shells(|own| &own.fat),
            thin: shells(|own| &own.thin),
        }
    }
}
