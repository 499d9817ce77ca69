//! The frame file: everything a machine needs to draw, as one block of bytes
//! that the host writes and QEMU loads into the machine's memory.
//!
//! Little-endian 32-bit words, read in place. All numbers are the bits of the
//! core's fixed-point types, so host and machine draw from the same bits.
//!
//! ```text
//! word  0  magic "RHFR"            word  7  asset length, bytes
//!       1  version                       8  light towards x, y, z
//!       2  file length, bytes           11  ambient, diffuse
//!       3  width | height << 16         13  splat, distortion
//!       4  view count                   15  repair | culling << 1
//!       5  first view, byte offset      16  views: 2 cameras each,
//!       6  asset, byte offset               then the asset
//! camera: eye x, y, z (2 words each, low first), right, up, forward x, y, z,
//!         focal length (2), near (2)
//! ```

#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod read;
mod window;
mod write;

use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{Light, Quality};

pub use read::{Frame, FrameError, Views};
pub use window::Window;
pub use write::write;

/// First word of a frame file: "RHFR" as bytes.
pub const MAGIC: u32 = u32::from_le_bytes(*b"RHFR");

/// Version that this crate reads and writes.
pub const VERSION: u32 = 3;

/// Words of the header.
const HEADER_WORDS: usize = 16;

/// Words of one camera.
const CAMERA_WORDS: usize = 19;

/// Bytes of one view: its two cameras.
const VIEW_BYTES: usize = 2 * CAMERA_WORDS * 4;

/// What all views of a frame file share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Picture width in pixels.
    pub width: u16,
    /// Picture height in pixels.
    pub height: u16,
    /// The light.
    pub light: Light,
    /// The options.
    pub quality: Quality,
}

/// One picture to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// Drawn first and not measured, so that nothing the measured picture
    /// needs is warm or already clear.
    pub warm_up: Camera,
    /// Drawn, measured, hashed.
    pub measured: Camera,
}
