//! From the canvas to colours, with holes closed.
//!
//! Samples are drawn as points where their cells are at most a pixel large, so
//! that a pixel here and there is missed: it shows nothing, or what lies
//! behind. Such a *hole* is a pixel between two others, left and right or
//! above and below, that are as near as each other, up to a few cells, and
//! nearer than it by more. It takes their mean colour. A gap of one pixel that
//! is really there is closed, too.

use crate::canvas::Canvas;
use crate::shade::Shader;
use crate::target::Picture;

/// How much nearer a neighbour is, depth << 16, to make a hole of a pixel
/// that shows `word`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// At depth zero; at most 2^30.
    pub base: u32,
    /// More for each depth: depth >> shift, at least two.
    pub shift: u32,
}

/// Writes a strip's colours, and depths where they are asked for.
pub(crate) fn resolve(
    canvas: &Canvas<'_>,
    repair: Option<Gap>,
    shader: &Shader<'_>,
    picture: &mut Picture<'_>,
) {
    let strip = canvas.strip;
    let (columns, rows) = canvas.touched();
    for row in strip.top..strip.bottom {
        let drawn = if rows.contains(&row) {
            columns.clone()
        } else {
            strip.left..strip.left
        };
        for beside in [strip.left..drawn.start, drawn.end..strip.right] {
            if let Some(colours) = picture.colours(beside.clone(), row) {
                colours.fill(0);
            }
            if let Some(depths) = picture.depths(beside, row) {
                depths.fill(0);
            }
        }
        let Some(lines) = canvas.neighbourhood(&drawn, row) else {
            return;
        };
        if let Some(colours) = picture.colours(drawn.clone(), row) {
            match repair {
                Some(gap) => resolve_row(lines, gap, shader, colours),
                None => plain_row(lines[1], shader, colours),
            }
        }
        if let Some(depths) = picture.depths(drawn, row) {
            depth_row(lines, repair, depths);
        }
    }
}

fn plain_row(line: &[u32], shader: &Shader<'_>, colours: &mut [u16]) {
    for (colour, &own) in colours.iter_mut().zip(line.iter().skip(1)) {
        *colour = shader.colour_of(own);
    }
}

/// Leaves out what is empty at the row's two ends, four pixels at a time.
fn resolve_row(lines: [&[u32]; 3], gap: Gap, shader: &Shader<'_>, colours: &mut [u16]) {
    let [above, line, _] = lines;
    // A hole has something on two sides, and so beside it or above it.
    let is_empty =
        |([a, b, c, d], [e, f, g, h]): (&[u32; 4], &[u32; 4])| a | b | c | d | e | f | g | h == 0;
    let fours = above.as_chunks().0.iter().zip(line.as_chunks().0);
    let ahead = fours.take_while(|&four| is_empty(four)).count();
    let fours = above.as_rchunks().1.iter().zip(line.as_rchunks().1);
    let behind = fours.rev().take_while(|&four| is_empty(four)).count();
    // Lines begin one pixel before the colours and end one behind them.
    let first = (4 * ahead).saturating_sub(2).min(colours.len());
    let rest = colours.len() - first;
    let last = (4 * behind).saturating_sub(2).min(rest);
    let (before, inner) = colours.split_at_mut(first);
    let (inner, after) = inner.split_at_mut(rest - last);
    before.fill(0);
    after.fill(0);
    let lines = lines.map(|line| line.get(first..).unwrap_or(&[]));
    resolve_pixels(lines, gap, shader, inner);
}

/// Most pixels are far from any hole: their left and upper neighbours are not
/// nearer than by the least gap, and nothing else is looked at.
#[inline(always)]
fn resolve_pixels(lines: [&[u32]; 3], gap: Gap, shader: &Shader<'_>, colours: &mut [u16]) {
    let [above, line, below] = lines;
    let [mut left, mut own, ref rest @ ..] = *line else {
        return;
    };
    let sides = above.iter().zip(below).skip(1);
    for ((colour, &right), (above, below)) in colours.iter_mut().zip(rest).zip(sides) {
        let least = gap.least(own);
        *colour = if left <= least && *above <= least {
            shader.colour_of(own)
        } else {
            match hole([left, right, *above, *below], gap.limit(own), gap) {
                None => shader.colour_of(own),
                Some([first, second]) => mean(shader.colour_of(first), shader.colour_of(second)),
            }
        };
        (left, own) = (own, right);
    }
}

fn depth_row(lines: [&[u32]; 3], repair: Option<Gap>, depths: &mut [u16]) {
    let [above, line, below] = lines;
    let triples = line.windows(3);
    let sides = above.iter().zip(below).skip(1);
    for ((depth, triple), (&above, &below)) in depths.iter_mut().zip(triples).zip(sides) {
        let &[left, own, right] = triple else {
            return;
        };
        let neighbours = [left, right, above, below];
        let shown = match repair.and_then(|gap| hole(neighbours, gap.limit(own), gap)) {
            Some([first, second]) => first.min(second),
            None => own,
        };
        *depth = (shown >> 16) as u16;
    }
}

impl Gap {
    /// A lower bound of [`Gap::limit`].
    #[inline(always)]
    fn least(self, word: u32) -> u32 {
        if word == 0 {
            0
        } else {
            word.saturating_add(self.base)
        }
    }

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

/// The neighbours that close a hole, if it is one.
#[inline(never)]
fn hole(neighbours: [u32; 4], limit: u32, gap: Gap) -> Option<[u32; 2]> {
    let [left, right, above, below] = neighbours;
    let closes = |a: u32, b: u32| {
        let (deeper, nearer) = (a.min(b), a.max(b));
        deeper > limit && nearer <= gap.limit(deeper)
    };
    if closes(left, right) {
        Some([left, right])
    } else if closes(above, below) {
        Some([above, below])
    } else {
        None
    }
}

/// The mean of two RGB565 colours, each channel rounded down.
#[inline(always)]
fn mean(a: u16, b: u16) -> u16 {
    (a & b) + (((a ^ b) & 0xf7de) >> 1)
}

#[cfg(test)]
mod tests;
