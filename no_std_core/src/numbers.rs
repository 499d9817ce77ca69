//! Every number format of the core, in one place.
//!
//! Boundary values are `fixed` types under role names. Inside the draw loops
//! values are plain `i32` in *block fixed point*: X and Y share an exponent for
//! each frame and w has its own, chosen in [`crate::projection`], so that
//! coordinates fill the word. Plain arithmetic traps on overflow in debug and test builds;
//! release relies on no wrapping that is not called `wrapping`.

use fixed::types::{I2F30, I20F12, I32F32, U0F32, U1F31, U16F16};

/// Positions and lengths in model space: the half side of the grid's cube is
/// one. Q32.32, steps of 2.3e-10, range +-2.1e9.
pub type Length = I32F32;

/// Components of unit vectors. Q2.30, steps of 9.3e-10, range [-2, 2).
pub type Unit = I2F30;

/// Angles in full turns, modulo one. Q0.32: a step is 8.4e-8 degrees.
pub type Turns = U0F32;

/// Focal lengths in pixels. Q32.32.
pub type FocalPx = I32F32;

/// Lengths on the screen that options give, in pixels. Q16.16.
pub type SplatPx = U16F16;

/// Screen coordinates in pixels, relative to the picture's middle inside the
/// projection and to its top left corner in the splatter. Q20.12: steps of
/// 1/4096 px, range +-524288 px; projection saturates.
pub type ScreenPx = I20F12;

/// Weights between zero and one (ambient, diffuse). Q1.31.
pub type Weight = U1F31;

/// Fraction bits of [`ScreenPx`].
pub(crate) const SCREEN_BITS: i32 = 12;

/// One pixel in [`ScreenPx`] bits.
pub(crate) const SCREEN_ONE: i32 = 1 << SCREEN_BITS;

/// Narrows to 32 bits, saturating at +-2^30, so that sums and differences of
/// two results still fit.
pub(crate) const fn saturate(value: i64) -> i32 {
    const LIMIT: i64 = 1 << 30;
    if value > LIMIT {
        LIMIT as i32
    } else if value < -LIMIT {
        -LIMIT as i32
    } else {
        value as i32
    }
}

/// `value >> shift`, rounded to nearest (halves up), for any shift: negative
/// shifts saturate to the left, large ones give zero.
pub(crate) fn shift_round(value: i128, shift: i32) -> i64 {
    if shift <= 0 {
        let left = shift.unsigned_abs().min(127);
        return match value.checked_mul(1i128.checked_shl(left).unwrap_or(1)) {
            Some(wide) => clamp_i64(wide),
            None if value < 0 => i64::MIN,
            None => i64::MAX,
        };
    }
    if shift > 126 {
        return 0;
    }
    clamp_i64(((value >> (shift - 1)) + 1) >> 1)
}

fn clamp_i64(value: i128) -> i64 {
    value.clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64
}

/// The square root of a number, rounded up: at most one and 2^-30 of it more.
pub(crate) fn root_up(square: u128) -> u64 {
    let (narrow, half_shift) = narrow_square(square);
    (narrow.isqrt() + 1) << half_shift
}

/// The square root of a third of a number, rounded up in the same way.
pub(crate) fn third_root_up(square: u128) -> u64 {
    let (narrow, half_shift) = narrow_square(square);
    (narrow.div_ceil(3).isqrt() + 1) << half_shift
}

/// A number over an even power of two, rounded up, in 62 bits; and half of that
/// power.
fn narrow_square(square: u128) -> (u64, i32) {
    let half_shift = ((bit_length(square) - 61) / 2).max(0);
    match half_shift {
        0 => (square as u64, 0),
        _ => ((square >> (2 * half_shift)) as u64 + 1, half_shift),
    }
}

/// Bits needed for a magnitude: 0 for 0, else the index of its highest set
/// bit plus one. A binary search of shifts; no CLZ is assumed.
pub(crate) const fn bit_length(value: u128) -> i32 {
    let mut rest = value;
    let mut bits = 0;
    let mut step = 64;
    while step > 0 {
        if rest >> step != 0 {
            rest >>= step;
            bits += step;
        }
        step >>= 1;
    }
    bits + (rest != 0) as i32
}
