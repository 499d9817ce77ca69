//! Reports: what settings cost and how good they are, measured.
//!
//! ```text
//! Model: geometry, views, reference, bakes -+
//!                                           +-> Chapter::measure -> rows -> data.csv
//! Effort: what is swept, how often ---------+                        |
//!                                   Chapter::write, Chapter::plot <--+-> report.md, SVG
//! ```
//!
//! Everything that is measured is a [`Row`]; pages and plots are made of rows
//! alone.

mod effort;
mod float;
mod machine;
mod memory;
mod model;
mod operations;
mod page;
mod paper;
mod plot;
mod quality;
mod row;
mod timing;

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::geometry::Up;
use crate::output::write_whole;

pub use effort::Effort;
pub use machine::Machine;
pub use model::Model;
pub use paper::Comparison;
pub use row::{Row, Setting, Subject, write_csv};

/// Hears what is being done.
pub type Progress<'a> = &'a dyn Fn(&str);

/// What chapters measure with.
#[derive(Clone, Copy)]
pub struct Means<'a> {
    /// How much.
    pub effort: &'a Effort,
    /// Counts instructions, too.
    pub machine: Option<&'a Machine>,
    /// Hears what is being done.
    pub progress: Progress<'a>,
}

/// A question and how it is answered.
struct Chapter {
    /// In the first column of its rows.
    name: &'static str,
    /// Its heading.
    title: &'static str,
    /// Measures one model.
    measure: fn(&Model, Means<'_>) -> Result<Vec<Row>, Error>,
    /// Its part of the page, from its rows of one model.
    write: fn(&[&Row]) -> String,
    /// What the page says before all models.
    introduction: &'static str,
    /// A picture of its rows: name and content.
    plot: Option<Plot>,
}

/// A picture of a chapter's rows.
struct Plot {
    /// Its file's name.
    file: &'static str,
    /// Draws it, SVG.
    draw: fn(&[&Row]) -> String,
}

/// The chapters, in the page's order.
const CHAPTERS: [Chapter; 3] = [memory::CHAPTER, operations::CHAPTER, quality::CHAPTER];

/// The files that a report looks for in a folder of models, and which of
/// their axes points up.
const MODELS: [(&str, Up); 2] = [("bunny.ply", Up::Y), ("buddha_100k.ply", Up::Z)];

/// A finished report.
pub struct Report {
    effort: Effort,
    machine: Option<Machine>,
    rows: Vec<Row>,
}

/// Loads what a folder has of the report's models; without a folder it is the
/// built-in scene.
///
/// # Errors
/// When the folder has none of them, or one cannot be read.
pub fn models(folder: Option<&Path>, effort: &Effort) -> Result<Vec<Model>, Error> {
    let Some(folder) = folder else {
        return Ok(vec![Model::builtin(effort)?]);
    };
    let paths = MODELS.map(|(file, up)| (folder.join(file), up));
    let there = paths.iter().filter(|(path, _)| path.is_file());
    let models: Vec<Model> = there
        .map(|(path, up)| Model::load(path, *up, effort))
        .collect::<Result<_, _>>()?;
    if models.is_empty() {
        let names = MODELS.map(|(file, _)| file).join(", ");
        return Err(Error::file(
            folder,
            "holds no model that a report is of",
            format!("give a folder with one of {names}, or leave --models out"),
        ));
    }
    Ok(models)
}

/// Makes the folder of a report where it is absent, and sees that files can be
/// made in it.
///
/// # Errors
/// When that is not possible.
pub fn make_folder(folder: &Path) -> Result<(), Error> {
    let made = std::fs::create_dir_all(folder);
    let probed = made.and_then(|()| tempfile::tempfile_in(folder));
    probed.map(|_| ()).map_err(|error| {
        let what = format!("cannot be written to: {error}");
        Error::file(folder, what, "name a folder that may be")
    })
}

/// Measures all chapters of all models.
///
/// # Errors
/// When something cannot be baked, or the machine fails.
pub fn measure(models: &[Model], means: Means<'_>) -> Result<Report, Error> {
    let mut rows = Vec::new();
    for model in models {
        for chapter in &CHAPTERS {
            (means.progress)(&format!("{}: {}", model.name, chapter.title));
            rows.extend((chapter.measure)(model, means)?);
        }
        model.forget();
    }
    Ok(Report {
        effort: *means.effort,
        machine: means.machine.cloned(),
        rows,
    })
}

impl Report {
    /// All figures.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Writes `report.md`, `data.csv` and the plots to a folder, each whole or
    /// not at all; gives their names.
    ///
    /// # Errors
    /// Whatever the file system has against one of them.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, Error> {
        let mut files: Vec<(&str, Vec<u8>)> = Vec::new();
        for chapter in &CHAPTERS {
            if let Some(Plot { file, draw }) = &chapter.plot {
                let rows = of_chapter(&self.rows, chapter.name);
                files.push((file, draw(&rows).into_bytes()));
            }
        }
        let mut data = Vec::new();
        write_csv(&self.rows, &mut data)
            .map_err(|error| Error::file(folder, format!("no CSV: {error}"), "report this"))?;
        files.push(("data.csv", data));
        files.push(("report.md", page::page(self).into_bytes()));
        let write = |(name, bytes): &(&str, Vec<u8>)| {
            let path = folder.join(name);
            write_whole(&path, |file| file.write_all(bytes))?;
            Ok(path)
        };
        files.iter().map(write).collect()
    }
}

fn of_chapter<'a>(rows: &'a [Row], chapter: &str) -> Vec<&'a Row> {
    rows.iter().filter(|row| row.chapter == chapter).collect()
}

/// The models of rows, each once, in order.
fn models_of<'a>(rows: &[&'a Row]) -> Vec<&'a str> {
    let mut models: Vec<&str> = rows.iter().map(|row| row.model.as_str()).collect();
    models.dedup();
    models
}
