//! The paper's tables and figures, its numbers beside ours.
//!
//! Source: Duguet and Drettakis 2003, tables 1 to 5, figures 5 and 6. Their
//! machine is an iPAQ with a 200 MHz SA-1110; ours is one under QEMU, with an
//! estimate of its cycles. Models stand in for those that are not to be had.

mod figures;
mod rates;
mod statistics;
mod subject;

use std::path::Path;
use std::process::Command;

use rhogrid_core::normal::{decode, encode};

use super::machine::asset_file;
use super::page::Table;
use super::{Effort, Machine, Means, Model, Progress, memory, operations};
use crate::error::Error;
use subject::Subjects;

/// What the paper is held against.
#[derive(Clone, Copy)]
pub struct Comparison<'a> {
    /// Folder of models; without one, built-in models alone.
    pub models: Option<&'a Path>,
    /// Folder of the pictures; made where it is absent.
    pub out: &'a Path,
    /// Counts cycles.
    pub machine: Option<&'a Machine>,
    /// Level 3 alone.
    pub quick: bool,
    /// Hears what is being done.
    pub progress: Progress<'a>,
}

/// Clock of the paper's machine, Hz.
const CLOCK: f64 = 200e6;

impl Comparison<'_> {
    /// Measures, writes the pictures, and gives the page, Markdown.
    ///
    /// # Errors
    /// When a model or a picture cannot be read or written, or the machine
    /// cannot be run.
    pub fn page(&self) -> Result<String, Error> {
        let subjects = Subjects::new(self.models)?;
        let mut text = format!(
            "# The paper's tables and figures\n\n\
            Duguet and Drettakis, Flexible Point-Based Rendering on Mobile Devices, 2003, and this \
            project at commit {}. Pictures are 240x320.\n",
            commit()
        );
        text += &self.by_rho(&subjects)?;
        text += &normals();
        text += &statistics::table(self, &subjects)?;
        text += &rates::table(self, &subjects)?;
        text += &figures::write(self, &subjects)?;
        Ok(text)
    }

    /// Tables 1 and 2: rho.
    fn by_rho(&self, subjects: &Subjects) -> Result<String, Error> {
        let effort = if self.quick { &SMALL } else { &Effort::FULL };
        let model = match subjects.bunny.load(self)? {
            Some(model) => model,
            None => Model::builtin(effort)?,
        };
        let means = Means {
            effort,
            machine: None,
            progress: self.progress,
        };
        let mut text = String::new();
        for (number, chapter) in [(1, memory::CHAPTER), (2, operations::CHAPTER)] {
            let rows = (chapter.measure)(&model, means)?;
            let rows: Vec<_> = rows.iter().collect();
            text += &format!(
                "\n## Table {number}: {}\n\nModel: {}, full views.\n\n{}\n{}",
                chapter.title,
                model.name,
                chapter.introduction,
                (chapter.write)(&rows)
            );
        }
        Ok(text)
    }

    /// Levels of tables and figures.
    fn levels(&self) -> &'static [u8] {
        if self.quick { &[3] } else { &[3, 4, 5] }
    }

    /// Cycles of a machine as frames a second of the paper's, of an asset or a
    /// scene with a name.
    fn rate(
        &self,
        (name, input): (&str, &Path),
        view: &str,
        options: &[&str],
    ) -> Result<Option<f64>, Error> {
        let Some(machine) = self.machine else {
            return Ok(None);
        };
        (self.progress)(&format!("{name}: draws {view} {}", options.join(" ")));
        let mut all = vec!["--view", view];
        all.extend(options);
        if let Some(models) = self.models.and_then(Path::to_str)
            && input
                .extension()
                .is_some_and(|extension| extension == "toml")
        {
            all.extend(["--models", models]);
        }
        Ok(machine.cycles(input, &all)?.map(|cycles| CLOCK / cycles))
    }
}

/// What quick comparisons sweep.
const SMALL: Effort = Effort {
    width: 48,
    height: 64,
    cells: 27,
    rounds: 1,
    ..Effort::QUICK
};

/// The working copy's commit, if this is one.
fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    match (
        git(&["rev-parse", "--short", "HEAD"]),
        git(&["status", "--porcelain"]),
    ) {
        (Some(commit), Some(changes)) if changes.is_empty() => commit,
        (Some(commit), _) => format!("{commit}, changed since"),
        _ => "unknown".into(),
    }
}

/// Table 3: largest error of a dot product with a quantized normal, by level.
const TABLE_3: [(u8, f64); 5] = [(3, 0.017), (4, 0.004), (5, 0.001), (6, 2.6e-4), (7, 6.4e-5)];

/// The level of our code: 2^13 normals.
const OUR_LEVEL: u8 = 5;

fn normals() -> String {
    let mut table = Table::new(&["level", "the paper", "ours"]);
    for (level, paper) in TABLE_3 {
        let ours = (level == OUR_LEVEL).then(largest_normal_error);
        table.line(level.to_string(), [Some(paper), ours], 6);
    }
    format!(
        "\n## Table 3: error of a dot product by the level of normals\n\n\
        One less the cosine between a random normal and what its code stands for, at most. \
        There is one code here, of level {OUR_LEVEL}: 13 bits.\n\n{table}"
    )
}

/// Over directions that are spread evenly.
fn largest_normal_error() -> f64 {
    const COUNT: u32 = 200_000;
    let error = |index: u32| {
        let height = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(COUNT);
        let around = (1.0 - height * height).sqrt();
        let turn = f64::from(index) * 2.399_963_229_728_653;
        let normal = [around * turn.cos(), height, around * turn.sin()];
        let code = encode(normal.map(|c| (c * f64::from(1 << 24)) as i32));
        let own = decode(code).map(f64::from);
        let length = own.iter().map(|c| c * c).sum::<f64>().sqrt();
        let dot: f64 = normal.iter().zip(own).map(|(a, b)| a * b).sum();
        1.0 - dot / length
    };
    (0..COUNT).map(error).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_as_exact_as_the_papers() {
        let paper = TABLE_3.iter().find(|(level, _)| *level == OUR_LEVEL);
        let (_, paper) = paper.expect("the level of our code");
        let ours = largest_normal_error();
        assert!(ours < *paper && ours > 0.8 * paper, "{ours}");
    }
}
