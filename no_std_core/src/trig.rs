//! Sine and cosine by table and angle addition: integers only, made at
//! compile time, within 2^-28 of the exact value.

use crate::numbers::{Turns, Unit};

/// Table steps in a full turn.
const STEPS: usize = 1024;
/// One quarter and its end point are stored; Q1.62.
const QUARTER: usize = STEPS / 4 + 1;
/// 2 pi in Q3.60.
const TAU: i128 = 7_244_019_458_077_122_842;
/// Sine of the angle `step / STEPS` turns in Q2.30, by its Taylor series.
const fn sine_of_step(step: usize) -> i32 {
    let angle = TAU * step as i128 / STEPS as i128;
    let square = (angle * angle) >> 60;
    let mut term = angle;
    let mut sum = angle;
    let mut order = 1;
    while order < 12 {
        term = -((term * square) >> 60) / ((2 * order) * (2 * order + 1));
        sum += term;
        order += 1;
    }
    ((sum + (1 << 29)) >> 30) as i32
}

const SINE: [i32; QUARTER] = {
    let mut table = [0; QUARTER];
    let mut step = 0;
    while step < QUARTER {
        table[step] = sine_of_step(step);
        step += 1;
    }
    table
};

/// Sine of a whole table step, any quadrant, Q2.30.
fn table_sine(step: usize) -> i64 {
    let within = step % (STEPS / 2);
    let mirrored = within.min(STEPS / 2 - within);
    let value = i64::from(SINE.get(mirrored).copied().unwrap_or(0));
    if step % STEPS < STEPS / 2 {
        value
    } else {
        -value
    }
}

/// Sine and cosine of an angle, each within 2^-28 of the exact value.
///
/// The angle's upper ten bits choose a table step a, the rest is a small
/// angle b < 0.0062 rad; sin(a + b) = sin a cos b + cos a sin b with
/// cos b = 1 - b^2/2 (error b^4/24 < 2^-33) and sin b = b - b^3/6.
pub fn sin_cos(angle: Turns) -> (Unit, Unit) {
    const REST_BITS: u32 = 22;
    let bits = angle.to_bits();
    let step = (bits >> REST_BITS) as usize;
    let rest = i64::from(bits & ((1 << REST_BITS) - 1));
    // Q0.36 radians: rest * 2 pi * 2^-32, below 2^30.
    let small = (rest * ((TAU >> 32) as i64)) >> 24;
    let square = (small * small) >> 36;
    let sin_small = small - ((square * small) >> 36) / 6;
    let cos_small = (1 << 36) - square / 2;
    let (sin_step, cos_step) = (table_sine(step), table_sine(step + STEPS / 4));
    // Q2.30 x Q1.31 -> Q3.61: below 2^62.
    let (sin_small, cos_small) = (sin_small >> 5, cos_small >> 5);
    let sine = (sin_step * cos_small + cos_step * sin_small + (1 << 30)) >> 31;
    let cosine = (cos_step * cos_small - sin_step * sin_small + (1 << 30)) >> 31;
    (Unit::from_bits(sine as i32), Unit::from_bits(cosine as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_float_everywhere() {
        for index in 0..200_000u32 {
            let bits = index.wrapping_mul(0x9e37_79b9);
            let (sine, cosine) = sin_cos(Turns::from_bits(bits));
            let angle = f64::from(bits) / f64::from(u32::MAX) * core::f64::consts::TAU;
            let angle = angle * (f64::from(u32::MAX) / 4_294_967_296.0);
            let bound = 1.0 / f64::from(1 << 28);
            let error = |got: Unit, want: f64| (got.to_num::<f64>() - want).abs();
            assert!(error(sine, angle.sin()) < bound, "sine of bits {bits:#x}");
            assert!(
                error(cosine, angle.cos()) < bound,
                "cosine of bits {bits:#x}"
            );
        }
    }

    #[test]
    fn quarters_are_exact() {
        let quarter = |n: u32| sin_cos(Turns::from_bits(n << 30));
        let (zero, one) = (Unit::ZERO, Unit::ONE);
        assert_eq!(quarter(0), (zero, one));
        assert_eq!(quarter(1), (one, zero));
        assert_eq!(quarter(2), (zero, -one));
        assert_eq!(quarter(3), (-one, zero));
    }
}
