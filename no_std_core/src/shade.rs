//! Shading: normal codes x materials -> colours.
//!
//! Source: Duguet and Drettakis 2003, 5.5. Once a frame, the colour of every
//! attribute goes into a table (16 KB a material); where the caller gives no
//! memory for it, samples are shaded one by one, to the same bytes.

use crate::asset::{MAX_MATERIALS, Rgb};
use crate::draw::Light;
use crate::normal::{CODES, OCTANT, OCTANT_CODES, decode};

/// Brightness steps between black and a material's full colour. A step is an
/// eighth of a level of 6-bit green: rounding to it adds 1/16 to the half level
/// that rounding to 5:6:5 costs.
const STEPS: usize = 512;

/// What shading needs to know of light and materials.
#[derive(Clone, Copy)]
struct Model {
    /// By material; black behind the last.
    ramps: [Ramp; MAX_MATERIALS],
    /// How many materials there are.
    count: usize,
    /// Towards the light, times the diffuse weight, Q2.14.
    towards: [i32; 3],
    /// Weight, Q1.15, with half a step.
    ambient: i32,
}

impl Model {
    /// Brightness for Lambert's cosine, weighted: 0 to [`STEPS`]. Q4.28.
    #[inline(always)]
    fn brightness(&self, dot: i32) -> usize {
        // Q1.15, at most one each: the sum is below 2^17.
        let weight = self.ambient + (dot.max(0) >> 13);
        (weight as usize >> 6).min(STEPS)
    }

    /// Brightness of a normal code.
    fn brightness_of(&self, code: u16) -> usize {
        let [x, y, z] = decode(code);
        // Q2.14 x Q2.14, a unit vector and any other: less than 2^30.
        self.brightness(x * self.towards[0] + y * self.towards[1] + z * self.towards[2])
    }

    fn colour(&self, attribute: u16) -> u16 {
        let ramp = &self.ramps[usize::from(attribute >> 13) % MAX_MATERIALS];
        ramp.colour(self.brightness_of(attribute))
    }

    /// Fills the table, material after material.
    fn fill(&self, table: &mut [u16]) {
        let ramps = self.ramps.iter().take(self.count);
        for (colours, ramp) in table.chunks_exact_mut(CODES).zip(ramps) {
            self.fill_material(&ramp.all(), colours);
        }
    }

    /// Two octants at once: of the cosines with a direction and its opposite,
    /// one is at most zero.
    fn fill_material(&self, ramp: &[u16; STEPS + 1], colours: &mut [u16]) {
        let (octants, _) = colours.as_chunks_mut::<OCTANT_CODES>();
        let [o0, o1, o2, o3, o4, o5, o6, o7] = octants else {
            return;
        };
        let dark = ramp[self.brightness(0)];
        // By the signs' bits: x, y, z from bit 0 on.
        let pairs = [(0, o0, o7), (1, o1, o6), (2, o2, o5), (3, o3, o4)];
        for (octant, own, opposite) in pairs {
            let [mut light_x, mut light_y, light_z] = self.towards;
            if octant & 1 != 0 {
                light_x = -light_x;
            }
            if octant & 2 != 0 {
                light_y = -light_y;
            }
            for ((normal, own), opposite) in OCTANT.iter().zip(own).zip(opposite) {
                let [x, y, z] = normal.map(i32::from);
                let dot = x * light_x + y * light_y + z * light_z;
                let lit = ramp[self.brightness(dot.abs())];
                (*own, *opposite) = if dot > 0 { (lit, dark) } else { (dark, lit) };
            }
        }
    }
}

/// A material's colours by brightness, RGB565, each channel rounded to
/// nearest.
#[derive(Clone, Copy)]
struct Ramp {
    /// A step of each channel, Q22; 512 steps stay below 2^29.
    steps: [u32; 3],
}

impl Ramp {
    const BLACK: Self = Self { steps: [0; 3] };

    fn new(material: Rgb) -> Self {
        let [red, green, blue] = material;
        let step = |value: u8, levels: u32| {
            // 1 / 255 = 0x808081 / 2^31, within 2^-32.
            ((u64::from(value) * u64::from(levels) * 0x80_8081) >> (9 + 9)) as u32
        };
        Self {
            steps: [step(red, 31), step(green, 63), step(blue, 31)],
        }
    }

    #[inline(always)]
    fn packed(channels: [u32; 3]) -> u16 {
        let [red, green, blue] = channels.map(|channel| (channel + (1 << 21)) >> 22);
        (red << 11 | green << 5 | blue) as u16
    }

    fn colour(&self, brightness: usize) -> u16 {
        Self::packed(self.steps.map(|step| step * brightness as u32))
    }

    /// The colours of all brightnesses.
    fn all(&self) -> [u16; STEPS + 1] {
        let mut colours = [0; STEPS + 1];
        let mut channels = [0; 3];
        for colour in &mut colours {
            *colour = Self::packed(channels);
            for (channel, step) in channels.iter_mut().zip(self.steps) {
                *channel += step;
            }
        }
        colours
    }
}

/// Colours of attributes for one frame.
pub(crate) struct Shader<'a> {
    model: Model,
    table: &'a [u16],
}

impl<'a> Shader<'a> {
    /// Fills the table if `memory` holds it: 8192 words for each material.
    pub fn new(light: &Light, materials: &[Rgb], memory: &'a mut [u16]) -> Self {
        let diffuse = (light.diffuse.to_bits() >> 16) as i32;
        let mut ramps = [Ramp::BLACK; MAX_MATERIALS];
        for (ramp, &material) in ramps.iter_mut().zip(materials) {
            *ramp = Ramp::new(material);
        }
        let model = Model {
            ramps,
            count: materials.len(),
            // Q2.30 x Q1.15 to Q2.14.
            towards: light.towards.map(|c| {
                let wide = i64::from(c.to_bits()) * i64::from(diffuse);
                ((wide >> 30) as i32 + 1) >> 1
            }),
            ambient: (light.ambient.to_bits() >> 16) as i32 + 32,
        };
        let table = match memory.get_mut(..CODES * materials.len()) {
            Some(table) => {
                model.fill(table);
                &*table
            }
            None => &[],
        };
        Self { model, table }
    }

    /// The table, if it is that of one material.
    pub fn table_of_one(&self) -> Option<&[u16; CODES]> {
        self.table.try_into().ok()
    }

    /// The colour of a pixel of the canvas: black where nothing is drawn.
    #[inline(always)]
    pub fn colour_of(&self, word: u32) -> u16 {
        if word == 0 {
            0
        } else {
            self.colour(word as u16)
        }
    }

    /// The colour of an attribute.
    #[inline(always)]
    pub fn colour(&self, attribute: u16) -> u16 {
        match self.table.get(usize::from(attribute)) {
            Some(&colour) => colour,
            None => self.model.colour(attribute),
        }
    }
}

#[cfg(test)]
mod tests;
