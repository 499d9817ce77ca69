//! Quick facing tests, for the blocks and samples of packed subtrees: by
//! 32-bit words, coarse normals and a view vector of unit length, on the safe
//! side by some degrees. [`super::facing`] has the exact ones.

use super::facing::Facing;
use crate::asset::node::{APERTURE_SINE, Flags};
use crate::normal::{COARSE_ONE, coarse};

/// Facing tests of all cells below one: by its view vector, scaled to unit
/// length, against thresholds of the level.
#[derive(Clone, Copy)]
pub(super) struct Normals {
    /// From the eye, unit length at most, Q14.
    view: [i32; 3],
    /// Sine that a test may be off for the cell's size.
    pub doubt: i32,
}

/// Q14 times 511 to one.
const TEST_ONE: i32 = COARSE_ONE << 14;
/// Sine of what coarse normals and the blocks' sizes may be off.
const DOUBT: i32 = TEST_ONE / 16;

/// No test exceeds it: sines and doubt add up, and nothing turns away.
const NEVER: i32 = 1 << 29;

/// The sines of [`APERTURE_SINE`] for [`Normals`], and of every angle.
static TEST_SINE: [i32; 16] = {
    let mut sines = [NEVER; 16];
    let mut aperture = 0;
    while aperture < 15 {
        sines[aperture] = ((APERTURE_SINE[aperture] as i64 * TEST_ONE as i64) >> 15) as i32;
        aperture += 1;
    }
    sines
};

/// A factor: mantissa 2^(shift - 32). The mantissa is signed for one
/// multiplication of signed words.
#[derive(Clone, Copy)]
struct Scale {
    mantissa: i32,
    shift: i32,
}

impl Scale {
    /// A component grows to 17 bits at most, a radius to 31: eye space's
    /// shortest vectors are a unit long.
    #[inline(always)]
    fn times(self, c: i32) -> i32 {
        ((i64::from(c << self.shift) * i64::from(self.mantissa)) >> 32) as i32
    }
}

/// Inverse roots, rounded down: entry i holds 2^33 / sqrt(i + 1), below 2^31
/// from the first one on that is asked for.
static INVERSE_ROOT: [i32; 64] = {
    let mut table = [0; 64];
    let mut index = 16;
    while index < 64 {
        table[index] = ((1u128 << 66) / (index as u128 + 1)).isqrt() as i32;
        index += 1;
    }
    table
};

/// 2^14 over the length of a vector with this square, at most three percent
/// too small.
#[inline(always)]
fn inverse_length(square: u32) -> Scale {
    // An even shift brings the highest bit to 30 or 31.
    let mut normalized = square | u32::from(square == 0);
    let mut halved = 0;
    for step in [8, 4, 2, 1] {
        if normalized >> (32 - 2 * step) == 0 {
            normalized <<= 2 * step;
            halved += step;
        }
    }
    // With i for the upper six bits, the length is at most sqrt(i + 1) 2^(13 -
    // halved), and 2^14 over it at least 2^33 / sqrt(i + 1) 2^(halved - 32).
    Scale {
        mantissa: INVERSE_ROOT[(normalized >> 26) as usize % 64],
        shift: halved,
    }
}

impl Normals {
    /// For a cell with a view vector, and a radius about its centre.
    #[inline(always)]
    pub fn new(view: [i32; 3], radius: i32) -> Self {
        let [x, y, z] = view.map(|c| c.unsigned_abs());
        // Below 2^15 each.
        let square = x * x + y * y + z * z;
        let scale = inverse_length(square);
        let radius = scale.times(radius.min(1 << 15)).min(1 << 15) * COARSE_ONE;
        Self {
            view: view.map(|c| scale.times(c)),
            doubt: DOUBT + radius,
        }
    }

    /// A normal's component along the view, [`TEST_ONE`] to one, added to a
    /// number.
    #[inline(always)]
    fn along(&self, code: u16, from: i32) -> i32 {
        let [x, y, z] = coarse(code);
        from + x * self.view[0] + y * self.view[1] + z * self.view[2]
    }

    /// Largest component of the viewing direction, Q14.
    pub fn largest(&self) -> i32 {
        let [x, y, z] = self.view.map(i32::abs);
        x.max(y).max(z)
    }

    /// Whether all of a cell faces away, by its cone.
    #[inline(always)]
    pub fn is_away(&self, flags: Flags, code: u16) -> bool {
        let sine = TEST_SINE[usize::from(flags.aperture) % TEST_SINE.len()];
        self.along(code, -self.doubt) > sine
    }

    /// How all of a cell faces, by its cone.
    #[inline(always)]
    pub fn facing(&self, flags: Flags, code: u16) -> Facing {
        let sine = TEST_SINE[usize::from(flags.aperture) % TEST_SINE.len()];
        let (along, limit) = (self.along(code, 0), sine + self.doubt);
        if along > limit {
            Facing::Away
        } else if along < -limit {
            Facing::Toward
        } else {
            Facing::Maybe
        }
    }

    /// Whether a sample faces away.
    #[inline(always)]
    pub fn faces_away(&self, attribute: u16) -> bool {
        self.along(attribute, 0) > 0
    }
}

/// Facing tests for the children of a cell, with one root for all of them.
pub(super) struct Around {
    scale: Scale,
    /// See [`Normals::doubt`].
    doubt: i32,
}

impl Around {
    /// For children with a radius, of a cell with a view vector and a radius.
    ///
    /// With u for the cell's radius over its distance, the children's distance
    /// is between 1 - u and 1 + u of the cell's. Their view vectors are scaled
    /// by (1 - u) <= 1 / (1 + u), so that none becomes longer than one, their
    /// radius by 1 + 2 u >= 1 / (1 - u), as long as u is at most one half.
    pub fn new(view: [i32; 3], around: i32, radius: i32) -> Self {
        let [x, y, z] = view.map(|c| c.unsigned_abs());
        let scale = inverse_length(x * x + y * y + z * z);
        // Q14, rounded up.
        let share = |radius: i32| scale.times(radius.min(1 << 15)) + 1;
        let u = share(around);
        if u > 1 << 13 {
            return Self {
                scale,
                doubt: NEVER,
            };
        }
        let radius = share(radius);
        let radius = radius + ((radius * u) >> 13) + 1;
        let mantissa = (i64::from(scale.mantissa) * i64::from((1 << 14) - u)) >> 14;
        Self {
            scale: Scale {
                mantissa: mantissa as i32,
                ..scale
            },
            doubt: DOUBT + radius * COARSE_ONE,
        }
    }

    /// For a child with a view vector.
    #[inline(always)]
    pub fn normals(&self, view: [i32; 3]) -> Normals {
        Normals {
            view: view.map(|c| self.scale.times(c)),
            doubt: self.doubt,
        }
    }
}
