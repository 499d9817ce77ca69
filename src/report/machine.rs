//! Instructions of draw calls on a machine, from the project's own
//! `targets/run`. It is a program beside this one: the host tool knows no
//! firmware.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use rhogrid_core::draw::Quality;
use serde_json::Value;

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
        let fail = |what: String, remedy: &str| Error {
            file: Some(PathBuf::from(PROGRAM)),
            place: Place::Whole,
            what,
            remedy: remedy.into(),
        };
        let unwritten = |error| {
            fail(
                format!("no file for it: {error}"),
                "make room for temporary files",
            )
        };
        let mut file = tempfile::NamedTempFile::with_suffix(".rho").map_err(unwritten)?;
        file.write_all(asset.bytes()).map_err(unwritten)?;
        let splat = splat_of(quality).to_string();
        let output = Command::new(PROGRAM)
            .arg(&self.name)
            .arg(file.path())
            .args([
                "--view",
                "full",
                "--splat",
                &splat,
                "--path",
                path_name(quality),
                "--json",
            ])
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
        mean(&String::from_utf8_lossy(&output.stdout))
            .ok_or_else(|| fail("tells no instructions".into(), "run it alone to see why"))
    }

    /// Whether the program is there.
    pub fn is_there() -> bool {
        Path::new(PROGRAM).is_file()
    }
}

/// The mean of the lines' instructions.
fn mean(lines: &str) -> Option<f64> {
    let count = |line: &str| {
        serde_json::from_str::<Value>(line)
            .ok()?
            .get("instructions")?
            .as_f64()
    };
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
        assert_eq!(mean(&(line(100) + &line(300))), Some(200.0));
        for broken in ["", "{}\n", "no JSON\n"] {
            assert_eq!(mean(broken), None, "{broken:?}");
        }
        assert_eq!(mean(&(line(100) + "{\"instructions\":null}\n")), None);
    }
}
