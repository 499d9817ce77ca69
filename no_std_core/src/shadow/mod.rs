//! Shadows: depth maps as lights see the scene, and what pixels read in them.
//!
//! Source: Duguet and Drettakis 2003, 5.3. A map is drawn with light-space
//! coordinates that grow by additions from cell to cell, as the paper has it.
//! Changes here: what is tested is not every sample but every pixel that shows
//! one, when colours are [resolved](crate::target): pixels are fewer than
//! samples, and the map need not be whole before. A pixel's place in light
//! space is linear in its column and row but for its w, so that it takes three
//! multiplications, not nine; and it is not asked for where the surface faces
//! away from the light.

mod map;
mod receive;
mod space;

pub(crate) use map::{CastForms, Map, PITCH, WINDOW, WINDOW_SIDE, edge};
pub(crate) use receive::{PictureForms, Receiver, Row, bias};
pub(crate) use space::{DEPTH_BITS, LightSpace, Sphere, TEXEL_BITS};

use crate::normal::CODES;
use crate::numbers::SplatPx;

/// How shadows are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shadows {
    /// How a frame's maps come about.
    pub method: Method,
    /// Texels along a side of a map, which holds the scene's bounding sphere:
    /// [`Shadows::MIN_SIZE`] to [`Shadows::MAX_SIZE`].
    pub size: u16,
    /// Cells with edges of at most so many texels cast as one square each.
    pub splat: SplatPx,
    /// How much nearer to the light something must be to cast a shadow, times
    /// what a surface may differ from its own squares: one is enough for
    /// planes, less lets surfaces shadow themselves, more lets light in where
    /// things touch.
    pub bias: SplatPx,
}

/// How a frame's shadow maps come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Nothing casts shadows.
    Off,
    /// A traversal for each map comes before the picture's. Serves everything.
    TwoPass,
    /// The map of one directional light is drawn while the picture is, where
    /// the plan allows it, else as with two passes.
    OnePass,
}

impl Shadows {
    /// The smallest map.
    pub const MIN_SIZE: u16 = 16;
    /// The largest map.
    pub const MAX_SIZE: u16 = 2048;

    /// Words that one light's map takes: texels, and the bias by normal code.
    pub const fn map_len(&self) -> usize {
        self.size as usize * self.size as usize + CODES / 2
    }
}

impl Default for Shadows {
    /// Off; 256 texels, of which cells take up to two and a quarter.
    fn default() -> Self {
        Self {
            method: Method::Off,
            size: 256,
            splat: SplatPx::lit("2.25"),
            bias: SplatPx::ONE,
        }
    }
}
