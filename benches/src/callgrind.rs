//! Frames on the host under callgrind, which counts the measured draw calls.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use rhogrid::error::Error;
use rhogrid_targets::stages::StageInstructions;
use rhogrid_targets::{failure, firmware};

use crate::profile::{Profile, ProfileError};

/// Package of the program that draws.
const PACKAGE: &str = "bench-frames";
/// Its function that counts.
const MEASURED: &str = "bench_frames::measured";

/// What a draw call took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostCount {
    /// Hash of the picture.
    pub frame_hash: u32,
    /// Instructions.
    pub stages: StageInstructions,
}

/// The program that draws, built like firmware.
///
/// # Errors
/// When it does not build.
pub fn build() -> Result<PathBuf, Error> {
    firmware::build_package(PACKAGE, &[])
}

/// Which valgrind there is.
///
/// # Errors
/// When there is none.
pub fn version() -> Result<String, Error> {
    Ok(output(Command::new("valgrind").arg("--version"))?
        .trim()
        .to_owned())
}

/// Draws all views of a frame file; profiles go to a folder.
///
/// # Errors
/// When something fails, or a profile does not tell the stages.
pub fn count(
    program: &Path,
    frame_file: &Path,
    view_count: usize,
    folder: &Path,
) -> Result<Vec<HostCount>, Error> {
    let profile = folder.join("profile");
    let mut to_profile = OsString::from("--callgrind-out-file=");
    to_profile.push(&profile);
    let printed = output(
        Command::new("valgrind")
            .args(["--quiet", "--tool=callgrind"])
            .args(["--compress-strings=no", "--compress-pos=no"])
            .arg(format!("--toggle-collect={MEASURED}"))
            .arg(format!("--dump-after={MEASURED}"))
            .arg(to_profile)
            .args([program, frame_file]),
    )?;
    let hashes: Vec<&str> = printed.lines().collect();
    if hashes.len() != view_count {
        let what = format!("{PACKAGE} drew {} of {view_count} views", hashes.len());
        return Err(failure(what, ""));
    }
    // The profile of the nth draw call is in the nth file.
    let numbered = hashes.iter().zip(1..);
    numbered
        .map(|(hash, number)| {
            Ok(HostCount {
                frame_hash: u32::from_str_radix(hash, 16)
                    .map_err(|_| failure(format!("{PACKAGE} printed {hash:?}"), ""))?,
                stages: stages(program, &profile.with_extension(number.to_string()))?,
            })
        })
        .collect()
}

fn stages(program: &Path, file: &Path) -> Result<StageInstructions, Error> {
    let text = fs::read_to_string(file).map_err(|error| {
        let remedy = "this valgrind's callgrind differs from version 3.19's; use that one";
        Error::file(file, format!("cannot be read: {error}"), remedy)
    })?;
    Profile::read(&text)
        .and_then(|profile| profile.stages(MEASURED))
        .map_err(|error| told(program, &error))
}

fn told(program: &Path, error: &ProfileError) -> Error {
    let (what, remedy) = match error {
        ProfileError::Absent(stage) => (
            format!("no function begins the stage `{}`", stage.name()),
            "the compiler has inlined it, or it has another name; \
             name it in targets/runner/src/stages.rs",
        ),
        other => (
            format!("the profile does not add up: {other:?}"),
            "this valgrind's callgrind differs from version 3.19's; use that one",
        ),
    };
    Error::file(program, what, remedy)
}

fn output(command: &mut Command) -> Result<String, Error> {
    let output = command.stdin(Stdio::null()).output().map_err(|error| {
        failure(
            format!("cannot run valgrind: {error}"),
            "install it (Debian, Ubuntu: apt-get install valgrind)",
        )
    })?;
    if !output.status.success() {
        let complaint = String::from_utf8_lossy(&output.stderr);
        let what = format!("valgrind failed: {}", complaint.trim());
        return Err(failure(what, ""));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
