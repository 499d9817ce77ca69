//! Scenes on their way to the core.

use std::path::Path;

use glam::DVec3;
use rhogrid_core::asset::Grid;
use rhogrid_core::numbers::{Length, Unit, Weight};
use rhogrid_core::placement::Placement;
use rhogrid_core::scene::{Instance, Lamp, Lighting, Scene as CoreScene};
use rhogrid_core::shadow::Shadows;

use super::model::{bake_asset, is_asset, load_geometry};
use crate::asset_file::AssetFile;
use crate::bake::GridOptions;
use crate::error::Error;
use crate::geometry::Geometry;
use crate::scene::{Load, Model, Scene, load};
use crate::view;

/// Whether a file calls itself a scene.
pub fn is_scene(input: &Path) -> bool {
    input
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// Reads a scene file and its models.
///
/// # Errors
/// When a file cannot be read, or says what cannot be.
pub fn load_scene(file: &Path, models: Option<&Path>) -> Result<Scene, Error> {
    load(file, models, &mut FromFiles { scene: file })
}

struct FromFiles<'a> {
    scene: &'a Path,
}

impl Load for FromFiles<'_> {
    fn model(&mut self, input: &Path, options: &GridOptions) -> Result<Model, Error> {
        if is_asset(input) {
            return Ok(Model {
                asset: AssetFile::load(input)?,
                geometry: None,
            });
        }
        let geometry = load_geometry(input, options.up)?;
        Ok(Model {
            asset: bake_asset(input, &geometry, options)?,
            geometry: Some(geometry),
        })
    }

    fn bake(&mut self, geometry: &Geometry, options: &GridOptions) -> Result<AssetFile, Error> {
        bake_asset(self.scene, geometry, options)
    }
}

/// The grids of a scene's models.
fn grids(scene: &Scene) -> Vec<Grid<'_>> {
    scene
        .models
        .iter()
        .map(|model| model.asset.grid())
        .collect()
}

/// Where a scene's instances stand, for the core: its centre becomes the
/// origin, its radius the unit.
pub fn placements(scene: &Scene) -> Vec<Placement> {
    let unit = scene.cube.radius;
    let length = |v: DVec3| v.to_array().map(Length::saturating_from_num);
    let place = |instance: &crate::scene::Instance| {
        let cube = scene.models[instance.model].asset.cube();
        let axis = |axis: DVec3| length(instance.place.linear * axis * cube.half_side / unit);
        Placement {
            axes: [DVec3::X, DVec3::Y, DVec3::Z].map(axis),
            origin: length((instance.place.point(cube.centre) - scene.cube.centre) / unit),
        }
    };
    scene.instances.iter().map(place).collect()
}

/// The instances.
fn instances<'a>(
    scene: &'a Scene,
    grids: &'a [Grid<'a>],
    placements: &[Placement],
) -> Vec<Instance<'a>> {
    let placed = scene.instances.iter().zip(placements);
    placed
        .map(|(instance, &placement)| Instance {
            grid: &grids[instance.model],
            placement,
            materials: instance.materials.as_deref(),
        })
        .collect()
}

/// The lights.
pub fn lamps(scene: &Scene) -> Vec<Lamp> {
    let lamp = |lamp: &view::Lamp| Lamp {
        towards: lamp.towards.to_array().map(Unit::from_num),
        colour: lamp.colour,
        diffuse: Weight::from_num(lamp.diffuse),
        casts: lamp.casts,
    };
    scene.lighting.lamps.iter().map(lamp).collect()
}

/// The ambient weight.
pub fn ambient(scene: &Scene) -> Weight {
    Weight::from_num(scene.lighting.ambient)
}

/// Hands a scene to what draws the core's.
pub fn with_core<T>(scene: &Scene, shadows: Shadows, draw: impl FnOnce(&CoreScene<'_>) -> T) -> T {
    let (grids, placements, lamps) = (grids(scene), placements(scene), lamps(scene));
    let instances = instances(scene, &grids, &placements);
    draw(&CoreScene {
        instances: &instances,
        lighting: Lighting {
            ambient: ambient(scene),
            matcap: scene.matcap(),
            lamps: &lamps,
        },
        shadows,
    })
}
