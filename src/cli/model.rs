//! What a command's input becomes: an asset, with the geometry it came from
//! where there is one.

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};

use super::Failure;
use super::args::SourceArgs;
use crate::asset_file::AssetFile;
use crate::bake::{self, GridOptions, Progress, writer};
use crate::error::Error;
use crate::geometry::{Geometry, Up};
use crate::import::{self, procedural};

/// Names the built-in scene where a file is asked for.
pub const DEMO: &str = "builtin:demo";

/// What names of built-in models begin with.
const BUILT_IN: &str = "builtin:";

/// An asset and its source.
#[derive(Debug)]
pub struct Model {
    /// The asset.
    pub asset: AssetFile,
    /// What it was baked from; a `.rho` file keeps no geometry.
    pub geometry: Option<Geometry>,
}

impl Model {
    /// Opens a `.rho` file, or loads and bakes anything else.
    ///
    /// # Errors
    /// When the input cannot be read or baked.
    pub fn open(input: &Path, source: &SourceArgs) -> Result<Self, Failure> {
        if is_asset(input) {
            source.check_unused(input)?;
            return Ok(Self {
                asset: AssetFile::load(input)?,
                geometry: None,
            });
        }
        let geometry = load_geometry(input, source.grid_options().up)?;
        let asset = bake_asset(input, &geometry, &source.grid_options())?;
        Ok(Self {
            asset,
            geometry: Some(geometry),
        })
    }
}

/// Whether a file calls itself an asset, by magic or by name.
pub fn is_asset(input: &Path) -> bool {
    let by_name = input
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("rho"));
    let magic = || {
        let mut first = [0; 4];
        let mut file = std::fs::File::open(input).ok()?;
        std::io::Read::read_exact(&mut file, &mut first).ok()?;
        Some(first == rhogrid_core::asset::MAGIC)
    };
    by_name || magic().unwrap_or(false)
}

/// Loads a mesh or cloud, or makes a built-in model, y up.
pub fn load_geometry(input: &Path, up: Up) -> Result<Geometry, Error> {
    if let Some(name) = input
        .to_str()
        .and_then(|input| input.strip_prefix(BUILT_IN))
    {
        let mesh = procedural::built_in(name).ok_or_else(|| {
            let known = procedural::NAMES.map(|name| format!("{BUILT_IN}{name}"));
            let remedy = format!("give {}", known.join(", "));
            Error::file(input, "no such model is built in", remedy)
        })?;
        return Ok(Geometry::Mesh(mesh).turned(up));
    }
    let imported = import::load(input)?;
    for note in &imported.notes {
        eprintln!("{}: note: {note}", input.display());
    }
    Ok(imported.geometry.turned(up))
}

/// Bakes geometry, with a progress bar where stderr is a terminal.
pub fn bake_asset(
    input: &Path,
    geometry: &Geometry,
    options: &GridOptions,
) -> Result<AssetFile, Error> {
    let bar = progress_bar();
    let baked = bake::grid(geometry, options, &|progress| match progress {
        Progress::Level { cells } => bar.set_length(bar.length().unwrap_or(0) + cells),
        Progress::Done { cells } => bar.inc(cells),
    });
    bar.finish_and_clear();
    let named = |error: Error| Error {
        file: Some(input.to_path_buf()),
        ..error
    };
    let bytes = writer::to_bytes(&baked.map_err(named)?).map_err(named)?;
    AssetFile::new(&bytes).map_err(|error| {
        let what = format!("baked into a bad asset: {error}");
        Error::file(input, what, "report this")
    })
}

/// A bar on a terminal's stderr; silent elsewhere.
pub fn progress_bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {elapsed}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(0).with_style(style)
}

/// Refuses to write over what is read.
///
/// # Errors
/// When both names lead to one file.
pub fn check_distinct(input: &Path, output: &Path) -> Result<(), Failure> {
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(input), Ok(output)) if input == output => Err(Failure::Usage(format!(
            "the output would replace the input {}; give another name",
            input.display()
        ))),
        _ => Ok(()),
    }
}
