//! The samples of packed subtrees: blocks, and the loops that draw them.

use core::hint::black_box;

use super::affine::Affine;
use super::mask::{self, Mask, Walk};
use super::normals::Normals;
use super::packed::Subcells;
use super::record::{Stored, record_of};
use crate::asset::Level;
use crate::asset::node::Flags;
use crate::canvas::{PITCH, Pixel, Window};
use crate::normal::OPPOSITE;

/// A cell whose children are drawn.
#[derive(Clone, Copy)]
pub(super) struct Block<'a, P: Pixel> {
    /// Its centre as a word, with the brush's offset.
    pub place: u32,
    /// Its drawn record where that is one word, else the record's index in the
    /// level below.
    pub record: u32,
    /// Attributes of the children that are drawn.
    pub attributes: &'a [u16],
    /// The first of these children.
    pub sample: P::Sample,
}

impl<P: Pixel> Block<'_, P> {
    /// To be overwritten.
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            place: 0,
            record: 0,
            attributes: &[],
            sample: P::sample(0, 0),
        }
    }

    /// Its drawn record. `level` is its children's.
    #[inline(always)]
    fn drawn<const RHO: u8>(&self, level: &Level<'_>) -> (Mask<RHO>, Flags) {
        if RHO == 3 {
            let flags = Flags::from_bits(self.record.flag_bits(RHO));
            return (self.record.mask(), flags);
        }
        match record_of(level, None, self.record as usize) {
            Some(record) => (record.drawn, record.flags),
            None => (Mask::NOTHING, Flags::from_bits(0)),
        }
    }
}

/// What draws samples: numbers that the compiler does not know, because it makes
/// known ones anew for each sample.
struct Pen {
    walk: Walk,
    /// The bits of a place, shifted right by 20, that are a pixel's index in
    /// the window.
    pixel: u32,
}

impl Pen {
    #[inline(always)]
    fn new() -> Self {
        Self {
            walk: Walk::new(),
            pixel: black_box(0xf0f),
        }
    }

    /// Draws a sample, COLUMNS by ROWS pixels of it. Of two samples the larger
    /// word stays: the nearer one, whichever comes first, and of equal depths
    /// always the same.
    #[inline(always)]
    fn dab<const COLUMNS: usize, const ROWS: usize, P: Pixel>(
        &self,
        place: u32,
        (attribute, sample): (u16, P::Sample),
        window: &mut Window<P>,
    ) {
        let first = (place >> 20 & self.pixel) as usize;
        let word = place << 16 | u32::from(attribute);
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let pixel = &mut window[first + row * PITCH + column];
                if word > pixel.word() {
                    *pixel = P::new(word, sample);
                }
            }
        }
    }

    /// Draws the children of a block. `seen` tells whether a sample shows, how,
    /// and how much deeper.
    #[inline(always)]
    fn draw<const RHO: u8, const COLUMNS: usize, const ROWS: usize, P: Pixel>(
        &self,
        block: &Block<'_, P>,
        drawn: Mask<RHO>,
        subcells: &Subcells,
        mut seen: impl FnMut(u16) -> Option<(u16, u32)>,
        window: &mut Window<P>,
    ) {
        let mut rest = block.attributes;
        let mut sample = block.sample;
        for (word, &middle) in drawn.words().zip(&subcells.words) {
            // One word has as many cells as there are attributes.
            let count = match mask::words(RHO) {
                1 => rest.len(),
                _ => word.count_ones() as usize,
            };
            let Some((own, others)) = rest.split_at_checked(count) else {
                break;
            };
            rest = others;
            let middle = match mask::words(RHO) {
                // The middle of all slabs is the block's.
                1 => block.place,
                _ => block.place.wrapping_add(middle),
            };
            let mut slots = word;
            for &attribute in own {
                let slot = self.walk.lowest(&mut slots);
                let place = middle.wrapping_add(subcells.cells[slot]);
                if let Some((attribute, deeper)) = seen(attribute) {
                    let place = place.wrapping_sub(deeper);
                    self.dab::<COLUMNS, ROWS, P>(place, (attribute, sample), window);
                }
                sample = P::ahead(sample, 1);
            }
        }
    }
}

/// Draws the children of blocks; gives how many are drawn. `level` is the
/// children's.
#[inline(never)]
pub(super) fn draw_blocks<const RHO: u8, const COLUMNS: usize, const ROWS: usize, P: Pixel>(
    window: &mut Window<P>,
    blocks: &[Block<'_, P>],
    affine: &Affine,
    level: &Level<'_>,
    normals: &Normals,
) -> u32 {
    let mut drawn = 0;
    let pen = Pen::new();
    let both_ways = affine.both_ways;
    for block in blocks {
        drawn += block.attributes.len() as u32;
        let (mask, flags) = block.drawn::<RHO>(level);
        if flags.aperture >= both_ways {
            let seen = (normals, flags.is_sheet());
            drawn -= draw_both_ways::<RHO, COLUMNS, ROWS, P>(block, mask, affine, seen, window);
        } else {
            let as_it_is = |attribute| Some((attribute, 0));
            pen.draw::<RHO, COLUMNS, ROWS, P>(block, mask, &affine.leaves, as_it_is, window);
        }
    }
    drawn
}

/// Draws a block whose samples may face either way: those that face the eye,
/// and gives how many do not. Those of a sheet show the side that is seen, but lie deeper where it is not
/// their own: where a wall has samples of its own on either side, the far side's
/// do not show between the near side's.
#[inline(never)]
fn draw_both_ways<const RHO: u8, const COLUMNS: usize, const ROWS: usize, P: Pixel>(
    block: &Block<'_, P>,
    drawn: Mask<RHO>,
    affine: &Affine,
    (normals, is_sheet): (&Normals, bool),
    window: &mut Window<P>,
) -> u32 {
    let pen = Pen::new();
    let mut away = 0;
    if is_sheet {
        let either_side = |attribute| match normals.faces_away(attribute) {
            true => Some((attribute ^ OPPOSITE, affine.far_side)),
            false => Some((attribute, 0)),
        };
        pen.draw::<RHO, COLUMNS, ROWS, P>(block, drawn, &affine.leaves, either_side, window);
    } else {
        let own_side = |attribute| match normals.faces_away(attribute) {
            true => {
                away += 1;
                None
            }
            false => Some((attribute, 0)),
        };
        pen.draw::<RHO, COLUMNS, ROWS, P>(block, drawn, &affine.leaves, own_side, window);
    }
    away
}
