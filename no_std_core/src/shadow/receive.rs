//! What pixels read in a shadow map.
//!
//! With w for its distance along the viewing direction, the place of a pixel
//! (x, y) in light space is
//!
//! ```text
//! L(eye) + w (L(forward) + x L(right) / f - y L(up) / f),
//! ```
//!
//! x and y being pixels from the picture's middle. L is linear, so that the
//! part in brackets grows by additions along a row.
//!
//! # Bias
//!
//! A texel holds the depth of a cell's centre, and a pixel shows the depth of
//! another. Over a plane at the angle t to the light's, both may lie off by what
//! the plane rises, tan t, on the way: half a square and half a texel in the
//! map, half a cell and half a pixel in the picture; and half a cell each along
//! the light. A shadow takes more than the sum of that.

use super::map::CastForms;
use super::space::LightSpace;
use crate::camera::Camera;
use crate::divisor::Divisor;
use crate::normal::{CODES, fill_facing};
use crate::numbers::{SplatPx, Unit, bit_length};
use crate::placement::NormalMap;
use crate::projection::{DepthToW, Projection};

/// Fraction bits of u and v.
const TEXEL_BITS: i32 = 8;
/// Fraction bits of depths.
const DEPTH_BITS: i32 = 1;
/// Where the surface faces away from the light.
const AWAY: u8 = u8::MAX;
/// Steps of the tangents that are tabulated.
const TANGENT_ONE: usize = 16;
/// Largest tangent, in steps: of 79 degrees. Beyond, a bias that keeps surfaces
/// from shadowing themselves would let in more light than it does good.
const STEEPEST: usize = 80;

/// A form of light space over a picture's pixels and w.
#[derive(Clone, Copy, Debug, Default)]
struct Ray {
    /// At the eye.
    eye: i32,
    /// At the picture's corner, for each block unit of w, 2^-(32 + shift); below
    /// 2^30 all over the picture.
    corner: i32,
    /// Its change from column to column and from row to row.
    steps: [i32; 2],
    shift: i32,
}

impl Ray {
    fn at_row(&self, row: u16) -> i32 {
        self.corner
            .wrapping_add(self.steps[1].wrapping_mul(i32::from(row)))
    }
}

/// A map and how a picture's pixels find their place in it.
pub(crate) struct Receiver<'a> {
    depths: &'a [u16],
    /// Bias by normal code.
    slopes: &'a [u8; CODES],
    size: u32,
    rays: [Ray; 3],
    to_w: &'a DepthToW,
    /// Bias of a plane across the light, and for each step of the tangent, Q4
    /// steps of depth.
    bias: [i32; 2],
}

/// A row of a picture before its pixels are looked at: u, v and depth at its
/// first column, for each block unit of w, and their change.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    starts: [i32; 3],
}

impl<'a> Receiver<'a> {
    /// For what of a placed grid is in the picture. `slopes` is memory for
    /// the biases of all normal codes, a byte each.
    pub fn new(
        space: &LightSpace,
        (depths, slopes): (&'a [u16], &'a mut [u16]),
        normals: &NormalMap,
        (picture, projection, to_w): (&PictureForms, &Projection, &'a DepthToW),
        bias: [i32; 2],
    ) -> Option<Self> {
        let slopes: &mut [u8] = bytemuck::cast_slice_mut(slopes);
        let slopes: &mut [u8; CODES] = slopes.first_chunk_mut()?;
        fill_slopes(slopes, normals, space.axes[2]);
        Some(Self {
            depths,
            slopes,
            size: u32::from(space.size),
            rays: picture.rays(space, projection),
            to_w,
            bias,
        })
    }

    /// A row of the picture from a column on.
    pub fn row(&self, column: u16, row: u16) -> Row {
        let start = |ray: &Ray| {
            let along = ray.steps[0].wrapping_mul(i32::from(column));
            ray.at_row(row).wrapping_add(along)
        };
        let [u, v, depth] = &self.rays;
        Row {
            starts: [start(u), start(v), start(depth)],
        }
    }

    /// Whether a word of the canvas lies in the shadow at the index-th pixel of
    /// a row, though its surface faces the light.
    #[inline(always)]
    pub fn is_shadowed(&self, row: &Row, index: usize, word: u32) -> bool {
        let slope = self.slopes[word as usize % CODES];
        if slope == AWAY {
            return false;
        }
        let [u, v, depth] = self.place(row, index, word);
        let (column, line) = ((u >> TEXEL_BITS) as u32, (v >> TEXEL_BITS) as u32);
        if column >= self.size || line >= self.size {
            return false;
        }
        let texel = self.depths.get((line * self.size + column) as usize);
        let bias = (self.bias[0] + self.bias[1] * i32::from(slope)) >> 4;
        texel.is_some_and(|&nearest| i32::from(nearest) > (depth >> DEPTH_BITS) + bias)
    }

    /// Where a word of the canvas lies in light space: u and v with
    /// [`TEXEL_BITS`], depth with [`DEPTH_BITS`].
    #[inline(always)]
    fn place(&self, row: &Row, index: usize, word: u32) -> [i32; 3] {
        let w = i64::from(self.to_w.w(word >> 16));
        let [u, v, depth] = &self.rays;
        let at = |ray: &Ray, start: i32| {
            let here = start.wrapping_add(ray.steps[0].wrapping_mul(index as i32));
            ray.eye + (((w * i64::from(here)) >> 32) as i32 >> ray.shift)
        };
        let [u_start, v_start, depth_start] = row.starts;
        [at(u, u_start), at(v, v_start), at(depth, depth_start)]
    }
}

/// Tangents between normals and the light, by code; of two opposite codes one
/// faces away.
fn fill_slopes(slopes: &mut [u8], normals: &NormalMap, light: [Unit; 3]) {
    let towards = normals.light(light);
    if !normals.is_plain() {
        for (slope, code) in slopes.iter_mut().zip(0u16..) {
            let [x, y, z] = normals.normal(code);
            *slope = match x * towards[0] + y * towards[1] + z * towards[2] {
                dot @ 1.. => tangent(dot),
                _ => AWAY,
            };
        }
        return;
    }
    fill_facing(slopes, towards, AWAY, tangent);
}

/// The tangent of an angle by its cosine, Q4.28.
#[inline(always)]
fn tangent(cosine: i32) -> u8 {
    TANGENTS[(cosine >> 20) as usize % TANGENTS.len()]
}

/// The tangent of an angle by its cosine, in 256ths, rounded up; of more than
/// one, by rounding, nothing.
static TANGENTS: [u8; 512] = {
    let mut table = [0; 512];
    let mut step = 0;
    while step < 256 {
        let sine = ((256 * 256 - step * step) as u64).isqrt() as usize;
        let tangent = match step {
            0 => STEEPEST,
            _ => sine * TANGENT_ONE / step + 1,
        };
        table[step] = if tangent < STEEPEST {
            tangent
        } else {
            STEEPEST
        } as u8;
        step += 1;
    }
    table
};

/// Light space over a picture's pixels: what all instances' rays come from.
#[derive(Clone, Copy)]
pub(crate) struct PictureForms {
    /// u, v and depth.
    forms: [PictureForm; 3],
}

#[derive(Clone, Copy, Default)]
struct PictureForm {
    /// At the eye.
    eye: i32,
    /// At the corner and from column to column and row to row, for each unit of
    /// w: times the sphere's radius and the map's reach, Q60.
    parts: [i128; 3],
    /// Bits of the largest over all pixels, over the radius, Q60.
    length: i32,
    /// Fraction bits of what comes out.
    bits: i32,
}

impl PictureForms {
    pub fn new(space: &LightSpace, camera: &Camera) -> Self {
        let focal = Divisor::new(i128::from(camera.focal_px.to_bits()));
        let bits = [TEXEL_BITS, TEXEL_BITS, DEPTH_BITS];
        let middle = i64::from(space.size) << (TEXEL_BITS - 1);
        let middles = [middle, middle, 1 << (15 + DEPTH_BITS)];
        let mut forms = [PictureForm::default(); 3];
        let parts = space.axes.into_iter().zip(space.reaches());
        let parts = parts.zip(middles).zip(bits);
        for (form, (((axis, reach), middle), bits)) in forms.iter_mut().zip(parts) {
            *form = PictureForm::new(space, (axis, reach), camera, &focal, (middle, bits));
        }
        Self { forms }
    }

    fn rays(&self, space: &LightSpace, projection: &Projection) -> [Ray; 3] {
        self.forms.map(|form| form.ray(space, projection))
    }
}

impl PictureForm {
    fn new(
        space: &LightSpace,
        (axis, reach): ([Unit; 3], i64),
        camera: &Camera,
        focal: &Divisor,
        (middle, bits): (i64, i32),
    ) -> Self {
        let along = |v: [i64; 3]| -> i128 {
            let products = axis.iter().zip(v);
            products
                .map(|(a, b)| i128::from(a.to_bits()) * i128::from(b))
                .sum()
        };
        let unit = |v: [Unit; 3]| along(v.map(|c| i64::from(c.to_bits())));
        // Q60; a pixel of more than eight units is no pixel.
        let per_pixel = |v: [Unit; 3]| i128::from(focal.quotient(unit(v), 32));
        let (right, down) = (per_pixel(camera.right), -per_pixel(camera.up));
        let [width, height] = [camera.width, camera.height].map(i128::from);
        let across = right * (width - 1) + down * (height - 1);
        let corner = unit(camera.forward) - across / 2;
        let parts = [corner, right, down].map(|part| part * i128::from(reach));
        let largest = parts[0].abs() + parts[1].abs() * width + parts[2].abs() * height;
        // In about 60 bits, to count them.
        let radius = u128::from(space.radius().unsigned_abs());
        let scale = 60 - bit_length(largest.unsigned_abs()) + bit_length(radius);
        let largest = space.over_radius(largest, scale);
        let eye = along(space.relative_to_middle(camera.eye)) * i128::from(reach);
        let eye = space.over_radius(eye, bits - 30).saturating_add(middle);
        Self {
            eye: eye.clamp(-(1 << 30), 1 << 30) as i32,
            parts,
            length: bit_length(u128::from(largest.unsigned_abs())) - scale + 32,
            bits,
        }
    }

    /// For each block unit of w.
    fn ray(&self, space: &LightSpace, projection: &Projection) -> Ray {
        // From Q60 for a unit to what a block unit is times 2^32.
        let all = 60 - 32 - self.bits - projection.w_scale;
        let shift = (all - (self.length - 30)).clamp(0, 31);
        let [corner, column, row] = self.parts.map(|part| {
            let part = space.over_radius(part, 32 - (all - shift));
            part.clamp(-(1 << 30), 1 << 30) as i32
        });
        Ray {
            eye: self.eye,
            corner,
            steps: [column, row],
            shift,
        }
    }
}

/// The bias that a map's squares ask for, and a picture whose cells have edges
/// of so many texels, Q16: see the module.
pub(crate) fn bias(space: &LightSpace, cast: &CastForms, cell: u64, factor: SplatPx) -> [i32; 2] {
    let [texels, _, steps] = space.reaches();
    let half = |q16: u64| (q16.min(1 << 24) / 2) as i64;
    let square = (cast.side as i64) << 16;
    let along = half(cell) + half(cast.edge);
    let across = (square + (1 << 16)) / 2 + half(cell) + half(cell);
    let factor = i64::from(factor.to_bits()).min(1 << 24);
    // Texels Q16, times Q16, to Q4 steps of depth.
    let in_steps = |texels_q16: i64| {
        // 32 + 24 + 15 bits: the lowest are of no weight.
        let wide = ((texels_q16 * factor) >> 20) * steps;
        (wide.checked_div(texels).unwrap_or(0) >> 8).min(1 << 20) as i32
    };
    [in_steps(along) + 16, in_steps(across) / TANGENT_ONE as i32]
}

#[cfg(test)]
mod tests;
