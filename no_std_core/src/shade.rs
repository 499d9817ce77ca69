//! Shading: normal codes x materials -> colours.
//!
//! Source: Duguet and Drettakis 2003, 5.5. Once a frame, the colour of every
//! attribute goes into a table (16 KB a material); where the caller gives no
//! memory for it, samples are shaded one by one, to the same bytes.

use crate::asset::Rgb;
use crate::draw::Light;
use crate::normal::{CODES, COMPONENT_BITS, decode};

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
    /// Lambert's cosine, 0 to 1, Q1.15.
    fn cosine(&self, normal: [i32; 3]) -> i32 {
        let [x, y, z] = normal;
        // Q2.14 x Q2.14: two unit vectors give 2^28 and some rounding, a unit
        // vector and any other less than 2^30.
        let dot = x * self.towards[0] + y * self.towards[1] + z * self.towards[2];
        (dot >> (2 * COMPONENT_BITS - 15)).clamp(0, 1 << 15)
    }

    fn colour(&self, attribute: u16) -> u16 {
        let cosine = self.cosine(decode(attribute));
        let material = self
            .materials
            .get(usize::from(attribute >> 13))
            .copied()
            .unwrap_or([0; 3]);
        // Q1.15, at most one; the product is below 2^16 x 2^15.
        let weight = (self.ambient + ((self.diffuse * cosine) >> 15)).clamp(0, 1 << 15) as u32;
        // 8 bits x 5 or 6 bits x Q1.15: below 2^30.
        let channel =
            |value: u8, levels: u32| (u32::from(value) * levels * weight / 255 + (1 << 14)) >> 15;
        let [red, green, blue] = material;
        (channel(red, 31) << 11 | channel(green, 63) << 5 | channel(blue, 31)) as u16
    }
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
                for (colour, attribute) in table.iter_mut().zip(0u16..=u16::MAX) {
                    *colour = model.colour(attribute);
                }
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
