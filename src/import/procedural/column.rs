//! The column: a twisted fluted shaft and a capital with a ring of beads.

use glam::DVec3;

use super::elementary::sin_cos;
use super::jet::{Jet, JetPoint};
use super::lathe::{Stretch, turned};
use super::rings::{Builder, End, Vertex, angle};
use super::shapes;
use super::{GOLD, SLATE, VERDIGRIS};

/// Flutes around the shaft and vertices for each.
const FLUTES: u32 = 20;
const STEPS: u32 = 12;
/// Depth of the flutes relative to the radius.
const DEPTH: f64 = 0.12;
/// Turn of the flutes from bottom to top, in radians.
const TWIST: f64 = 0.9;

/// The shaft between two heights, with its radius at each.
pub fn shaft(builder: &mut Builder, bottom: [f64; 2], top: [f64; 2]) {
    let rows = 28;
    let columns = FLUTES * STEPS;
    let ring = |builder: &mut Builder, row: u32| {
        let x = Jet::u(f64::from(row) / f64::from(rows));
        let radius = x * (top[0] - bottom[0]) + bottom[0];
        builder.ring(columns, |i| {
            let around = Jet::v(angle(i, columns));
            let half_phase = around * (f64::from(FLUTES) / 2.0);
            // |sin| with its kink rounded: hollow flutes, narrow ridges.
            let hollow = (half_phase.sin().square() + 0.004).sqrt();
            let (sine, cosine) = (around + x * TWIST).sin_cos();
            let distance = radius * (hollow * -DEPTH + 1.0);
            let point = JetPoint {
                x: distance * cosine,
                y: x * (top[1] - bottom[1]) + bottom[1],
                z: distance * sine,
            };
            Vertex {
                position: point.position(),
                normal: point.normal(),
            }
        })
    };
    let apex = |height: f64, normal: DVec3| Vertex {
        position: DVec3::Y * height,
        normal,
    };
    let mut from = ring(builder, 0);
    builder.lid(from, End::First, apex(bottom[1], DVec3::NEG_Y), VERDIGRIS);
    for row in 1..=rows {
        let to = ring(builder, row);
        builder.join(from, to, VERDIGRIS);
        from = to;
    }
    builder.lid(from, End::Last, apex(top[1], DVec3::Y), VERDIGRIS);
}

/// The capital, from `base` upwards: a necking, a flared cup and a shallow
/// bowl on top, with beads around its brim.
pub fn capital(builder: &mut Builder, base: f64, radius: f64) {
    let at = |x: f64, y: f64| [radius * x, base + radius * y];
    let profile = [
        Stretch::curve(
            [at(0.92, 0.0), at(1.12, 0.0), at(1.12, 0.16), at(0.92, 0.16)],
            10,
            SLATE,
        ),
        Stretch::line(at(0.92, 0.16), at(0.92, 0.20), SLATE),
        Stretch::curve(
            [at(0.92, 0.20), at(0.98, 0.42), at(1.2, 0.52), at(1.5, 0.58)],
            14,
            VERDIGRIS,
        ),
        Stretch::curve(
            [at(1.5, 0.58), at(1.62, 0.60), at(1.62, 0.74), at(1.5, 0.74)],
            10,
            SLATE,
        ),
        Stretch::curve(
            [at(1.5, 0.74), at(1.2, 0.74), at(0.6, 0.52), at(0.05, 0.52)],
            12,
            SLATE,
        ),
    ];
    turned(builder, &profile, 96);
    let beads = 40;
    for i in 0..beads {
        let (sine, cosine) = sin_cos(angle(i, beads));
        let middle =
            DVec3::new(cosine, 0.0, sine) * (radius * 1.56) + DVec3::Y * (base + radius * 0.66);
        shapes::bead(builder, middle, radius * 0.105, GOLD);
    }
}
