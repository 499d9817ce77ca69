//! `rhogrid render`.

mod report;
mod scene;

use std::path::{Path, PathBuf};

use clap::Args;
use rhogrid_core::camera::Camera;
use rhogrid_core::plan::Plan;
use rhogrid_core::projection::DepthRange;
use rhogrid_core::shadow::{Method, Shadows};
use serde::Serialize;

use super::Failure;
use super::args::{QualityArgs, ShadowChoice, SourceArgs, ViewArgs};
use super::frame::{
    Frame, core_camera, core_light, core_quality, core_shadows, draw_frame, draw_shadowed,
    float_light, float_view,
};
use super::model::{Model, check_distinct, is_asset, load_geometry, progress_bar};
use super::scene::is_scene;
use crate::asset_file::AssetFile;
use crate::bake::Cube;
use crate::geometry::Geometry;
use crate::measure::{Depths, SizeMismatch, against_reference, shadow_errors};
use crate::reference::{DEFAULT_SAMPLES_PER_AXIS, Reference, Scene, render};
use crate::view::{Lighting, View};
use report::{Report, print};

/// Arguments of `rhogrid render`.
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// Asset (.rho), mesh or cloud (.obj, .ply), scene (.toml), or builtin:demo,
    /// builtin:tree-broad, builtin:tree-willow
    input: PathBuf,
    /// Picture to write; with --orbit, OUT-000.png and so on
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    #[command(flatten)]
    source: SourceArgs,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    quality: QualityArgs,
    /// Draw the original geometry with the float reference instead
    #[arg(long, conflicts_with_all = ["compare", "frames"])]
    reference: bool,
    /// Where a scene's models are, if not beside its file
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,
    /// Measure the picture against the float reference, too
    #[arg(long)]
    compare: bool,
    /// Draw N pictures around the y axis
    #[arg(long, value_name = "N", conflicts_with_all = ["eye", "look_at"], value_parser = clap::value_parser!(u32).range(1..=10000))]
    orbit: Option<u32>,
    /// Draw each picture N times and give the median time
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    /// One JSON object for each picture on stdout
    #[arg(long)]
    json: bool,
    /// Say more of what was drawn
    #[arg(short, long)]
    verbose: bool,
}

/// What the reference drew.
#[derive(Debug, Serialize)]
struct ReferenceReport {
    output: PathBuf,
    width: u32,
    height: u32,
    /// Null where the eye was given.
    yaw: Option<f64>,
}

/// Draws and writes one picture or an orbit of them.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    args.source.check()?;
    args.view.check()?;
    args.quality.check()?;
    check_distinct(&args.input, &args.output)?;
    if args
        .output
        .extension()
        .is_some_and(|extension| !extension.eq_ignore_ascii_case("png"))
    {
        let output = args.output.display();
        return Err(Failure::Usage(format!(
            "{output}: pictures are PNG; name it OUT.png"
        )));
    }
    if is_scene(&args.input) {
        return scene::run(args);
    }
    if args.models.is_some() {
        return Err(Failure::Usage("--models is for scenes".into()));
    }
    let count = args.orbit.unwrap_or(1);
    if args.reference {
        let geometry = source_geometry(args)?;
        let scene = Scene::new(&geometry, args.source.two_sided);
        let cube = Cube::of(&geometry)?;
        let lighting = float_light(&args.quality).into();
        return (0..count)
            .try_for_each(|index| draw_reference(args, &scene, &cube, &lighting, index));
    }
    let model = Model::open(&args.input, &args.source)?;
    let scene = match (&model.geometry, args.compare) {
        (_, false) => None,
        (Some(geometry), true) => Some(Scene::new(geometry, model.asset.grid().two_sided())),
        (None, true) => return Err(no_geometry(&args.input)),
    };
    (0..count).try_for_each(|index| draw_grid(args, &model.asset, scene.as_ref(), index))
}

fn no_geometry(input: &Path) -> Failure {
    Failure::failed(
        format!(
            "{}: an asset keeps no original geometry to compare with",
            input.display()
        ),
        "give the mesh or cloud that it was baked from",
    )
}

fn source_geometry(args: &RenderArgs) -> Result<Geometry, Failure> {
    if is_asset(&args.input) {
        return Err(no_geometry(&args.input));
    }
    Ok(load_geometry(&args.input, args.source.grid_options().up)?)
}

/// The view of the index-th picture.
fn view_at(args: &RenderArgs, index: u32) -> ViewArgs {
    let step = args.orbit.map_or(0.0, |count| 360.0 / f64::from(count));
    ViewArgs {
        yaw: args.view.yaw + step * f64::from(index),
        ..args.view.clone()
    }
}

/// The name of the index-th picture.
fn output_at(args: &RenderArgs, index: u32) -> PathBuf {
    if args.orbit.is_none() {
        return args.output.clone();
    }
    let stem = args
        .output
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    args.output.with_file_name(format!("{stem}-{index:03}.png"))
}

fn draw_reference(
    args: &RenderArgs,
    scene: &Scene,
    cube: &Cube,
    lighting: &Lighting,
    index: u32,
) -> Result<(), Failure> {
    let view = view_at(args, index);
    let output = output_at(args, index);
    let reference = trace(&view, scene, cube, lighting);
    reference.picture().save_png(&output)?;
    if args.json {
        return super::print_json(&ReferenceReport {
            output,
            width: reference.width,
            height: reference.height,
            yaw: args.view.eye.is_none().then_some(view.yaw),
        });
    }
    super::say(format_args!(
        "{}: reference, {}x{}",
        output.display(),
        reference.width,
        reference.height
    ))?;
    Ok(())
}

fn trace(view: &ViewArgs, scene: &Scene, cube: &Cube, lighting: &Lighting) -> Reference {
    let bar = progress_bar();
    bar.set_length(u64::from(view.size.height));
    let reference = render(
        scene,
        &float_view(view, cube),
        lighting,
        DEFAULT_SAMPLES_PER_AXIS,
        &|rows| {
            bar.set_position(u64::from(rows));
        },
    );
    bar.finish_and_clear();
    reference
}

fn draw_grid(
    args: &RenderArgs,
    asset: &AssetFile,
    scene: Option<&Scene>,
    index: u32,
) -> Result<(), Failure> {
    let (grid, cube) = (asset.grid(), asset.cube());
    let view = view_at(args, index);
    let output = output_at(args, index);
    let camera = core_camera(&view, grid.radius(), &cube);
    let quality = core_quality(&args.quality);
    if args.verbose && !args.json {
        let plan = Plan::new(&grid, &camera, &quality).to_string();
        super::say(format_args!("{}", plan.trim_end()))?;
    }
    let light = core_light(&args.quality);
    let shadows = core_shadows(&args.quality, ShadowChoice::Off);
    let frame = match shadows.method {
        Method::Off => draw_frame(&grid, &camera, &light, &quality, args.frames),
        _ => draw_shadowed(&grid, &camera, &light, &quality, &shadows, args.frames),
    };
    let picture = frame.picture();
    picture.save_png(&output)?;
    let measures = scene.map(|scene| {
        let reference = trace(&view, scene, &cube, &float_light(&args.quality).into());
        let (w, tolerance) = depths(&frame, &camera, asset, args.quality.splat);
        let depths = Depths {
            w: &w,
            tolerance: &tolerance,
        };
        let mut measures = against_reference(&picture, Some(depths), &reference)?;
        if shadows.method != Method::Off {
            let lit = draw_frame(&grid, &camera, &light, &quality, 1).picture();
            let radius = edge_radius(&float_view(&view, &cube), &cube, &shadows);
            let errors = shadow_errors(&picture, &lit, &reference, radius)?;
            measures.shadow_errors = Some(errors);
        }
        Ok(measures)
    });
    let measures = measures
        .transpose()
        .map_err(|_: SizeMismatch| Failure::failed("sizes differ", "report this"))?;
    print(
        args,
        &Report::new(
            output,
            args.view.eye.is_none().then_some(view.yaw),
            &frame,
            args.frames,
            measures,
        ),
    )
}

/// Two texels of a shadow map in pixels, in the middle of a model: nearer to the
/// edge of a shadow its state is not held against the reference.
fn edge_radius(view: &View, cube: &Cube, shadows: &Shadows) -> f64 {
    let w = (cube.centre - view.eye)
        .dot(view.forward)
        .max(f64::MIN_POSITIVE);
    let texel = 2.0 * cube.radius / f64::from(shadows.size);
    (2.0 * texel * view.focal_px / w).min(f64::from(view.width))
}

/// Each pixel's w in source units, and how much deeper than the reference is
/// see-through: two diagonals of the drawn cell, which is a leaf or as large
/// as a splat, and one step of depth.
fn depths(frame: &Frame, camera: &Camera, asset: &AssetFile, splat: f64) -> (Vec<f32>, Vec<f32>) {
    let grid = asset.grid();
    let unit = asset.cube().half_side;
    let range = DepthRange::of(camera);
    let (near, far) = (range.near.to_num::<f64>(), range.far.to_num::<f64>());
    let steps = (1.0 / near - 1.0 / far) / 65534.0;
    let leaf = 2.0 / f64::from(grid.rho()).powi(i32::from(grid.depth()));
    let focal = camera.focal_px.to_num::<f64>();
    let pixel = |depth: &u16| {
        let w = 1.0 / (1.0 / far + f64::from(depth.saturating_sub(1)) * steps);
        let cell = leaf.max(splat * w / focal);
        let tolerance = 2.0 * 3f64.sqrt() * cell + w * w * steps;
        ((w * unit) as f32, (tolerance * unit) as f32)
    };
    frame.depth.iter().map(pixel).unzip()
}
