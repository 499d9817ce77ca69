//! The core's canvas in float: samples of different w compete for pixels, and
//! pixels that points have missed are closed from their neighbours, as
//! `no_std_core/src/resolve.rs` has it.

use glam::DVec3;
use rhogrid_core::normal::{COMPONENT_BITS, decode};

use crate::picture::{Picture, rgb565};
use crate::view::{Light, View};

/// Pixels beside the picture that repair looks at.
const AROUND: [usize; 2] = [1, 2];

/// What is drawn where.
pub(super) struct Canvas {
    width: usize,
    height: usize,
    /// Nearest w of each pixel, infinity where nothing is drawn.
    w: Vec<f64>,
    attributes: Vec<u16>,
    /// Pixels between rows.
    pitch: usize,
}

impl Canvas {
    pub fn new(view: &View) -> Self {
        let (width, height) = (view.width as usize, view.height as usize);
        let pitch = width + 2 * AROUND[0];
        let pixels = pitch * (height + 2 * AROUND[1]);
        Self {
            width,
            height,
            w: vec![f64::INFINITY; pixels],
            attributes: vec![0; pixels],
            pitch,
        }
    }

    /// Draws a pixel of a sample; the nearest stays, of equals the first.
    pub fn dab(&mut self, column: i64, row: i64, w: f64, attribute: u16) {
        let within = |at: i64, size: usize, around: usize| {
            let index = usize::try_from(at + around as i64).ok()?;
            (index < size + 2 * around).then_some(index)
        };
        let column = within(column, self.width, AROUND[0]);
        let row = within(row, self.height, AROUND[1]);
        if let (Some(column), Some(row)) = (column, row) {
            let pixel = row * self.pitch + column;
            if w < self.w[pixel] {
                self.w[pixel] = w;
                self.attributes[pixel] = attribute;
            }
        }
    }

    /// Which rows and columns a picture's edge leaves: see [`Canvas::dab`].
    pub fn bounds(&self) -> [[i64; 2]; 2] {
        let of = |size: usize, around: usize| [-(around as i64), (size + around) as i64];
        [of(self.width, AROUND[0]), of(self.height, AROUND[1])]
    }

    /// The colours, holes closed. A neighbour is nearer if it is so by two cells
    /// of the splat's size, `gap` of w.
    pub fn picture(&self, materials: &[[u8; 3]], light: &Light, gap: f64) -> Picture {
        let colour = |pixel: usize| shade(self.attributes[pixel], materials, light);
        let (mut frame, mut drawn) = (Vec::new(), Vec::new());
        for row in 0..self.height {
            for column in 0..self.width {
                let own = (row + AROUND[1]) * self.pitch + column + AROUND[0];
                let closing = self.hole(own, gap);
                drawn.push(closing.is_some() || self.w[own].is_finite());
                frame.push(match closing {
                    Some([first, second]) => mean(colour(first), colour(second)),
                    None if self.w[own].is_finite() => colour(own),
                    None => 0,
                });
            }
        }
        Picture::from_rgb565(self.width as u32, self.height as u32, &frame, drawn)
    }

    /// The two pixels that close a hole, if it is one.
    fn hole(&self, own: usize, gap: f64) -> Option<[usize; 2]> {
        // 1 / w of a neighbour exceeds the own by the share of a gap.
        let limit = self.w[own] / (1.0 + gap);
        let is_nearer = |pixel: usize| self.w[pixel] < limit;
        let mut closing = None;
        let mut nearest = limit;
        let (mut before, mut behind) = (0, 0);
        for offset in [1, self.pitch, self.pitch + 1, self.pitch - 1] {
            let pair = [own - offset, own + offset];
            let deeper = self.w[pair[0]].max(self.w[pair[1]]);
            if deeper < nearest {
                nearest = deeper;
                closing = Some(pair);
            }
            before += usize::from(is_nearer(pair[0]));
            behind += usize::from(is_nearer(pair[1]));
        }
        if closing.is_some() || before == 0 || before + behind < 4 {
            return closing;
        }
        let long = [
            [own - self.pitch, own + 2 * self.pitch],
            [own - 2 * self.pitch, own + self.pitch],
        ];
        long.into_iter()
            .find(|pair| pair.iter().all(|&pixel| is_nearer(pixel)))
    }
}

fn shade(attribute: u16, materials: &[[u8; 3]], light: &Light) -> u16 {
    let normal =
        DVec3::from_array(decode(attribute).map(f64::from)) / f64::from(1 << COMPONENT_BITS);
    let brightness = light.ambient + light.diffuse * normal.dot(light.towards).max(0.0);
    let material = materials
        .get(usize::from(attribute >> 13))
        .copied()
        .unwrap_or([0; 3]);
    rgb565(material.map(|channel| f64::from(channel) * brightness))
}

/// The mean of two RGB565 colours, each channel rounded down.
fn mean(a: u16, b: u16) -> u16 {
    (a & b) + (((a ^ b) & 0xf7de) >> 1)
}
