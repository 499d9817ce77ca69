//! The plan of a frame: from which distance on cells of each depth are small
//! enough, and what need not be looked at.
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

use crate::asset::{Grid, MAX_LEVELS};
use crate::camera::Camera;
use crate::draw::Quality;
use crate::numbers::bit_length;
use crate::projection::Projection;
use crate::resolve::Gap;

/// Deepest packed subtree.
const PACKED_LEVELS: usize = 2;
/// Cells up to this edge are drawn as points, pixels Q16: a larger one is a
/// splat of its own size.
const POINT_PX: i64 = 5 << 14;
/// Points of cells with longer edges are two pixels wide, pixels Q16.
const WIDE_PX: i64 = 15 << 12;
/// How much nearer a hole's neighbours are, in cells.
const GAP_CELLS: i64 = 4;
/// Longest focal length of which sizes are told, pixels Q8; with a longer one
/// no cell is small enough.
const LONGEST: i64 = 1 << 30;
/// Never: no cell is so far away.
const NEVER: i32 = i32::MAX;

/// From where on cells of one depth are small enough, block units of w.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LevelPlan {
    /// To stop there: an edge is at most the quality's splat.
    pub stop: i32,
    /// To be drawn as the bottom of a packed subtree of one level, of two.
    pub packed: [i32; PACKED_LEVELS],
    /// To be drawn as points that are one pixel wide.
    pub narrow: i32,
}

/// What a frame does.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// By depth.
    pub levels: [LevelPlan; MAX_LEVELS],
    /// Depth of the deepest cells that are drawn: nothing of the cube is near
    /// enough for deeper ones.
    pub depth: u8,
    /// What makes a hole; `None` leaves holes alone.
    pub repair: Option<Gap>,
}

impl Plan {
    pub fn new(
        grid: &Grid<'_>,
        camera: &Camera,
        quality: &Quality,
        projection: &Projection,
    ) -> Self {
        let none = LevelPlan {
            stop: NEVER,
            packed: [NEVER; PACKED_LEVELS],
            narrow: NEVER,
        };
        let mut levels = [none; MAX_LEVELS];
        let lens = Lens::new(camera, projection);
        let rho = i64::from(grid.rho()).max(1);
        // The root's edge is two half sides.
        let mut edge = 2 * projection.half_side();
        let splat = i64::from(quality.splat.to_bits());
        let distortion = i64::from(quality.distortion.to_bits());
        for level in levels.iter_mut().take(usize::from(grid.depth()) + 1) {
            *level = LevelPlan {
                stop: lens.farther_than(edge, splat),
                packed: [rho, rho * rho].map(|cells| lens.packed(edge, cells, distortion)),
                narrow: lens.farther_than(edge, WIDE_PX),
            };
            edge /= rho;
        }
        let repair = quality.repair.then(|| lens.gap(projection, splat));
        let nearest = projection.nearest();
        let depth = (0..grid.depth())
            .find(|&depth| nearest >= levels[usize::from(depth) % MAX_LEVELS].stop)
            .unwrap_or(grid.depth());
        Self {
            levels,
            depth,
            repair,
        }
    }

    /// The plan of a depth.
    #[inline(always)]
    pub fn level(&self, depth: u8) -> &LevelPlan {
        &self.levels[usize::from(depth) % MAX_LEVELS]
    }
}

/// Lengths to pixels, roughly, from above.
struct Lens {
    /// Focal length in pixels, Q8, rounded up.
    focal: i64,
    /// f' of the module, pixels Q8, rounded up.
    oblique: i64,
    near: i64,
}

impl Lens {
    fn new(camera: &Camera, projection: &Projection) -> Self {
        let focal = (camera.focal_px.to_bits() >> 24).clamp(0, LONGEST) + 1;
        let [width, height] = [camera.width, camera.height].map(|size| i64::from(size) << 7);
        let square = focal * focal + width * width + height * height;
        Self {
            focal,
            oblique: square.unsigned_abs().isqrt() as i64 + 1,
            near: i64::from(projection.near),
        }
    }

    /// The distance from which an edge is at most `pixels`, Q16, long.
    fn farther_than(&self, edge: i64, pixels: i64) -> i32 {
        if pixels <= 0 || self.focal > LONGEST {
            return NEVER;
        }
        // Q8 pixels x 31 bits, to Q16.
        let wide = (i128::from(edge + 1) * i128::from(self.focal)) << 8;
        narrow((wide / i128::from(pixels)) as i64)
    }

    /// [`GAP_CELLS`] cells of the splat's size. At the distance w such a cell
    /// is splat w / f long; depth + offset being scale / w, its depth is
    /// (depth + offset) splat / f.
    fn gap(&self, projection: &Projection, splat: i64) -> Gap {
        let cells = GAP_CELLS * splat.max(1 << 16);
        let slope = ((self.focal << 8) / cells.max(1)).max(1);
        let shift = bit_length(slope as u128) - 1;
        let base = projection.depth_offset() >> shift;
        Gap {
            base: (base.clamp(0, 1 << 14) as u32) << 16,
            shift: (shift as u32).clamp(2, 31),
        }
    }

    /// The distance from which a subtree of so many cells an axis is packed.
    fn packed(&self, edge: i64, cells: i64, distortion: i64) -> i32 {
        if distortion <= 0 {
            return NEVER;
        }
        // sqrt(3) / 2 < 887 / 1024.
        let radius = (((edge + 1) * (cells - 1) * 887) >> 10) + 1;
        // r^2 f' / distortion <= w (w - r).
        let square = i128::from(radius) * i128::from(radius);
        let square = ((square * i128::from(self.oblique)) << 8) / i128::from(distortion);
        let square = square + i128::from(radius) * i128::from(radius) / 4;
        let root = u64::try_from(square)
            .map_or(u64::MAX, |square| square)
            .isqrt() as i64;
        narrow(
            (radius / 2 + root + 1)
                .max(i64::from(self.farther_than(edge, POINT_PX)))
                .max(self.near.saturating_add(radius)),
        )
    }
}

fn narrow(w: i64) -> i32 {
    w.clamp(0, i64::from(NEVER)) as i32
}
