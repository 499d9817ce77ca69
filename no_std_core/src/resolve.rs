//! From the canvas to colours, with holes closed.
//!
//! Samples are drawn as points where their cells are about a pixel large, so
//! that a pixel here and there is missed: it shows nothing, or what lies
//! behind. Such a *hole* is a pixel between two others, beside, above and below
//! or across, that are both nearer than it by a few cells. Of several such
//! pairs the one counts whose deeper pixel is nearest; the hole takes its mean
//! colour. Where pixels are missed side by side, half of a hole's eight
//! neighbours are nearer, some to the left or above and some on the other
//! side, though no two are opposite: then it lies between the one above and the
//! second one below, or the other way round. A gap of one pixel that is really
//! there is closed, too.

mod merge;

pub(crate) use merge::{Shadowed, merge};

use core::ops::Range;

use crate::canvas::{Canvas, PITCH, Pixel};
use crate::shade::Shader;
use crate::target::{Picture, Rect, blank};

/// How much nearer a neighbour is, depth << 16, to make a hole of a pixel
/// that shows `word`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// At depth zero; at most 2^30.
    pub base: u32,
    /// More for each depth: depth >> shift, at least two.
    pub shift: u32,
}

/// A pixel and what lies around it on the canvas: five rows of three.
type Neighbourhood<P> = [P; 4 * PITCH + 3];

/// Where the pixel itself is.
const OWN: usize = 2 * PITCH + 1;

/// From a pixel to one of two opposite neighbours, behind it; the other is
/// before it.
const OPPOSITE: [usize; 4] = [1, PITCH, PITCH + 1, PITCH - 1];

/// Writes a strip's colours, and depths where they are asked for. What lies
/// beyond the canvas is empty.
pub(crate) fn resolve<P: Pixel>(
    canvas: &Canvas<'_, P>,
    strip: Rect,
    repair: Option<Gap>,
    shader: &Shader<'_>,
    picture: &mut Picture<'_>,
) {
    let repair = repair.filter(|_| cfg!(feature = "repair"));
    let (columns, rows) = canvas.touched();
    let mut above = [0; 2];
    for beyond in [strip.top..rows.start, rows.end..strip.bottom] {
        picture.blank(strip.left..strip.right, beyond);
    }
    for row in rows {
        for beside in [strip.left..columns.start, columns.end..strip.right] {
            picture.blank(beside, row..row + 1);
        }
        let Some(pixels) = canvas.neighbourhoods(&columns, row) else {
            return;
        };
        if let Some(colours) = picture.colours(columns.clone(), row) {
            match (repair, shader.table_of_one()) {
                (None, _) => plain_row(pixels, shader, colours),
                (Some(gap), None) => {
                    row_of(pixels, &mut above, gap, colours, |pixel: P| {
                        pixel.colour(shader, 0)
                    });
                }
                (Some(gap), Some(table)) => {
                    row_of(pixels, &mut above, gap, colours, |pixel: P| {
                        table[pixel.word() as usize % table.len()]
                    });
                }
            }
        }
        if let Some(depths) = picture.depths(columns.clone(), row) {
            depth_row(pixels, repair, depths);
        }
    }
}

fn plain_row<P: Pixel>(pixels: &[P], shader: &Shader<'_>, colours: &mut [u16]) {
    for (colour, &own) in colours.iter_mut().zip(pixels.iter().skip(OWN)) {
        *colour = match own.word() {
            0 => 0,
            _ => own.colour(shader, 0),
        };
    }
}

/// Least numbers of empty pixels at a line's two ends, four at a time.
fn empty_ends<P: Pixel>(line: &[P]) -> [usize; 2] {
    let is_empty = |&&[a, b, c, d]: &&[P; 4]| a.word() | b.word() | c.word() | d.word() == 0;
    let ahead = line.as_chunks().0.iter().take_while(is_empty);
    let behind = line.as_rchunks().1.iter().rev().take_while(is_empty);
    [4 * ahead.count(), 4 * behind.count()]
}

/// Which of a row's pixels may show something. `above` is how much of the row
/// above is known to be empty at its ends, and then how much of this one.
#[inline(always)]
fn inner<P: Pixel>(pixels: &[P], above: &mut [usize; 2], length: usize) -> Range<usize> {
    // A hole has something on two sides, and so beside it or above it.
    let line = pixels.get(2 * PITCH..2 * PITCH + length + 2);
    let own = line.map_or([0; 2], empty_ends);
    let ahead = above[0].min(own[0]);
    let behind = above[1].min(own[1]);
    *above = own;
    // Lines begin one pixel before the colours and end one behind them.
    let first = ahead.saturating_sub(2).min(length);
    let last = behind.saturating_sub(2).min(length - first);
    first..length - last
}

/// A row of colours, `colour` being that of what is drawn. Its empty ends are
/// left out: `above` is how much of the row above is known to be empty, and
/// then how much of this one.
#[inline(never)]
fn row_of<P: Pixel>(
    pixels: &[P],
    above: &mut [usize; 2],
    gap: Gap,
    colours: &mut [u16],
    colour: impl Fn(P) -> u16,
) {
    let Range { start, end } = inner(pixels, above, colours.len());
    let Some((inner, after)) = colours.split_at_mut_checked(end) else {
        return;
    };
    let Some((before, inner)) = inner.split_at_mut_checked(start) else {
        return;
    };
    blank(before);
    blank(after);
    let around = pixels.get(start..).unwrap_or(&[]).array_windows();
    for (own, around) in inner.iter_mut().zip(around) {
        *own = pixel(around, gap, &colour);
    }
}

/// Whether a pixel that shows something is far from any hole, as most are: of
/// what lies before it nothing is nearer by the least gap.
#[inline(always)]
fn is_far_from_holes<P: Pixel>(around: &Neighbourhood<P>, gap: Gap) -> bool {
    let [before, middle, ahead] =
        [OWN - PITCH - 1, OWN - PITCH, OWN - PITCH + 1].map(|at| around[at].word());
    let nearest = ahead.max(middle).max(before);
    let least = around[OWN].word().saturating_add(gap.base);
    nearest <= least && around[OWN - 1].word() <= least
}

#[inline(always)]
fn pixel<P: Pixel>(around: &Neighbourhood<P>, gap: Gap, colour: &impl Fn(P) -> u16) -> u16 {
    let own = around[OWN];
    if own.word() != 0 && is_far_from_holes(around, gap) {
        return colour(own);
    }
    let colour_of = |pixel: P| match pixel.word() {
        0 => 0,
        _ => colour(pixel),
    };
    match hole(around, gap) {
        None => colour_of(own),
        Some([first, second]) => mean(colour_of(first), colour_of(second)),
    }
}

fn depth_row<P: Pixel>(pixels: &[P], repair: Option<Gap>, depths: &mut [u16]) {
    for (depth, around) in depths.iter_mut().zip(pixels.array_windows()) {
        let shown = match repair.and_then(|gap| hole(around, gap)) {
            Some([first, second]) => first.word().min(second.word()),
            None => around[OWN].word(),
        };
        *depth = (shown >> 16) as u16;
    }
}

impl Gap {
    /// What a neighbour exceeds if it is nearer by the gap.
    #[inline(always)]
    fn limit(self, word: u32) -> u32 {
        if word == 0 {
            0
        } else {
            // Below 2^31: see the fields' bounds.
            word.saturating_add(self.base + (word >> self.shift))
        }
    }
}

/// The two pixels that close a hole, if it is one: see the module.
#[inline(always)]
fn hole<P: Pixel>(around: &Neighbourhood<P>, gap: Gap) -> Option<[P; 2]> {
    let limit = gap.limit(around[OWN].word());
    let before = OPPOSITE.map(|offset| around[OWN - offset].word());
    if before.into_iter().all(|word| word <= limit) {
        return None;
    }
    let behind = OPPOSITE.map(|offset| around[OWN + offset].word());
    if behind.into_iter().all(|word| word <= limit) {
        return None;
    }
    closing(around, limit)
}

/// The same where neighbours on both sides are nearer than the limit.
#[inline(never)]
fn closing<P: Pixel>(around: &Neighbourhood<P>, limit: u32) -> Option<[P; 2]> {
    let pairs = OPPOSITE.map(|offset| [around[OWN - offset], around[OWN + offset]]);
    let deeper = pairs.map(|[before, behind]| before.word().min(behind.word()));
    let nearest = deeper.into_iter().fold(0, u32::max);
    if nearest > limit {
        return pairs
            .into_iter()
            .find(|[before, behind]| before.word().min(behind.word()) == nearest);
    }
    let nearer = pairs.into_iter().flatten();
    let nearer = nearer.filter(|pixel| pixel.word() > limit);
    if nearer.count() < 4 {
        return None;
    }
    let long = [
        [around[OWN - PITCH], around[OWN + 2 * PITCH]],
        [around[OWN - 2 * PITCH], around[OWN + PITCH]],
    ];
    long.into_iter()
        .find(|[above, below]| above.word() > limit && below.word() > limit)
}

/// The mean of two RGB565 colours, each channel rounded down.
#[inline(always)]
fn mean(a: u16, b: u16) -> u16 {
    (a & b) + (((a ^ b) & 0xf7de) >> 1)
}

#[cfg(test)]
mod tests;
