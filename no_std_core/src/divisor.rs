//! Wide numbers over one divisor: a division once, a product each time.

use crate::numbers::{bit_length, shift_round};

/// A positive divisor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divisor {
    /// 2^(63 + bits) over it, rounded down: within 2^-62 of that.
    inverse: u64,
    /// Its bit length.
    bits: i32,
}

impl Divisor {
    /// What is not positive counts as one.
    pub fn new(divisor: i128) -> Self {
        let divisor = divisor.max(1).unsigned_abs();
        let bits = bit_length(divisor);
        // The highest bit goes to bit 63.
        let mantissa = match bits - 64 {
            down @ 1.. => divisor >> down,
            up => divisor << -up,
        };
        let inverse = (1u128 << 127).checked_div(mantissa).unwrap_or(0);
        Self {
            inverse: inverse.min(u128::from(u64::MAX)) as u64,
            bits,
        }
    }

    /// `value / divisor * 2^scale` within 2^-60 of it, rounded to nearest and
    /// saturated.
    pub fn quotient(&self, value: i128, scale: i32) -> i64 {
        let magnitude = value.unsigned_abs();
        let down = (bit_length(magnitude) - 63).max(0);
        // 63 + 64 bits; one less, so that half of them still rounds up.
        let product = ((magnitude >> down) * u128::from(self.inverse)) >> 1;
        let product = match value < 0 {
            true => -(product as i128),
            false => product as i128,
        };
        shift_round(product, 62 + self.bits - down - scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number of any length up to so many bits.
    fn number(rng: &mut fastrand::Rng, bits: u32) -> i128 {
        (rng.u128(..) >> (128 - rng.u32(1..=bits))) as i128
    }

    #[test]
    fn quotients_are_those_of_a_division() {
        let mut rng = fastrand::Rng::with_seed(91);
        for case in 0..100_000 {
            let divisor = number(&mut rng, 126).max(1);
            let value = number(&mut rng, 126) * i128::from(rng.i32(-1..=1));
            let scale = rng.i32(-100..100);
            let got = Divisor::new(divisor).quotient(value, scale);
            let want = value as f64 / divisor as f64 * 2f64.powi(scale);
            let want = want.clamp(i64::MIN as f64, i64::MAX as f64);
            let slack = 0.5 + want.abs() * 2f64.powi(-50);
            let off = (got as f64 - want).abs();
            assert!(off <= slack, "case {case}: {value} / {divisor} * 2^{scale}");
        }
    }

    #[test]
    fn sixty_bits_are_right() {
        let mut rng = fastrand::Rng::with_seed(92);
        for _ in 0..100_000 {
            let divisor = number(&mut rng, 60).max(1);
            let value = number(&mut rng, 100) / divisor.max(1 << 38);
            let exact = (value << 26) / divisor;
            if exact < 1 << 62 {
                let got = i128::from(Divisor::new(divisor).quotient(value, 26));
                assert!(
                    (got - exact).abs() <= 1 + (exact >> 60),
                    "{value} / {divisor}"
                );
            }
        }
    }

    #[test]
    fn what_is_not_positive_counts_as_one() {
        for divisor in [1, 0, -5, i128::MIN] {
            assert_eq!(Divisor::new(divisor).quotient(-77, 0), -77);
        }
        assert_eq!(Divisor::new(i128::MAX).quotient(i128::MAX, 0), 1);
    }
}
