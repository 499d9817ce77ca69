//! Instances of a scene, one after the other: what is nearer stays.

use core::ops::Range;

use super::{Gap, Neighbourhood, OWN, hole, inner, is_far_from_holes, mean};
use crate::canvas::{Canvas, Pixel};
use crate::scene::MAX_LAMPS;
use crate::shade::Shader;
use crate::shadow::{Receiver, Row};
use crate::target::Picture;

/// Colours of an instance's samples, by what light reaches their pixels.
pub(crate) struct Shadowed<'a> {
    pub shader: &'a Shader<'a>,
    /// By lamp.
    pub receivers: &'a [Option<Receiver<'a>>; MAX_LAMPS],
}

/// A row of the picture in the lamps' maps.
type Rows = [Option<Row>; MAX_LAMPS];

impl Shadowed<'_> {
    fn rows(&self, column: u16, row: u16) -> Rows {
        self.receivers
            .each_ref()
            .map(|receiver| Some(receiver.as_ref()?.row(column, row)))
    }

    /// The colour of a pixel of the canvas, the index-th of a row.
    fn colour<P: Pixel>(&self, rows: &Rows, index: usize, pixel: P) -> u16 {
        let mut unlit = 0;
        for (bit, (receiver, row)) in self.receivers.iter().zip(rows).enumerate() {
            if let (Some(receiver), Some(row)) = (receiver, row)
                && receiver.is_shadowed(row, index, pixel.word())
            {
                unlit |= 1 << bit;
            }
        }
        pixel.colour(self.shader, unlit)
    }
}

/// Writes a strip's colours and depths where they are nearer than what is
/// there.
pub(crate) fn merge<P: Pixel>(
    canvas: &Canvas<'_, P>,
    repair: Option<Gap>,
    shadowed: &Shadowed<'_>,
    picture: &mut Picture<'_>,
) {
    let repair = repair.filter(|_| cfg!(feature = "repair"));
    let (columns, rows) = canvas.touched();
    let mut above = [0; 2];
    for row in rows {
        let Some(pixels) = canvas.neighbourhoods(&columns, row) else {
            return;
        };
        let Some((colours, depths)) = picture.layer(columns.clone(), row) else {
            return;
        };
        let mut line = Line {
            pixels,
            repair,
            inner: inner(pixels, &mut above, colours.len()),
            colours,
            depths,
        };
        match shadowed.receivers {
            [None, None, None] => line.merge(|_, pixel| pixel.colour(shadowed.shader, 0)),
            [Some(receiver), None, None] => {
                let row = receiver.row(columns.start, row);
                line.merge(|index, pixel| {
                    let unlit = receiver.is_shadowed(&row, index, pixel.word());
                    pixel.colour(shadowed.shader, unlit.into())
                });
            }
            _ => {
                let maps = shadowed.rows(columns.start, row);
                line.merge(|index, pixel| shadowed.colour(&maps, index, pixel));
            }
        }
    }
}

/// A row on its way into the picture.
struct Line<'l, P> {
    pixels: &'l [P],
    repair: Option<Gap>,
    /// The pixels that may show something.
    inner: Range<usize>,
    colours: &'l mut [u16],
    depths: &'l mut [u16],
}

impl<P: Pixel> Line<'_, P> {
    #[inline(never)]
    fn merge(&mut self, colour: impl Fn(usize, P) -> u16) {
        let inner = self.inner.clone();
        let (Some(pixels), Some(colours), Some(depths)) = (
            self.pixels.get(inner.start..),
            self.colours.get_mut(inner.clone()),
            self.depths.get_mut(inner.clone()),
        ) else {
            return;
        };
        let places = colours.iter_mut().zip(depths).zip(pixels.array_windows());
        for (((own, depth), around), index) in places.zip(inner.start..) {
            let (hole, shown) = match self.repair {
                Some(gap) => shown(around, gap),
                None => (None, around[OWN]),
            };
            let nearer = (shown.word() >> 16) as u16;
            if nearer > *depth {
                *depth = nearer;
                *own = match hole {
                    Some([first, second]) => mean(colour(index, first), colour(index, second)),
                    None => colour(index, shown),
                };
            }
        }
    }
}

/// What closes a pixel, if it is a hole, and the pixel that its depth is of.
#[inline(always)]
fn shown<P: Pixel>(around: &Neighbourhood<P>, gap: Gap) -> (Option<[P; 2]>, P) {
    let own = around[OWN];
    if own.word() != 0 && is_far_from_holes(around, gap) {
        return (None, own);
    }
    match hole(around, gap) {
        Some([first, second]) => {
            let deeper = match first.word() < second.word() {
                true => first,
                false => second,
            };
            (Some([first, second]), deeper)
        }
        None => (None, own),
    }
}
