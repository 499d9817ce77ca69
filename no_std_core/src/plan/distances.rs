//! From which distance on cells of a depth are small enough.
//!
//! # Sizes
//!
//! An edge of length e at the distance w is e f / w pixels long at right
//! angles to the view, f being the focal length. Off the axis a length l, its
//! part along the view included, moves by at most l f' / w pixels, f'^2 = f^2
//! plus the square of half the picture's diagonal.
//!
//! # Distortion
//!
//! In screen space a subtree whose cells' centres lie within r of its own
//! centre is walked by additions. A centre at the offset d, seen from w,
//! lands at (dX - X / w dw) / (w + dw) from the subtree's centre; additions
//! leave the dw below the line out. They err by the offset times |dw| / (w +
//! dw), at most
//!
//! ```text
//! r f' / w * r / (w - r) pixels.
//! ```
//!
//! Where that is within the quality's distortion, and the subtree within a
//! window of the canvas, the subtree is *packed*. For subtrees of m levels
//! with the edge e at the bottom, r = sqrt(3) / 2 (rho^m - 1) e.
//!
//! *Siblings* share the steps at their parent's centre. A centre at the offset
//! d of a subtree at the offset D from its parent errs by what the steps
//! change on the way, with w' for the subtree's own w
//!
//! ```text
//! (dX - X / w dw) / w Dw / w' + (DX - X / w Dw) / w' dw / w',
//! ```
//!
//! in magnitude at most 2 r R f' / v^2, with v for the least w of the
//! siblings' centres and R = sqrt(3) / 2 (rho - 1) rho^m e. That adds to what
//! they would err by alone: in all f' (r^2 + 2 r R) / (v (v - r)).

use super::{BRUSH_PX, GAP_CELLS, LevelPlan, NEVER, PACKED_LEVELS, POINT_PX, WIDE_PX};
use crate::camera::Camera;
use crate::draw::Quality;
use crate::numbers::bit_length;
use crate::projection::Projection;
use crate::resolve::Gap;

/// Longest focal length of which sizes are told, pixels Q8; with a longer one
/// no cell is small enough.
const LONGEST: i64 = 1 << 30;
/// Never, at the root: divided by rho^MAX_LEVELS it still exceeds [`NEVER`].
const FARTHEST: i64 = 1 << 62;

/// Lengths to pixels, roughly, from above.
pub(super) struct Lens {
    /// Focal length in pixels, Q8, rounded up.
    focal: i64,
    /// f' of the module, pixels Q8, rounded up.
    oblique: i64,
    pub near: i64,
}

/// The distances of cells of one depth, block units of w; all are
/// proportional to the edge.
#[derive(Clone, Copy)]
pub(super) struct Distances {
    edge: i64,
    stop: i64,
    brush: i64,
    point: i64,
    wide: i64,
    /// Where packed subtrees of one level, of two, and siblings of them, keep
    /// the distortion: the v of the module.
    packed: [i64; PACKED_LEVELS],
    siblings: [i64; PACKED_LEVELS],
}

impl Distances {
    /// Those a level below. Each is rounded up, by 2^-29 of it and one at most.
    pub fn below(self, rho: i64) -> Self {
        // 1 / rho, Q32, rounded up: no division for each.
        let factor = (1 << 32) / (rho as u64).max(1) + 1;
        let next = |distance: i64| {
            let distance = distance.unsigned_abs();
            // 31 + 31 and 32 + 31 bits.
            let high = (distance >> 32) * factor;
            let low = ((distance & 0xffff_ffff) * factor) >> 32;
            (high + low + 1) as i64
        };
        Self {
            edge: next(self.edge),
            stop: next(self.stop),
            brush: next(self.brush),
            point: next(self.point),
            wide: next(self.wide),
            packed: self.packed.map(next),
            siblings: self.siblings.map(next),
        }
    }

    pub fn plan(&self, rho: i64, near: i64) -> LevelPlan {
        let spans = [rho, rho * rho];
        let from = |v: i64, cells: i64, apart: i64| {
            let [r, apart] = [cells - 1, apart].map(|cells| diagonal(self.edge, cells));
            let v = v.max(self.brush).max(near.saturating_add(r));
            narrow(v.saturating_add(apart))
        };
        let packed = |at: usize| from(self.packed[at], spans[at], 0);
        let siblings = |at: usize| from(self.siblings[at], spans[at], (rho - 1) * spans[at]);
        LevelPlan {
            stop: narrow(self.stop),
            packed: [packed(0), packed(1)],
            siblings: [siblings(0), siblings(1)],
            point: narrow(self.point),
            wide: narrow(self.wide),
        }
    }
}

/// Half the diagonal of so many cells with an edge, rounded up.
fn diagonal(edge: i64, cells: i64) -> i64 {
    // sqrt(3) / 2 < 887 / 1024; edges are at most 2^32, cells below 2^10.
    (((edge + 1) * cells * 887) >> 10) + 1
}

impl Lens {
    pub fn new(camera: &Camera, projection: &Projection) -> Self {
        let focal = (camera.focal_px.to_bits() >> 24).clamp(0, LONGEST) + 1;
        let [width, height] = [camera.width, camera.height].map(|size| i64::from(size) << 7);
        let square = focal * focal + width * width + height * height;
        Self {
            focal,
            oblique: square.unsigned_abs().isqrt() as i64 + 1,
            near: i64::from(projection.near),
        }
    }

    /// The root's.
    pub fn distances(&self, rho: i64, projection: &Projection, quality: &Quality) -> Distances {
        // Two half sides.
        let edge = 2 * projection.half_side;
        let splat = i64::from(quality.splat.to_bits());
        let distortion = i64::from(quality.distortion.to_bits());
        let spans = [rho, rho * rho];
        let undistorted = |cells, apart| self.undistorted(edge, cells, apart, distortion);
        Distances {
            edge,
            stop: self.farther_than(edge, splat),
            brush: self.farther_than(edge, BRUSH_PX),
            point: self.farther_than(edge, POINT_PX),
            wide: self.farther_than(edge, WIDE_PX),
            packed: spans.map(|cells| undistorted(cells, 0)),
            siblings: spans.map(|cells| undistorted(cells, (rho - 1) * cells)),
        }
    }

    /// The distance from which an edge is at most `pixels`, Q16, long.
    fn farther_than(&self, edge: i64, pixels: i64) -> i64 {
        if pixels <= 0 || self.focal > LONGEST {
            return FARTHEST;
        }
        // 32 + 30 bits, Q8 pixels, over Q16 ones.
        let wide = (edge + 1).saturating_mul(self.focal);
        (wide / pixels + 1).saturating_mul(1 << 8).min(FARTHEST)
    }

    /// The gap that makes a hole: [`GAP_CELLS`] cells of the splat's size. At
    /// the distance w such a cell is splat w / f long; depth + offset being
    /// scale / w, its depth is (depth + offset) splat / f.
    pub fn gap(&self, projection: &Projection, quality: &Quality) -> Gap {
        let splat = i64::from(quality.splat.to_bits());
        let cells = GAP_CELLS * splat.max(1 << 16);
        let slope = ((self.focal << 8) / cells.max(1)).max(1);
        let shift = bit_length(slope as u128) - 1;
        let base = projection.depth_offset() >> shift;
        Gap {
            base: (base.clamp(0, 1 << 14) as u32) << 16,
            shift: (shift as u32).clamp(2, 31),
        }
    }

    /// The least v at which subtrees of `cells` an axis, siblings whose centres
    /// span `apart` cells, keep a distortion, pixels Q16: see the module.
    fn undistorted(&self, edge: i64, cells: i64, apart: i64, distortion: i64) -> i64 {
        if distortion <= 0 {
            return FARTHEST;
        }
        // v is at most r + sqrt((r^2 + 2 r R) f' / distortion). With edges of
        // one, the root's square is 3 / 4 of a whole number times Q8 over Q16:
        // to Q20.
        let r = cells - 1;
        let square = 3 * r * (r + 2 * apart) * self.oblique;
        let ratio = square.saturating_mul(1 << 26) / distortion;
        let root = ratio.unsigned_abs().isqrt() as i64 + 1;
        let root = root.saturating_mul(edge + 1) >> 10;
        root.saturating_add(diagonal(edge, r) + 1).min(FARTHEST)
    }
}

fn narrow(w: i64) -> i32 {
    w.clamp(0, i64::from(NEVER)) as i32
}
