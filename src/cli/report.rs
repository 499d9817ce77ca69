//! `rhogrid report`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::Failure;
use crate::report::{Comparison, Effort, Machine, Means, make_folder, measure, models};

/// Arguments of `rhogrid report`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct ReportArgs {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    sweep: SweepArgs,
}

/// Reports of their own.
#[derive(Debug, Subcommand)]
enum Command {
    /// Print the paper's tables and figures, its numbers beside ours
    Paper(PaperArgs),
}

/// Arguments of `rhogrid report paper`.
#[derive(Debug, Args)]
struct PaperArgs {
    /// Folder for the pictures; made where it is absent
    #[arg(long, value_name = "DIR", default_value = "rhogrid-paper")]
    out: PathBuf,
    /// Level 3 of built-in models alone: seconds
    #[arg(long, conflicts_with = "models")]
    quick: bool,
    /// Folder with bunny.ply, dragon_res2.ply, buddha_100k.ply, turbine_blade_199k.ply, or some
    /// of them, which stand for the paper's models [default: built-in ones alone]
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,
    /// Estimate cycles with targets/run NAME, for frames a second, instead of host times; from
    /// the project's folder
    #[arg(long, value_name = "NAME")]
    machine: Option<String>,
}

/// Arguments of the report that sweeps settings.
#[derive(Debug, Args)]
struct SweepArgs {
    /// Folder for report.md, data.csv and plots; made where it is absent
    #[arg(long, value_name = "DIR", default_value = "rhogrid-report")]
    out: PathBuf,
    /// Less of everything, of the built-in scene alone: under two minutes
    #[arg(long, conflicts_with = "models")]
    quick: bool,
    /// Folder with bunny.ply, buddha_100k.ply, or one of them [default: the built-in scene]
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,
    /// Count instructions, too, with targets/run NAME; from the project's folder
    #[arg(long, value_name = "NAME")]
    machine: Option<String>,
}

/// Measures and writes.
pub fn run(args: &ReportArgs) -> Result<(), Failure> {
    match &args.command {
        Some(Command::Paper(paper)) => compare(paper),
        None => sweep(&args.sweep),
    }
}

fn machine(name: Option<&String>) -> Result<Option<Machine>, Failure> {
    if name.is_some() && !Machine::is_there() {
        return Err(Failure::failed(
            "--machine needs targets/run, which is not here",
            "start from the project's folder",
        ));
    }
    Ok(name.map(|name| Machine { name: name.clone() }))
}

fn compare(args: &PaperArgs) -> Result<(), Failure> {
    let machine = machine(args.machine.as_ref())?;
    // Before the work, not after it.
    make_folder(&args.out)?;
    let comparison = Comparison {
        models: args.models.as_deref(),
        out: &args.out,
        machine: machine.as_ref(),
        quick: args.quick,
        progress: &|what| eprintln!("{what}"),
    };
    super::say(format_args!("{}", comparison.page()?.trim_end()))?;
    Ok(())
}

fn sweep(args: &SweepArgs) -> Result<(), Failure> {
    let effort = if args.quick {
        &Effort::QUICK
    } else {
        &Effort::FULL
    };
    let machine = machine(args.machine.as_ref())?;
    let models = models(args.models.as_deref(), effort)?;
    // Before the work, not after it.
    make_folder(&args.out)?;
    let means = Means {
        effort,
        machine: machine.as_ref(),
        progress: &|what| eprintln!("{what}"),
    };
    let report = measure(&models, means)?;
    for path in report.write(&args.out)? {
        super::say(format_args!("wrote {}", path.display()))?;
    }
    Ok(())
}
