//! What a picture cost, as it is printed.

use std::path::PathBuf;

use serde::Serialize;

use super::super::frame::Frame;
use super::super::{Failure, print_json, say};
use super::RenderArgs;
use crate::measure::ReferenceMeasures;

/// What was drawn, and what it cost.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    output: PathBuf,
    width: u16,
    height: u16,
    /// Null where the eye was given.
    yaw: Option<f64>,
    frame_hash: String,
    nodes_visited: u32,
    nodes_back_facing: u32,
    nodes_outside: u32,
    nodes_hidden: u32,
    facing_tests: u32,
    side_tests: u32,
    samples_drawn: u32,
    splats_drawn: u32,
    shadow_passes: u32,
    casters_visited: u32,
    casters_drawn: u32,
    pixels_written: usize,
    time_ns: u64,
    frames: u32,
    #[serde(flatten)]
    measures: Option<ReferenceMeasures>,
}

impl Report {
    pub(super) fn new(
        output: PathBuf,
        yaw: Option<f64>,
        frame: &Frame,
        frames: u32,
        measures: Option<ReferenceMeasures>,
    ) -> Self {
        Self {
            output,
            width: frame.width,
            height: frame.height,
            yaw,
            frame_hash: format!("{:08x}", frame.hash()),
            nodes_visited: frame.stats.nodes_visited,
            nodes_back_facing: frame.stats.nodes_back_facing,
            nodes_outside: frame.stats.nodes_outside,
            nodes_hidden: frame.stats.nodes_hidden,
            facing_tests: frame.stats.facing_tests,
            side_tests: frame.stats.side_tests,
            samples_drawn: frame.stats.samples_drawn,
            splats_drawn: frame.stats.splats_drawn,
            shadow_passes: frame.stats.shadow_passes,
            casters_visited: frame.stats.casters_visited,
            casters_drawn: frame.stats.casters_drawn,
            pixels_written: frame.depth.iter().filter(|&&depth| depth > 0).count(),
            time_ns: frame.time_ns,
            frames,
            measures,
        }
    }
}

/// Prints a line, or with `--json` an object.
pub(super) fn print(args: &RenderArgs, report: &Report) -> Result<(), Failure> {
    if args.json {
        return print_json(report);
    }
    say(format_args!(
        "{}: {}x{}, frame {}, {} samples, {} pixels written, {:.2} ms",
        report.output.display(),
        report.width,
        report.height,
        report.frame_hash,
        report.samples_drawn,
        report.pixels_written,
        report.time_ns as f64 / 1e6
    ))?;
    if args.verbose {
        say(format_args!(
            "  work: {} nodes, {} back-facing, {} outside, {} hidden; {} facing tests, {} side tests; \
             {} samples one by one; {} nodes and {} squares for shadows in {} passes of their own; median of {} frames",
            report.nodes_visited,
            report.nodes_back_facing,
            report.nodes_outside,
            report.nodes_hidden,
            report.facing_tests,
            report.side_tests,
            report.splats_drawn,
            report.casters_visited,
            report.casters_drawn,
            report.shadow_passes,
            report.frames
        ))?;
    }
    if let Some(measures) = &report.measures {
        say(format_args!(
            "  against the reference: {}",
            describe(measures)
        ))?;
    }
    Ok(())
}

fn describe(measures: &ReferenceMeasures) -> String {
    let decibels =
        |value: Option<f64>| value.map_or("identical".into(), |db| format!("{db:.2} dB"));
    let inside = match measures.inside_pixels {
        0 => "of no pixel".into(),
        _ => decibels(measures.psnr_inside),
    };
    let shadows = measures.shadow_errors.map_or(String::new(), |share| {
        format!(", {:.2}% in the wrong shadow state", 100.0 * share)
    });
    format!(
        "psnr_inside {inside}, psnr {}, ssim {:.4}, rmse {:.2}, {} holes, {} see-through{shadows}",
        decibels(measures.frame.psnr),
        measures.frame.ssim,
        measures.frame.rmse,
        measures.holes,
        measures.see_through.unwrap_or(0)
    )
}
