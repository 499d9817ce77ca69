//! `targets/run MACHINE FILE.rho`: draws an asset on a machine under QEMU,
//! measures every view, and compares its pictures with the host's.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use rhogrid_core::draw::{Light, Quality};
use rhogrid_targets::frame_file::{light, quality};
use rhogrid_targets::job::{Job, run};
use rhogrid_targets::machine::{self, Machine};
use rhogrid_targets::views::{self, View};

/// Draws an asset on a machine under QEMU, measures every view, and compares
/// its pictures with the host's.
#[derive(Parser)]
#[command(name = "targets/run", bin_name = "targets/run")]
struct Arguments {
    /// The machine: sa1110 or m3
    #[arg(value_parser = machine::find)]
    machine: &'static Machine,
    /// The asset
    #[arg(value_name = "FILE.rho")]
    file: PathBuf,
    /// full, far, close (four yaws each) or YAW,PITCH,DISTANCE in degrees and
    /// radii; may be repeated [default: full, far and close]
    #[arg(long = "view", value_name = "VIEW", value_parser = parse_views, allow_hyphen_values = true)]
    views: Vec<Vec<View>>,
    /// Longer side in pixels below which a cell is one splat
    #[arg(long, value_name = "PX", default_value = "1.0", value_parser = parse_splat)]
    splat: Quality,
    /// Direction towards the light
    #[arg(long, value_name = "X,Y,Z", default_value = "1,2,1.5", value_parser = parse_light, allow_hyphen_values = true)]
    light: Light,
    /// One JSON object a line
    #[arg(long)]
    json: bool,
}

fn parse_views(text: &str) -> Result<Vec<View>, String> {
    views::parse(text)
}

fn parse_splat(text: &str) -> Result<Quality, String> {
    quality(text.parse().unwrap_or(f64::NAN))
}

fn parse_light(text: &str) -> Result<Light, String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| part.trim().parse().unwrap_or(f64::NAN))
        .collect();
    light(numbers.try_into().unwrap_or([f64::NAN; 3]))
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let file = arguments.file;
    if file
        .extension()
        .is_some_and(|extension| extension == "toml")
    {
        let message = "scenes are not supported yet; name an asset (FILE.rho)";
        Arguments::command()
            .error(ErrorKind::InvalidValue, message)
            .exit();
    }
    let views = if arguments.views.is_empty() {
        views::standard()
    } else {
        arguments.views.concat()
    };
    let job = Job {
        machine: arguments.machine,
        file,
        views,
        light: arguments.light,
        quality: arguments.splat,
        json: arguments.json,
    };
    match run(&job) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
