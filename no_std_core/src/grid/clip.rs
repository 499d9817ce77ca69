//! Which cells lie inside a strip, and which beside it, without a division.
//!
//! Source: Duguet and Drettakis 2003, 5.2 (tests in homogeneous coordinates).
//! With b for a side of the strip in pixels from the picture's middle, X
//! 2^screen_scale = b w is a plane through the eye; what a point is beyond it
//! is linear in the point, so a cell's reach across is the sum over its half
//! edges, the same for all cells of a depth.

use super::tables::{Point, Tables};
use crate::canvas::AROUND;
use crate::numbers::SCREEN_BITS;
use crate::projection::Projection;
use crate::target::Rect;

/// Where a cell lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// All of it beyond one side, or nearer than the near plane.
    Outside,
    /// All of it inside the four sides.
    Inside,
    /// Some of it may be inside, some outside.
    Across,
}

/// A side: positive beyond it is outer * (X or Y) * 2^scale - bound * w.
#[derive(Clone, Copy, Debug, Default)]
struct Plane {
    /// 2^scale, or its negative.
    outer: i64,
    /// Pixels, Q12, times the sign.
    bound: i64,
}

/// The sides of a strip and how far cells reach across them.
pub(super) struct Clip<const LEVELS: usize> {
    /// Left, right, top, bottom; `None` where they do not fit the words:
    /// nothing is known of any cell then.
    planes: Option<[Plane; 4]>,
    /// By depth, of each plane.
    reaches: [[i64; 4]; 16],
    /// By depth, in w.
    half_w: [i32; 16],
    near: i32,
}

impl<const LEVELS: usize> Clip<LEVELS> {
    pub fn new<const CELLS: usize>(
        projection: &Projection,
        tables: &Tables<CELLS, LEVELS>,
        depth: u8,
        strip: Rect,
    ) -> Self {
        let scale = projection.screen_scale + SCREEN_BITS;
        let [columns, rows] = AROUND;
        let planes = (0..=30).contains(&scale).then(|| {
            let outer = 1i64 << scale;
            let [middle_x, middle_y] = projection.middle.map(|middle| middle.to_bits());
            let plane = |sign: i64, side: u16, margin: i32, middle: i32| Plane {
                outer: sign * outer,
                bound: sign * i64::from(((i32::from(side) + margin) << SCREEN_BITS) - middle),
            };
            [
                plane(-1, strip.left, -columns, middle_x),
                plane(1, strip.right, columns, middle_x),
                plane(-1, strip.top, -rows, middle_y),
                plane(1, strip.bottom, rows, middle_y),
            ]
        });
        let mut clip = Self {
            planes,
            reaches: [[0; 4]; 16],
            half_w: [0; 16],
            near: projection.near,
        };
        let levels = clip.reaches.iter_mut().zip(&mut clip.half_w);
        for ((reaches, half_w), depth) in levels.zip(0..=depth) {
            let extents = tables.extents(depth);
            *half_w = extents.half_w;
            for ((reach, plane), row) in reaches
                .iter_mut()
                .zip(planes.unwrap_or_default())
                .zip([0, 0, 1, 1])
            {
                let across = |edge: &Point| plane.across(*edge, row).abs();
                let sum: i64 = extents.half_edges.iter().map(across).sum();
                // Eight block units for rounded centres and edges.
                *reach = sum + 8 * (plane.outer.abs() + plane.bound.abs());
            }
        }
        clip
    }

    /// Where a cell of a depth lies.
    pub fn side(&self, depth: u8, centre: Point) -> Side {
        let depth = usize::from(depth) % 16;
        let half_w = self.half_w[depth];
        if centre.w + half_w < self.near {
            return Side::Outside;
        }
        let Some(planes) = &self.planes else {
            return Side::Across;
        };
        if half_w > centre.w / 4 {
            return Side::Across;
        }
        let mut inside = true;
        for ((plane, reach), row) in planes.iter().zip(&self.reaches[depth]).zip([0, 0, 1, 1]) {
            let across = plane.across(centre, row);
            if across > 2 * *reach {
                return Side::Outside;
            }
            inside &= across < -*reach;
        }
        if inside { Side::Inside } else { Side::Across }
    }
}

impl Plane {
    /// How far a point is beyond the plane: 30 x 30 bits.
    #[inline(always)]
    fn across(self, point: Point, row: usize) -> i64 {
        let screen = if row == 0 { point.x } else { point.y };
        i64::from(screen) * self.outer - self.bound * i64::from(point.w)
    }
}
