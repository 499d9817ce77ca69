//! The slow twin of drawing: every leaf in float, straight from the
//! definition, with an interval wherever the stated errors leave doubt.
//!
//! A leaf's place, half sides and depth come with their error bounds. Each
//! pixel that a leaf surely covers limits the picture's depth from below;
//! what the picture shows must be a leaf that may cover the pixel, at a depth
//! inside that leaf's interval. So a picture is right or wrong, up to what
//! the bounds leave open, and how much that is gets counted.

use std::vec::Vec;

use crate::camera::Camera;
use crate::normal::decode;
use crate::numbers::Length;
use crate::projection::DepthRange;
use crate::testing::model::Cell;
use crate::testing::view::eye_unit;
use crate::testing::{Exact, Model, dot};

/// What sixteenths of a pixel lose in a packed place: half of one for the
/// start, and of each of two levels for the row, the word, and up to two steps
/// along x.
const PACKED_ROUNDING: f64 = (1.0 + 2.0 * 4.0) / 32.0;

/// Least aperture of blocks whose samples are tested for facing away.
const BOTH_WAYS: u8 = 7;

/// A value and how far it may be off.
#[derive(Clone, Copy, Debug)]
struct Near {
    value: f64,
    error: f64,
}

impl Near {
    fn surely_above(self, limit: f64) -> bool {
        self.value - self.error > limit
    }

    fn maybe_above(self, limit: f64) -> bool {
        self.value + self.error > limit
    }
}

/// One leaf on the screen.
#[derive(Debug)]
struct Leaf {
    place: [Near; 2],
    half: [Near; 2],
    core: Near,
    rim: Near,
    colour: u16,
    /// Whether it is drawn without doubt.
    sure: bool,
    /// Whether it may cover its home pixel alone.
    may_be_point: bool,
}

/// What a comparison found.
#[derive(Debug, Default)]
pub(super) struct Verdict {
    /// Pixels that a leaf surely covers.
    pub covered: usize,
    /// Pixels where more than one answer is right.
    pub open: usize,
}

/// A view in float.
struct View<'a> {
    model: &'a Model,
    exact: Exact,
    /// Upper bounds of the block units: X and Y, w.
    units: [f64; 2],
    near: f64,
    /// Where depth is 65535 and 1.
    range: [f64; 2],
    eye_unit: f64,
    /// Largest error of a packed subtree, pixels; none is packed at zero.
    distortion: f64,
}

/// Compares a picture with its twin. `None` where a whole block's treatment
/// at the near plane is in doubt.
pub(super) fn compare(
    model: &Model,
    camera: &Camera,
    distortion: f64,
    colour: &[u16],
    depth: &[u16],
) -> Option<Result<Verdict, std::string::String>> {
    let view = View::new(model, camera, distortion);
    let leaves = view.leaves()?;
    let width = usize::from(camera.width);
    let mut least = std::vec![0f64; depth.len()];
    for leaf in &leaves {
        leaf.for_each_pixel(width, depth.len() / width, |pixel, sure, [low, _]| {
            if sure && leaf.sure {
                least[pixel] = least[pixel].max(low);
            }
        });
    }
    let mut explained = std::vec![false; depth.len()];
    let mut contenders = std::vec![0usize; depth.len()];
    for leaf in &leaves {
        leaf.for_each_pixel(width, depth.len() / width, |pixel, _, [low, high]| {
            if high >= least[pixel] {
                contenders[pixel] += 1;
                let drawn = f64::from(depth[pixel]);
                explained[pixel] |= leaf.colour == colour[pixel] && (low..=high).contains(&drawn);
            }
        });
    }
    let mut verdict = Verdict::default();
    for (pixel, &drawn) in depth.iter().enumerate() {
        let answers = contenders[pixel] + usize::from(least[pixel] == 0.0);
        verdict.open += usize::from(answers > 1);
        verdict.covered += usize::from(least[pixel] > 0.0);
        let right = if drawn == 0 {
            least[pixel] == 0.0
        } else {
            explained[pixel] && f64::from(drawn) >= least[pixel]
        };
        if !right {
            let (x, y) = (pixel % width, pixel / width);
            return Some(Err(std::format!(
                "pixel {x}, {y}: colour {:#06x}, depth {drawn}; {} leaves may show, depth at least {}",
                colour[pixel],
                contenders[pixel],
                least[pixel]
            )));
        }
    }
    Some(Ok(verdict))
}

impl<'a> View<'a> {
    fn new(model: &'a Model, camera: &Camera, distortion: f64) -> Self {
        let exact = Exact::new(camera);
        let centre = exact.forms([0.0; 3]);
        let edges = exact.half_edges(1.0);
        let largest = |row: usize| {
            let edges = edges.iter().map(|edge| edge[row].abs());
            centre[row].abs() + edges.sum::<f64>()
        };
        // 2^30 units hold the largest value with a margin of 1/256, and at
        // most twice that.
        let unit = |largest: f64| largest * (257.0 / 256.0) * 2f64.powi(-29);
        let range = DepthRange::of(camera);
        Self {
            model,
            units: [unit(largest(0).max(largest(1))), unit(largest(2))],
            near: camera.near.max(Length::DELTA).to_num(),
            range: [range.near.to_num(), range.far.to_num()],
            eye_unit: eye_unit(camera),
            distortion,
            exact,
        }
    }

    /// All leaves that may be drawn.
    fn leaves(&self) -> Option<Vec<Leaf>> {
        let model = self.model;
        let depth = usize::from(model.depth());
        let mut leaves = Vec::new();
        for cell in &model.levels[depth] {
            let centre = model.centre(depth, cell);
            let point = self.exact.forms(centre);
            let units = (depth as f64 + 1.0) / 2.0 + 2f64.powi(-8);
            let w_error = (units + 1.0) * self.units[1];
            if point[2] < self.near - w_error {
                continue;
            }
            let mut sure = point[2] > self.near + w_error;
            let edges = self.edges(depth);
            if self.left_out(depth, cell, units, -1.0) {
                continue;
            }
            sure &= !self.left_out(depth, cell, units, 1.0);
            // The block decides whose nearest corner counts.
            let mut base = (point, None);
            if depth > 0 {
                let block = &model.levels[depth - 1][cell.parent];
                let block_centre = model.centre(depth - 1, block);
                let block_point = self.exact.forms(block_centre);
                let nearest = block_point[2] - self.reach(depth - 1);
                let doubt = (units + 6.0) * self.units[1];
                let limit = self.near.max(block_point[2] / 2.0);
                if (nearest - limit).abs() <= doubt {
                    return None;
                }
                if nearest > limit {
                    base = (block_point, Some(nearest));
                }
                if !block.flags.two_sided {
                    let turned = self.turned(cell.attribute, block_centre, depth);
                    // Points are drawn wherever they face.
                    if turned.surely_above(0.0) && self.distortion == 0.0 {
                        continue;
                    }
                    sure &= !turned.maybe_above(0.0);
                }
            }
            let (origin, nearest) = base;
            let nearest = nearest.unwrap_or((point[2] - self.reach(depth)).max(self.near));
            let mut core = self.depth(point[2], units);
            let mut place = self.place(point, units);
            if self.distortion > 0.0 {
                // The bounds of `plan.rs` and `grid/packed.rs`.
                for at in &mut place {
                    at.error += self.distortion + PACKED_ROUNDING;
                }
                let above = usize::from(model.depth()).saturating_sub(3);
                let ratio = (self.reach(above) / point[2]).min(0.5);
                core.error +=
                    self.depth_scaled(point[2]) * ratio * ratio / (1.0 - ratio).powi(2) + 16.0;
                let block = depth
                    .checked_sub(1)
                    .map(|above| &model.levels[above][cell.parent]);
                if let Some(block) = block
                    && block.flags.aperture >= BOTH_WAYS
                    && self.may_face_away(cell.attribute, centre, depth)
                {
                    match block.flags.is_sheet() {
                        true => core = self.far_side(core, centre, depth),
                        false => sure = false,
                    }
                }
            }
            let drop = self.drop(origin[2], &edges, units);
            leaves.push(Leaf {
                place,
                half: [0, 1].map(|row| self.half(row, origin, nearest, &edges, units)),
                core,
                rim: Near {
                    value: core.value - drop.value,
                    error: core.error + drop.error,
                },
                colour: self.colour(cell.attribute),
                sure,
                may_be_point: self.distortion > 0.0,
            });
        }
        Some(leaves)
    }

    /// Whether a cell, or one above it, is near and lies beside the picture: surely with a doubt of -1, maybe with 1.
    fn left_out(&self, depth: usize, cell: &Cell, units: f64, doubt: f64) -> bool {
        let point = self.exact.forms(self.model.centre(depth, cell));
        let nearest = point[2] - self.reach(depth);
        let limit = self.near.max(point[2] / 2.0) + doubt * (units + 6.0) * self.units[1];
        nearest <= limit && self.is_beside(point, &self.edges(depth), units, doubt)
            || depth.checked_sub(1).is_some_and(|above| {
                let parent = &self.model.levels[above][cell.parent];
                self.left_out(above, parent, units, doubt)
            })
    }

    /// Whether a cell lies beyond one of the picture's four sides.
    fn is_beside(&self, point: [f64; 3], edges: &[[f64; 3]; 3], units: f64, doubt: f64) -> bool {
        let slack = doubt * (units + 16.0) * (self.units[0] + self.units[1]);
        [0, 1].into_iter().any(|row| {
            let bound = self.exact.middle[row];
            [-1.0, 1.0].into_iter().any(|side| {
                let across = |point: [f64; 3]| side * point[row] - bound * point[2];
                let reach: f64 = edges.iter().map(|&edge| across(edge).abs()).sum();
                across(point) > reach - slack * (1.0 + bound)
            })
        })
    }

    /// Half edges of cells of a depth.
    fn edges(&self, depth: usize) -> [[f64; 3]; 3] {
        let across = self.model.cells_per_axis(depth) as f64;
        self.exact.half_edges(1.0 / across)
    }

    /// Half the extent in w of cells of a depth.
    fn reach(&self, depth: usize) -> f64 {
        self.edges(depth).iter().map(|edge| edge[2].abs()).sum()
    }

    /// The bound of `grid/tables.rs`.
    fn place(&self, point: [f64; 3], units: f64) -> [Near; 2] {
        let screen = self.exact.screen(point);
        let least_w = (point[2] - units * self.units[1]).max(f64::MIN_POSITIVE);
        [0, 1].map(|row| {
            let from_middle = (point[row] / point[2]).abs();
            let blocks = self.units[0] + from_middle * self.units[1];
            let error = units * blocks / least_w * (1.0 + 2f64.powi(-18))
                + from_middle * 2f64.powf(-18.9)
                + 2f64.powi(-12);
            Near {
                value: screen[row].clamp(-262144.0, 262144.0 + 2048.0),
                error,
            }
        })
    }

    /// Half a side of the first-order bounding rectangle: the sum over the
    /// edges d of |dX - X / w dw|, over the nearest w.
    fn half(
        &self,
        row: usize,
        origin: [f64; 3],
        nearest: f64,
        edges: &[[f64; 3]; 3],
        units: f64,
    ) -> Near {
        let [screen_unit, w_unit] = self.units;
        let (at, w) = (origin[row], origin[2]);
        let (mut sum, mut error) = (0.0, 0.0);
        for edge in edges {
            // It saturates for leaves that reach behind the eye.
            let ratio = (edge[2] / w).clamp(-1.0, 1.0);
            sum += (edge[row] - at * ratio).abs();
            // dw / w by the reciprocal table, from a rounded dw and w.
            let ratio_error = ratio.abs() * 2f64.powf(-18.8)
                + (0.5 + ratio.abs() * units) * w_unit / w
                + 2f64.powi(-29);
            error += (2.0 + ratio.abs() * units) * screen_unit + at.abs() * ratio_error;
        }
        let nearest_error = (units + 6.0) * w_unit;
        let least = nearest - nearest_error;
        if least <= 0.0 {
            return Near {
                value: sum / nearest,
                error: f64::INFINITY,
            };
        }
        let value = sum / nearest;
        Near {
            value: value.min(131072.0),
            error: (error + value * nearest_error) / least
                + value * 2f64.powf(-18.8)
                + 2f64.powi(-10),
        }
    }

    /// Depth without its offset: proportional to 1 / w.
    fn depth_scaled(&self, w: f64) -> f64 {
        let [near, far] = self.range;
        65534.0 / w / (1.0 / near - 1.0 / far)
    }

    /// Depth of a w that errs by some units, by the bound of
    /// [`crate::projection`].
    fn depth(&self, w: f64, units: f64) -> Near {
        let [near, far] = self.range;
        let value = 1.0 + 65534.0 * (1.0 / w - 1.0 / far) / (1.0 / near - 1.0 / far);
        let scale = 65534.0 * far / (far - near);
        // Beyond twice the range's end depth is limited anyway.
        let share = (near / w).min(2.0);
        let table = scale * (share + near / far) * 2f64.powf(-18.8);
        let moved = scale * share * units * self.units[1] / w.max(near / 2.0);
        Near {
            value: value.clamp(1.0, 65535.0),
            error: 3.0 + table + moved,
        }
    }

    /// Whether a packed sample does not surely face the eye. Its view is that of
    /// a cell two levels up, its normal 3.4 degrees off.
    fn may_face_away(&self, attribute: u16, centre: [f64; 3], depth: usize) -> bool {
        let view = [0, 1, 2].map(|i| centre[i] - self.exact.eye[i]);
        let along = dot(decode(attribute).map(|c| f64::from(c) / 16384.0), view);
        along / dot(view, view).sqrt() >= -self.facing_doubt(centre, depth)
    }

    fn facing_doubt(&self, centre: [f64; 3], depth: usize) -> f64 {
        let view = [0, 1, 2].map(|i| centre[i] - self.exact.eye[i]);
        let above = self.model.cells_per_axis(depth.saturating_sub(2)) as f64;
        0.07 + 2.0 / above / dot(view, view).sqrt()
    }

    /// The depth of a sheet's packed sample that may face away and lies two
    /// cells deeper then: at both.
    fn far_side(&self, core: Near, centre: [f64; 3], depth: usize) -> Near {
        let doubt = self.facing_doubt(centre, depth);
        let w = self.exact.forms(centre)[2];
        let deeper = self.depth_scaled(w) * 4.0 * self.reach(depth) / w;
        let error = core.error + deeper * (doubt + 2.0 * doubt * doubt) + 8.0;
        Near {
            value: core.value - deeper / 2.0,
            error: error + deeper / 2.0,
        }
    }

    /// How much deeper the rim lies.
    fn drop(&self, w: f64, edges: &[[f64; 3]; 3], units: f64) -> Near {
        let reach: f64 = edges.iter().map(|edge| edge[2].abs()).sum();
        let front = self.depth(w, units);
        let back = self.depth(w + 2.0 * reach, units + 6.0);
        Near {
            value: front.value - back.value + 1.0,
            error: front.error + back.error,
        }
    }

    /// How far a leaf's normal points beyond the limit away from the eye.
    fn turned(&self, attribute: u16, block: [f64; 3], depth: usize) -> Near {
        let view = [0, 1, 2].map(|i| (block[i] - self.exact.eye[i]) * self.eye_unit);
        let along = dot(decode(attribute).map(|c| f64::from(c) / 16384.0), view);
        let longest = view.iter().fold(0f64, |longest, c| longest.max(c.abs()));
        let sum: f64 = view.iter().map(|c| c.abs()).sum();
        let length = longest + (sum - longest) / 2.0;
        let across = self.model.cells_per_axis(depth - 1) as f64;
        let radius = self.eye_unit * 1.75 / across + 2.0 + depth as f64;
        Near {
            value: along - radius - length * 3.0 / 64.0,
            error: 10.0 + depth as f64,
        }
    }

    /// A material in white ambient light.
    fn colour(&self, attribute: u16) -> u16 {
        let material = self.model.materials[usize::from(attribute >> 13)];
        let [red, green, blue] = material.map(f64::from);
        let level = |value: f64, levels: f64| (value * levels / 255.0).round() as u16;
        level(red, 31.0) << 11 | level(green, 63.0) << 5 | level(blue, 31.0)
    }
}

/// How a pixel column or row stands to a splat.
#[derive(Clone, Copy, Default)]
struct Cover {
    maybe: bool,
    sure: bool,
    core_maybe: bool,
    core_sure: bool,
}

impl Leaf {
    fn cover(&self, axis: usize, pixel: usize) -> Cover {
        let (place, half) = (self.place[axis], self.half[axis]);
        let centre = pixel as f64 + 0.5;
        // The home pixel.
        let offset = (place.value - centre).abs();
        let home_maybe = offset <= 0.5 + place.error;
        let home_sure = offset < 0.5 - place.error;
        let within = |half: f64, error: f64| {
            let error = place.error + error;
            (offset <= half + error, offset < half - error)
        };
        let (maybe, sure) = within(half.value, half.error);
        let core_error = half.error / 2.0 + 2f64.powi(-12);
        let (core_maybe, core_sure) = within(half.value / 2.0, core_error);
        Cover {
            maybe: maybe || home_maybe,
            sure: if self.may_be_point {
                home_sure
            } else {
                sure || home_sure
            },
            core_maybe: core_maybe || home_maybe,
            core_sure: core_sure || home_sure,
        }
    }

    /// Every pixel that may be covered: its index, whether it surely is, and
    /// the interval of its depth.
    fn for_each_pixel(
        &self,
        width: usize,
        height: usize,
        mut visit: impl FnMut(usize, bool, [f64; 2]),
    ) {
        let columns: Vec<_> = (0..width).map(|pixel| self.cover(0, pixel)).collect();
        for y in 0..height {
            let row = self.cover(1, y);
            if !row.maybe {
                continue;
            }
            for (x, column) in columns.iter().enumerate().filter(|(_, c)| c.maybe) {
                let high = if row.core_maybe && column.core_maybe {
                    self.core.value + self.core.error
                } else {
                    self.rim.value + self.rim.error
                };
                let low = if row.core_sure && column.core_sure {
                    self.core.value - self.core.error
                } else {
                    self.rim.value - self.rim.error
                };
                let interval = [low, high].map(|depth| depth.clamp(1.0, 65535.0));
                visit(y * width + x, row.sure && column.sure, interval);
            }
        }
    }
}
