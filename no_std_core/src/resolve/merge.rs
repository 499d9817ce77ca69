//! Instances of a scene, one after the other: what is nearer stays.

use super::{Gap, Neighbourhood, OWN, hole, is_far_from_holes, mean};
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
    #[inline(always)]
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
    for row in rows {
        let Some(words) = canvas.neighbourhoods(&columns, row) else {
            return;
        };
        let maps = shadowed.rows(columns.start, row);
        if let Some((colours, depths)) = picture.layer(columns.clone(), row) {
            let colour = |index, word| shadowed.colour(&maps, index, word);
            merge_row(words, repair, colours, depths, colour);
        }
    }
}

#[inline(never)]
fn merge_row(
    words: &[u32],
    repair: Option<Gap>,
    colours: &mut [u16],
    depths: &mut [u16],
    colour: impl Fn(usize, u32) -> u16,
) {
    let pixels = colours.iter_mut().zip(depths).zip(words.array_windows());
    for (index, ((own, depth), around)) in pixels.enumerate() {
        let around: &Neighbourhood = around;
        let word = around[OWN];
        let hole = match repair {
            Some(gap) if !is_far_from_holes(around, gap) => hole(around, gap),
            _ => None,
        };
        let shown = match hole {
            Some([first, second]) => first.min(second),
            None => word,
        };
        let nearer = (shown >> 16) as u16;
        if nearer <= *depth {
            continue;
        }
        *depth = nearer;
        *own = match hole {
            Some([first, second]) => mean(colour(index, first), colour(index, second)),
            None => colour(index, word),
        };
    }
}
