//! The camera's projection of one grid, in block fixed point.
//!
//! A point p of the model maps linearly to X = f (p - eye) . right, Y = -f
//! (p - eye) . up and w = (p - eye) . forward; the pixel is the picture's
//! middle plus (X, Y) / w. X and Y share one binary exponent, w has its own,
//! both chosen so that every point of the cube stays below 2^30 in magnitude
//! and uses that width. The exponents' difference is the only scale that the
//! draw loops see.
//!
//! # Depth
//!
//! Depth is 16 bits, larger is nearer, zero is empty: depth = 1 + 65534
//! (1/w - 1/far) / (1/near - 1/far), limited to [1, 65535], where *far* is
//! the w of the cube's farthest corner and *near* that of its nearest, but at
//! least far / 128 and the camera's near distance. It resolves w^2 (1/near -
//! 1/far) / 65534: at the far end far / 65534 where near:far is 1:2, far / 516
//! where it is 1:128. What lies nearer than *near* shares one depth.
//!
//! Depth never grows with w and is 1 at *far*. Elsewhere it errs by at most
//!
//! ```text
//! 2 + 65534 (near / w + near / far) far / (far - near) 2^-18.8:
//! ```
//!
//! rounding, and the reciprocal table's error at w and at far. That is below 3
//! up to a distance of 6 half sides and grows with the eye's distance.
//!
//! # Error of the forms
//!
//! In block units, X and Y lie within 2^-10 + |X| 2^-31 of the camera's exact
//! bits (the eye's products keep 40 fraction bits, the focal length 31), w
//! within 2^-31. What becomes of that on the screen: see `grid/tables.rs`.

mod part;
mod unproject;

pub(crate) use unproject::DepthToW;

use crate::camera::Camera;
use crate::numbers::{Length, SCREEN_BITS, ScreenPx, Unit, bit_length, shift_round};
use crate::reciprocal::{Reciprocal, reciprocal};
use crate::target::Rect;

/// Fraction bits that the basis keeps beyond the block's unit.
const GUARD_BITS: i32 = 32;
/// Magnitudes stay below two to this.
const BLOCK_BITS: i32 = 30;
/// What an edge of the cube is bounded by, block units of w, half of it.
const MAX_HALF_SIDE: i64 = 1 << 31;
/// The depth range is at most near:far = 1:2^7.
const DEPTH_OCTAVES: u32 = 7;

/// A linear form of model space in block units with guard bits: value at the
/// cube's centre, and change over the half side along x, y, z.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Form {
    pub centre: i64,
    pub axes: [i64; 3],
}

/// The projection of a grid for one frame.
#[derive(Clone, Debug)]
pub(crate) struct Projection {
    /// X, Y, w in block units with [`GUARD_BITS`] fraction bits.
    pub forms: [Form; 3],
    /// Pixels = X / w * 2^screen_scale.
    pub screen_scale: i32,
    /// The picture's middle.
    pub middle: [ScreenPx; 2],
    /// Least w that is drawn, block units, at least 1.
    pub near: i32,
    /// A block unit of w is 2^w_scale half sides.
    pub w_scale: i32,
    /// The cube's half side in block units of w, rounded up, at most
    /// [`MAX_HALF_SIDE`].
    pub half_side: i64,
    depth: DepthScale,
}

/// depth = (mantissa * reciprocal's mantissa >> shift) - offset.
#[derive(Clone, Copy, Debug)]
struct DepthScale {
    mantissa: u32,
    shift: i32,
    offset: i64,
    /// The offset, or what makes every 30-bit value end at one.
    narrow_offset: i32,
    /// Nearest and farthest w of the scale, block units.
    range: [i64; 2],
}

/// A linear form of model space before it is scaled: value at the cube's
/// centre and change over the half side along x, y, z, 62 fraction bits, below
/// 2^98.
pub(crate) type Row = (i128, [i128; 3]);

/// A camera as a grid sees it.
pub(crate) struct Sight {
    /// (p - eye) along right, up and forward.
    pub rows: [Row; 3],
    /// The eye in model space, where facing is tested.
    pub eye: [Length; 3],
    /// The longest edge of a cell that spans the half cube, in the units of w.
    pub half_side: Length,
}

impl Sight {
    /// Of a camera in model space.
    pub fn new(camera: &Camera) -> Self {
        let eye = camera.eye.map(|c| i128::from(c.to_bits()));
        let row = |v: [Unit; 3]| {
            let axes = v.map(|c| i128::from(c.to_bits()));
            // Q2.30 x Q32.32.
            let centre = -(axes[0] * eye[0] + axes[1] * eye[1] + axes[2] * eye[2]);
            (centre, axes.map(|axis| axis << 32))
        };
        Self {
            rows: [row(camera.right), row(camera.up), row(camera.forward)],
            eye: camera.eye,
            half_side: Length::ONE,
        }
    }
}

impl Sight {
    /// The nearest and farthest w.
    pub fn range(&self) -> [Length; 2] {
        let (centre, axes) = self.rows[2];
        let reach: i128 = axes.iter().map(|axis| axis.abs()).sum();
        [centre - reach, centre + reach].map(|w| Length::from_bits(shift_round(w, 30)))
    }
}

impl Projection {
    /// Sets a frame up for a camera in model space.
    pub fn new(camera: &Camera) -> Self {
        Self::of(camera, &Sight::new(camera), None)
    }

    /// The same for a camera as a grid sees it. `range` is of the w that depths
    /// resolve; `None` for the cube's own.
    pub fn of(camera: &Camera, sight: &Sight, range: Option<[Length; 2]>) -> Self {
        let [right, up, w] = sight.rows;
        let down = (-up.0, up.1.map(|axis| -axis));
        // The focal length's highest bit goes to bit 30.
        let focal_bits = i128::from(camera.focal_px.to_bits()).max(1);
        let focal_shift = bit_length(focal_bits as u128) - 31;
        let focal = i128::from(shift_round(focal_bits, focal_shift));
        let times_focal = |(centre, axes): (i128, [i128; 3])| {
            // 62 fraction bits become 40: 2^76 x 2^31 fits.
            let scaled = |v: i128| (v >> 22) * focal;
            (scaled(centre), axes.map(scaled))
        };
        let x = times_focal(right);
        let y = times_focal(down);
        let screen_shift = block_shift(&[x, y]);
        let w_shift = block_shift(&[w]);
        let form = |(centre, axes): (i128, [i128; 3]), shift: i32| Form {
            centre: shift_round(centre, shift),
            axes: axes.map(|axis| shift_round(axis, shift)),
        };
        let forms = [
            form(x, screen_shift),
            form(y, screen_shift),
            form(w, w_shift),
        ];
        // X has 40 + 32 - focal_shift fraction bits before its shift, w 62.
        let screen_scale =
            (screen_shift + GUARD_BITS) - (72 - focal_shift) - ((w_shift + GUARD_BITS) - 62);
        let near = i128::from(camera.near.to_bits().max(1));
        let near = shift_round(near, w_shift + GUARD_BITS - 30).clamp(1, 1 << BLOCK_BITS);
        let middle = |size: u16| ScreenPx::from_bits(i32::from(size) << 11);
        let w_scale = w_shift + GUARD_BITS - 62;
        let range = match range {
            None => range_of(&forms[2]),
            Some(range) => range.map(|w| shift_round(i128::from(w.to_bits()), w_scale + 32)),
        };
        Self {
            depth: DepthScale::new(range, near),
            forms,
            screen_scale,
            middle: [middle(camera.width), middle(camera.height)],
            near: near as i32,
            w_scale,
            half_side: shift_round(i128::from(sight.half_side.to_bits()), w_scale + 32)
                .clamp(0, MAX_HALF_SIDE - 1)
                + 1,
        }
    }

    /// Bounds of w over the cube, block units.
    pub fn range(&self) -> [i32; 2] {
        let [_, _, w] = &self.forms;
        let reach: i64 = w.axes.iter().map(|axis| axis.saturating_abs()).sum();
        let bound = |w: i64, slack: i64| (w >> GUARD_BITS).saturating_add(slack) as i32;
        [bound(w.centre - reach, -2), bound(w.centre + reach, 2)]
    }

    /// Whether the cube lies in front of the near plane and inside the four
    /// sides of a part of the picture.
    ///
    /// X 2^screen_scale = b w is the plane through a side at b pixels from the
    /// picture's middle: linear, so that the cube's reach across it is the sum
    /// over its half edges.
    pub fn holds_cube(&self, part: Rect) -> bool {
        let scale = self.screen_scale + SCREEN_BITS;
        if !(0..=30).contains(&scale) || self.range()[0] < self.near {
            return false;
        }
        let [x, y, w] = self.forms.map(|form| {
            let unit = |value: i64| value >> GUARD_BITS;
            (unit(form.centre), form.axes.map(unit))
        });
        let sides = [
            (x, -1, part.left, self.middle[0]),
            (x, 1, part.right, self.middle[0]),
            (y, -1, part.top, self.middle[1]),
            (y, 1, part.bottom, self.middle[1]),
        ];
        sides
            .into_iter()
            .all(|((centre, axes), sign, side, middle)| {
                let bound = (i64::from(side) << SCREEN_BITS) - i64::from(middle.to_bits());
                // 30 bits times 30: planes as in `grid/clip.rs`.
                let across = |screen: i64, w: i64| sign * ((screen << scale) - bound * w);
                let edges = axes.iter().zip(w.1);
                let reach: i64 = edges.map(|(&edge, dw)| across(edge, dw).abs()).sum();
                let slack = 8 * ((1 << scale) + bound.abs());
                across(centre, w.0) < -reach - slack
            })
    }

    /// What depth lacks to be proportional to 1 / w.
    pub fn depth_offset(&self) -> i64 {
        self.depth.offset
    }

    /// Depth of a reciprocal w.
    #[inline(always)]
    pub fn depth(&self, w: Reciprocal) -> u16 {
        let shift = self.depth.shift - w.shift;
        if let 32..=63 = shift {
            // The product's upper word is below 2^30.
            let high = (u64::from(w.mantissa) * u64::from(self.depth.mantissa)) >> 32;
            let scaled = (high as u32 >> (shift - 32)) as i32;
            return (scaled - self.depth.narrow_offset).clamp(1, 65535) as u16;
        }
        (self.depth.scaled(w) - self.depth.offset).clamp(1, 65535) as u16
    }

    /// How depth follows from a mantissa where reciprocals have a shift: its
    /// factor, how far the product's upper word goes to the right, and what is
    /// taken off. `None` if that shift is none of a word.
    pub fn depth_scale(&self, shift: i32) -> Option<(u32, i32, i32)> {
        let DepthScale {
            mantissa,
            narrow_offset,
            ..
        } = self.depth;
        match self.depth.shift - shift {
            shift @ 32..=63 => Some((mantissa, shift - 32, narrow_offset)),
            _ => None,
        }
    }

    /// Depth without its offset: proportional to 1 / w.
    pub fn depth_scaled(&self, w: Reciprocal) -> i64 {
        self.depth.scaled(w)
    }
}

/// The shift that brings the largest magnitude over the cube just below
/// 2^(BLOCK_BITS + GUARD_BITS), rounding included.
fn block_shift(rows: &[(i128, [i128; 3])]) -> i32 {
    let bound = |(centre, axes): &(i128, [i128; 3])| {
        axes.iter().map(|axis| axis.unsigned_abs()).sum::<u128>() + centre.unsigned_abs()
    };
    let largest = rows.iter().map(bound).max().unwrap_or(0);
    bit_length(largest + (largest >> 8)) - (BLOCK_BITS + GUARD_BITS)
}

/// The distances between which depth resolves: see
/// [`crate::projection`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthRange {
    /// Where depth is 65535, half sides.
    pub near: Length,
    /// Where depth is 1, half sides.
    pub far: Length,
}

impl DepthRange {
    /// The range of a camera's frames.
    pub fn of(camera: &Camera) -> Self {
        let projection = Projection::new(camera);
        let [near, far] = projection.depth.range.map(|w| {
            let bits = shift_round(i128::from(w), -projection.w_scale - 32);
            Length::from_bits(bits.max(1))
        });
        Self { near, far }
    }
}

/// The nearest and farthest w of the cube.
fn range_of(w: &Form) -> [i64; 2] {
    let reach: i64 = w
        .axes
        .iter()
        .map(|axis| axis.saturating_abs() >> GUARD_BITS)
        .sum::<i64>()
        + 2;
    let centre = w.centre >> GUARD_BITS;
    [centre - reach, centre + reach]
}

impl DepthScale {
    /// Of the nearest and farthest w, and the least that is drawn.
    fn new([near, far]: [i64; 2], least: i64) -> Self {
        let far = far.max(1);
        let near = near.max(far >> DEPTH_OCTAVES).max(least).max(1);
        // 65534 / (1/near - 1/far) = 65534 near far / (far - near) = scale.
        let span = (far - near).max(1);
        let scale = 65534 * i128::from(near) * i128::from(far) / i128::from(span);
        let shift = bit_length(scale.unsigned_abs()) - 31;
        let mut depth = Self {
            mantissa: shift_round(scale, shift) as u32,
            shift: 62 - shift,
            offset: 0,
            narrow_offset: 0,
            range: [near, far],
        };
        // By the same table: its error at far would shift all depths.
        let beyond = (bit_length(far.unsigned_abs().into()) - 31).max(0);
        let inverse = reciprocal((far >> beyond) as u32);
        depth.offset = depth.scaled(Reciprocal {
            shift: inverse.shift - beyond,
            ..inverse
        }) - 1;
        depth.narrow_offset = depth.offset.min(1 << 30) as i32;
        depth
    }

    /// The scale over w, rounded down: 31 x 31 bits.
    #[inline(never)]
    fn scaled(&self, w: Reciprocal) -> i64 {
        (i64::from(w.mantissa) * i64::from(self.mantissa)) >> (self.shift - w.shift).clamp(0, 63)
    }
}

#[cfg(test)]
mod tests;
