//! A shadow map: the depths of what is nearest to the light.

use super::space::{DEPTH_BITS, LightSpace, TEXEL_BITS};
use crate::asset::Grid;
use crate::numbers::{Length, SplatPx};
use crate::placement::Placement;
use crate::projection::Form;

/// Squares of n texels lie side by side without gaps for edges of up to n - 1
/// and so much more, texels Q16.
const FILL: u64 = 3 << 14;

/// A map while it is drawn.
pub(crate) struct Map<'a> {
    depths: &'a mut [u16],
    size: usize,
}

impl<'a> Map<'a> {
    /// Of so many texels along a side.
    pub fn new(depths: &'a mut [u16], size: u16) -> Self {
        Self {
            depths,
            size: usize::from(size),
        }
    }

    /// The window around a place, u and v with [`TEXEL_BITS`], in a map of
    /// [`PITCH`] texels a side; and its first column and row.
    #[inline(always)]
    pub fn window(&mut self, [u, v]: [i32; 2]) -> Option<([i32; 2], &mut Window)> {
        let last = PITCH as i32 - WINDOW - WINDOW_SIDE as i32 + 1;
        let first = |at: i32| ((at >> TEXEL_BITS) - WINDOW / 2).clamp(0, last);
        let first = [first(u), first(v)];
        let start = first[1] as usize * PITCH + first[0] as usize;
        let texels = self.depths.get_mut(start..)?.first_chunk_mut()?;
        Some((first, texels))
    }

    /// Whether the map has windows: [`PITCH`] texels a side.
    pub fn has_windows(&self) -> bool {
        self.size == PITCH
    }

    /// Draws a square of texels around a place, u and v with [`TEXEL_BITS`],
    /// depth with [`DEPTH_BITS`].
    #[inline(always)]
    pub fn square(&mut self, [u, v, depth]: [i32; 3], side: usize) {
        // The texels whose centres lie nearest to the place.
        let half = ((side as i32) << (TEXEL_BITS - 1)) - (1 << (TEXEL_BITS - 1));
        let last = self.size.saturating_sub(side);
        let first = |at: i32| (((at - half) >> TEXEL_BITS).max(0) as usize).min(last);
        let depth = (depth >> DEPTH_BITS).clamp(1, 0xffff) as u16;
        let mut start = first(v) * self.size + first(u);
        for _ in 0..side {
            let Some(texels) = self.depths.get_mut(start..start + side) else {
                return;
            };
            for texel in texels {
                if depth > *texel {
                    *texel = depth;
                }
            }
            start += self.size;
        }
    }
}

/// Texels from row to row of maps that have windows.
pub(crate) const PITCH: usize = 256;

/// Rows and columns of a window.
pub(crate) const WINDOW: i32 = 16;

/// Texels along a side of the largest squares that are drawn in windows.
pub(crate) const WINDOW_SIDE: usize = 3;

/// A part of a map: 16 rows and columns, and what squares at any of them reach.
pub(crate) type Window = [u16; (WINDOW as usize + WINDOW_SIDE - 2) * (PITCH + 1) + 1];

/// How a grid's cells reach a map.
pub(crate) struct CastForms {
    /// u, v and depth over the cube.
    pub forms: [Form; 3],
    /// Depth of the cells that are drawn.
    pub bottom: u8,
    /// Their edge, texels Q16.
    pub edge: u64,
    /// Texels along a side of their squares.
    pub side: usize,
}

impl CastForms {
    /// Cells with an edge of at most `splat` texels are one square each.
    pub fn new(space: &LightSpace, grid: &Grid<'_>, placement: &Placement, splat: SplatPx) -> Self {
        let rho = u64::from(grid.rho()).max(1);
        let mut edge = edge(space, placement.half_side());
        let mut bottom = 0;
        while bottom < grid.depth() && edge > u64::from(splat.to_bits()) {
            edge = edge.checked_div(rho).unwrap_or(0) + 1;
            bottom += 1;
        }
        let side = ((edge + FILL) >> 16) as usize + 1;
        Self {
            forms: space.forms(placement),
            bottom,
            edge,
            side: side.min(usize::from(space.size)),
        }
    }
}

/// Twice a length, an edge's half, in texels, Q16.
pub(crate) fn edge(space: &LightSpace, half: Length) -> u64 {
    let [texels, ..] = space.reaches();
    let wide = i128::from(half.to_bits()) * i128::from(texels);
    space.over_radius(wide, 17).clamp(0, 1 << 40) as u64
}
