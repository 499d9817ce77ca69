//! Where a grid stands in the world: an affine map from model space.
//!
//! The camera's and the lights' linear forms are composed with the map, so that
//! a placed grid costs what it does in model space: nothing is multiplied for a
//! cell. Facing is tested in model space, which any affine map that keeps the
//! orientation leaves as it is: (n A^-1) . (A p - A e) = n . (p - e).

use crate::camera::Camera;
use crate::divisor::Divisor;
use crate::normal::decode;
use crate::numbers::{Length, Turns, Unit, bit_length, root_up, third_root_up};
use crate::projection::{Row, Sight};
use crate::trig::sin_cos;

/// An affine map: world = origin + axes\[0\] x + axes\[1\] y + axes\[2\] z for a
/// model point (x, y, z) in half sides.
///
/// World units are the caller's. Lengths have 32 fraction bits: axes from about
/// 2^-16 of a unit on keep 16 bits. Axes that span no volume draw nothing; axes
/// that mirror (a negative determinant) turn the surface inside out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// What the model's half side along x, y and z becomes. Below 2^30.
    pub axes: [[Length; 3]; 3],
    /// Where the model's centre comes to lie. Below 2^30.
    pub origin: [Length; 3],
}

impl Placement {
    /// The world is model space.
    pub const IDENTITY: Self = Self {
        axes: [
            [Length::ONE, Length::ZERO, Length::ZERO],
            [Length::ZERO, Length::ONE, Length::ZERO],
            [Length::ZERO, Length::ZERO, Length::ONE],
        ],
        origin: [Length::ZERO; 3],
    };

    /// Turned around the y axis, counter-clockwise from above, and scaled.
    pub fn turned(yaw: Turns, half_side: Length, origin: [Length; 3]) -> Self {
        let (sin, cos) = sin_cos(yaw);
        let scaled = |c: Unit| {
            let wide = i128::from(c.to_bits()) * i128::from(half_side.to_bits());
            Length::from_bits((wide >> 30) as i64)
        };
        let (sin, cos) = (scaled(sin), scaled(cos));
        Self {
            axes: [
                [cos, Length::ZERO, -sin],
                [Length::ZERO, half_side, Length::ZERO],
                [sin, Length::ZERO, cos],
            ],
            origin,
        }
    }

    /// The camera as the placed grid sees it, given the map's inverse.
    pub(crate) fn sight(&self, camera: &Camera, inverse: &Inverse) -> Sight {
        let from_eye = difference(self.origin, camera.eye);
        Sight {
            rows: [camera.right, camera.up, camera.forward].map(|v| self.row(v, from_eye)),
            eye: inverse.point(difference(camera.eye, self.origin)),
            half_side: self.half_side(),
        }
    }

    /// (p - from) . direction for model points p, `origin` being the map's
    /// relative to *from*.
    pub(crate) fn row(&self, direction: [Unit; 3], origin: [i64; 3]) -> Row {
        let along = |v: [i64; 3]| -> i128 {
            // Q2.30 x Q32.32: 62 fraction bits, below 2^96.
            let products = v.iter().zip(direction);
            products
                .map(|(&a, b)| i128::from(a) * i128::from(b.to_bits()))
                .sum()
        };
        (along(origin), self.axes.map(|axis| along(bits(axis))))
    }

    /// The longest edge of what the half cube becomes; not less than what makes
    /// its longest diagonal sqrt(3) times as long.
    pub(crate) fn half_side(&self) -> Length {
        // Halves: their sums fit.
        let halves = self.axes.map(|axis| bits(axis).map(|c| c >> 1));
        let [a, b, c] = halves;
        let sum = |signs: [i64; 2]| [0, 1, 2].map(|at| a[at] + signs[0] * b[at] + signs[1] * c[at]);
        let diagonals = [[1, 1], [1, -1], [-1, 1], [-1, -1]].map(|signs| square(sum(signs)));
        let edges = halves.map(|half| 3 * square(half));
        let longest = diagonals.into_iter().chain(edges).fold(0, u128::max);
        // Two for what the halves have lost.
        let root = 2 * third_root_up(longest) + 2;
        Length::from_bits(root.min(1 << 62) as i64)
    }

    /// Radius of the placed grid around its origin, given that in model space.
    pub(crate) fn radius(&self, model: Length) -> Length {
        // The map's norm is at most that of its longest axes together.
        let squares = self.axes.map(|axis| square(bits(axis)));
        let norm = root_up(match self.is_similar() {
            true => squares.into_iter().fold(0, u128::max),
            false => squares.into_iter().sum::<u128>(),
        });
        let wide = u128::from(norm + 1) * u128::from(model.to_bits().unsigned_abs());
        Length::from_bits((wide >> 32).min(1 << 62) as i64 + 1)
    }

    /// Whether shapes stay similar to themselves: axes at right angles and of
    /// one length, within 2^-12.
    pub(crate) fn is_similar(&self) -> bool {
        let [a, b, c] = self.axes.map(bits);
        let squares = [a, b, c].map(square);
        let slack = squares.into_iter().fold(0, u128::max) >> 12;
        let across = [(a, b), (b, c), (c, a)].map(|(a, b)| dot(a, b).unsigned_abs());
        squares.iter().all(|&own| own.abs_diff(squares[0]) <= slack)
            && across.into_iter().all(|across| across <= slack)
    }
}

/// What takes world vectors back to model space, scaled: see [`Inverse::of`].
pub(crate) struct Inverse {
    /// Rows of the axes' adjugate, which are their normals: below 2^48.
    pub rows: [[i64; 3]; 3],
    /// The inverse is the rows times the determinant's sign over this ...
    volume: Divisor,
    is_mirrored: bool,
    /// ... times two to this.
    shift: i32,
}

impl Inverse {
    /// `None` where axes span no volume that 31-bit axes tell from none.
    pub fn of(placement: &Placement) -> Option<Self> {
        let axes = placement.axes.map(bits);
        let largest = axes.iter().flatten().map(|c| c.unsigned_abs()).max()?;
        let scale = bit_length(u128::from(largest)) - 31;
        let [a, b, c] = axes.map(|axis| axis.map(|c| shifted(i128::from(c), scale)));
        // 2^31 x 2^31 each.
        let crossed = [cross(b, c), cross(c, a), cross(a, b)];
        let volume: i128 = a.iter().zip(crossed[0]).map(|(&a, n)| a * n).sum();
        if volume == 0 {
            return None;
        }
        let largest = crossed.iter().flatten().map(|c| c.unsigned_abs()).max()?;
        let down = bit_length(largest) - 47;
        Some(Self {
            rows: crossed.map(|row| row.map(|c| shifted(c, down) as i64)),
            volume: Divisor::new(volume.abs()),
            is_mirrored: volume < 0,
            // rows 2^down / volume is the inverse of axes 2^-scale, whose unit is
            // 2^-32.
            shift: down - scale + 32,
        })
    }

    /// A world vector, Q32.32, in model space.
    pub fn point(&self, vector: [i64; 3]) -> [Length; 3] {
        self.rows.map(|row| {
            // 2^47 x 2^62 and two bits.
            let sum = i128::from(self.sign()) * dot(row, vector);
            Length::from_bits(self.volume.quotient(sum, self.shift))
        })
    }

    fn sign(&self) -> i64 {
        if self.is_mirrored { -1 } else { 1 }
    }

    /// A world direction in model space, times any positive factor, below 2^30;
    /// zero for zero.
    pub fn direction(&self, vector: [Unit; 3]) -> [i32; 3] {
        let sign = i128::from(self.sign());
        let wide = self.rows.map(|row| {
            let products = row.iter().zip(vector);
            let sum: i128 = products
                .map(|(&a, b)| i128::from(a) * i128::from(b.to_bits()))
                .sum();
            sign * sum
        });
        let largest = wide.iter().map(|c| c.unsigned_abs()).fold(0, u128::max);
        wide.map(|c| shifted(c, bit_length(largest) - 30) as i32)
    }
}

/// How a placed grid's normals meet world directions.
pub(crate) struct NormalMap {
    inverse: Inverse,
    /// Rows of what takes normals to the world, below 2^14; `None` where it is
    /// enough to bring lights to the model.
    rows: Option<[[i32; 3]; 3]>,
}

impl NormalMap {
    pub fn new(placement: &Placement, inverse: Inverse) -> Self {
        let rows = (!placement.is_similar()).then(|| {
            let sign = inverse.sign();
            // The adjugate's columns are normals of the map's sides.
            let largest = inverse.rows.iter().flatten().map(|c| c.unsigned_abs());
            let down = bit_length(u128::from(largest.fold(0, u64::max))) - 14;
            let normal = |at: usize| {
                inverse
                    .rows
                    .map(|row| shifted(i128::from(sign * row[at]), down) as i32)
            };
            [normal(0), normal(1), normal(2)]
        });
        Self { inverse, rows }
    }

    /// Whether normals are used as they are decoded.
    pub fn is_plain(&self) -> bool {
        self.rows.is_none()
    }

    /// A world direction as normals meet it: Q2.14, unit length.
    pub fn light(&self, towards: [Unit; 3]) -> [i32; 3] {
        match self.rows {
            None => unit(self.inverse.direction(towards).map(i64::from)),
            Some(_) => towards.map(|c| (c.to_bits() + (1 << 15)) >> 16),
        }
    }

    /// The normal of a code, Q2.14, unit length.
    pub fn normal(&self, code: u16) -> [i32; 3] {
        let normal = decode(code);
        match self.rows {
            None => normal,
            Some(rows) => unit(rows.map(|row| {
                let products = row.iter().zip(normal);
                products.map(|(&a, b)| i64::from(a) * i64::from(b)).sum()
            })),
        }
    }

    /// Away from a light, in model space, components below 2^15.
    pub fn away(&self, towards: [Unit; 3]) -> [i32; 3] {
        self.inverse.direction(towards).map(|c| -(c >> 16))
    }
}

/// A vector of components below 2^31 in unit length, Q2.14, rounded to nearest.
fn unit(vector: [i64; 3]) -> [i32; 3] {
    let square: i64 = vector.iter().map(|c| c * c / 4).sum();
    let length = 2 * square.unsigned_abs().isqrt().max(1) as i64;
    vector.map(|c| {
        let wide = (2 * (c << 14) + length * c.signum()).checked_div(2 * length);
        wide.unwrap_or(0) as i32
    })
}

/// A vector's bits.
fn bits(vector: [Length; 3]) -> [i64; 3] {
    vector.map(|c| c.to_bits())
}

fn difference(a: [Length; 3], b: [Length; 3]) -> [i64; 3] {
    let [a, b] = [a, b].map(bits);
    [0, 1, 2].map(|at| a[at].saturating_sub(b[at]).clamp(-(1 << 62), 1 << 62))
}

fn square(v: [i64; 3]) -> u128 {
    dot(v, v).unsigned_abs()
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i128 {
    let products = a.into_iter().zip(b);
    products.map(|(a, b)| i128::from(a) * i128::from(b)).sum()
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// To the right, or to the left by a negative number of bits.
fn shifted(value: i128, by: i32) -> i128 {
    match by {
        0..=127 => value >> by,
        -127..0 => value << -by,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn float(v: [Length; 3]) -> [f64; 3] {
        v.map(|c| c.to_num())
    }

    /// Seeded maps: turned, stretched up to 1000:1, sheared, of any size.
    fn placement(rng: &mut fastrand::Rng) -> Placement {
        let size = 2f64.powi(rng.i32(-8..8));
        let stretch = [0, 1, 2].map(|_| 10f64.powf(rng.f64() * -3.0));
        let mut vector =
            |scale: f64| [0, 1, 2].map(|_| Length::from_num((rng.f64() - 0.5) * scale));
        Placement {
            axes: stretch.map(|s| vector(size * s)),
            origin: vector(100.0),
        }
    }

    #[test]
    fn inverse_takes_points_back() {
        let mut rng = fastrand::Rng::with_seed(31);
        for case in 0..2000 {
            let placement = placement(&mut rng);
            let model = [0, 1, 2].map(|_| (rng.f64() - 0.5) * 8.0);
            let axes = placement.axes.map(float);
            let vector = [0, 1, 2].map(|at| {
                let sum: f64 = (0..3).map(|axis| axes[axis][at] * model[axis]).sum();
                Length::from_num(sum).to_bits()
            });
            let Some(inverse) = Inverse::of(&placement) else {
                continue;
            };
            // The map of what comes back is the vector, as far as 2^-32 of a
            // half side and the axes' 31 bits tell.
            let back = float(inverse.point(vector));
            let size = placement.half_side().to_num::<f64>();
            let farthest = back.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
            for at in 0..3 {
                let image: f64 = (0..3).map(|axis| axes[axis][at] * back[axis]).sum();
                let want = vector[at] as f64 / 2f64.powi(32);
                assert!(
                    (image - want).abs() < farthest * size * 1e-8,
                    "case {case}: {image} for {want}, {placement:?}"
                );
            }
        }
    }

    #[test]
    fn identity_sees_what_the_camera_sees() {
        let mut rng = fastrand::Rng::with_seed(7);
        for _ in 0..200 {
            let camera = crate::testing::view::camera(&mut rng, 20.0, 320.0);
            let inverse = Inverse::of(&Placement::IDENTITY).expect("has volume");
            let sight = Placement::IDENTITY.sight(&camera, &inverse);
            let own = Sight::new(&camera);
            assert_eq!(sight.rows, own.rows);
            for (placed, own) in sight.eye.iter().zip(own.eye) {
                assert!(
                    (*placed - own).abs() < Length::from_bits(1 << 6),
                    "{camera:?}"
                );
            }
            assert!(sight.half_side - own.half_side < Length::from_bits(1 << 4));
        }
    }

    #[test]
    fn flat_maps_are_none() {
        let flat = Placement {
            axes: [[Length::ONE; 3], [Length::ONE; 3], [Length::ZERO; 3]],
            ..Placement::IDENTITY
        };
        assert!(Inverse::of(&flat).is_none());
    }

    #[test]
    fn half_side_and_radius_bound_what_the_cube_becomes() {
        let mut rng = fastrand::Rng::with_seed(19);
        for _ in 0..2000 {
            let placement = placement(&mut rng);
            let axes = placement.axes.map(float);
            let point = [0, 1, 2].map(|_| rng.f64() * 2.0 - 1.0);
            let image = [0, 1, 2].map(|at| (0..3).map(|axis| axes[axis][at] * point[axis]).sum());
            let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
            let model = Length::from_num(length(point) + 1e-9);
            assert!(length(image) <= placement.radius(model).to_num::<f64>());
            let edge: f64 = placement.half_side().to_num();
            assert!(length(image) <= 3f64.sqrt() * edge);
            assert!(axes.iter().all(|&axis| length(axis) <= edge));
        }
    }

    #[test]
    fn turned_maps_are_similar() {
        let turned = Placement::turned(
            Turns::from_bits(0x1234_5678),
            Length::from_num(0.3),
            [Length::ONE; 3],
        );
        assert!(turned.is_similar());
        let z = float(turned.axes[2]);
        let yaw = f64::from(0x1234_5678) / 2f64.powi(32) * std::f64::consts::TAU;
        assert!((z[0] - 0.3 * yaw.sin()).abs() < 1e-8 && (z[2] - 0.3 * yaw.cos()).abs() < 1e-8);
        let mut stretched = turned;
        stretched.axes[1][1] = Length::ONE;
        assert!(!stretched.is_similar());
    }
}
