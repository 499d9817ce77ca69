//! `rhogrid report`.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use crate::report::{Effort, Machine, Means, make_folder, measure, models};

/// Arguments of `rhogrid report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
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
    let effort = if args.quick {
        &Effort::QUICK
    } else {
        &Effort::FULL
    };
    let machine = args.machine.clone().map(|name| Machine { name });
    if machine.is_some() && !Machine::is_there() {
        return Err(Failure::failed(
            "--machine needs targets/run, which is not here",
            "start from the project's folder",
        ));
    }
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
