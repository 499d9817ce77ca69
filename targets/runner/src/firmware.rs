//! Builds firmware, and other programs that are measured.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use rhogrid::error::Error;

use crate::machine::{Machine, TOOLCHAIN};
use crate::{failure, workspace};

/// Builds a machine's firmware if anything it is made of has changed, and
/// tells where the image is. Compiler messages go to stderr.
///
/// # Errors
/// When cargo cannot be run or the build fails.
pub fn build(machine: &Machine) -> Result<PathBuf, Error> {
    build_package(machine.package, &machine.target.flags())
}

/// The same for the program of a package of this workspace; `flags` are
/// cargo's.
///
/// # Errors
/// When cargo cannot be run or the build fails.
pub fn build_package(package: &str, flags: &[&str]) -> Result<PathBuf, Error> {
    let remedy = format!(
        "`rustup toolchain install {TOOLCHAIN} --profile minimal -c rust-src -c llvm-tools \
         -t thumbv7m-none-eabi` installs what it takes"
    );
    let output = Command::new("cargo")
        .arg(format!("+{TOOLCHAIN}"))
        .args(["build", "--release", "--quiet", "--package", package])
        .args(["--message-format", "json-render-diagnostics"])
        .args(flags)
        .current_dir(workspace())
        // Firmware must not depend on flags that are meant for the host.
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env_remove("CARGO_BUILD_TARGET")
        // build-std on a release compiler.
        .env("RUSTC_BOOTSTRAP", "1")
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| failure(format!("cannot run cargo: {error}"), remedy.clone()))?;
    if !output.status.success() {
        return Err(failure(format!("{package} does not build"), remedy));
    }
    executable(&String::from_utf8_lossy(&output.stdout), package)
        .ok_or_else(|| failure(format!("cargo built {package} but does not say where"), ""))
}

/// The executable that cargo's messages name for a package.
fn executable(messages: &str, package: &str) -> Option<PathBuf> {
    messages
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter(|message| message["target"]["name"] == package)
        .find_map(|message| message["executable"].as_str().map(PathBuf::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_executable_is_found_among_the_messages() {
        let messages = concat!(
            r#"{"reason":"compiler-artifact","target":{"name":"core"},"executable":null}"#,
            "\nnot json\n",
            r#"{"reason":"compiler-artifact","target":{"name":"other"},"executable":"/a/other"}"#,
            "\n",
            r#"{"reason":"compiler-artifact","target":{"name":"firmware"},"executable":"/a/firmware"}"#,
            "\n",
            r#"{"reason":"build-finished","success":true}"#,
        );
        assert_eq!(executable(messages, "firmware"), Some("/a/firmware".into()));
        assert_eq!(executable(messages, "core"), None);
    }
}
