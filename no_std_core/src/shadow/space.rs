//! Light space: the scene's bounding sphere as a parallel light sees it.
//!
//! u and v are texels of the map, depth has 16 bits, larger is nearer to the
//! light. The sphere's middle is the map's, and [`MARGIN`] texels around it stay
//! free for squares at its rim; its nearest point has the depth 32768 +
//! [`DEPTH_REACH`], its farthest 32768 - [`DEPTH_REACH`].

use crate::divisor::Divisor;
use crate::numbers::{Length, Unit, root_up, shift_round};
use crate::placement::Placement;
use crate::projection::{Form, Row};
use crate::scene::Instance;

/// Texels between the sphere and the map's sides.
const MARGIN: i64 = 4;
/// Steps of depth from the sphere's middle to its rim.
const DEPTH_REACH: i64 = 32_000;
/// Fraction bits of u and v.
pub(crate) const TEXEL_BITS: i32 = 16;
/// Fraction bits of depths.
pub(crate) const DEPTH_BITS: i32 = 14;
/// Fraction bits of shares of the sphere's radius.
const SHARE_BITS: i32 = 60;
/// Guard bits of forms.
const GUARD_BITS: i32 = 32;

/// A sphere around everything, world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    pub centre: [Length; 3],
    /// Positive.
    pub radius: Length,
}

impl Sphere {
    /// Around the box around all instances' spheres.
    pub fn around(instances: &[Instance<'_>]) -> Self {
        let spheres = || {
            instances.iter().map(|instance| {
                let Instance {
                    grid, placement, ..
                } = instance;
                (placement.origin, placement.radius(grid.radius()))
            })
        };
        let [mut low, mut high] = [[Length::MAX; 3], [Length::MIN; 3]];
        for (origin, radius) in spheres() {
            for ((low, high), at) in low.iter_mut().zip(&mut high).zip(origin) {
                *low = (*low).min(at.saturating_sub(radius));
                *high = (*high).max(at.saturating_add(radius));
            }
        }
        let mut centre = [Length::ZERO; 3];
        for ((centre, low), high) in centre.iter_mut().zip(low).zip(high) {
            // Half each: the sum may not fit.
            *centre = Length::from_bits((low.to_bits() >> 1) + (high.to_bits() >> 1));
        }
        let farthest = spheres().map(|(origin, radius)| {
            let apart = origin.iter().zip(centre).map(|(a, b)| {
                let apart = i128::from(a.to_bits()) - i128::from(b.to_bits());
                (apart * apart).unsigned_abs()
            });
            let apart = root_up(apart.sum()).min(1 << 62) as i64;
            radius.saturating_add(Length::from_bits(apart))
        });
        Self {
            centre,
            radius: farthest.fold(Length::DELTA, Length::max),
        }
    }
}

/// A parallel light's view of a sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSpace {
    /// Along u and v, and towards the light; world, at right angles.
    pub axes: [[Unit; 3]; 3],
    sphere: Sphere,
    per_radius: Divisor,
    /// Texels along a side of the map.
    pub size: u16,
}

impl LightSpace {
    pub fn new(towards: [Unit; 3], sphere: Sphere, size: u16) -> Self {
        let [x, y, z] = towards.map(|c| i64::from(c.to_bits()));
        // At right angles to the light and to the axis that it is farthest
        // from: the longer of these is at least sqrt(2/3) long.
        let [ax, ay, az] = [x, y, z].map(i64::abs);
        let across = if ax <= ay && ax <= az {
            [0, -z, y]
        } else if ay <= az {
            [z, 0, -x]
        } else {
            [-y, x, 0]
        };
        let u = unit(across);
        let [ux, uy, uz] = u.map(|c| i64::from(c.to_bits()));
        let v = [y * uz - z * uy, z * ux - x * uz, x * uy - y * ux];
        Self {
            axes: [u, v.map(|c| Unit::from_bits((c >> 30) as i32)), towards],
            sphere,
            per_radius: Divisor::new(i128::from(sphere.radius.to_bits())),
            size,
        }
    }

    /// Texels, and steps of depth, from the sphere's middle to its rim.
    pub fn reaches(&self) -> [i64; 3] {
        let texels = i64::from(self.size) / 2 - MARGIN;
        [texels, texels, DEPTH_REACH]
    }

    /// u, v and depth of a placed grid: forms with [`GUARD_BITS`] beyond
    /// [`TEXEL_BITS`] and [`DEPTH_BITS`]. Within the sphere they stay below
    /// 2^30 before the guard bits.
    pub fn forms(&self, placement: &Placement) -> [Form; 3] {
        let middle = i64::from(self.size) << (TEXEL_BITS - 1);
        let middles = [middle, middle, 1 << (15 + DEPTH_BITS)];
        let bits = [TEXEL_BITS, TEXEL_BITS, DEPTH_BITS];
        let mut forms = [Form::default(); 3];
        let origin = self.relative_to_middle(placement.origin);
        let rows = self.axes.map(|axis| placement.row(axis, origin));
        let parts = rows.iter().zip(self.reaches()).zip(middles).zip(bits);
        for (form, (((row, reach), middle), bits)) in forms.iter_mut().zip(parts) {
            let scaled = |part: i128| {
                let wide = i128::from(self.share(part)) * i128::from(reach);
                shift_round(wide, SHARE_BITS - bits - GUARD_BITS)
            };
            let (centre, axes): Row = *row;
            *form = Form {
                centre: scaled(centre).saturating_add(middle << GUARD_BITS),
                axes: axes.map(scaled),
            };
        }
        forms
    }

    /// A length with 62 fraction bits as a share of the sphere's radius, at most
    /// two to either side.
    fn share(&self, length: i128) -> i64 {
        let limit = i128::from(self.radius()) << 31;
        self.over_radius(length.clamp(-limit, limit), 30)
    }

    /// `length / radius * 2^scale`, saturated.
    pub fn over_radius(&self, length: i128, scale: i32) -> i64 {
        self.per_radius.quotient(length, scale)
    }

    /// From the sphere's middle to a point.
    pub fn relative_to_middle(&self, point: [Length; 3]) -> [i64; 3] {
        let centre = self.sphere.centre;
        [0, 1, 2].map(|at| point[at].to_bits().saturating_sub(centre[at].to_bits()))
    }

    /// The sphere's radius, Q32.32.
    pub fn radius(&self) -> i64 {
        self.sphere.radius.to_bits().max(1)
    }
}

/// A vector of components up to 2^31, not zero, scaled to unit length.
fn unit(vector: [i64; 3]) -> [Unit; 3] {
    let square: i64 = vector.iter().map(|c| (c * c) >> 2).sum();
    let length = i64::from(square.unsigned_abs().isqrt() as u32).max(1) * 2;
    vector.map(|c| Unit::from_bits(((c << 30).checked_div(length).unwrap_or(0)) as i32))
}
