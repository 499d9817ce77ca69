//! The command line: one file for each command.

mod args;
mod bake;
mod compare;
mod demo;
mod frame;
mod info;
mod model;
mod render;
mod report;
mod scene;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::error::{Error, Place};

pub use args::{QualityArgs, ShadowChoice, Size, SourceArgs, Triple, ViewArgs};
pub use frame::{
    Frame, core_camera, core_light, core_quality, core_shadows, draw_frame, draw_placed,
    draw_shadowed, float_light, float_view,
};
pub use info::Description;
pub use model::Model;
pub use scene::{ambient, is_scene, lamps, load_scene, placements, with_core};

/// Bakes, previews and measures 3D assets for devices without FPU, GPU or
/// heap. Without a command it runs the demo.
#[derive(Debug, Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Bake a mesh or cloud into a .rho asset
    Bake(bake::BakeArgs),
    /// Describe a .rho asset
    Info(info::InfoArgs),
    /// Draw an asset, mesh or cloud into a PNG
    Render(Box<render::RenderArgs>),
    /// Measure the difference of two pictures
    Compare(compare::CompareArgs),
    /// Measure what settings cost and how good they are
    Report(report::ReportArgs),
}

/// Why a command did not do its work.
#[derive(Debug)]
pub enum Failure {
    /// The command line asks for what is not possible: exit code 2.
    Usage(String),
    /// The work failed: exit code 1.
    Failed(Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

impl Failure {
    /// A failure without a file.
    fn failed(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Failed(Error {
            file: None,
            place: Place::Whole,
            what: what.into(),
            remedy: remedy.into(),
        })
    }
}

/// Parses the process's arguments and runs the command. Exit codes: 0 done,
/// 1 failed, 2 wrong usage.
pub fn run() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command {
        None => demo::run(),
        Some(Command::Bake(args)) => bake::run(&args),
        Some(Command::Info(args)) => info::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Compare(args)) => compare::run(&args),
        Some(Command::Report(args)) => report::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Usage(what)) => {
            eprintln!("error: {what}\n\nFor more information, try '--help'.");
            ExitCode::from(2)
        }
        Err(Failure::Failed(error)) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints one JSON object.
fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(value)
        .map_err(|error| Failure::failed(format!("no JSON: {error}"), "report this"))?;
    say(format_args!("{text}"))
}

/// Writes one line of results to stdout.
///
/// # Errors
/// When nobody takes it: a closed pipe, a full disk.
fn say(line: std::fmt::Arguments<'_>) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    writeln!(stdout, "{line}")
        .and_then(|()| stdout.flush())
        .map_err(|error| {
            Failure::failed(
                format!("results cannot be written to stdout: {error}"),
                "check where it leads",
            )
        })
}
