//! Scenes: models placed in a world, their lights, a ground.
//!
//! ```text
//! SCENE.toml -> file -> models, loaded and baked once each -> Scene -> core, reference
//! ```

mod file;
mod place;

use std::path::{Path, PathBuf};

use glam::DVec3;
use rhogrid_core::asset::{MAX_MATERIALS, Shell};
use rhogrid_core::scene::{MAX_LAMPS, Matcap as CoreMatcap};
use toml::Spanned;

use crate::asset_file::AssetFile;
use crate::bake::{Cube, GridOptions};
use crate::error::Error;
use crate::geometry::{Geometry, Material, Mesh, Triangle};
use crate::picture::{Picture, rgb565};
use crate::view::{Lamp, Lighting, Matcap};
use file::{GroundTable, InstanceTable, LightTable, ShellName, Source};

pub use place::Affine;

/// Ambient weight without a matcap, unless a file says otherwise.
const AMBIENT: f64 = 0.2;

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
    let mut builder = Builder {
        file,
        folder: models,
        load,
        keys: Vec::new(),
        models: Vec::new(),
        instances: Vec::new(),
    };
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
    let mut lamps = Vec::new();
    for table in &content.light {
        let lamp = lamp(table.get_ref()).map_err(|wrong| wrong.at(&source, table.span()))?;
        lamps.push(lamp);
    }
    let matcap = match &content.matcap {
        None => None,
        Some(name) => Some(matcap(file, name, &source)?),
    };
    if lamps.is_empty() && matcap.is_none() {
        lamps.push(default_lamp());
    }
    if lamps.len() > MAX_LAMPS {
        let span = content.light[MAX_LAMPS].span();
        return Err(source.error(span, "there are more than three lights", "leave some out"));
    }
    let unless_said = if matcap.is_some() { 1.0 } else { AMBIENT };
    let ambient = content.ambient.unwrap_or(unless_said);
    if !(0.0..=1.0).contains(&ambient) {
        return Err(source.error(0..0, "ambient is not between 0 and 1", "give a weight"));
    }
    let cube = bounds(&models, &instances);
    Ok(Scene {
        models,
        instances,
        lighting: Lighting {
            ambient,
            matcap,
            lamps,
        },
        cube,
    })
}

/// Reads a picture of a lit sphere, relative to the scene's file.
fn matcap(file: &Path, name: &Spanned<PathBuf>, source: &Source<'_>) -> Result<Matcap, Error> {
    let path = file.parent().unwrap_or(Path::new("")).join(name.get_ref());
    let picture = Picture::load(&path)?;
    let colours = picture
        .rgb
        .iter()
        .map(|colour| rgb565(colour.map(f64::from)));
    let matcap = Matcap {
        texels: colours.collect(),
    };
    let is_square = picture.width == picture.height;
    match CoreMatcap::new(&matcap.texels) {
        Some(_) if is_square => Ok(matcap),
        _ => {
            let what = format!("a matcap of {} by {} pixels", picture.width, picture.height);
            let remedy = "give a square of at most 1024 pixels a side";
            Err(source.error(name.span(), what, remedy))
        }
    }
}

/// What is wrong with a table.
enum Wrong {
    /// In the table: what, and what to do.
    Here(String, &'static str),
    /// In another file.
    There(Error),
}

impl Wrong {
    fn at(self, source: &Source<'_>, span: std::ops::Range<usize>) -> Error {
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

struct Builder<'b> {
    file: &'b Path,
    folder: Option<&'b Path>,
    load: &'b mut dyn Load,
    /// What each model was made of.
    keys: Vec<(PathBuf, GridOptions)>,
    models: Vec<Model>,
    instances: Vec<Instance>,
}

impl Builder<'_> {
    fn instance(&mut self, table: &InstanceTable) -> Result<(), Wrong> {
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

    fn ground(&mut self, table: &GroundTable) -> Result<(), Wrong> {
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

fn lamp(table: &LightTable) -> Result<Lamp, Wrong> {
    let towards = DVec3::from(table.towards).try_normalize();
    let Some(towards) = towards.filter(|towards| towards.is_finite()) else {
        let what = "the light has no direction".into();
        return Err(Wrong::Here(what, "give towards other than 0, 0, 0"));
    };
    if !(0.0..=1.0).contains(&table.intensity) {
        let what = "intensity is not between 0 and 1".into();
        return Err(Wrong::Here(what, "give a weight"));
    }
    Ok(Lamp {
        towards,
        colour: table.colour,
        diffuse: table.intensity,
        casts: table.shadows,
    })
}

fn default_lamp() -> Lamp {
    Lamp {
        towards: DVec3::new(1.0, 2.0, 1.5).normalize(),
        colour: [255; 3],
        diffuse: 0.8,
        casts: true,
    }
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

/// The box of everything, and the farthest that anything reaches from its
/// middle: vertices where they are known, else the corners of boxes.
fn bounds(models: &[Model], instances: &[Instance]) -> Cube {
    let points = || {
        instances.iter().flat_map(|instance| {
            let model = &models[instance.model];
            let points = match &model.geometry {
                Some(geometry) => geometry.points(),
                None => model.asset.cube().corners(),
            };
            let place = instance.place;
            points.into_iter().map(move |point| place.point(point))
        })
    };
    let (min, max) = points().fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(min, max), point| (min.min(point), max.max(point)),
    );
    let centre = min.midpoint(max);
    let radius = points()
        .map(|point| point.distance(centre))
        .fold(f64::MIN_POSITIVE, f64::max);
    Cube {
        centre,
        extents: max - centre,
        half_side: radius,
        radius,
    }
}

impl Scene {
    /// What ambient light is, for the core.
    pub fn matcap(&self) -> Option<CoreMatcap<'_>> {
        let matcap = self.lighting.matcap.as_ref()?;
        CoreMatcap::new(&matcap.texels)
    }

    /// Everything as one mesh in the world, for the reference; `None` where a
    /// model's geometry is not known or is a cloud.
    pub fn merged(&self) -> Option<Mesh> {
        let mut merged = Mesh::default();
        for instance in &self.instances {
            let Some(Geometry::Mesh(mesh)) = &self.models[instance.model].geometry else {
                return None;
            };
            instance.add_to(mesh, &mut merged)?;
        }
        Some(merged)
    }
}

impl Instance {
    fn add_to(&self, mesh: &Mesh, merged: &mut Mesh) -> Option<()> {
        let first = |length: usize| u32::try_from(length).ok();
        let position = first(merged.positions.len())?;
        let normal = first(merged.normals.len())?;
        let material = u8::try_from(merged.materials.len()).ok()?;
        u8::try_from(merged.materials.len() + mesh.materials.len()).ok()?;
        let positions = mesh.positions.iter();
        merged
            .positions
            .extend(positions.map(|&position| self.place.point(position)));
        let normals = mesh.normals.iter();
        merged
            .normals
            .extend(normals.map(|&normal| self.place.normal(normal)));
        let turn = |corners: [u32; 3], first: u32| {
            let [a, b, c] = corners.map(|corner| first + corner);
            if self.place.mirrors() {
                [a, c, b]
            } else {
                [a, b, c]
            }
        };
        let triangles = mesh.triangles.iter().map(|triangle| Triangle {
            positions: turn(triangle.positions, position),
            normals: turn(triangle.normals, normal),
            material: material + triangle.material,
        });
        merged.triangles.extend(triangles);
        let diffuse = |index: usize| match &self.materials {
            None => mesh.materials[index].diffuse,
            Some(given) => given.get(index).copied().unwrap_or([0; 3]),
        };
        let own = mesh.colours.iter().filter(|_| self.materials.is_none());
        let own = own.map(Some).chain(std::iter::repeat(None));
        let colours = mesh
            .triangles
            .iter()
            .zip(own)
            .map(|(triangle, own)| match own {
                Some(&[a, b, c]) if self.place.mirrors() => [a, c, b],
                Some(&colours) => colours,
                None => [diffuse(usize::from(triangle.material)); 3],
            });
        merged.colours.extend(colours);
        for (index, own) in mesh.materials.iter().enumerate() {
            merged.materials.push(Material {
                diffuse: diffuse(index),
                ..own.clone()
            });
        }
        Some(())
    }
}
