//! Shading: normal codes x materials -> colours.
//!
//! Source: Duguet and Drettakis 2003, 5.5. Once a frame, the colour of every
//! attribute goes into a table (16 KB a material); where the caller gives no
//! memory for it, samples are shaded one by one, to the same bytes.

pub(crate) mod matcap;
mod model;
mod ramp;

use crate::asset::{Grid, Level, MAX_MATERIALS, Rgb};
use crate::camera::Camera;
use crate::canvas::{Pixel, canvas_rows};
use crate::draw::Light;
use crate::normal::CODES;
use crate::placement::NormalMap;
use crate::scene::Lighting;
use matcap::LitSphere;
use model::{Beam, Model};
use ramp::{Ramp, steps};

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
        let model = Model::new(light.ambient, paint.materials(), [beam], None, None);
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
        let model = Model::new(lighting.ambient, paint.materials(), beams, sheared, sphere);
        Self::with(model, paint, memory)
    }

    fn with(model: Model<'a>, paint: Paint<'a>, memory: &'a mut [u16]) -> Self {
        let ambient = [steps(model.ambient); 3];
        let (levels, length): (&[_], _) = match paint {
            Paint::Materials(_) => (&[], CODES * model.count),
            Paint::Samples(levels) => (levels, CODES),
        };
        // Brightness is one for all channels, or is not tabulated.
        let tabulates = levels.is_empty() || model.is_plain;
        let table = match memory.get_mut(..length).filter(|_| tabulates) {
            None => &[],
            Some(table) => {
                match paint {
                    Paint::Materials(_) => model.fill(table),
                    Paint::Samples(_) => model.fill_brightness(table),
                }
                &*table
            }
        };
        Self {
            dark: model.ramps.map(|ramp| ramp.colour(ambient)),
            model,
            table,
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
