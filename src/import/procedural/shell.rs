//! The ammonite: a tube whose cross-section grows along an equiangular
//! spiral, with ribs that fork halfway up the flank, and a hollow mouth.
//!
//! Based on: David M. Raup, Geometric Analysis of Shell Coiling, 1966: a shell
//! is a section, its distance from the axis and its growth per turn.
//!
//! u is the growth angle in radians, 0 at the mouth and negative inside; v
//! runs around the section, 0 on the outer rim and pi at the inner seam. Rows
//! of the mesh lean with v as the growth lines do, so that ribs and colour
//! bands follow them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::elementary::sin_cos;
use super::jet::{Jet, JetPoint};
use super::rings::{Builder, End, Vertex, angle};
use super::shapes;
use super::{GOLD, IVORY, TERRACOTTA};

/// Natural logarithm of the growth per radian: twice as large every turn.
const GROWTH: f64 = std::f64::consts::LN_2 / TAU;
/// Whorls, counted from the mouth.
const TURNS: usize = 5;
/// Half the section's extent away from and along the axis, relative to the
/// distance of its middle from the axis.
const HALF_HEIGHT: f64 = 0.385;
const HALF_WIDTH: f64 = 0.47;
/// Ribs per turn at the seam; twice as many cross the rim.
const RIBS: u32 = 24;
/// How far ribs lean forward at the rim, in radians of growth.
const LEAN: f64 = 0.13;
/// Vertices around a section.
const COLUMNS: u32 = 52;
/// Colour bands per turn.
const BANDS: u32 = 8;
/// Rows of the mesh for one band and one gap, oldest turn first; a fifth of
/// them lies on either side of the middle of the band.
const ROWS: [u32; TURNS] = [10, 20, 20, 50, 70];
/// Wall thickness at the mouth, relative to the section.
const WALL: f64 = 0.08;
/// Angle from the mouth to the closed bottom of the living chamber.
const CHAMBER: f64 = 2.2;
/// Distance of a band's edge from its middle, in rows of the mesh as a part of
/// band and gap.
const EDGE: f64 = 0.2;

/// Where the shell stands: placement of its own frame (spiral in the x-y
/// plane, axis z, mouth at angle 0) in the world.
pub struct Placement {
    pub centre: DVec3,
    /// Distance of the mouth's middle from the axis.
    pub size: f64,
    /// Angle of the mouth in the plane of the spiral.
    pub roll: f64,
    /// Turn about the y axis.
    pub turn: f64,
}

impl Placement {
    fn world(&self, point: JetPoint) -> JetPoint {
        let (sine, cosine) = sin_cos(self.turn);
        let (x, z) = (point.x * self.size, point.z * self.size);
        JetPoint {
            x: x * cosine + z * sine + self.centre.x,
            y: point.y * self.size + self.centre.y,
            z: z * cosine - x * sine + self.centre.z,
        }
    }
}

/// Height of the relief, relative to the section, at growth angle `u`.
fn relief(u: Jet, v: Jet) -> Jet {
    let outward = v.cos();
    let phase = u * f64::from(RIBS);
    // Two bumps that coincide near the seam and part towards the rim: a fork.
    let fork = outward.smoothstep(-0.6, 0.7) * FRAC_PI_2;
    let bump = |x: Jet| (x.cos() * 0.5 + 0.5).square().square();
    let ribs = (bump(phase - fork) + bump(phase + fork)) * (fork * (0.5 / FRAC_PI_2) + 0.5);
    let strength = outward.smoothstep(-0.97, -0.2);
    // A collar without ribs at the mouth.
    let fade = (-u).smoothstep(0.02, 0.2);
    // The oldest whorls are nearly smooth.
    let youth = u.smoothstep(-4.5 * TAU, -2.5 * TAU);
    ribs * strength * fade * youth * 0.095
}

/// A point of the shell: `scale` is 1 on the outside and less on the inside.
fn surface(placement: &Placement, u: Jet, v: Jet, scale: Jet, relief: Jet) -> Vertex {
    let (sine, cosine) = v.sin_cos();
    let lean = (cosine * 0.5 + 0.5).square() * LEAN;
    let growth = u + lean;
    let size = (growth * GROWTH).exp();
    let (up, along) = (growth + placement.roll).sin_cos();
    let flare = u.smoothstep(-0.22, 0.06) * 0.07;
    let section = scale * (relief + flare + 1.0);
    let distance = size * (section * cosine * HALF_HEIGHT + 1.0);
    // Widest a little inside the middle, as in life.
    let width = size * section * sine * (cosine * -0.12 + 1.0) * HALF_WIDTH;
    let point = placement.world(JetPoint {
        x: distance * along,
        y: distance * up,
        z: width,
    });
    Vertex {
        position: point.position(),
        normal: point.normal(),
    }
}

/// Where a row of the mesh runs at `v`: rows are squeezed and stretched so
/// that the edges of the bands, flames that taper from the rim to the seam,
/// lie exactly on rows. `row` counts bands and may be a fraction; the result is
/// a growth angle.
fn flame(row: f64, v: f64) -> f64 {
    let rim = Jet::from(sin_cos(v).1).smoothstep(-0.85, 0.9).value;
    let half_width = 0.03 + 0.27 * rim;
    let whole = (row + 0.5).floor();
    let offset = row - whole;
    let size = offset.abs();
    let warped = if size <= EDGE {
        size * half_width / EDGE
    } else {
        0.5 - (0.5 - size) * (0.5 - half_width) / (0.5 - EDGE)
    };
    (whole + if offset < 0.0 { -warped } else { warped }) * TAU / f64::from(BANDS)
}

/// Adds the shell.
pub fn ammonite(builder: &mut Builder, placement: &Placement) {
    let v = |i: u32| Jet::v(angle(i, COLUMNS));
    let outside = |builder: &mut Builder, row: f64| {
        builder.ring(COLUMNS, |i| {
            let v = v(i);
            let u = Jet::u(flame(row, v.value));
            surface(placement, u, v, 1.0.into(), relief(u, v))
        })
    };

    // Outside, from the first chamber to the mouth; older whorls are smaller
    // and need fewer rows.
    let bands = BANDS * TURNS as u32;
    let mut ring = outside(builder, -f64::from(bands));
    let start = middle(placement, -TAU * TURNS as f64);
    let apex = Vertex {
        normal: -start.normal,
        ..start
    };
    builder.lid(ring, End::First, apex, IVORY);
    for band in 0..bands {
        let rows = ROWS[(band / BANDS) as usize];
        for row in 1..=rows {
            let place = |row: u32| f64::from(row) / f64::from(rows);
            let to = outside(builder, place(row) + f64::from(band) - f64::from(bands));
            // A band is centred on the border between two counts.
            let banded = 5 * row <= rows || 5 * (row - 1) >= 4 * rows;
            let material = if banded { TERRACOTTA } else { IVORY };
            builder.join(ring, to, material);
            ring = to;
        }
    }

    // Around the lip: half a turn from the outside to the inside.
    let lip_steps = 8;
    for step in 1..=lip_steps {
        let half_turn = Jet::u(PI * f64::from(step) / f64::from(lip_steps));
        let (sine, cosine) = half_turn.sin_cos();
        let to = builder.ring(COLUMNS, |i| {
            let scale = cosine * (WALL / 2.0) + (1.0 - WALL / 2.0);
            surface(placement, sine * (WALL / 4.0), v(i), scale, 0.0.into())
        });
        builder.join(ring, to, GOLD);
        ring = to;
    }

    // Inside, from the mouth backwards.
    let rows = 40;
    for row in 1..=rows {
        let depth = Jet::u(CHAMBER * f64::from(row) / f64::from(rows));
        let to = builder.ring(COLUMNS, |i| {
            surface(placement, -depth, v(i), (1.0 - WALL).into(), 0.0.into())
        });
        builder.join(ring, to, GOLD);
        ring = to;
    }
    let apex = middle(placement, -CHAMBER);
    builder.lid(ring, End::Last, apex, GOLD);

    // A bead closes the eye of the spiral.
    shapes::bead(builder, placement.centre, placement.size * 0.05, GOLD);
}

/// Middle of the section at growth angle u; its normal looks along the spiral
/// towards the mouth.
fn middle(placement: &Placement, u: f64) -> Vertex {
    let size = Jet::from(u * GROWTH).exp();
    let (up, along) = Jet::u(u + placement.roll).sin_cos();
    let point = placement.world(JetPoint {
        x: along * size,
        y: up * size,
        z: 0.0.into(),
    });
    let forward = DVec3::new(point.x.du, point.y.du, point.z.du).normalize();
    Vertex {
        position: point.position(),
        normal: forward,
    }
}
