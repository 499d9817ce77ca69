//! Which cells face away from the eye.
//!
//! Eye space is model space relative to the eye, in units of
//! [`EyeSpace::unit`] to the cube's half side, every component below 2^15, so
//! that products with Q2.14 normals fit 32 bits. It only serves facing tests;
//! where rounding or a cell's size leaves doubt, cells count as facing the
//! eye.

use crate::asset::node::{APERTURE_ALL, APERTURE_COSINE, APERTURE_SINE, Flags};
use crate::normal::{COMPONENT_BITS, OPPOSITE, decode};
use crate::numbers::{Length, bit_length, shift_round};

/// The scale of eye space and the root's place in it.
pub(crate) struct EyeSpace {
    /// Half side of the cube; zero for eyes so far away that it is below one.
    pub unit: i32,
    /// The root's centre relative to the eye.
    pub centre: [i32; 3],
}

impl EyeSpace {
    /// Of an eye in model space.
    pub fn new(eye: [Length; 3]) -> Self {
        let eye = eye.map(|c| c.to_bits());
        let farthest = eye.iter().map(|c| c.unsigned_abs()).max().unwrap_or(0);
        // |eye| + 1 half side and rounding stay below 2^bits half sides.
        let bits = bit_length(u128::from(farthest) + (3 << 31)) - 32;
        let unit_bits = (15 - bits).min(14);
        let centre = eye.map(|c| shift_round(-i128::from(c), 32 - unit_bits) as i32);
        Self {
            unit: if unit_bits < 0 { 0 } else { 1 << unit_bits },
            centre,
        }
    }
}

/// What a cell's normals say about its visibility.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Facing {
    /// Nothing in the cell faces the eye.
    Away,
    /// Some of it may.
    Maybe,
    /// Everything in the cell does.
    Toward,
}

/// The component of a view vector along a unit normal; positive where the
/// normal points away from the eye. Within four units.
#[inline(always)]
pub(crate) fn along(code: u16, view: [i32; 3]) -> i32 {
    let [x, y, z] = decode(code);
    // Q2.14 x 15 bits: |normal| |view| <= 2^14 2^15 sqrt(3) fits.
    (x * view[0] + y * view[1] + z * view[2]) >> COMPONENT_BITS
}

/// Tests a cell's normal cone. `view` leads from the eye to the cell's
/// centre, `radius` is its bounding sphere's.
///
/// For a normal n within the aperture t of the axis a, any point of the cell
/// v + d with |d| <= radius, and c = a . v: n . (v + d) >= c cos t - sin t
/// sqrt(v^2 - c^2) - radius. The cell faces away where that is positive.
/// Squared, to need no root: (c cos t - radius)^2 > sin^2 t (v^2 - c^2). With
/// -c for c it faces the eye.
pub(crate) fn cone(flags: Flags, code: u16, view: [i32; 3], radius: i32) -> Facing {
    let aperture = usize::from(flags.aperture);
    let (Some(&sine), Some(&cosine)) = (APERTURE_SINE.get(aperture), APERTURE_COSINE.get(aperture))
    else {
        return Facing::Maybe;
    };
    let (sine, cosine) = (i64::from(sine), i64::from(cosine));
    let signed = along(code, view);
    let along = i64::from(signed.abs()) - 4;
    let margin = ((along * cosine) >> 15) - i64::from(radius) - 1;
    if margin <= 0 {
        return Facing::Maybe;
    }
    let [x, y, z] = view.map(i64::from);
    let across = x * x + y * y + z * z - along * along;
    // 16-bit sine squared x 33 bits: below 2^64 / 2.
    let sine_square = ((sine * sine) >> 15) + 1;
    if margin * margin <= (sine_square * across) >> 15 {
        Facing::Maybe
    } else if signed > 0 {
        Facing::Away
    } else {
        Facing::Toward
    }
}

/// Upper bound of a view vector's length, at most 23% too long: the longest
/// component and half of the others.
#[inline(always)]
fn length(view: [i32; 3]) -> i32 {
    let [x, y, z] = view.map(i32::abs);
    let longest = x.max(y).max(z);
    longest + (x + y + z - longest) / 2
}

/// How far along its normal a leaf may lie behind its horizon and still be
/// drawn: the block's radius, because the view vector is the block's, and
/// 3/64 of the distance, which is the sine of the code's 2.5 degrees.
#[inline(always)]
pub(crate) fn horizon(view: [i32; 3], radius: i32) -> i32 {
    radius + length(view) * 3 / 64
}

/// The attribute of a sample that is drawn though its own normal faces away.
///
/// Where the cell holds faces of every direction, it shows its other side:
/// the opposite normal. Elsewhere its normal is only bent beyond a face that
/// is seen, and stays.
#[inline(always)]
pub(crate) fn turned(attribute: u16, flags: Flags) -> u16 {
    if flags.aperture == APERTURE_ALL {
        attribute ^ OPPOSITE
    } else {
        attribute
    }
}

#[cfg(test)]
mod tests;
