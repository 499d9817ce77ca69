//! The paper's tables and figures, its numbers beside ours.
//!
//! Source: Duguet and Drettakis 2003, tables 1 to 5, figures 5 and 6. Their
//! machine is an iPAQ with a 200 MHz SA-1110; ours is one under QEMU, with an
//! estimate of its cycles. Models stand in for those that are not to be had.

mod drawing;
mod figures;
mod normals;
mod rates;
mod statistics;
mod subject;

use std::path::Path;
use std::process::Command;

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
    /// Level 3 of built-in models alone.
    pub quick: bool,
    /// Hears what is being done.
    pub progress: Progress<'a>,
}

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
            project at commit {}: `{}`. Pictures are 240x320.\n",
            commit(),
            self.command()
        );
        text += &self.by_rho(&subjects)?;
        text += &normals::table();
        text += &statistics::table(self, &subjects)?;
        text += &rates::table(self, &subjects)?;
        text += &figures::write(self, &subjects)?;
        Ok(text)
    }

    /// Tables 1 and 2: rho.
    fn by_rho(&self, subjects: &Subjects) -> Result<String, Error> {
        let effort = if self.quick { &SMALL } else { &Effort::FULL };
        let built_in;
        let model = match subjects.bunny.load(self)? {
            Some(model) => model,
            None => {
                built_in = Model::builtin(effort)?;
                &built_in
            }
        };
        let means = Means {
            effort,
            machine: None,
            progress: self.progress,
        };
        let mut text = String::new();
        for (number, chapter) in [(1, memory::CHAPTER), (2, operations::CHAPTER)] {
            let rows = (chapter.measure)(model, means)?;
            let rows: Vec<_> = rows.iter().collect();
            text += &format!(
                "\n## Table {number}: {}\n\nModel: {}, full views.\n\n{}\n{}",
                chapter.title,
                model.name,
                chapter.introduction,
                (chapter.write)(&rows)
            );
        }
        model.forget();
        Ok(text)
    }

    /// The command that makes the page.
    fn command(&self) -> String {
        let mut command = String::from("rhogrid report paper");
        if self.quick {
            command += " --quick";
        }
        if let Some(models) = self.models {
            command += &format!(" --models {}", models.display());
        }
        if let Some(machine) = self.machine {
            command += &format!(" --machine {}", machine.name);
        }
        command + &format!(" --out {}", self.out.display())
    }

    /// Levels of tables and figures.
    fn levels(&self) -> &'static [u8] {
        if self.quick { &[3] } else { &[3, 4, 5] }
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
        git(&["status", "--porcelain", "--untracked-files=no"]),
    ) {
        (Some(commit), Some(changes)) if changes.is_empty() => commit,
        (Some(commit), _) => format!("{commit}-dirty"),
        _ => "unknown".into(),
    }
}
