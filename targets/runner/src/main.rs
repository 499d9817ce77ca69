//! `targets/run MACHINE FILE.rho|SCENE.toml`: draws an asset or a scene on a machine under QEMU,
//! measures every view, and compares its pictures with the host's.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use rhogrid::cli::{
    Failure, QualityArgs, ShadowChoice, core_light, core_quality, core_shadows, is_scene,
};
use rhogrid_targets::job::{Job, measure, print};
use rhogrid_targets::machine::{self, Machine};
use rhogrid_targets::views::{self, View};

/// How far to trust the cycles.
const CYCLES: &str = "\
Instructions are exact. Cycles are an estimate, for sa1110 only: instructions,
waits for loads and products, words of multiple transfers, taken branches, and
28 cycles for each miss of the SA-1110's caches, all counted in QEMU. Assumed
are the memory, that it takes stores at any rate, and how large the factors of
products are; targets/runner/src/cycles.rs has the model and its sources.
Without a C compiler, or a QEMU that loads the counting plugin, there is no
estimate (JSON: null), and stderr says why.";

/// Draws an asset on a machine under QEMU, measures every view, and compares
/// its pictures with the host's.
#[derive(Parser)]
#[command(name = "targets/run", bin_name = "targets/run", after_help = CYCLES)]
struct Arguments {
    /// The machine: sa1110 or m3
    #[arg(value_parser = machine::find)]
    machine: &'static Machine,
    /// The asset, or a scene
    #[arg(value_name = "FILE.rho|SCENE.toml")]
    file: PathBuf,
    /// Where a scene's models are, if not beside its file
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,
    /// full, far, close (four yaws each) or YAW,PITCH,DISTANCE in degrees and
    /// radii; may be repeated [default: full, far and close]
    #[arg(long = "view", value_name = "VIEW", value_parser = parse_views, allow_hyphen_values = true)]
    views: Vec<Vec<View>>,
    #[command(flatten)]
    quality: QualityArgs,
    /// One JSON object a line
    #[arg(long)]
    json: bool,
}

fn parse_views(text: &str) -> Result<Vec<View>, String> {
    views::parse(text)
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Err(what) = arguments.check() {
        Arguments::command()
            .error(ErrorKind::InvalidValue, what)
            .exit();
    }
    let json = arguments.json;
    match measure(&arguments.job(), &mut |measurement| {
        print(measurement, json)
    }) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

impl Arguments {
    /// Checks what clap cannot.
    fn check(&self) -> Result<(), String> {
        if is_scene(&self.file) && self.quality.light.is_some() {
            return Err("--light is for assets; a scene file has its own lights".to_owned());
        }
        if !is_scene(&self.file) && self.models.is_some() {
            return Err("--models is for scenes".to_owned());
        }
        match self.quality.check() {
            Ok(()) => Ok(()),
            Err(Failure::Usage(what)) => Err(what),
            Err(Failure::Failed(error)) => Err(error.to_string()),
        }
    }

    fn job(self) -> Job {
        let views = if self.views.is_empty() {
            views::standard()
        } else {
            self.views.concat()
        };
        let shadows = match is_scene(&self.file) {
            true => ShadowChoice::OnePass,
            false => ShadowChoice::Off,
        };
        Job {
            machine: self.machine,
            shadows: core_shadows(&self.quality, shadows),
            file: self.file,
            models: self.models,
            views,
            light: core_light(&self.quality),
            quality: core_quality(&self.quality),
            by_stage: false,
        }
    }
}
