//! `check_armv4 IMAGE`: fails unless every instruction of an ELF image is one
//! of ARMv4. Uses llvm-objdump and llvm-readobj of the firmware's toolchain.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use rhogrid_targets::armv4::{examine, has_thumb};
use rhogrid_targets::machine::TOOLCHAIN;

/// Refused lines that are shown; the rest is counted.
const SHOWN: usize = 20;

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [image] = arguments.as_slice() else {
        eprintln!("usage: check_armv4 IMAGE");
        return ExitCode::from(2);
    };
    match check(image) {
        Ok(instructions) => {
            println!(
                "{}: {instructions} instructions, all ARMv4",
                image.display()
            );
            ExitCode::SUCCESS
        }
        Err(what) => {
            eprintln!("{}: {what}", image.display());
            ExitCode::FAILURE
        }
    }
}

fn check(image: &Path) -> Result<usize, String> {
    let tools = tools()?;
    let symbols = output(
        Command::new(tools.join("llvm-readobj"))
            .arg("--symbols")
            .arg(image),
    )?;
    if has_thumb(&symbols) {
        return Err("contains Thumb code".to_owned());
    }
    let disassembly = output(
        Command::new(tools.join("llvm-objdump"))
            .args(["-d", "--no-show-raw-insn", "--triple=armv7a-none-eabi"])
            .arg(image),
    )?;
    let finding = examine(&disassembly);
    if finding.instructions == 0 {
        return Err("contains no ARM code".to_owned());
    }
    if finding.refused.is_empty() {
        return Ok(finding.instructions);
    }
    let shown: Vec<&str> = finding
        .refused
        .iter()
        .take(SHOWN)
        .map(String::as_str)
        .collect();
    Err(format!(
        "{} instructions are not ARMv4:\n{}",
        finding.refused.len(),
        shown.join("\n")
    ))
}

/// The folder of the toolchain's own LLVM tools.
fn tools() -> Result<PathBuf, String> {
    let toolchain = format!("+{TOOLCHAIN}");
    let libraries = output(Command::new("rustc").args([&toolchain, "--print", "target-libdir"]))?;
    Ok(Path::new(libraries.trim()).with_file_name("bin"))
}

fn output(command: &mut Command) -> Result<String, String> {
    let remedy = format!(
        "`rustup toolchain install {TOOLCHAIN} --profile minimal -c llvm-tools` installs it"
    );
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command
        .output()
        .map_err(|error| format!("cannot run {program}: {error}; {remedy}"))?;
    if !output.status.success() {
        let complaint = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{program} failed: {}", complaint.trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
