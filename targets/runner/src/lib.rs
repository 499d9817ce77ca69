//! Runs frames on machines under QEMU and compares them with the host's.
//!
//! ```text
//! FILE.rho -> asset -> frame_file -+-> host: frames and hashes -------+
//!                views --^         |                                  = ?
//!                                  +-> qemu: firmware -> session -----+
//!                                            qmp -> screen (5:6:5) ---+
//! ```
//!
//! Where a machine has a cycle model, QEMU runs `../plugin/sa1110.c`, which
//! counts; plugin reads the counts, and cycles makes an estimate of them. Where
//! symbols tells it which functions begin which of the stages, it counts by
//! stage, too.

#![forbid(unsafe_code)]

pub mod aligned;
pub mod armv4;
pub mod clock;
pub mod cycles;
pub mod firmware;
pub mod frame_file;
pub mod host;
pub mod job;
pub mod machine;
pub mod measurement;
pub mod plugin;
pub mod qemu;
pub mod qmp;
pub mod screen;
pub mod session;
pub mod stages;
pub mod symbols;
pub mod toolchain;
pub mod views;

use std::path::Path;

use rhogrid::error::{Error, Place};

/// The workspace of the firmware: the folder `targets/`.
pub fn workspace() -> &'static Path {
    let runner = Path::new(env!("CARGO_MANIFEST_DIR"));
    runner.parent().unwrap_or(runner)
}

/// An error that concerns no file.
pub fn failure(what: impl Into<String>, remedy: impl Into<String>) -> Error {
    Error {
        file: None,
        place: Place::Whole,
        what: what.into(),
        remedy: remedy.into(),
    }
}
