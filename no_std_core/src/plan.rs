//! The plan of a frame, made before anything is drawn: from which distance on
//! cells of each depth are small enough for which path, and what is left out.
//! Shown, it tells what a frame will do; [`crate::stats::Stats`] tells what it
//! did.

mod distances;
mod show;

use core::cmp::Ordering;

use crate::asset::{Grid, MAX_LEVELS};
use crate::camera::Camera;
use crate::draw::Quality;
use crate::projection::Projection;
use crate::resolve::Gap;
use crate::target::Rect;
use distances::Lens;

/// Deepest packed subtree.
const PACKED_LEVELS: usize = 2;
/// Cells up to this edge are drawn with a [brush](crate::grid), pixels Q16: a
/// larger one is a splat of its own size. At two pixels, squares of two leave
/// slits where neighbours of a thin shell meet at corners.
const BRUSH_PX: i64 = 15 << 13;
/// Cells up to this edge are one pixel, pixels Q16.
const POINT_PX: i64 = 18 << 12;
/// Cells up to this edge are at most two pixels side by side, pixels Q16.
const WIDE_PX: i64 = 24 << 12;
/// How much nearer a hole's neighbours are, in cells.
const GAP_CELLS: i64 = 2;
/// A part of the picture with fewer pixels, for each material, is shaded pixel
/// by pixel: a table takes as long as 2,800 of them, and a scan covers a
/// quarter to a third of its cube's part.
const FEW_PIXELS: usize = 8000;
/// Never: no cell is so far away.
const NEVER: i32 = i32::MAX;
/// From where on cells of one depth are small enough, block units of w.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LevelPlan {
    /// To stop there: an edge is at most the quality's splat.
    pub stop: i32,
    /// To be the bottom of a packed subtree of one level, of two.
    pub packed: [i32; PACKED_LEVELS],
    /// The same of siblings; their parent's w.
    pub siblings: [i32; PACKED_LEVELS],
    /// To be drawn as one pixel.
    pub point: i32,
    /// To be drawn as at most two pixels side by side.
    pub wide: i32,
}

impl LevelPlan {
    const NEVER: Self = Self {
        stop: NEVER,
        packed: [NEVER; PACKED_LEVELS],
        siblings: [NEVER; PACKED_LEVELS],
        point: NEVER,
        wide: NEVER,
    };
}

/// What a frame does.
#[derive(Clone, Debug)]
pub struct Plan {
    /// By depth.
    pub(crate) levels: [LevelPlan; MAX_LEVELS],
    /// Depth of the deepest cells that are drawn: nothing of the cube is near
    /// enough for deeper ones.
    pub(crate) depth: u8,
    /// What makes a hole; `None` leaves holes alone.
    pub(crate) repair: Option<Gap>,
    /// Whether cells are tested for facing away: not where every surface is
    /// drawn from both sides.
    pub(crate) faces: bool,
    /// Whether samples that face away are drawn like any other.
    pub(crate) shows_all: bool,
    /// Whether subtrees are skipped behind what is drawn.
    pub(crate) hides: bool,
    /// Whether cells are tested against the picture's sides: not where it
    /// holds the cube. Strips of it have sides of their own.
    pub(crate) culls: bool,
    /// The part of the picture that holds what is drawn: where all cells are
    /// small, no more than the cube's surroundings.
    pub(crate) part: Rect,
    /// Whether colours are tabulated before they are used.
    pub(crate) tabulates: bool,
    /// Least and largest w of the cube, block units.
    range: [i32; 2],
    /// See [`Projection::w_scale`].
    w_scale: i32,
    /// Depth of the asset's leaves.
    leaves: u8,
    materials: u8,
}

impl Plan {
    /// The plan of a frame.
    pub fn new(grid: &Grid<'_>, camera: &Camera, quality: &Quality) -> Self {
        Self::with(grid, camera, quality, &Projection::new(camera))
    }

    pub(crate) fn with(
        grid: &Grid<'_>,
        camera: &Camera,
        quality: &Quality,
        projection: &Projection,
    ) -> Self {
        let lens = Lens::new(camera, projection);
        let rho = i64::from(grid.rho()).max(1);
        let mut distances = lens.distances(rho, projection, quality);
        let mut levels = [LevelPlan::NEVER; MAX_LEVELS];
        for level in levels.iter_mut().take(usize::from(grid.depth()) + 1) {
            *level = distances.plan(rho, lens.near);
            distances = distances.below(rho);
        }
        let range = projection.range();
        let depth = (0..grid.depth())
            .find(|&depth| range[0] >= levels[usize::from(depth) % MAX_LEVELS].stop)
            .unwrap_or(grid.depth());
        let picture = Rect {
            left: 0,
            top: 0,
            right: camera.width,
            bottom: camera.height,
        };
        let part = part(
            &levels[usize::from(depth) % MAX_LEVELS],
            rho,
            quality,
            projection,
            picture,
        );
        let materials = grid.materials().len();
        Self {
            levels,
            depth,
            repair: quality.repair.then(|| lens.gap(projection, quality)),
            faces: quality.culling && !grid.two_sided(),
            shows_all: !quality.culling,
            hides: quality.culling,
            part,
            tabulates: part.pixels() >= FEW_PIXELS * materials,
            culls: !projection.holds_cube(picture),
            range,
            w_scale: projection.w_scale,
            leaves: grid.depth(),
            materials: materials as u8,
        }
    }

    /// How many of the deepest cells span an axis.
    pub(crate) fn leaves_per_axis(&self, rho: u8) -> u64 {
        u64::from(rho).saturating_pow(self.depth.into())
    }

    /// From which w on a cell above a depth stops there.
    #[inline(always)]
    pub(crate) fn stop(&self, depth: u8) -> i32 {
        match depth.cmp(&self.depth) {
            Ordering::Less => self.level(depth).stop,
            Ordering::Equal => i32::MIN,
            Ordering::Greater => NEVER,
        }
    }

    /// The plan of a depth.
    #[inline(always)]
    pub(crate) fn level(&self, depth: u8) -> &LevelPlan {
        &self.levels[usize::from(depth) % MAX_LEVELS]
    }
}

/// See [`Plan::part`]. `deepest` is the plan of the deepest cells, which are
/// the smallest: larger ones, where they are drawn, are less than rho times as
/// large.
fn part(
    deepest: &LevelPlan,
    rho: i64,
    quality: &Quality,
    projection: &Projection,
    picture: Rect,
) -> Rect {
    if projection.range()[0] < deepest.wide {
        return picture;
    }
    // So far an affine place may lie off, and all of a sample beyond that.
    let margin = quality.distortion.to_num::<i32>() + 2 * rho as i32 + 2;
    projection.part(picture, margin)
}
