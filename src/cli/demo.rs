//! `rhogrid` alone: the built-in scene, no file needed.

use std::path::Path;

use clap::Parser;

use super::Failure;
use super::args::{QualityArgs, SourceArgs, ViewArgs};
use super::frame::{core_camera, core_light, core_quality, draw_frame};
use super::info::Description;
use super::model::{DEMO, Model};

/// The picture that the demo writes.
const OUTPUT: &str = "rhogrid-demo.png";
/// Draws for the median time.
const REPEATS: u32 = 20;

#[derive(Parser)]
struct Defaults {
    #[command(flatten)]
    source: SourceArgs,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    quality: QualityArgs,
}

/// Bakes and draws the built-in scene with the default options.
pub fn run() -> Result<(), Failure> {
    let defaults = Defaults::parse_from(["rhogrid", "--yaw", "30", "--distance", "2.1"]);
    let model = Model::open(Path::new(DEMO), &defaults.source)?;
    let (grid, cube) = (model.asset.grid(), model.asset.cube());
    let camera = core_camera(&defaults.view, grid.radius(), &cube);
    let (light, quality) = (
        core_light(&defaults.quality),
        core_quality(&defaults.quality),
    );
    let frame = draw_frame(&grid, &camera, &light, &quality, REPEATS);
    frame.picture().save_png(Path::new(OUTPUT))?;
    super::say(format_args!(
        "built-in scene: {}",
        Description::of(&model.asset).summary()
    ))?;
    super::say(format_args!(
        "drawn with integers alone: {} samples into {}x{} pixels, {:.2} ms, frame {:08x}",
        frame.stats.samples_drawn,
        frame.width,
        frame.height,
        frame.time_ns as f64 / 1e6,
        frame.hash()
    ))?;
    super::say(format_args!(
        "wrote {OUTPUT}; next: rhogrid render YOUR.ply -o out.png, or rhogrid --help"
    ))?;
    Ok(())
}
