//! Instances of a scene, one after the other: what is nearer stays.

use core::ops::Range;

use super::{Gap, Neighbourhood, OWN, hole, inner, is_far_from_holes, mean};
use crate::canvas::Canvas;
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

    /// The colour of a word of the canvas at the index-th pixel of a row.
    fn colour(&self, rows: &Rows, index: usize, word: u32) -> u16 {
        let mut unlit = 0;
        for (bit, (receiver, row)) in self.receivers.iter().zip(rows).enumerate() {
            if let (Some(receiver), Some(row)) = (receiver, row)
                && receiver.is_shadowed(row, index, word)
            {
                unlit |= 1 << bit;
            }
        }
        self.shader.colour_without(word as u16, unlit)
    }
}

/// Writes a strip's colours and depths where they are nearer than what is
/// there.
pub(crate) fn merge(
    canvas: &Canvas<'_>,
    repair: Option<Gap>,
    shadowed: &Shadowed<'_>,
    picture: &mut Picture<'_>,
) {
    let repair = repair.filter(|_| cfg!(feature = "repair"));
    let (columns, rows) = canvas.touched();
    let mut above = [0; 2];
    for row in rows {
        let Some(words) = canvas.neighbourhoods(&columns, row) else {
            return;
        };
        let Some((colours, depths)) = picture.layer(columns.clone(), row) else {
            return;
        };
        let mut line = Line {
            words,
            repair,
            inner: inner(words, &mut above, colours.len()),
            colours,
            depths,
        };
        match shadowed.receivers {
            [None, None, None] => line.merge(|_, word| shadowed.shader.colour(word as u16)),
            [Some(receiver), None, None] => {
                let row = receiver.row(columns.start, row);
                line.merge(|index, word| {
                    let unlit = receiver.is_shadowed(&row, index, word);
                    let attribute = word as u16;
                    shadowed.shader.colour_without(attribute, unlit.into())
                });
            }
            _ => {
                let maps = shadowed.rows(columns.start, row);
                line.merge(|index, word| shadowed.colour(&maps, index, word));
            }
        }
    }
}

/// A row on its way into the picture.
struct Line<'l> {
    words: &'l [u32],
    repair: Option<Gap>,
    /// The pixels that may show something.
    inner: Range<usize>,
    colours: &'l mut [u16],
    depths: &'l mut [u16],
}

impl Line<'_> {
    #[inline(never)]
    fn merge(&mut self, colour: impl Fn(usize, u32) -> u16) {
        let inner = self.inner.clone();
        let (Some(words), Some(colours), Some(depths)) = (
            self.words.get(inner.start..),
            self.colours.get_mut(inner.clone()),
            self.depths.get_mut(inner.clone()),
        ) else {
            return;
        };
        let pixels = colours.iter_mut().zip(depths).zip(words.array_windows());
        for (((own, depth), around), index) in pixels.zip(inner.start..) {
            let (hole, shown) = match self.repair {
                Some(gap) => shown(around, gap),
                None => (None, around[OWN]),
            };
            let nearer = (shown >> 16) as u16;
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

/// What closes a pixel, if it is a hole, and the word that its depth is of.
#[inline(always)]
fn shown(around: &Neighbourhood, gap: Gap) -> (Option<[u32; 2]>, u32) {
    let own = around[OWN];
    if own != 0 && is_far_from_holes(around, gap) {
        return (None, own);
    }
    match hole(around, gap) {
        Some([first, second]) => (Some([first, second]), first.min(second)),
        None => (None, own),
    }
}
