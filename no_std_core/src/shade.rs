//! Shading: normal codes x materials -> colours.
//!
//! Source: Duguet and Drettakis 2003, 5.5. Once a frame, the colour of every
//! attribute goes into a table (16 KB a material); where the caller gives no
//! memory for it, samples are shaded one by one, to the same bytes.

use crate::asset::Rgb;
use crate::draw::Light;
use crate::normal::{CODES, COMPONENT_BITS, OCTANT, OCTANT_CODES, decode};

/// Brightness steps between black and a material's full colour. A step is an
/// eighth of a level of 6-bit green: rounding to it adds 1/16 to the half level
/// that rounding to 5:6:5 costs.
const STEPS: usize = 512;

/// What shading needs to know of light and materials.
#[derive(Clone, Copy)]
struct Model<'a> {
    materials: &'a [Rgb],
    /// Towards the light, Q2.14.
    towards: [i32; 3],
    /// Weights, Q1.15.
    ambient: i32,
    diffuse: i32,
}

impl Model<'_> {
    /// Ambient and Lambert's diffuse light on a normal: 0 to [`STEPS`].
    #[inline(always)]
    fn brightness(&self, normal: [i32; 3], towards: [i32; 3]) -> u16 {
        let [x, y, z] = normal;
        // Q2.14 x Q2.14: two unit vectors give 2^28 and some rounding, a unit
        // vector and any other less than 2^30.
        let dot = x * towards[0] + y * towards[1] + z * towards[2];
        let cosine = (dot >> (2 * COMPONENT_BITS - 15)).clamp(0, 1 << 15);
        // Q1.15, at most one; the product is at most 2^15 x 2^15.
        let weight = (self.ambient + ((self.diffuse * cosine) >> 15)).clamp(0, 1 << 15);
        ((weight + 32) >> 6) as u16
    }

    fn colour(&self, attribute: u16) -> u16 {
        let material = self.materials.get(usize::from(attribute >> 13));
        let brightness = self.brightness(decode(attribute), self.towards);
        shaded(material.copied().unwrap_or([0; 3]), brightness)
    }

    /// Fills the table, material after material. The first material's part
    /// holds brightnesses until all others have used them.
    fn fill(&self, table: &mut [u16]) {
        let Some((first, others)) = table.split_at_mut_checked(CODES) else {
            return;
        };
        for (codes, octant) in first.chunks_exact_mut(OCTANT_CODES).zip(0u16..) {
            // Flipping the light's signs instead of the normals'.
            let flipped = |axis: usize| match octant >> axis & 1 {
                0 => self.towards[axis],
                _ => -self.towards[axis],
            };
            let towards = [flipped(0), flipped(1), flipped(2)];
            for (brightness, normal) in codes.iter_mut().zip(&OCTANT) {
                *brightness = self.brightness(normal.map(i32::from), towards);
            }
        }
        let mut materials = self.materials.iter();
        let own = materials.next();
        for (colours, &material) in others.chunks_exact_mut(CODES).zip(materials) {
            let ramp = ramp(material);
            for (colour, &brightness) in colours.iter_mut().zip(&*first) {
                *colour = lookup(&ramp, brightness);
            }
        }
        if let Some(&material) = own {
            let ramp = ramp(material);
            for colour in first {
                *colour = lookup(&ramp, *colour);
            }
        }
    }
}

/// A material's colour at a brightness, RGB565, rounded to nearest.
fn shaded(material: Rgb, brightness: u16) -> u16 {
    // 8 bits x 5 or 6 bits x Q9: below 2^23.
    let channel = |value: u8, levels: u32| {
        (u32::from(value) * levels * u32::from(brightness) / 255 + STEPS as u32 / 2) / STEPS as u32
    };
    let [red, green, blue] = material;
    (channel(red, 31) << 11 | channel(green, 63) << 5 | channel(blue, 31)) as u16
}

fn ramp(material: Rgb) -> [u16; STEPS + 1] {
    let mut ramp = [0; STEPS + 1];
    for (colour, brightness) in ramp.iter_mut().zip(0u16..) {
        *colour = shaded(material, brightness);
    }
    ramp
}

#[inline(always)]
fn lookup(ramp: &[u16; STEPS + 1], brightness: u16) -> u16 {
    ramp.get(usize::from(brightness)).copied().unwrap_or(0)
}

/// Colours of attributes for one frame.
pub(crate) struct Shader<'a> {
    model: Model<'a>,
    table: &'a [u16],
}

impl<'a> Shader<'a> {
    /// Fills the table if `memory` holds it: 8192 words for each material.
    pub fn new(light: &Light, materials: &'a [Rgb], memory: &'a mut [u16]) -> Self {
        let model = Model {
            materials,
            // Halves up, without the overflow of adding first.
            towards: light.towards.map(|c| ((c.to_bits() >> 15) + 1) >> 1),
            ambient: (light.ambient.to_bits() >> 16) as i32,
            diffuse: (light.diffuse.to_bits() >> 16) as i32,
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
