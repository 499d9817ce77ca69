//! Brightness and colours of attributes, one by one and for tables of all.

use super::matcap::LitSphere;
use super::ramp::{BRIGHTNESS, Ramp, STEPS, steps};
use crate::asset::{MAX_MATERIALS, Rgb};
use crate::normal::{CODES, decode, fill_facing};
use crate::numbers::Weight;
use crate::placement::NormalMap;
use crate::scene::MAX_LAMPS;

/// What shading needs to know of lights and materials.
#[derive(Clone, Copy)]
pub struct Model<'a> {
    /// By material; black behind the last.
    pub ramps: [Ramp; MAX_MATERIALS],
    /// How many materials there are.
    pub count: usize,
    /// Weight, Q1.15, with half a step.
    pub ambient: i32,
    pub lamps: [Beam; MAX_LAMPS],
    /// How many lamps there are.
    pub lamp_count: usize,
    /// How normals meet the lamps; `None` where they do as they are.
    normals: Option<&'a NormalMap>,
    /// What ambient light is.
    pub sphere: Option<LitSphere<'a>>,
    /// Whether brightness is that of one white light on normals as they are.
    pub is_plain: bool,
}

/// A directional light as normals meet it.
#[derive(Clone, Copy, Default)]
pub struct Beam {
    /// Towards the light, times the diffuse weight, Q2.14.
    towards: [i32; 3],
    /// Share of each channel, Q8.
    colour: [i32; 3],
}

/// The share of a channel that white has, Q8.
const WHITE: i32 = 256;

impl Beam {
    /// `towards` has unit length, Q2.30.
    pub fn new(towards: [i32; 3], diffuse: Weight, colour: Rgb) -> Self {
        let diffuse = (diffuse.to_bits() >> 16) as i32;
        Self {
            // Q2.30 x Q1.15 to Q2.14.
            towards: towards.map(|c| {
                let wide = i64::from(c) * i64::from(diffuse);
                ((wide >> 30) as i32 + 1) >> 1
            }),
            colour: colour.map(|c| i32::from(c) + i32::from(c >> 7)),
        }
    }

    /// Lambert's cosine, weighted, Q4.28; negative where the normal faces away.
    #[inline(always)]
    pub fn cosine(&self, [x, y, z]: [i32; 3]) -> i32 {
        // Q2.14 x Q2.14, a unit vector and any other: less than 2^30.
        x * self.towards[0] + y * self.towards[1] + z * self.towards[2]
    }
}

impl<'a> Model<'a> {
    pub fn new(
        ambient: Weight,
        materials: &[Rgb],
        beams: impl IntoIterator<Item = Beam>,
        normals: Option<&'a NormalMap>,
        sphere: Option<LitSphere<'a>>,
    ) -> Self {
        let mut model = Self {
            ramps: [Ramp::BLACK; MAX_MATERIALS],
            count: materials.len().min(MAX_MATERIALS),
            ambient: (ambient.to_bits() >> 16) as i32 + 32,
            lamps: [Beam::default(); MAX_LAMPS],
            lamp_count: 0,
            normals,
            sphere,
            is_plain: false,
        };
        for (ramp, &material) in model.ramps.iter_mut().zip(materials) {
            *ramp = Ramp::new(material);
        }
        for (lamp, beam) in model.lamps.iter_mut().zip(beams) {
            *lamp = beam;
            model.lamp_count += 1;
        }
        let is_white = model.lamp_count == 1 && model.lamps[0].colour == [WHITE; 3];
        model.is_plain = is_white && normals.is_none() && sphere.is_none();
        model
    }

    /// Brightness for Lambert's cosine of the only, white light, weighted: 0 to
    /// [`STEPS`]. Q4.28.
    #[inline(always)]
    pub fn brightness(&self, dot: i32) -> usize {
        steps(self.ambient + (dot.max(0) >> 13))
    }

    /// The colour of an attribute under the lamps whose bits are not set.
    #[inline(never)]
    pub fn colour(&self, attribute: u16, unlit: u32) -> u16 {
        let ramp = &self.ramps[usize::from(attribute >> 13) % MAX_MATERIALS];
        if unlit == 0 && self.is_plain {
            let brightness = self.brightness(self.lamps[0].cosine(decode(attribute)));
            return ramp.colour([brightness; 3]);
        }
        ramp.colour(self.brightnesses(attribute, unlit))
    }

    /// The brightness of each channel, 0 to [`STEPS`].
    #[inline(always)]
    pub fn brightnesses(&self, attribute: u16, unlit: u32) -> [usize; 3] {
        let normal = match self.normals {
            None => decode(attribute),
            Some(normals) => normals.normal(attribute),
        };
        let mut weights = match &self.sphere {
            None => [self.ambient; 3],
            Some(sphere) => sphere.light(normal).map(|channel| {
                // 255ths, within 2^-8 of the last step.
                let share = i32::from(channel) + i32::from(channel >> 7);
                self.ambient * share / WHITE
            }),
        };
        for (lamp, bit) in self.lamps.iter().take(self.lamp_count).zip(0..) {
            if unlit >> bit & 1 == 0 {
                let lit = lamp.cosine(normal).max(0) >> 13;
                for (weight, share) in weights.iter_mut().zip(lamp.colour) {
                    *weight += lit * share / WHITE;
                }
            }
        }
        weights.map(steps)
    }

    /// Fills the table of brightness by normal, which suits every colour: of one
    /// white light.
    pub fn fill_brightness(&self, table: &mut [u16]) {
        self.fill_material(&BRIGHTNESS, table);
    }

    /// Fills the table, material after material.
    pub fn fill(&self, table: &mut [u16]) {
        if !self.is_plain {
            for (colour, attribute) in table.iter_mut().zip(0u16..) {
                *colour = self.colour(attribute, 0);
            }
            return;
        }
        let ramps = self.ramps.iter().take(self.count);
        for (colours, ramp) in table.chunks_exact_mut(CODES).zip(ramps) {
            self.fill_material(&ramp.all(), colours);
        }
    }

    fn fill_material(&self, ramp: &[u16; STEPS + 1], colours: &mut [u16]) {
        let dark = ramp[self.brightness(0)];
        fill_facing(colours, self.lamps[0].towards, dark, |cosine| {
            ramp[self.brightness(cosine)]
        });
    }
}
