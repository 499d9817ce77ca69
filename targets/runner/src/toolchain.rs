//! Tools of the toolchain that firmware is built with.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

use rhogrid::error::Error;

use crate::failure;
use crate::machine::TOOLCHAIN;

/// The output of one of the toolchain's LLVM tools, `llvm-nm` or another.
///
/// # Errors
/// When it is absent or fails.
pub fn llvm<A: AsRef<OsStr>>(tool: &str, arguments: &[A]) -> Result<String, Error> {
    let toolchain = format!("+{TOOLCHAIN}");
    let libraries = output(Command::new("rustc").args([&toolchain, "--print", "target-libdir"]))?;
    let program = Path::new(libraries.trim()).with_file_name("bin").join(tool);
    output(Command::new(program).args(arguments))
}

fn output(command: &mut Command) -> Result<String, Error> {
    let remedy = format!(
        "`rustup toolchain install {TOOLCHAIN} --profile minimal -c llvm-tools` installs it"
    );
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command
        .output()
        .map_err(|error| failure(format!("cannot run {program}: {error}"), remedy))?;
    if !output.status.success() {
        let complaint = String::from_utf8_lossy(&output.stderr);
        let what = format!("{program} failed: {}", complaint.trim());
        return Err(failure(what, ""));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
