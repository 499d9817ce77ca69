//! Shading: normal codes x materials -> colours.
//!
//! Source: Duguet and Drettakis 2003, 5.5. Once a frame, the colour of every
//! attribute goes into a table (16 KB a material); where the caller gives no
//! memory for it, samples are shaded one by one, to the same bytes.

pub(crate) mod matcap;

use crate::asset::{Grid, Level, MAX_MATERIALS, Rgb};
use crate::camera::Camera;
use crate::canvas::{Pixel, canvas_rows};
use crate::draw::Light;
use crate::normal::{CODES, OCTANT, OCTANT_CODES, decode};
use crate::numbers::Weight;
use crate::placement::NormalMap;
use crate::scene::{Lighting, MAX_LAMPS};
use matcap::LitSphere;

/// Brightness steps between black and a material's full colour. A step is an
/// eighth of a level of 6-bit green: rounding to it adds 1/16 to the half level
/// that rounding to 5:6:5 costs.
const STEPS: usize = 512;

/// Every brightness as it is.
static BRIGHTNESS: [u16; STEPS + 1] = {
    let mut ramp = [0; STEPS + 1];
    let mut step = 0;
    while step <= STEPS {
        ramp[step] = step as u16;
        step += 1;
    }
    ramp
};

/// What shading needs to know of lights and materials.
#[derive(Clone, Copy)]
struct Model<'a> {
    /// By material; black behind the last.
    ramps: [Ramp; MAX_MATERIALS],
    /// How many materials there are.
    count: usize,
    /// Weight, Q1.15, with half a step.
    ambient: i32,
    lamps: [Beam; MAX_LAMPS],
    /// How many lamps there are.
    lamp_count: usize,
    /// How normals meet the lamps; `None` where they do as they are.
    normals: Option<&'a NormalMap>,
    /// What ambient light is.
    sphere: Option<LitSphere<'a>>,
}

/// A directional light as normals meet it.
#[derive(Clone, Copy, Default)]
struct Beam {
    /// Towards the light, times the diffuse weight, Q2.14.
    towards: [i32; 3],
    /// Share of each channel, Q8.
    colour: [i32; 3],
}

/// The share of a channel that white has, Q8.
const WHITE: i32 = 256;

impl Beam {
    /// `towards` has unit length, Q2.30.
    fn new(towards: [i32; 3], diffuse: Weight, colour: Rgb) -> Self {
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
    fn cosine(&self, [x, y, z]: [i32; 3]) -> i32 {
        // Q2.14 x Q2.14, a unit vector and any other: less than 2^30.
        x * self.towards[0] + y * self.towards[1] + z * self.towards[2]
    }
}

impl<'a> Model<'a> {
    fn new(
        ambient: Weight,
        materials: &[Rgb],
        beams: impl IntoIterator<Item = Beam>,
        normals: Option<&'a NormalMap>,
    ) -> Self {
        let mut model = Self {
            ramps: [Ramp::BLACK; MAX_MATERIALS],
            count: materials.len().min(MAX_MATERIALS),
            ambient: (ambient.to_bits() >> 16) as i32 + 32,
            lamps: [Beam::default(); MAX_LAMPS],
            lamp_count: 0,
            normals,
            sphere: None,
        };
        for (ramp, &material) in model.ramps.iter_mut().zip(materials) {
            *ramp = Ramp::new(material);
        }
        for (lamp, beam) in model.lamps.iter_mut().zip(beams) {
            *lamp = beam;
            model.lamp_count += 1;
        }
        model
    }

    /// Brightness for Lambert's cosine of the only, white light, weighted: 0 to
    /// [`STEPS`]. Q4.28.
    #[inline(always)]
    fn brightness(&self, dot: i32) -> usize {
        steps(self.ambient + (dot.max(0) >> 13))
    }

    /// The colour of an attribute under the lamps whose bits are not set.
    #[inline(never)]
    fn colour(&self, attribute: u16, unlit: u32) -> u16 {
        let ramp = &self.ramps[usize::from(attribute >> 13) % MAX_MATERIALS];
        ramp.colour(self.brightnesses(attribute, unlit))
    }

    /// The brightness of each channel, 0 to [`STEPS`].
    #[inline(always)]
    fn brightnesses(&self, attribute: u16, unlit: u32) -> [usize; 3] {
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

    /// Whether brightness is that of one white light on normals as they are.
    fn is_plain(&self) -> bool {
        let is_white = self.lamp_count == 1 && self.lamps[0].colour == [WHITE; 3];
        is_white && self.normals.is_none() && self.sphere.is_none()
    }

    /// Fills the table of brightness by normal, which suits every colour, if
    /// that is one for all channels.
    fn fill_brightness(&self, table: &mut [u16]) -> bool {
        if self.is_plain() {
            self.fill_material(&BRIGHTNESS, table);
        }
        self.is_plain()
    }

    /// Fills the table, material after material.
    fn fill(&self, table: &mut [u16]) -> bool {
        if !self.is_plain() {
            for (colour, attribute) in table.iter_mut().zip(0u16..) {
                *colour = self.colour(attribute, 0);
            }
            return true;
        }
        let ramps = self.ramps.iter().take(self.count);
        for (colours, ramp) in table.chunks_exact_mut(CODES).zip(ramps) {
            self.fill_material(&ramp.all(), colours);
        }
        true
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
            let [mut light_x, mut light_y, light_z] = self.lamps[0].towards;
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

    /// The colour for each channel's brightness.
    fn colour(&self, brightness: [usize; 3]) -> u16 {
        let mut channels = self.steps;
        for (channel, brightness) in channels.iter_mut().zip(brightness) {
            *channel *= brightness as u32;
        }
        Self::packed(channels)
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

/// Steps of brightness in a weight, Q1.15. At most four lights' worth: below
/// 2^19.
#[inline(always)]
fn steps(weight: i32) -> usize {
    (weight as usize >> 6).min(STEPS)
}

/// What has the colours.
#[derive(Clone, Copy)]
pub(crate) enum Paint<'a> {
    Materials(&'a [Rgb]),
    /// The samples of these levels.
    Samples(&'a [Level<'a>]),
}

impl<'a> Paint<'a> {
    fn materials(self) -> &'a [Rgb] {
        match self {
            Self::Materials(materials) => materials,
            Self::Samples(_) => &[],
        }
    }

    /// Of a grid on a canvas of so many words: its samples' own colours, if they
    /// have some and the canvas has a row for them; else its materials'.
    #[inline(always)]
    pub fn of(grid: &'a Grid<'a>, canvas: usize) -> Self {
        let is_coloured = cfg!(feature = "colour") && grid.attribute_bits() > 16;
        match is_coloured && canvas_rows(canvas / <[u32; 2]>::WORDS) > 0 {
            true => Self::Samples(grid.levels()),
            false => Self::Materials(grid.materials()),
        }
    }
}

/// Colours of attributes for one frame.
pub(crate) struct Shader<'a> {
    model: Model<'a>,
    /// What materials are in ambient light alone.
    dark: [u16; MAX_MATERIALS],
    table: &'a [u16],
    /// Those whose samples have the colours; the table is of brightness then.
    levels: &'a [Level<'a>],
}

impl<'a> Shader<'a> {
    /// For one light in model space. Fills the table if `memory` holds it: 8192
    /// words for each material.
    pub fn new(light: &Light, paint: Paint<'a>, memory: &'a mut [u16]) -> Self {
        let towards = light.towards.map(|c| c.to_bits());
        let beam = Beam::new(towards, light.diffuse, [255; 3]);
        let model = Model::new(light.ambient, paint.materials(), [beam], None);
        Self::with(model, paint, memory)
    }

    /// The same for a placed grid in a scene's light.
    pub fn placed(
        lighting: &Lighting<'a>,
        camera: &Camera,
        normals: &'a NormalMap,
        paint: Paint<'a>,
        memory: &'a mut [u16],
    ) -> Self {
        let beams = lighting.lamps.iter().map(|lamp| {
            let towards = normals.light(lamp.towards).map(|c| c << 16);
            Beam::new(towards, lamp.diffuse, lamp.colour)
        });
        let sheared = (!normals.is_plain()).then_some(normals);
        let sphere = lighting
            .matcap
            .map(|matcap| LitSphere::new(matcap, camera, normals));
        let model = Model {
            sphere,
            ..Model::new(lighting.ambient, paint.materials(), beams, sheared)
        };
        Self::with(model, paint, memory)
    }

    fn with(model: Model<'a>, paint: Paint<'a>, memory: &'a mut [u16]) -> Self {
        let ambient = [steps(model.ambient); 3];
        let levels: &[_] = match paint {
            Paint::Materials(_) => &[],
            Paint::Samples(levels) => levels,
        };
        let table = match levels {
            [] => memory.get_mut(..CODES * model.count),
            _ => memory.get_mut(..CODES),
        };
        let table = table.and_then(|table| {
            let is_full = match levels {
                [] => model.fill(table),
                _ => model.fill_brightness(table),
            };
            is_full.then_some(&*table)
        });
        Self {
            dark: model.ramps.map(|ramp| ramp.colour(ambient)),
            model,
            table: table.unwrap_or(&[]),
            levels,
        }
    }

    /// The colour of an attribute where lamps whose bits are set do not shine.
    #[inline(always)]
    pub fn colour_without(&self, attribute: u16, unlit: u32) -> u16 {
        if unlit == 0 {
            self.colour(attribute)
        } else if self.model.lamp_count == 1 && self.model.sphere.is_none() {
            self.dark[usize::from(attribute >> 13) % MAX_MATERIALS]
        } else {
            self.model.colour(attribute, unlit)
        }
    }

    /// The table, if it is that of one material.
    pub fn table_of_one(&self) -> Option<&[u16; CODES]> {
        let is_of_colours = self.levels.is_empty();
        self.table.try_into().ok().filter(|_| is_of_colours)
    }

    /// The colour of an attribute of a sample, given its depth and its index in
    /// its level.
    #[inline(never)]
    pub fn coloured(&self, attribute: u16, (depth, index): (usize, usize), unlit: u32) -> u16 {
        let level = self.levels.get(depth);
        let own = level.and_then(|level| level.colours.get(index));
        let brightness = self.table.get(usize::from(attribute) % CODES);
        let brightnesses = match brightness {
            Some(&brightness) if unlit == 0 => [usize::from(brightness); 3],
            _ => self.model.brightnesses(attribute, unlit),
        };
        Ramp::new(own.unwrap_or([0; 3])).colour(brightnesses)
    }

    /// The colour of an attribute.
    #[inline(always)]
    pub fn colour(&self, attribute: u16) -> u16 {
        match self.table.get(usize::from(attribute)) {
            Some(&colour) => colour,
            None => self.model.colour(attribute, 0),
        }
    }
}

#[cfg(test)]
mod tests;
