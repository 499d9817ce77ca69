//! Models and instances from their tables.

use std::path::{Path, PathBuf};

use glam::DVec3;
use rhogrid_core::asset::{MAX_MATERIALS, Shell};

use super::file::{GroundTable, InstanceTable, ShellName, Source};
use super::place::{self, Affine};
use super::{Instance, Load, Model};
use crate::bake::GridOptions;
use crate::error::Error;
use crate::geometry::{Geometry, Material, Mesh, Triangle};

/// What is wrong with a table.
pub enum Wrong {
    /// In the table: what, and what to do.
    Here(String, &'static str),
    /// In another file.
    There(Error),
}

impl Wrong {
    pub fn at(self, source: &Source<'_>, span: std::ops::Range<usize>) -> Error {
        match self {
            Self::Here(what, remedy) => source.error(span, what, remedy),
            Self::There(error) => error,
        }
    }
}

impl From<Error> for Wrong {
    fn from(error: Error) -> Self {
        Self::There(error)
    }
}

/// What a scene file's tables become.
pub struct Builder<'b> {
    file: &'b Path,
    folder: Option<&'b Path>,
    load: &'b mut dyn Load,
    /// What each model was made of.
    keys: Vec<(PathBuf, GridOptions)>,
    pub models: Vec<Model>,
    pub instances: Vec<Instance>,
}

impl<'b> Builder<'b> {
    pub fn new(file: &'b Path, folder: Option<&'b Path>, load: &'b mut dyn Load) -> Self {
        Self {
            file,
            folder,
            load,
            keys: Vec::new(),
            models: Vec::new(),
            instances: Vec::new(),
        }
    }

    pub fn instance(&mut self, table: &InstanceTable) -> Result<(), Wrong> {
        if table.materials.len() > MAX_MATERIALS {
            let what = format!("there are more than {MAX_MATERIALS} materials");
            return Err(Wrong::Here(what, "leave some out"));
        }
        let key = (self.find(&table.model)?, options(table)?);
        let model = match self.keys.iter().position(|other| *other == key) {
            Some(model) => model,
            None => {
                self.models.push(self.load.model(&key.0, &key.1)?);
                self.keys.push(key);
                self.models.len() - 1
            }
        };
        let place = place::of(table, &self.models[model].asset.cube())
            .map_err(|what| Wrong::Here(what, "give finite numbers, scales other than 0"))?;
        self.instances.push(Instance {
            model,
            place,
            materials: (!table.materials.is_empty()).then(|| table.materials.clone()),
        });
        Ok(())
    }

    /// A model's file, or its name if it is built in.
    fn find(&self, name: &str) -> Result<PathBuf, Wrong> {
        if name.starts_with("builtin:") {
            return Ok(name.into());
        }
        let beside = self.file.parent().unwrap_or(Path::new("")).join(name);
        let folders = self.folder.map(|folder| folder.join(name));
        let candidates = [Some(beside), folders];
        let found = candidates.into_iter().flatten().find(|path| path.exists());
        found.ok_or_else(|| {
            Wrong::Here(
                format!("there is no {name} beside the scene file or in --models"),
                "give the folder that holds it with --models DIR",
            )
        })
    }

    pub fn ground(&mut self, table: &GroundTable) -> Result<(), Wrong> {
        let is_finite = table.y.is_finite() && table.size.is_finite();
        if !(is_finite && table.size > 0.0) {
            let what = "the ground has no size".into();
            return Err(Wrong::Here(what, "give size, half its side"));
        }
        let geometry = Geometry::Mesh(square(table));
        let options = GridOptions {
            level: table.level.unwrap_or(GridOptions::default().level),
            ..GridOptions::default()
        };
        self.models.push(Model {
            asset: self.load.bake(&geometry, &options)?,
            geometry: Some(geometry),
        });
        self.instances.push(Instance {
            model: self.models.len() - 1,
            place: Affine::IDENTITY,
            materials: None,
        });
        Ok(())
    }
}

fn options(table: &InstanceTable) -> Result<GridOptions, Wrong> {
    let defaults = GridOptions::default();
    let rho = table.rho.unwrap_or(defaults.rho);
    if !(2..=5).contains(&rho) {
        return Err(Wrong::Here(format!("rho is {rho}"), "give 2 to 5"));
    }
    Ok(GridOptions {
        rho,
        level: table.level.unwrap_or(defaults.level),
        shell: match table.shell {
            Some(ShellName::Fat) => Shell::Fat,
            Some(ShellName::Thin) => Shell::Thin,
            None => defaults.shell,
        },
        up: table.up.map_or(defaults.up, Into::into),
        two_sided: table.two_sided,
        ..defaults
    })
}

/// Two triangles that face upwards.
fn square(table: &GroundTable) -> Mesh {
    let corner = |x: f64, z: f64| DVec3::new(x * table.size, table.y, z * table.size);
    let triangle = |positions| Triangle {
        positions,
        normals: [0; 3],
        material: 0,
    };
    Mesh {
        positions: vec![
            corner(-1.0, -1.0),
            corner(-1.0, 1.0),
            corner(1.0, 1.0),
            corner(1.0, -1.0),
        ],
        normals: vec![glam::Vec3::Y],
        triangles: vec![triangle([0, 1, 2]), triangle([0, 2, 3])],
        materials: vec![Material {
            name: "ground".into(),
            diffuse: table.colour,
        }],
        colours: Vec::new(),
        two_sided: false,
    }
}
