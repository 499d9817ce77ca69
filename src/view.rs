//! The float camera: what the command line asks for, in world units. The
//! reference draws with it; the core's fixed-point camera is made from it.

use glam::DVec3;

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
