//! `rhogrid compare`.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use crate::measure::{compare, difference};
use crate::picture::Picture;

/// Arguments of `rhogrid compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// First picture (PNG or JPEG)
    first: PathBuf,
    /// Second picture, of the same size
    second: PathBuf,
    /// Write the absolute difference, amplified four times
    #[arg(long, value_name = "OUT.png")]
    difference: Option<PathBuf>,
    /// One JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Loads both and measures.
pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    let (first, second) = (Picture::load(&args.first)?, Picture::load(&args.second)?);
    let sizes = |_| {
        Failure::failed(
            format!(
                "{} is {}x{} but {} is {}x{}",
                args.first.display(),
                first.width,
                first.height,
                args.second.display(),
                second.width,
                second.height
            ),
            "compare pictures of one size",
        )
    };
    let measures = compare(&first, &second).map_err(sizes)?;
    if let Some(output) = &args.difference {
        difference(&first, &second)
            .map_err(sizes)?
            .save_png(output)?;
    }
    if args.json {
        return super::print_json(&measures);
    }
    match measures.psnr {
        None => super::say(format_args!("identical"))?,
        Some(psnr) => super::say(format_args!(
            "psnr {psnr:.2} dB, ssim {:.4}, rmse {:.3}, largest {}, {} pixels differ",
            measures.ssim, measures.rmse, measures.max_error, measures.differing_pixels
        ))?,
    }
    Ok(())
}
