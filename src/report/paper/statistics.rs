//! Table 4: samples, alpha and file sizes.

use rhogrid_core::asset::Shell;

use super::Comparison;
use super::subject::Subjects;
use crate::bake::GridOptions;
use crate::cli::Description;
use crate::error::Error;
use crate::geometry::Geometry;
use crate::report::page::Table;

/// Table 4, a model: polygons; samples, alpha and bytes at levels 3, 4 and 5.
struct Printed {
    polygons: f64,
    samples: [f64; 3],
    alpha: [f64; 3],
    bytes: [f64; 3],
}

const fn printed(polygons: f64, samples: [f64; 3], alpha: [f64; 3], bytes: [f64; 3]) -> Printed {
    Printed {
        polygons,
        samples,
        alpha,
        bytes,
    }
}

/// In the order of [`Subjects::all`].
const TABLE_4: [Printed; 6] = [
    printed(
        69e3,
        [26e3, 230e3, 2.1e6],
        [9.36, 9.03, 9.0],
        [76.8e3, 698e3, 6.28e6],
    ),
    printed(
        870e3,
        [18e3, 170e3, 1.5e6],
        [9.75, 9.19, 9.04],
        [54.5e3, 506e3, 4.6e6],
    ),
    printed(
        1.08e6,
        [14e3, 130e3, 1.2e6],
        [10.3, 9.45, 9.07],
        [41.5e3, 396e3, 3.65e6],
    ),
    printed(
        1.76e6,
        [17e3, 180e3, 1.7e6],
        [13.19, 10.77, 9.26],
        [46.2e3, 520e3, 5.06e6],
    ),
    printed(
        540e3,
        [40e3, 370e3, 3.2e6],
        [11.45, 9.18, 8.63],
        [114e3, 1.1e6, 9.77e6],
    ),
    printed(
        420e3,
        [45e3, 430e3, 3.4e6],
        [13.62, 9.62, 7.84],
        [121e3, 1.28e6, 10.7e6],
    ),
];

/// The table.
///
/// # Errors
/// When a model cannot be read or baked.
pub fn table(comparison: &Comparison<'_>, subjects: &Subjects) -> Result<String, Error> {
    let mut text = String::from(
        "\n## Table 4: the models\n\n\
        Thousands of polygons and leaf samples; alpha, the mean number of non-empty subcells of \
        the level above the leaves; files in thousand bytes, 16 bits an attribute. The paper's \
        cells are those that the surface touches: our fat shell. Thin ones are the default.\n\n",
    );
    let mut table = Table::new(&[
        "model, level",
        "polygons, the paper",
        "ours",
        "samples, the paper",
        "fat",
        "thin",
        "alpha, the paper",
        "fat",
        "file, the paper",
        "fat",
        "thin",
    ]);
    for (subject, paper) in subjects.all().into_iter().zip(&TABLE_4) {
        let model = subject.load(comparison)?;
        let polygons = model.as_ref().map(|model| match &model.geometry {
            Geometry::Mesh(mesh) => mesh.triangles.len() as f64 / 1e3,
            Geometry::Cloud(_) => 0.0,
        });
        for &level in comparison.levels() {
            let at = usize::from(level - 3);
            let own = |shell| {
                let model = model.as_ref()?;
                let options = GridOptions {
                    level,
                    shell,
                    ..GridOptions::default()
                };
                let baked = model.baked(options, comparison.progress);
                let counts = baked.map(|baked| Counts::of(&Description::of(&baked.asset)));
                model.forget();
                Some(counts)
            };
            let fat = own(Shell::Fat).transpose()?;
            let thin = own(Shell::Thin).transpose()?;
            let thousands = |of: fn(&Counts) -> f64, counts: &Option<Counts>| {
                counts.as_ref().map(|counts| of(counts) / 1e3)
            };
            let values = [
                Some(paper.polygons / 1e3),
                polygons,
                Some(paper.samples[at] / 1e3),
                thousands(|counts| counts.leaves, &fat),
                thousands(|counts| counts.leaves, &thin),
                Some(paper.alpha[at]),
                fat.as_ref().map(|counts| counts.alpha),
                Some(paper.bytes[at] / 1e3),
                thousands(|counts| counts.bytes, &fat),
                thousands(|counts| counts.bytes, &thin),
            ];
            let there = if model.is_some() { "" } else { ", not there" };
            let name = format!("{} ({}{there}), {level}", subject.name, subject.ours);
            table.line(name, values, 2);
        }
    }
    text += &table.to_string();
    Ok(text)
}

/// What an asset holds.
struct Counts {
    leaves: f64,
    alpha: f64,
    bytes: f64,
}

impl Counts {
    fn of(description: &Description) -> Self {
        let count = |from_last: usize| {
            let cells = description.cells_per_depth.iter().rev().nth(from_last);
            cells.map_or(1.0, |&cells| cells as f64)
        };
        let drawn = description.drawn_cells_per_depth.last();
        Self {
            leaves: drawn.map_or(1.0, |&drawn| drawn as f64),
            alpha: count(0) / count(1),
            bytes: description.bytes_total as f64,
        }
    }
}
