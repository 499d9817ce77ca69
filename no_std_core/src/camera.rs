//! The camera: a pinhole in model space, all numbers fixed point.
//!
//! Pixel centres lie at half-integers, x to the right, y down, the principal
//! point in the middle of the picture. A point's *w* is its distance along
//! the viewing direction.

use crate::numbers::{FocalPx, Length, Turns, Unit};
use crate::trig::sin_cos;

/// A pinhole camera in model space (y up; the grid's cube spans [-1, 1]^3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Camera {
    /// Eye position.
    pub eye: [Length; 3],
    /// Unit vector to the right of the picture.
    pub right: [Unit; 3],
    /// Unit vector to the top of the picture.
    pub up: [Unit; 3],
    /// Unit vector into the scene.
    pub forward: [Unit; 3],
    /// Focal length in pixels: height / 2 / tan(vertical field of view / 2).
    pub focal_px: FocalPx,
    /// Picture width in pixels, 1 to 4096.
    pub width: u16,
    /// Picture height in pixels, 1 to 4096.
    pub height: u16,
    /// Nothing nearer than this along the viewing direction is drawn.
    /// Positive; non-positive values count as the smallest step.
    pub near: Length,
}

/// An eye on a sphere around the model's centre, looking at the centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orbit {
    /// Angle around the y axis; zero looks along -z from +z.
    pub yaw: Turns,
    /// Angle above the horizon, modulo one turn.
    pub pitch: Turns,
    /// Distance of the eye from the centre.
    pub distance: Length,
}

impl Camera {
    /// The near distance that the constructors choose: 2^-20 of the cube's
    /// half side.
    pub const NEAR: Length = Length::from_bits(1 << 12);

    /// A camera on an orbit: eye = distance (sin yaw cos pitch, sin pitch,
    /// cos yaw cos pitch). Straight above and below the centre the picture's
    /// right stays the yaw's right.
    pub fn orbit(orbit: &Orbit, focal_px: FocalPx, width: u16, height: u16) -> Self {
        let (sin_yaw, cos_yaw) = sin_cos(orbit.yaw);
        let (sin_pitch, cos_pitch) = sin_cos(orbit.pitch);
        let back = [
            product(sin_yaw, cos_pitch),
            sin_pitch,
            product(cos_yaw, cos_pitch),
        ];
        let up = [
            -product(sin_yaw, sin_pitch),
            cos_pitch,
            -product(cos_yaw, sin_pitch),
        ];
        Self {
            eye: back.map(|component| scaled(component, orbit.distance)),
            right: [cos_yaw, Unit::ZERO, -sin_yaw],
            up,
            forward: back.map(|component| -component),
            focal_px,
            width,
            height,
            near: Self::NEAR,
        }
    }
}

/// Product of two components in [-1, 1], rounded down.
fn product(a: Unit, b: Unit) -> Unit {
    Unit::from_bits(((i64::from(a.to_bits()) * i64::from(b.to_bits())) >> 30) as i32)
}

/// A component in [-1, 1] times a length: at most the length.
fn scaled(component: Unit, length: Length) -> Length {
    let wide = i128::from(component.to_bits()) * i128::from(length.to_bits());
    Length::from_bits((wide >> 30) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orbit_is_orthonormal_and_looks_at_the_centre() {
        for index in 0..1000u32 {
            let orbit = Orbit {
                yaw: Turns::from_bits(index.wrapping_mul(0x9e37_79b9)),
                pitch: Turns::from_bits(index.wrapping_mul(0x85eb_ca6b)),
                distance: Length::from_num(3),
            };
            let camera = Camera::orbit(&orbit, FocalPx::from_num(320), 240, 320);
            let float = |v: [Unit; 3]| v.map(|c| c.to_num::<f64>());
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let (right, up, forward) =
                (float(camera.right), float(camera.up), float(camera.forward));
            for (a, b, want) in [
                (right, right, 1.0),
                (up, up, 1.0),
                (forward, forward, 1.0),
                (right, up, 0.0),
                (up, forward, 0.0),
                (right, forward, 0.0),
            ] {
                assert!((dot(a, b) - want).abs() < 2e-8, "{orbit:?}");
            }
            let eye = camera.eye.map(|c| c.to_num::<f64>());
            assert!((dot(eye, forward) + 3.0).abs() < 1e-7, "{orbit:?}");
            let cross = right[1] * up[2] - right[2] * up[1];
            assert!((cross + forward[0]).abs() < 2e-8, "right-handed: {orbit:?}");
        }
    }
}
