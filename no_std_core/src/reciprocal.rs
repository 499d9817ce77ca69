//! Reciprocals by table and shift, for cores without a divide instruction.
//!
//! Source: Duguet and Drettakis 2003, 6.1 (a look-up table, the operand's
//! scale taken out by shifts). Changes here: the table is interpolated
//! linearly between 256 steps.
//!
//! The operand w > 0 is shifted left until its highest bit is bit 31: m = w
//! << shift, 2^31 <= m < 2^32. The mantissa r approximates 2^62 / m, so that
//! 1 / w = r 2^(shift - 62).
//!
//! A chord over a step h = 1/256 lies at most h^2 / 4 = 2^-18 above 1/m at
//! m = 1, relative to it. Half of the chord's largest error is taken off the
//! table, which leaves 2^-19 either way; rounding adds less than 2^-29. The
//! relative error is below 2^-18.9, and r never grows with w: a test walks
//! all 2^24 operands that the interpolation tells apart.

use crate::numbers::saturate;

const STEPS: usize = 256;

static TABLE: [u32; STEPS + 1] = {
    let mut table = [0; STEPS + 1];
    let mut step = 0;
    while step <= STEPS {
        let mantissa = (STEPS + step) as u128;
        let exact = (STEPS as u128) << 31;
        // Half the chord's error: 2^31 h^2 / (8 m^3), m = mantissa / 256.
        let correction = (4096 << 24) / (mantissa * mantissa * mantissa);
        table[step] = ((exact + mantissa / 2) / mantissa - correction) as u32;
        step += 1;
    }
    table
};

/// A reciprocal: `mantissa * 2^(shift - 62)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reciprocal {
    /// Between 2^30 - 2^10 and 2^31.
    pub mantissa: u32,
    /// Left shift that brought the operand's highest bit to bit 31: 0 to 31.
    pub shift: i32,
}

/// The reciprocal of a positive operand; zero counts as one.
#[inline(always)]
pub fn reciprocal(operand: u32) -> Reciprocal {
    let mut normalized = operand | u32::from(operand == 0);
    let mut shift = 0;
    for step in [16, 8, 4, 2, 1] {
        if normalized >> (32 - step) == 0 {
            normalized <<= step;
            shift += step;
        }
    }
    Reciprocal {
        mantissa: mantissa(normalized),
        shift,
    }
}

/// The reciprocal's mantissa of an operand whose highest bit is bit 31.
#[inline(always)]
pub(crate) fn mantissa(normalized: u32) -> u32 {
    let index = (normalized >> 23) as usize % STEPS;
    let fraction = (normalized >> 7) & 0xffff;
    let (left, right) = match TABLE.get(index..index + 2) {
        Some(&[left, right]) => (left, right),
        _ => (0, 0),
    };
    let below = (u64::from(left.wrapping_sub(right)) * u64::from(fraction)) >> 16;
    left.wrapping_sub(below as u32)
}

impl Reciprocal {
    /// `value / operand * 2^scale`, rounded down and saturated at +-2^30.
    ///
    /// 32 x 32 -> 64 bits: |value| <= 2^31 and the mantissa below 2^31 leave
    /// one bit. As both are signed, that is one instruction.
    #[inline(always)]
    pub fn times(self, value: i32, scale: i32) -> i32 {
        let product = i64::from(value) * i64::from(self.mantissa as i32);
        let shift = 62 - scale - self.shift;
        if let 32..=63 = shift {
            // The upper word is at most 2^30 in magnitude.
            return (product >> 32) as i32 >> (shift - 32);
        }
        wide_shift(product, shift)
    }
}

/// Shifts a product right and saturates it, for any shift. Where the shift
/// would be to the left, every non-zero product saturates anyway: it is at
/// least 2^30 - 2^10 before.
#[inline(never)]
fn wide_shift(product: i64, shift: i32) -> i32 {
    saturate(product >> shift.clamp(0, 63))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mantissa_is_within_the_bound_and_monotone() {
        let bound = 2f64.powf(-18.9);
        let mut above = u32::MAX;
        let mut worst = 0f64;
        for group in 1u32 << 24..1 << 25 {
            let (first, last) = (group << 7, (group << 7) | 127);
            let got = reciprocal(first);
            assert_eq!(got, reciprocal(last), "operands {first:#x} and {last:#x}");
            assert_eq!(got.shift, 0);
            assert!(got.mantissa <= above, "grows at {first:#x}");
            above = got.mantissa;
            for operand in [first, last] {
                let product = f64::from(operand) * f64::from(got.mantissa);
                worst = worst.max((product / 2f64.powi(62) - 1.0).abs());
            }
        }
        assert!(worst < bound, "relative error {worst}");
        let wrapped = reciprocal(1 << 31).mantissa / 2;
        assert!(wrapped <= above, "grows between octaves");
    }

    #[test]
    fn every_shift_is_found() {
        for bits in 0..32 {
            let operand = 1u32 << bits;
            assert_eq!(reciprocal(operand).shift, 31 - bits);
            assert_eq!(reciprocal(operand | (operand / 2)).shift, 31 - bits);
        }
        assert_eq!(reciprocal(0), reciprocal(1));
    }

    #[test]
    fn times_divides_and_saturates() {
        assert_eq!(reciprocal(4).times(1 << 20, 2) >> 4, ((1 << 20) - 4) >> 4);
        assert_eq!(reciprocal(1).times(i32::MAX, 31), 1 << 30);
        assert_eq!(reciprocal(1).times(i32::MIN, 31), -(1 << 30));
        assert_eq!(reciprocal(u32::MAX).times(0, 31), 0);
        assert_eq!(reciprocal(u32::MAX).times(1, -40), 0);
    }
}
