//! Scenes: placed grids in the light of up to three lamps, some of which cast
//! shadows.
//!
//! Each instance is drawn on a canvas of its own, as if it were alone, and
//! comes before what is behind it by depth when its colours are resolved:
//! normals, materials and shadows are an instance's own then.

mod draw;
mod order;

pub use draw::{Memory, draw_scene};

use crate::asset::{Grid, Rgb};
use crate::numbers::{Unit, Weight};
use crate::placement::Placement;
use crate::shade::Paint;
pub use crate::shade::matcap::Matcap;
use crate::shadow::Shadows;

/// Lamps in a scene at most.
pub const MAX_LAMPS: usize = 3;

/// A placed grid.
#[derive(Clone, Copy)]
pub struct Instance<'a> {
    /// The grid; several instances may share one.
    pub grid: &'a Grid<'a>,
    /// Where it stands.
    pub placement: Placement,
    /// Its materials' colours, whatever its samples'; `None` for the grid's own.
    /// Beyond the last one, black.
    pub materials: Option<&'a [Rgb]>,
}

impl Instance<'_> {
    /// What has its colours on a canvas of so many words.
    #[inline(always)]
    pub(crate) fn paint(&self, canvas: usize) -> Paint<'_> {
        match self.materials {
            Some(materials) => Paint::Materials(materials),
            None => Paint::of(self.grid, canvas),
        }
    }
}

/// A directional light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lamp {
    /// Unit vector towards the light, world.
    pub towards: [Unit; 3],
    /// Its colour at full weight.
    pub colour: Rgb,
    /// Diffuse weight.
    pub diffuse: Weight,
    /// Whether it casts shadows.
    pub casts: bool,
}

/// The lights of a scene: colour = material * (ambient + the sum of lamps'
/// colour * diffuse * max(0, normal . towards)), no gamma. With a matcap, ambient
/// times its texel takes the place of ambient.
#[derive(Clone, Copy, Debug)]
pub struct Lighting<'a> {
    /// Ambient weight.
    pub ambient: Weight,
    /// Ambient light by where normals point on the screen.
    pub matcap: Option<Matcap<'a>>,
    /// Up to [`MAX_LAMPS`]; further ones are dark.
    pub lamps: &'a [Lamp],
}

/// What is drawn.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The placed grids.
    pub instances: &'a [Instance<'a>],
    /// Their light.
    pub lighting: Lighting<'a>,
    /// How shadows are drawn.
    pub shadows: Shadows,
}

#[cfg(test)]
mod tests;
