//! A model under measurement: its geometry, what it is baked into, and the
//! reference's pictures of it from the four full views.

use std::cell::{OnceCell, RefCell};
use std::path::Path;
use std::rc::Rc;

use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{Light, Quality};

use super::Progress;
use super::effort::Effort;
use super::row::{normals_name, shell_name};
use super::timing::Call;
use crate::asset_file::AssetFile;
use crate::bake::{self, BakedGrid, Cube, GridOptions, writer};
use crate::cli::{
    Frame, QualityArgs, Size, ViewArgs, core_camera, core_light, draw_frame, float_light,
    float_view,
};
use crate::error::{Error, Place};
use crate::geometry::{Geometry, Up};
use crate::import;
use crate::measure::against_reference;
use crate::picture::Picture;
use crate::reference::{DEFAULT_SAMPLES_PER_AXIS, Reference, Scene, render};
use crate::view;

/// Yaws of the standard views, degrees.
const YAWS: [f64; 4] = [0.0, 90.0, 180.0, 270.0];

/// An asset, as baked and as written.
pub struct Baked {
    /// Before it was written.
    pub grid: BakedGrid,
    /// Its file.
    pub asset: AssetFile,
}

/// A model.
pub struct Model {
    /// What the report calls it.
    pub name: String,
    /// What it is.
    pub geometry: Geometry,
    /// Where its grids lie in it.
    pub cube: Cube,
    up: Up,
    scene: Scene,
    /// The four full views.
    pub views: Vec<ViewArgs>,
    references: OnceCell<Vec<Reference>>,
    baked: RefCell<Vec<(GridOptions, Rc<Baked>)>>,
}

/// How good a picture is, and what was done for it; means over the views.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    /// See [`crate::measure::ReferenceMeasures`].
    pub psnr_inside: f64,
    /// See [`crate::measure::ReferenceMeasures`].
    pub holes: f64,
}

#[derive(clap::Parser)]
struct Defaults {
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    quality: QualityArgs,
}

fn defaults() -> Defaults {
    <Defaults as clap::Parser>::parse_from(["rhogrid"])
}

/// The standard light, for the core.
pub fn light() -> Light {
    core_light(&defaults().quality)
}

/// The standard light, for float.
pub fn bright() -> view::Light {
    float_light(&defaults().quality)
}

/// The core's camera of a view of an asset.
pub fn camera(asset: &AssetFile, view: &ViewArgs) -> Camera {
    core_camera(view, asset.grid().radius(), &asset.cube())
}

impl Model {
    /// The built-in scene.
    ///
    /// # Errors
    /// None that geometry with extent gives.
    pub fn builtin(effort: &Effort) -> Result<Self, Error> {
        let geometry = Geometry::Mesh(import::procedural::demo());
        Self::new("builtin:demo".into(), geometry, Up::Y, effort)
    }

    /// A mesh or cloud.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn load(path: &Path, up: Up, effort: &Effort) -> Result<Self, Error> {
        let geometry = import::load(path)?.geometry.turned(up);
        let name = path.file_stem().unwrap_or(path.as_os_str());
        Self::new(name.to_string_lossy().into_owned(), geometry, up, effort)
    }

    /// Geometry, y up, by a name.
    ///
    /// # Errors
    /// When it has no extent.
    pub fn new(name: String, geometry: Geometry, up: Up, effort: &Effort) -> Result<Self, Error> {
        let size = Size {
            width: effort.width,
            height: effort.height,
        };
        let views = Self::full_views()
            .into_iter()
            .map(|view| ViewArgs { size, ..view });
        Ok(Self {
            name,
            cube: Cube::of(&geometry)?,
            up,
            scene: Scene::new(&geometry, false),
            geometry,
            views: views.collect(),
            references: OnceCell::new(),
            baked: RefCell::default(),
        })
    }

    /// The four full views, of the standard size.
    pub fn full_views() -> Vec<ViewArgs> {
        let view = |yaw| ViewArgs {
            yaw,
            ..defaults().view
        };
        YAWS.map(view).to_vec()
    }

    /// Bakes, or gives what was baked before.
    ///
    /// # Errors
    /// When options or sizes are impossible.
    pub fn baked(&self, options: GridOptions, progress: Progress<'_>) -> Result<Rc<Baked>, Error> {
        let options = GridOptions {
            up: self.up,
            ..options
        };
        let known =
            |(own, baked): &(GridOptions, Rc<Baked>)| (*own == options).then(|| Rc::clone(baked));
        if let Some(baked) = self.baked.borrow().iter().find_map(known) {
            return Ok(baked);
        }
        progress(&format!(
            "{}: bakes rho {}, level {}, {} shell, {} normals",
            self.name,
            options.rho,
            options.level,
            shell_name(options.shell),
            normals_name(options.normals)
        ));
        let grid = bake::grid(&self.geometry, &options, &|_| {})?;
        let asset = AssetFile::new(&writer::to_bytes(&grid)?).map_err(|error| Error {
            file: None,
            place: Place::Whole,
            what: format!("{} was baked into a bad asset: {error}", self.name),
            remedy: "report this".into(),
        })?;
        let baked = Rc::new(Baked { grid, asset });
        self.baked.borrow_mut().push((options, Rc::clone(&baked)));
        Ok(baked)
    }

    /// The supersampled reference of each view.
    pub fn references(&self, progress: Progress<'_>) -> &[Reference] {
        self.references.get_or_init(|| {
            progress(&format!("{}: draws the reference", self.name));
            self.rendered(DEFAULT_SAMPLES_PER_AXIS)
        })
    }

    /// The reference of each view with so many samples squared a pixel.
    pub fn rendered(&self, samples_per_axis: u32) -> Vec<Reference> {
        let views = self.views.iter();
        views
            .map(|view| self.reference(view, bright(), samples_per_axis))
            .collect()
    }

    /// The reference of a view under a light.
    pub fn reference(
        &self,
        view: &ViewArgs,
        light: view::Light,
        samples_per_axis: u32,
    ) -> Reference {
        let view = float_view(view, &self.cube);
        render(&self.scene, &view, &light.into(), samples_per_axis, &|_| {})
    }

    /// A view in the cube's coordinates.
    pub fn float_view(&self, view: &ViewArgs) -> view::View {
        let view = float_view(view, &self.cube);
        view::View {
            eye: (view.eye - self.cube.centre) / self.cube.half_side,
            ..view
        }
    }

    /// Drops all assets.
    pub fn forget(&self) {
        self.baked.borrow_mut().clear();
    }

    /// The core's camera of each view.
    pub fn cameras(&self, asset: &AssetFile) -> Vec<Camera> {
        let views = self.views.iter();
        views.map(|view| camera(asset, view)).collect()
    }

    /// The draw call of each view.
    pub fn calls<'a>(&self, asset: &'a AssetFile, quality: Quality) -> Vec<Call<'a>> {
        let grid = asset.grid();
        let call = |camera| Call {
            grid: grid.clone(),
            camera,
            quality,
        };
        self.cameras(asset).into_iter().map(call).collect()
    }

    /// Draws the core's frame of each view.
    pub fn frames(&self, asset: &AssetFile, quality: &Quality) -> Vec<Frame> {
        let cameras = self.cameras(asset);
        let draw = |camera| draw_frame(&asset.grid(), camera, &light(), quality, 1);
        cameras.iter().map(draw).collect()
    }

    /// Holds pictures of the views against the reference.
    pub fn score(&self, pictures: &[Picture], progress: Progress<'_>) -> Score {
        let references = self.references(progress);
        let measures = pictures
            .iter()
            .zip(references)
            .filter_map(|(picture, own)| {
                // Sizes are the views'.
                against_reference(picture, None, own).ok()
            });
        let measures: Vec<_> = measures.collect();
        let mean = |of: &dyn Fn(usize) -> f64| {
            (0..measures.len()).map(of).sum::<f64>() / measures.len().max(1) as f64
        };
        Score {
            psnr_inside: mean(&|at| measures[at].psnr_inside.unwrap_or(f64::INFINITY)),
            holes: mean(&|at| measures[at].holes as f64),
        }
    }
}
