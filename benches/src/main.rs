//! `benches/run`: counts the instructions of standard frames, on the host
//! under callgrind and on an SA-1110 under QEMU, whole and by stage.
//!
//! ```text
//! cases -> measure -> callgrind -> profile -+-> table -> stdout, readme
//!             |                             |-> json
//!             +----> rhogrid_targets::job --+
//! ```

#![forbid(unsafe_code)]

mod callgrind;
mod cases;
mod json;
mod measure;
mod profile;
mod readme;
mod table;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rhogrid::error::Error;
use rhogrid_targets::machine::{self, TOOLCHAIN};
use rhogrid_targets::{failure, views, workspace};

use cases::{CASES, Case, QUICK};
use measure::Bench;
use table::Setting;

/// The machine beside the host.
const MACHINE: &str = "sa1110";

/// What figures mean.
const FIGURES: &str = "\
Instructions are exact and no time: a draw call's, after another one 90 degrees
away. Of a picture whose hash is not that of the same picture drawn without
counting, nothing is counted. Stages add up to the whole: set-up is projection,
plan, displacement tables and what no other stage has; clear zeroes the canvas;
traversal draws samples on it; resolve makes colours of it and closes holes.
The host's include the C library's for clearing and copying memory, which
depend on the processor.";

/// Counts the instructions of standard frames, on the host and on an SA-1110
/// under QEMU, whole and by stage.
#[derive(Parser)]
#[command(name = "benches/run", bin_name = "benches/run", after_help = FIGURES)]
struct Arguments {
    /// Count models of this folder (bunny.ply, buddha_100k.ply), too, not the
    /// built-in scene alone
    #[arg(long, value_name = "FOLDER")]
    models: Option<PathBuf>,
    /// Count one view of a coarse built-in scene alone
    #[arg(long, conflicts_with_all = ["models", "write_readme"])]
    quick: bool,
    /// One JSON object with all views instead of tables of means
    #[arg(long)]
    json: bool,
    /// Put the tables into README.md, too
    #[arg(long, requires = "models")]
    write_readme: bool,
}

fn main() -> ExitCode {
    match Arguments::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

impl Arguments {
    fn run(self) -> Result<(), Error> {
        let cases = self.cases()?;
        let valgrind = callgrind::version()?;
        let machine = machine::find(MACHINE).map_err(|what| failure(what, ""))?;
        let setting = Setting {
            machines: [std::env::consts::ARCH, MACHINE].map(str::to_owned),
            tools: format!("Rust {TOOLCHAIN}, {valgrind}"),
        };
        let mut views = views::standard();
        if self.quick {
            views.truncate(1);
        }
        let bench = Bench {
            program: callgrind::build()?,
            machine,
            models: self.models,
            views,
        };
        let count = |case: &'static Case| {
            eprintln!("counting {}", case.name);
            bench.count(case)
        };
        let counted = cases
            .into_iter()
            .map(count)
            .collect::<Result<Vec<_>, _>>()?;
        let tables = table::markdown(&setting, &counted);
        if self.json {
            let run = json::Run::new(&setting, &counted);
            print(&serde_json::to_string(&run).map_err(|error| failure(error.to_string(), ""))?)?;
        } else {
            print(tables.trim_end())?;
        }
        if self.write_readme {
            readme::write(&workspace().join("../README.md"), &tables)?;
        }
        Ok(())
    }

    /// What is to be counted; all of its inputs are there.
    fn cases(&self) -> Result<Vec<&'static Case>, Error> {
        if self.quick {
            return Ok(vec![&QUICK]);
        }
        let Some(models) = &self.models else {
            return Ok(CASES.iter().filter(|case| case.is_built_in()).collect());
        };
        for case in CASES.iter().filter(|case| !case.is_built_in()) {
            let file = measure::input(case, Some(models));
            if !file.is_file() {
                let remedy = "give the folder that has it to --models";
                return Err(Error::file(&file, "is not there", remedy));
            }
        }
        Ok(CASES.iter().collect())
    }
}

fn print(text: &str) -> Result<(), Error> {
    writeln!(std::io::stdout(), "{text}")
        .map_err(|error| failure(format!("cannot print: {error}"), ""))
}
