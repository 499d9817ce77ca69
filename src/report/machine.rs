//! Instructions of draw calls on a machine, from the project's own
//! `targets/run`. It is a program beside this one: the host tool knows no
//! firmware.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use rhogrid_core::draw::Quality;
use serde_json::Value;
use tempfile::NamedTempFile;

use super::row::{path_name, splat_of};
use crate::asset_file::AssetFile;
use crate::error::{Error, Place};

/// Where the program is, seen from the project's folder.
const PROGRAM: &str = "targets/run";

/// A machine under QEMU.
#[derive(Clone, Debug)]
pub struct Machine {
    /// As `targets/run` calls it.
    pub name: String,
}

impl Machine {
    /// Draws the four full views and gives their mean number of instructions.
    ///
    /// # Errors
    /// When the program is not there or fails.
    pub fn instructions(&self, asset: &AssetFile, quality: &Quality) -> Result<f64, Error> {
        let file = asset_file(asset.bytes())?;
        let splat = splat_of(quality).to_string();
        let options = [
            "--view",
            "full",
            "--splat",
            &splat,
            "--path",
            path_name(quality),
        ];
        let lines = self.run(file.path(), &options)?;
        mean(&lines, "instructions")
            .ok_or_else(|| fail("tells no instructions".into(), "run it alone to see why"))
    }

    /// Draws what options of the program say of an asset or a scene, and gives
    /// the mean of the estimated cycles; `None` where the machine has none.
    ///
    /// # Errors
    /// When the program is not there or fails.
    pub fn cycles(&self, input: &Path, options: &[&str]) -> Result<Option<f64>, Error> {
        Ok(mean(&self.run(input, options)?, "cycles_estimate"))
    }

    /// What the program prints.
    fn run(&self, input: &Path, options: &[&str]) -> Result<String, Error> {
        let output = Command::new(PROGRAM)
            .arg(&self.name)
            .arg(input)
            .args(options)
            .arg("--json")
            .output()
            .map_err(|error| {
                fail(
                    format!("cannot be run: {error}"),
                    "start from the project's folder",
                )
            })?;
        if !output.status.success() {
            let told = String::from_utf8_lossy(&output.stderr);
            let last = told.lines().last().unwrap_or("it tells nothing");
            return Err(fail(format!("failed: {last}"), "run it alone to see why"));
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    /// Whether the program is there.
    pub fn is_there() -> bool {
        Path::new(PROGRAM).is_file()
    }
}

fn fail(what: String, remedy: &str) -> Error {
    Error {
        file: Some(PathBuf::from(PROGRAM)),
        place: Place::Whole,
        what,
        remedy: remedy.into(),
    }
}

/// A file of an asset, there as long as it is kept.
///
/// # Errors
/// When there is no room for it.
pub(super) fn asset_file(bytes: &[u8]) -> Result<NamedTempFile, Error> {
    let unwritten = |error| {
        let what = format!("no file for an asset: {error}");
        fail(what, "make room for temporary files")
    };
    let mut file = NamedTempFile::with_suffix(".rho").map_err(unwritten)?;
    file.write_all(bytes).map_err(unwritten)?;
    Ok(file)
}

/// The mean of a number that all lines have.
fn mean(lines: &str, key: &str) -> Option<f64> {
    let count = |line: &str| serde_json::from_str::<Value>(line).ok()?.get(key)?.as_f64();
    let counts: Option<Vec<f64>> = lines.lines().map(count).collect();
    let counts = counts.filter(|counts| !counts.is_empty())?;
    Some(counts.iter().sum::<f64>() / counts.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_are_the_mean_of_all_lines() {
        let line = |count: u32| format!("{{\"view\":\"full/0\",\"instructions\":{count}}}\n");
        assert_eq!(mean(&(line(100) + &line(300)), "instructions"), Some(200.0));
        for broken in ["", "{}\n", "no JSON\n"] {
            assert_eq!(mean(broken, "instructions"), None, "{broken:?}");
        }
        let null = line(100) + "{\"instructions\":null}\n";
        assert_eq!(mean(&null, "instructions"), None);
    }
}
