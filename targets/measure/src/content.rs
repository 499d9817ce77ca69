//! What a frame file shows: one grid, or a scene.

use rhogrid_core::asset::Grid;
use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{Light, draw};
use rhogrid_core::numbers::{Unit, Weight};
use rhogrid_core::placement::Placement;
use rhogrid_core::scene::{Instance, Lamp, Lighting, MAX_LAMPS, Matcap, Memory, Scene, draw_scene};
use rhogrid_core::shadow::Method;
use rhogrid_core::stats::Stats;
use rhogrid_core::target::{Layers, Target, TargetError};
use rhogrid_frame::{Frame, MAX_INSTANCES, Materials, Placed, Settings};

use crate::flow::Failure;

/// What the draw call may write beside the picture.
pub struct Memories<'a> {
    /// The shade table.
    pub shades: &'a mut [u16],
    /// Shadow maps.
    pub shadows: &'a mut [u16],
    /// The canvas.
    pub canvas: &'a mut [u32],
}

/// The grids, where they stand, and their light.
pub struct Content<'a> {
    settings: Settings,
    grids: &'a [Option<Grid<'a>>],
    placed: [Option<(Placed, &'a Grid<'a>)>; MAX_INSTANCES],
    lamps: [Lamp; MAX_LAMPS],
    lamp_count: usize,
    matcap: Option<Matcap<'a>>,
    lone: Option<Light>,
}

impl<'a> Content<'a> {
    /// Of a frame file, its assets opened.
    ///
    /// # Errors
    /// When an instance is of no asset.
    pub fn new(frame: &Frame<'a>, grids: &'a [Option<Grid<'a>>]) -> Result<Self, Failure> {
        let mut content = Self {
            settings: frame.settings(),
            grids,
            placed: [None; MAX_INSTANCES],
            lamps: [DARK; MAX_LAMPS],
            lamp_count: 0,
            matcap: frame.matcap(),
            lone: frame.lone_light(),
        };
        for (place, placed) in content.placed.iter_mut().zip(frame.instances()) {
            let grid = grids.get(placed.asset as usize).and_then(Option::as_ref);
            *place = Some((placed, grid.ok_or(Failure::Instance)?));
        }
        for (place, lamp) in content.lamps.iter_mut().zip(frame.lamps()) {
            *place = lamp;
            content.lamp_count += 1;
        }
        Ok(content)
    }

    /// The largest number of materials.
    pub fn materials(&self) -> usize {
        let own = self.grids.iter().flatten();
        let own = own.map(|grid| grid.materials().len());
        let given = self.placed.iter().flatten();
        let given = given.filter_map(|(placed, _)| placed.materials);
        let given = given.map(|materials| materials.as_slice().len());
        own.chain(given).max().unwrap_or(0)
    }

    /// What of the memory for shadow maps the lamps use.
    ///
    /// # Errors
    /// When they want more.
    pub fn shadows<'m>(&self, memory: &'m mut [u16]) -> Result<&'m mut [u16], Failure> {
        let casting = self.lamps().iter().filter(|lamp| lamp.casts).count();
        let length = match self.settings.shadows.method {
            Method::Off => 0,
            _ => casting * self.settings.shadows.map_len(),
        };
        memory.get_mut(..length).ok_or(Failure::Shadows(length))
    }

    /// The instances, and how many there are.
    ///
    /// # Errors
    /// Without any.
    pub fn instances(&self) -> Result<([Instance<'_>; MAX_INSTANCES], usize), Failure> {
        let first = self.placed.iter().flatten().next();
        let (_, grid) = first.ok_or(Failure::Instance)?;
        let to_be_overwritten = Instance {
            grid,
            placement: Placement::IDENTITY,
            materials: None,
        };
        let mut instances = [to_be_overwritten; MAX_INSTANCES];
        let mut count = 0;
        for (instance, (placed, grid)) in instances.iter_mut().zip(self.placed.iter().flatten()) {
            *instance = Instance {
                grid,
                placement: placed.placement,
                materials: placed.materials.as_ref().map(Materials::as_slice),
            };
            count += 1;
        }
        Ok((instances, count))
    }

    fn lamps(&self) -> &[Lamp] {
        self.lamps.get(..self.lamp_count).unwrap_or(&self.lamps)
    }

    /// The draw call. Not inlined, so that all of its stack lies below the
    /// caller's frame.
    ///
    /// # Errors
    /// When the buffers do not fit the picture.
    #[inline(never)]
    pub fn draw(
        &self,
        instances: &[Instance<'_>],
        camera: &Camera,
        colour: &mut [u16],
        depth: &mut [u16],
        memory: &mut Memories<'_>,
    ) -> Result<Stats, TargetError> {
        let Settings {
            width,
            height,
            quality,
            ..
        } = &self.settings;
        let mut target = Target::new(*width, *height, colour, memory.canvas)?;
        match (&self.lone, self.grids.first()) {
            (Some(light), Some(Some(grid))) => {
                let shades = &mut *memory.shades;
                Ok(draw(grid, camera, light, quality, shades, &mut target))
            }
            _ => {
                let mut layers = Layers::new(target.with_depth(depth)?)?;
                let memory = Memory {
                    shades: memory.shades,
                    shadows: memory.shadows,
                };
                let scene = Scene {
                    instances,
                    lighting: Lighting {
                        ambient: self.settings.ambient,
                        matcap: self.matcap,
                        lamps: self.lamps(),
                    },
                    shadows: self.settings.shadows,
                };
                Ok(draw_scene(&scene, camera, quality, memory, &mut layers))
            }
        }
    }
}

/// To be overwritten.
const DARK: Lamp = Lamp {
    towards: [Unit::ZERO; 3],
    colour: [0; 3],
    diffuse: Weight::ZERO,
    casts: false,
};
