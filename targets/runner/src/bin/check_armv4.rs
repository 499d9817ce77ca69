//! `check_armv4 IMAGE`: fails unless every instruction of an ELF image is one
//! of ARMv4. Uses llvm-objdump and llvm-readobj of the firmware's toolchain.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use rhogrid_targets::armv4::{examine, has_thumb};
use rhogrid_targets::toolchain::llvm;

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
    let tool = |name: &str, options: &[&str]| {
        let options = options.iter().map(Path::new);
        let arguments: Vec<&Path> = options.chain([image]).collect();
        llvm(name, &arguments).map_err(|error| error.to_string())
    };
    if has_thumb(&tool("llvm-readobj", &["--symbols"])?) {
        return Err("contains Thumb code".to_owned());
    }
    let options = ["-d", "--no-show-raw-insn", "--triple=armv7a-none-eabi"];
    let disassembly = tool("llvm-objdump", &options)?;
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
