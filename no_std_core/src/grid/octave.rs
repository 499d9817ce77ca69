//! The projection of points at about one distance.
//!
//! Within one octave of w reciprocals have one shift, so that whatever depends
//! on it is found once for many points.

use super::footprint::Place;
use super::tables::Point;
use crate::numbers::SCREEN_BITS;
use crate::projection::Projection;
use crate::reciprocal::{Reciprocal, mantissa};

/// The projection within an octave of w.
pub(super) struct Octave {
    /// The highest bit of its w.
    top: i32,
    /// Left shift that brings it to bit 31.
    shift: i32,
    /// Right shift of the upper word of X or Y times a mantissa.
    screen_shift: i32,
    /// The picture's middle.
    middle: [i32; 2],
    /// See [`Projection::depth_scale`].
    depth_factor: u32,
    depth_shift: i32,
    depth_offset: i32,
}

/// The highest bit of no positive w.
const NO_TOP: i32 = 31;

impl Octave {
    /// The octave of a reciprocal; without points where shifts are not a
    /// word's.
    pub fn of(projection: &Projection, inverse: Reciprocal) -> Self {
        let shift = inverse.shift;
        let screen_shift = 30 - (projection.screen_scale + SCREEN_BITS) - shift;
        let depth = projection.depth_scale(shift);
        let is_narrow = (0..=31).contains(&screen_shift) && depth.is_some();
        let (depth_factor, depth_shift, depth_offset) = depth.unwrap_or_default();
        Self {
            top: if is_narrow { 31 - shift } else { NO_TOP },
            shift,
            screen_shift,
            middle: projection.middle.map(|middle| middle.to_bits()),
            depth_factor,
            depth_shift,
            depth_offset,
        }
    }

    /// The place of a point, as [`Place::of`] has it, but for its depth, which
    /// may also lie beyond the limits that are set there. `None` beyond the
    /// octave.
    #[inline(always)]
    pub fn place(&self, point: Point) -> Option<Place> {
        if point.w >> self.top != 1 {
            return None;
        }
        let mantissa = mantissa((point.w as u32) << self.shift);
        let [middle_x, middle_y] = self.middle;
        let on_screen = |value: i32| {
            let product = i64::from(value) * i64::from(mantissa as i32);
            (product >> 32) as i32 >> self.screen_shift
        };
        let product = u64::from(mantissa) * u64::from(self.depth_factor);
        let scaled = ((product >> 32) as u32 >> self.depth_shift) as i32;
        Some(Place {
            x: on_screen(point.x) + middle_x,
            y: on_screen(point.y) + middle_y,
            depth: scaled - self.depth_offset,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reciprocal::reciprocal;
    use crate::testing::view::camera;
    use fastrand::Rng;

    #[test]
    fn places_are_those_of_the_projection() {
        let mut rng = Rng::with_seed(1);
        let (mut placed, mut beyond) = (0, 0);
        for _ in 0..20_000 {
            let projection = Projection::new(&camera(&mut rng, 20.0, 320.0));
            let bits = rng.i32(1..31);
            let w = rng.i32(1..1 << bits);
            let octave = Octave::of(&projection, reciprocal(w as u32));
            for _ in 0..8 {
                let reach = 1 << 29;
                let point = Point {
                    x: rng.i32(-reach..reach),
                    y: rng.i32(-reach..reach),
                    w: rng.i32(w / 2 + 1..w.saturating_mul(2)),
                };
                let Some(place) = octave.place(point) else {
                    beyond += 1;
                    continue;
                };
                placed += 1;
                let want = Place::of(&projection, point, reciprocal(point.w as u32));
                let got = [place.x, place.y, place.depth.clamp(1, 65535)];
                assert_eq!(got, [want.x, want.y, want.depth], "{point:?}");
            }
        }
        assert!(placed > 10_000 && beyond > 10_000, "{placed} {beyond}");
    }
}
