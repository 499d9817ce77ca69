//! The float camera: what the command line asks for, in world units. The
//! reference draws with it; the core's fixed-point camera is made from it.

use glam::DVec3;
use rhogrid_core::asset::Rgb;

use crate::picture::widen_rgb565;

/// A pinhole camera. Pixel centres lie at half-integers, x to the right, y
/// down; the principal point is the middle of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Eye position, world units.
    pub eye: DVec3,
    /// Unit vector to the right of the picture.
    pub right: DVec3,
    /// Unit vector to the top of the picture.
    pub up: DVec3,
    /// Unit vector into the scene.
    pub forward: DVec3,
    /// Focal length in pixels.
    pub focal_px: f64,
    /// Picture width in pixels.
    pub width: u32,
    /// Picture height in pixels.
    pub height: u32,
}

impl View {
    /// Focal length in pixels of a vertical field of view in degrees.
    pub fn focal_px(fov_degrees: f64, height: u32) -> f64 {
        f64::from(height) / 2.0 / (fov_degrees.to_radians() / 2.0).tan()
    }

    /// A ray's direction (not normalized; its component along
    /// [`View::forward`] is 1) through a point of the picture in pixels.
    pub fn direction(&self, x_px: f64, y_px: f64) -> DVec3 {
        let x = (x_px - f64::from(self.width) / 2.0) / self.focal_px;
        let y = (f64::from(self.height) / 2.0 - y_px) / self.focal_px;
        self.forward + self.right * x + self.up * y
    }
}

/// A directional light with the ambient and diffuse weights of the shading
/// model: colour = material * (ambient + diffuse * max(0, normal . towards)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Unit vector towards the light, world space.
    pub towards: DVec3,
    /// Ambient weight, 0 to 1.
    pub ambient: f64,
    /// Diffuse weight, 0 to 1.
    pub diffuse: f64,
    /// Whether the light casts shadows.
    pub casts: bool,
}

/// A directional light of some colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Unit vector towards it, world space.
    pub towards: DVec3,
    /// Its colour.
    pub colour: Rgb,
    /// Diffuse weight, 0 to 1.
    pub diffuse: f64,
    /// Whether it casts shadows.
    pub casts: bool,
}

/// The picture of a lit sphere, RGB565: ambient light by where a normal points
/// on the screen. See [`rhogrid_core::scene::Matcap`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matcap {
    /// A square, row after row.
    pub texels: Vec<u16>,
}

impl Matcap {
    /// The light on a unit normal, 0 to 1 a channel.
    pub fn light(&self, view: &View, normal: DVec3) -> DVec3 {
        let side = self.texels.len().isqrt();
        let at = |along: f64| {
            let place = (along + 1.0) / 2.0 * side as f64;
            (place.max(0.0) as usize).min(side.saturating_sub(1))
        };
        let (column, row) = (at(normal.dot(view.right)), at(-normal.dot(view.up)));
        let texel = self.texels.get(row * side + column).copied().unwrap_or(0);
        DVec3::from_array(widen_rgb565(texel).map(f64::from)) / 255.0
    }
}

/// The lights of a scene: colour = material * (ambient + the sum of lamps'
/// colour * diffuse * max(0, normal . towards)); with a matcap ambient is that of
/// its texel.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// Ambient weight, 0 to 1.
    pub ambient: f64,
    /// What ambient light is.
    pub matcap: Option<Matcap>,
    /// The lamps.
    pub lamps: Vec<Lamp>,
}

impl Lighting {
    /// The lamp that casts shadows, if it is the only one that does.
    pub fn caster(&self) -> Option<&Lamp> {
        let mut casting = self.lamps.iter().filter(|lamp| lamp.casts);
        casting.next().filter(|_| casting.next().is_none())
    }
}

impl From<Light> for Lighting {
    fn from(light: Light) -> Self {
        Self {
            ambient: light.ambient,
            matcap: None,
            lamps: vec![Lamp {
                towards: light.towards,
                colour: [255; 3],
                diffuse: light.diffuse,
                casts: light.casts,
            }],
        }
    }
}
