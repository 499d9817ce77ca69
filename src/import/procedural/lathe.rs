//! Solids of revolution around the y axis from a profile of cubic curves.

use glam::{DVec2, DVec3};

use super::elementary::sin_cos;
use super::rings::{Builder, End, Vertex, angle};

/// One stretch of a profile, (radius, height) from bottom to top along the
/// outside. Stretches meet in sharp edges unless their tangents agree.
pub struct Stretch {
    /// Control points of a cubic Bezier curve.
    pub curve: [DVec2; 4],
    /// Steps the curve is cut into.
    pub steps: u32,
    pub material: u8,
}

impl Stretch {
    /// A straight stretch.
    pub fn line(from: [f64; 2], to: [f64; 2], material: u8) -> Self {
        let (from, to) = (DVec2::from(from), DVec2::from(to));
        Self {
            curve: [from, from.lerp(to, 1.0 / 3.0), from.lerp(to, 2.0 / 3.0), to],
            steps: 1,
            material,
        }
    }

    /// A curved stretch.
    pub fn curve(curve: [[f64; 2]; 4], steps: u32, material: u8) -> Self {
        Self {
            curve: curve.map(DVec2::from),
            steps,
            material,
        }
    }

    /// Point and direction at step i.
    fn at(&self, i: u32) -> (DVec2, DVec2) {
        let [a, b, c, d] = self.curve;
        let x = f64::from(i) / f64::from(self.steps);
        let rest = 1.0 - x;
        let (ab, bc, cd) = (a * rest + b * x, b * rest + c * x, c * rest + d * x);
        let (abc, bcd) = (ab * rest + bc * x, bc * rest + cd * x);
        (abc * rest + bcd * x, (bcd - abc).normalize())
    }
}

/// Turns a profile into a closed solid, with flat lids at its two ends.
pub fn turned(builder: &mut Builder, profile: &[Stretch], columns: u32) {
    let vertex = |(point, direction): (DVec2, DVec2), i: u32| {
        let (sine, cosine) = sin_cos(angle(i, columns));
        let around = |outward: f64, up: f64| DVec3::new(outward * cosine, up, outward * sine);
        Vertex {
            position: around(point.x, point.y),
            normal: around(direction.y, -direction.x),
        }
    };
    let mut last = None;
    for stretch in profile {
        let start = stretch.at(0);
        let mut from = match last {
            Some(ring) => builder.crease(ring, |i| vertex(start, i).normal),
            None => {
                let ring = builder.ring(columns, |i| vertex(start, i));
                let apex = Vertex {
                    position: DVec3::Y * start.0.y,
                    normal: DVec3::NEG_Y,
                };
                builder.lid(ring, End::First, apex, stretch.material);
                ring
            }
        };
        for step in 1..=stretch.steps {
            let to = builder.ring(columns, |i| vertex(stretch.at(step), i));
            builder.join(from, to, stretch.material);
            from = to;
        }
        last = Some(from);
    }
    if let (Some(ring), Some(stretch)) = (last, profile.last()) {
        let apex = Vertex {
            position: DVec3::Y * stretch.curve[3].y,
            normal: DVec3::Y,
        };
        builder.lid(ring, End::Last, apex, stretch.material);
    }
}
