//! Scenes: models placed in a world, their lights, a ground.
//!
//! ```text
//! SCENE.toml -> file -> models, loaded and baked once each -> Scene -> core, reference
//! ```

mod build;
mod file;
mod lights;
mod merge;
mod place;

use std::path::Path;

use rhogrid_core::scene::Matcap;

use crate::asset_file::AssetFile;
use crate::bake::{Cube, GridOptions};
use crate::error::Error;
use crate::geometry::Geometry;
use crate::view::Lighting;
use build::Builder;
use file::Source;
use lights::lighting;
use merge::bounds;

pub use place::Affine;

/// What a model of a scene is made with.
pub trait Load {
    /// Opens or loads and bakes a model: a file, or a built-in one's name.
    ///
    /// # Errors
    /// When it cannot be read or baked.
    fn model(&mut self, input: &Path, options: &GridOptions) -> Result<Model, Error>;

    /// Bakes geometry.
    ///
    /// # Errors
    /// When it cannot be baked.
    fn bake(&mut self, geometry: &Geometry, options: &GridOptions) -> Result<AssetFile, Error>;
}

/// An asset and what it was baked from.
#[derive(Debug)]
pub struct Model {
    /// The asset.
    pub asset: AssetFile,
    /// `None` for assets that were baked before.
    pub geometry: Option<Geometry>,
}

/// A placed model.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Index of the model.
    pub model: usize,
    /// From source units, y up, to the world.
    pub place: Affine,
    /// Colours that take the place of its materials'.
    pub materials: Option<Vec<[u8; 3]>>,
}

/// A scene, its models in memory.
#[derive(Debug)]
pub struct Scene {
    /// The models, each once.
    pub models: Vec<Model>,
    /// Where they stand.
    pub instances: Vec<Instance>,
    /// Its lights.
    pub lighting: Lighting,
    /// Its box; its half side is its radius.
    pub cube: Cube,
}

/// Reads a scene file and its models. Names of models are relative to the
/// file's folder, or else to `models`.
///
/// # Errors
/// When a file cannot be read, or says what cannot be.
pub fn load(file: &Path, models: Option<&Path>, load: &mut dyn Load) -> Result<Scene, Error> {
    let text = std::fs::read_to_string(file)
        .map_err(|error| Error::file(file, error.to_string(), "check the path"))?;
    let source = Source::new(file, &text);
    let content = source.parse()?;
    let mut builder = Builder::new(file, models, load);
    for table in &content.instance {
        builder
            .instance(table.get_ref())
            .map_err(|wrong| wrong.at(&source, table.span()))?;
    }
    if let Some(table) = &content.ground {
        builder
            .ground(table.get_ref())
            .map_err(|wrong| wrong.at(&source, table.span()))?;
    }
    let Builder {
        models, instances, ..
    } = builder;
    if instances.is_empty() {
        return Err(source.error(0..0, "the scene is empty", "add an [[instance]]"));
    }
    let lighting = lighting(file, &content, &source)?;
    let cube = bounds(&models, &instances);
    Ok(Scene {
        models,
        instances,
        lighting,
        cube,
    })
}

impl Scene {
    /// What ambient light is, for the core.
    pub fn matcap(&self) -> Option<Matcap<'_>> {
        let matcap = self.lighting.matcap.as_ref()?;
        Matcap::new(&matcap.texels)
    }
}
