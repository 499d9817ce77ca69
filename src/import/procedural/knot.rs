//! A wreath: a torus knot of round bar, knurled with small raised diamonds.

use std::f64::consts::TAU;

use super::jet::{Jet, JetPoint};
use super::rings::{Builder, Ring, Vertex, angle};

/// A knot around the y axis.
pub struct Knot {
    /// Height of its middle plane.
    pub height: f64,
    /// Radii of the torus it lies on; the second is the half width of the
    /// torus's section, the third its half height.
    pub radii: [f64; 3],
    /// Turns around the axis and around the torus's section; coprime.
    pub turns: [u32; 2],
    /// Radius of the bar.
    pub bar: f64,
    /// Knurls along and around the bar.
    pub knurls: [u32; 2],
    /// Height of the knurls, relative to the bar's radius.
    pub knurl_height: f64,
    pub material: u8,
}

/// Vertices per knurl in both directions.
const STEPS: u32 = 5;

impl Knot {
    /// Point of the bar at `u` along, 0 to 2 pi once through, and `v` around.
    fn surface(&self, u: Jet, v: Jet) -> Vertex {
        let [around, across] = self.turns.map(f64::from);
        let [radius, width, height] = self.radii;
        let (sin_phi, cos_phi) = (u * around).sin_cos();
        let (sin_theta, cos_theta) = (u * across).sin_cos();

        let distance = cos_theta * width + radius;
        let middle = JetPoint {
            x: distance * cos_phi,
            y: sin_theta * height + self.height,
            z: distance * sin_phi,
        };
        // Derivative of the middle line along u.
        let drift = sin_theta * (-width * across);
        let tangent = JetPoint {
            x: drift * cos_phi - distance * sin_phi * around,
            y: cos_theta * (height * across),
            z: drift * sin_phi + distance * cos_phi * around,
        };
        let torus_normal = JetPoint {
            x: cos_theta * cos_phi,
            y: sin_theta,
            z: cos_theta * sin_phi,
        };
        let side = torus_normal.cross(tangent).normalized();
        let outward = tangent.cross(side).normalized();

        let [along, about] = self.knurls.map(f64::from);
        let (rising, falling) = (u * along + v * about, u * along - v * about);
        // |sin| of half of each phase, its kink rounded: diamonds between two
        // families of crossed grooves.
        let ridge = |phase: Jet| (phase.cos() * -0.5 + 0.55).sqrt();
        let diamond = ridge(rising) * ridge(falling);
        let thickness = (diamond * self.knurl_height + 1.0) * self.bar;
        let (sine, cosine) = v.sin_cos();
        let point = middle + outward.scaled(thickness * cosine) + side.scaled(thickness * sine);
        Vertex {
            position: point.position(),
            normal: point.normal(),
        }
    }

    /// Adds the wreath.
    pub fn build(&self, builder: &mut Builder) {
        let [rows, columns] = self.knurls.map(|count| count * STEPS);
        let row = |builder: &mut Builder, i: u32| {
            let u = TAU * f64::from(i) / f64::from(rows);
            builder.ring(columns, |i| {
                self.surface(Jet::u(u), Jet::v(angle(i, columns)))
            })
        };
        let first: Ring = row(builder, 0);
        let mut from = first;
        for i in 1..rows {
            let to = row(builder, i);
            builder.join(from, to, self.material);
            from = to;
        }
        builder.join(from, first, self.material);
    }
}
