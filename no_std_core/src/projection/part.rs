//! The part of the picture that holds the cube: beyond it nothing is drawn,
//! cleared or looked at.

use super::{GUARD_BITS, Projection};
use crate::numbers::SCREEN_BITS;
use crate::reciprocal::reciprocal;
use crate::target::Rect;

impl Projection {
    /// A part of the picture beyond which, by more than `margin` pixels, no
    /// point of the cube is seen. All of it where the cube reaches behind the
    /// near plane.
    ///
    /// In front of it the cube's picture is the hull of its corners'. A
    /// corner's place errs by less than a pixel where that matters: by 2^-18.9
    /// of how far it lies from the picture's middle.
    pub fn part(&self, picture: Rect, margin: i32) -> Rect {
        if self.range()[0] < self.near {
            return picture;
        }
        let (mut first, mut last) = ([i32::MAX; 2], [i32::MIN; 2]);
        for corner in 0..8 {
            let pixel = self.pixel(corner);
            for axis in 0..2 {
                first[axis] = first[axis].min(pixel[axis]);
                last[axis] = last[axis].max(pixel[axis]);
            }
        }
        let within = |at: i32, low: u16, high: u16| {
            at.clamp(i32::from(low), i32::from(high.max(low))) as u16
        };
        let columns = |at: i32| within(at, picture.left, picture.right);
        let rows = |at: i32| within(at, picture.top, picture.bottom);
        let margin = margin + 1;
        Rect {
            left: columns(first[0] - margin),
            top: rows(first[1] - margin),
            right: columns(last[0] + margin + 1),
            bottom: rows(last[1] + margin + 1),
        }
    }

    /// The pixel of a corner in front of the eye, whose signs are the bits of
    /// a number.
    fn pixel(&self, corner: u32) -> [i32; 2] {
        let [x, y, w] = self.forms.map(|form| {
            let along = form.axes.into_iter().enumerate();
            let sum: i64 = along
                .map(|(axis, step)| if corner >> axis & 1 != 0 { step } else { -step })
                .sum();
            // Below 2^30: see the module above.
            ((form.centre + sum) >> GUARD_BITS) as i32
        });
        let inverse = reciprocal(w.max(1) as u32);
        let scale = self.screen_scale + SCREEN_BITS;
        let pixel = |value, middle: i32| (inverse.times(value, scale) + middle) >> SCREEN_BITS;
        let [middle_x, middle_y] = self.middle.map(|middle| middle.to_bits());
        [pixel(x, middle_x), pixel(y, middle_y)]
    }
}
