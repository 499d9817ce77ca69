//! The `rhogrid` command: parses and dispatches.

use std::process::ExitCode;

fn main() -> ExitCode {
    rhogrid::cli::run()
}
