//! Random cameras, and what they see in exact arithmetic.

use super::Rng;
use crate::camera::Camera;
use crate::numbers::{FocalPx, Length, Unit};

pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn normalized(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}

/// A number in [-1, 1).
pub(crate) fn signed(rng: &mut Rng) -> f64 {
    2.0 * rng.f64() - 1.0
}

/// A number in [low, high), evenly over its logarithm.
pub(crate) fn magnitude(rng: &mut Rng, low: f64, high: f64) -> f64 {
    low * (high / low).powf(rng.f64())
}

/// A direction, evenly over the sphere.
pub(crate) fn direction(rng: &mut Rng) -> Vector {
    loop {
        let v = [signed(rng), signed(rng), signed(rng)];
        let square = dot(v, v);
        if (0.01..1.0).contains(&square) {
            return normalized(v);
        }
    }
}

/// A camera from anywhere to anywhere: eye inside the cube, near, or up to
/// `farthest` half sides away; three in four look at a point of the cube.
pub(crate) fn camera(rng: &mut Rng, farthest: f64, max_size: f64) -> Camera {
    let size = |rng: &mut Rng| magnitude(rng, 1.0, max_size + 0.99) as u16;
    let (width, height) = (size(rng), size(rng));
    let field_of_view = match rng.u8(..2) {
        0 => 0.5 + 178.5 * rng.f64(),
        _ => 30.0 + 60.0 * rng.f64(),
    };
    let focal_px = f64::from(height) / 2.0 / (field_of_view.to_radians() / 2.0).tan();
    let eye = match rng.u8(..4) {
        0 => [signed(rng), signed(rng), signed(rng)],
        1 => direction(rng).map(|c| c * magnitude(rng, 1.0, 2.0)),
        2 => {
            let distance = 1.8 + 6.0 * rng.f64();
            direction(rng).map(|c| c * distance)
        }
        _ => {
            let distance = magnitude(rng, 2.0, farthest);
            direction(rng).map(|c| c * distance)
        }
    };
    let forward = match rng.u8(..4) {
        0 => direction(rng),
        _ => {
            let target = [signed(rng), signed(rng), signed(rng)];
            normalized([0, 1, 2].map(|i| target[i] - eye[i]))
        }
    };
    looking(eye, forward, direction(rng), focal_px, width, height)
}

/// A camera with a viewing direction and some direction upwards.
pub(crate) fn looking(
    eye: Vector,
    forward: Vector,
    upwards: Vector,
    focal_px: f64,
    width: u16,
    height: u16,
) -> Camera {
    let right = normalized(cross(forward, upwards));
    let unit = |v: Vector| v.map(Unit::from_num);
    Camera {
        eye: eye.map(Length::from_num),
        right: unit(right),
        up: unit(cross(right, forward)),
        forward: unit(forward),
        focal_px: FocalPx::from_num(focal_px),
        width,
        height,
        near: Camera::NEAR,
    }
}

/// A camera's linear forms X, Y (pixels x half sides) and w (half sides),
/// from its exact bits; the eye's products are summed as integers, the rest
/// errs by a few 2^-53 of the largest term.
pub(crate) struct Exact {
    centre: Vector,
    axes: [Vector; 3],
    pub eye: Vector,
    /// Half the picture, pixels.
    pub middle: [f64; 2],
}

impl Exact {
    pub fn new(camera: &Camera) -> Self {
        let rows = [
            camera.right,
            camera.up.map(core::ops::Neg::neg),
            camera.forward,
        ];
        let focal_px = camera.focal_px.to_num::<f64>();
        let scales = [focal_px, focal_px, 1.0];
        let centre = |row: [Unit; 3]| {
            let sum: i128 = row
                .iter()
                .zip(camera.eye)
                .map(|(unit, eye)| i128::from(unit.to_bits()) * i128::from(eye.to_bits()))
                .sum();
            -sum as f64 / 2f64.powi(62)
        };
        Self {
            centre: [0, 1, 2].map(|i| centre(rows[i]) * scales[i]),
            axes: [0, 1, 2].map(|i| rows[i].map(|c| c.to_num::<f64>() * scales[i])),
            eye: camera.eye.map(|c| c.to_num::<f64>()),
            middle: [camera.width, camera.height].map(|size| f64::from(size) / 2.0),
        }
    }

    /// X, Y, w of a point.
    pub fn forms(&self, point: Vector) -> Vector {
        [0, 1, 2].map(|i| self.centre[i] + dot(self.axes[i], point))
    }

    /// Changes of X, Y, w along half edges of a given length.
    pub fn half_edges(&self, length: f64) -> [Vector; 3] {
        [0, 1, 2].map(|axis| [0, 1, 2].map(|i| self.axes[i][axis] * length))
    }

    /// Pixels from the picture's top left corner.
    pub fn screen(&self, [x, y, w]: Vector) -> [f64; 2] {
        [x / w + self.middle[0], y / w + self.middle[1]]
    }
}

/// Units of eye space to the cube's half side, also where below one.
pub(crate) fn eye_unit(camera: &Camera) -> f64 {
    let farthest = camera.eye.map(|c| c.to_num::<f64>().abs());
    let farthest = farthest.into_iter().fold(0.0, f64::max) + 1.5;
    let mut unit = 2f64.powi(14);
    while farthest * unit >= 2f64.powi(15) {
        unit /= 2.0;
    }
    unit
}
