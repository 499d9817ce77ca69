//! The frame file: everything a machine needs to draw, as one block of bytes
//! that the host writes and QEMU loads into the machine's memory.
//!
//! Little-endian 32-bit words, read in place. All numbers are the bits of the
//! core's fixed-point types, so host and machine draw from the same bits.
//!
//! ```text
//! word  0  magic "RHFR"            word  9  first instance, byte offset
//!       1  version                      10  lamp count
//!       2  file length, bytes           11  first lamp, byte offset
//!       3  width | height << 16         12  ambient
//!       4  view count                   13  splat, distortion
//!       5  first view, byte offset      15  repair | culling << 1 | shadows << 2
//!       6  asset count                  16  map's size, splat, bias
//!       7  first asset, byte offset     19  matcap's texel count, 0 for none
//!       8  instance count              20  first texel, byte offset
//!                                      21  views, assets, instances, lamps,
//!                                          texels, and the assets' bytes
//! view:     two cameras
//! camera:   eye x, y, z (2 words each, low first), right, up, forward x, y, z,
//!           focal length (2), near (2)
//! asset:    first byte, byte offset; length, bytes
//! instance: asset, materials (0: the asset's own), 8 colours red | green << 8 |
//!           blue << 16, origin x, y, z and axes (2 words each)
//! lamp:     towards x, y, z, colour, diffuse, casts
//! texel:    RGB565, two in a word, padded
//! ```

#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod read;
mod window;
mod write;

use rhogrid_core::asset::{MAX_MATERIALS, Rgb};
use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::Weight;
use rhogrid_core::placement::Placement;
use rhogrid_core::scene::{Lamp, Matcap};
use rhogrid_core::shadow::{Method, Shadows};

pub use read::{Frame, FrameError};
pub use window::Window;
pub use write::write;

/// First word of a frame file: "RHFR" as bytes.
pub const MAGIC: u32 = u32::from_le_bytes(*b"RHFR");

/// Version that this crate reads and writes.
pub const VERSION: u32 = 5;

/// Most assets of a frame file.
pub const MAX_ASSETS: usize = 16;

/// Most instances of a frame file.
pub const MAX_INSTANCES: usize = 64;

/// Words of the header.
const HEADER_WORDS: usize = 21;

/// Words of one camera.
const CAMERA_WORDS: usize = 19;

/// Bytes of one view: its two cameras.
const VIEW_BYTES: usize = 2 * CAMERA_WORDS * 4;

/// Bytes of where an asset lies.
const ASSET_BYTES: usize = 2 * 4;

/// Bytes of one instance.
const INSTANCE_BYTES: usize = (2 + MAX_MATERIALS + 4 * 3 * 2) * 4;

/// Bytes of one lamp.
const LAMP_BYTES: usize = 6 * 4;

/// Bytes of one texel.
const TEXEL_BYTES: usize = 2;

/// What all views of a frame file share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Picture width in pixels.
    pub width: u16,
    /// Picture height in pixels.
    pub height: u16,
    /// The ambient weight.
    pub ambient: Weight,
    /// The options.
    pub quality: Quality,
    /// How shadows are drawn.
    pub shadows: Shadows,
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

/// A placed asset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placed {
    /// Index of the asset.
    pub asset: u32,
    /// Where it stands.
    pub placement: Placement,
    /// Colours that take the place of its own.
    pub materials: Option<Materials>,
}

impl Placed {
    /// The first asset, as it is.
    pub const ALONE: Self = Self {
        asset: 0,
        placement: Placement::IDENTITY,
        materials: None,
    };
}

/// Up to eight colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Materials {
    /// How many there are, one to eight.
    pub count: u8,
    /// The colours; further ones are black.
    pub colours: [Rgb; MAX_MATERIALS],
}

impl Materials {
    /// Of up to eight colours; further ones are left out.
    pub fn new(colours: &[Rgb]) -> Self {
        let mut own = [[0; 3]; MAX_MATERIALS];
        let mut count = 0;
        for (own, &colour) in own.iter_mut().zip(colours) {
            *own = colour;
            count += 1;
        }
        Self {
            count,
            colours: own,
        }
    }

    /// The colours.
    pub fn as_slice(&self) -> &[Rgb] {
        self.colours
            .get(..usize::from(self.count))
            .unwrap_or(&self.colours)
    }
}

/// What a frame file holds.
#[derive(Clone, Copy, Debug)]
pub struct Content<'a> {
    /// What all views share.
    pub settings: Settings,
    /// The pictures.
    pub views: &'a [View],
    /// The assets' bytes, at most [`MAX_ASSETS`].
    pub assets: &'a [&'a [u8]],
    /// Where they stand, at most [`MAX_INSTANCES`].
    pub instances: &'a [Placed],
    /// The lights.
    pub lamps: &'a [Lamp],
    /// What ambient light is.
    pub matcap: Option<Matcap<'a>>,
}

/// The light of one asset that stands alone and casts no shadows: what
/// [`rhogrid_core::draw::draw`] draws.
fn lone_light(settings: &Settings, placed: Option<Placed>, lamp: Option<Lamp>) -> Option<Light> {
    let lamp = lamp.filter(|lamp| lamp.colour == [255; 3])?;
    let is_lone = settings.shadows.method == Method::Off && placed == Some(Placed::ALONE);
    is_lone.then_some(Light {
        towards: lamp.towards,
        ambient: settings.ambient,
        diffuse: lamp.diffuse,
    })
}
