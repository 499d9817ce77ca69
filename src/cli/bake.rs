//! `rhogrid bake`.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::args::SourceArgs;
use super::info::Description;
use super::model::{bake_asset, check_distinct, load_geometry};
use crate::asset_file::AssetFile;
use crate::error::Error;
use crate::output::write_whole;

/// Arguments of `rhogrid bake`.
#[derive(Debug, Args)]
pub struct BakeArgs {
    /// Mesh or cloud (.obj, .ply), or builtin:demo
    input: PathBuf,
    /// Asset to write
    #[arg(short, long, value_name = "OUT.rho")]
    output: PathBuf,
    #[command(flatten)]
    source: SourceArgs,
    /// Keep only as many levels as fit
    #[arg(long, value_name = "N")]
    max_bytes: Option<u64>,
    /// Describe the asset as JSON on stdout
    #[arg(long)]
    json: bool,
}

/// Bakes and writes.
pub fn run(args: &BakeArgs) -> Result<(), Failure> {
    args.source.check()?;
    check_distinct(&args.input, &args.output)?;
    let mut source = args.source.clone();
    let geometry = load_geometry(&args.input, source.grid_options().up)?;
    let mut asset = bake_asset(&args.input, &geometry, &source.grid_options())?;
    while let Some(limit) = args
        .max_bytes
        .filter(|&limit| asset.bytes().len() as u64 > limit)
    {
        let level = source.grid_options().level;
        if level == 0 {
            let bytes = asset.bytes().len();
            let what = format!("even level 0 takes {bytes} bytes, more than {limit}");
            let remedy = "raise --max-bytes or lower --rho";
            return Err(Error::file(&args.input, what, remedy).into());
        }
        source.level = Some(level - 1);
        asset = bake_asset(&args.input, &geometry, &source.grid_options())?;
    }
    write_whole(&args.output, |file| file.write_all(asset.bytes()))?;
    report(args, &asset)
}

fn report(args: &BakeArgs, asset: &AssetFile) -> Result<(), Failure> {
    let description = Description::of(asset);
    if args.json {
        super::print_json(&description)
    } else {
        super::say(format_args!(
            "{}: {}",
            args.output.display(),
            description.summary()
        ))?;
        Ok(())
    }
}
