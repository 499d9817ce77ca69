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

fn resolve_row(lines: [&[u32]; 3], gap: Gap, shader: &Shader<'_>, colours: &mut [u16]) {
    let [above, line, below] = lines;
    let [mut left, mut own, ref rest @ ..] = *line else {
        return;
    };
    let sides = above.iter().zip(below).skip(1);
    for ((colour, &right), (above, below)) in colours.iter_mut().zip(rest).zip(sides) {
        let limit = gap.limit(own);
        let is_plain = left.min(right) <= limit && (*above).min(*below) <= limit;
        let closed = match is_plain {
            true => None,
            false => hole([left, right, *above, *below], limit, gap),
        };
        *colour = match closed {
            None => shader.colour_of(own),
            Some([first, second]) => mean(shader.colour_of(first), shader.colour_of(second)),
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
