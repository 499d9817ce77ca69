//! `rhogrid render SCENE.toml`.

use rhogrid_core::numbers::Length;
use rhogrid_core::scene::Scene as CoreScene;
use rhogrid_core::shadow::{Method, Shadows};

use super::super::Failure;
use super::super::args::ShadowChoice;
use super::super::frame::{core_camera, core_quality, core_shadows, draw_placed, float_view};
use super::super::scene::{load_scene, with_core};
use super::report::{Report, print};
use super::{RenderArgs, draw_reference, edge_radius, output_at, trace, view_at};
use crate::geometry::Geometry;
use crate::measure::{SizeMismatch, against_reference, shadow_errors};
use crate::reference;
use crate::scene::Scene;
use crate::view::Lighting;

/// Draws and writes one picture or an orbit of them.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    args.source.check_unused(&args.input)?;
    if args.quality.light.is_some() {
        return Err(Failure::Usage(
            "--light is for models; a scene file has its own lights".into(),
        ));
    }
    let scene = load_scene(&args.input, args.models.as_deref())?;
    let count = args.orbit.unwrap_or(1);
    let original = match args.reference || args.compare {
        true => Some(original(args, &scene)?),
        false => None,
    };
    (0..count).try_for_each(|index| match &original {
        Some((original, lighting)) if args.reference => {
            draw_reference(args, original, &scene.cube, lighting, index)
        }
        original => draw(args, &scene, original.as_ref(), index),
    })
}

/// The original geometry and its light, for the reference.
fn original(args: &RenderArgs, scene: &Scene) -> Result<(reference::Scene, Lighting), Failure> {
    let mesh = scene.merged().ok_or_else(|| {
        let file = args.input.display();
        Failure::failed(
            format!("{file}: the reference draws scenes of meshes alone, with 255 materials"),
            "name meshes, not assets or clouds",
        )
    })?;
    let is_two_sided = scene
        .models
        .iter()
        .any(|model| model.asset.grid().two_sided());
    let mut lighting = scene.lighting.clone();
    if args.quality.shadows == Some(ShadowChoice::Off) {
        lighting
            .lamps
            .iter_mut()
            .for_each(|lamp| lamp.casts = false);
    }
    let original = reference::Scene::new(&Geometry::Mesh(mesh), is_two_sided);
    Ok((original, lighting))
}

fn draw(
    args: &RenderArgs,
    scene: &Scene,
    original: Option<&(reference::Scene, Lighting)>,
    index: u32,
) -> Result<(), Failure> {
    let shadows = core_shadows(&args.quality, ShadowChoice::OnePass);
    with_core(scene, shadows, |content| {
        draw_content(args, scene, content, original, index)
    })
}

fn draw_content(
    args: &RenderArgs,
    scene: &Scene,
    content: &CoreScene<'_>,
    original: Option<&(reference::Scene, Lighting)>,
    index: u32,
) -> Result<(), Failure> {
    let view = view_at(args, index);
    let output = output_at(args, index);
    let camera = core_camera(&view, Length::ONE, &scene.cube);
    let quality = core_quality(&args.quality);
    if args.verbose && !args.json {
        describe(scene, content)?;
    }
    let frame = draw_placed(content, &camera, &quality, args.frames);
    let picture = frame.picture();
    picture.save_png(&output)?;
    let measures = original.map(|(original, lighting)| {
        let reference = trace(&view, original, &scene.cube, lighting);
        let mut measures = against_reference(&picture, None, &reference)?;
        if content.shadows.method != Method::Off && lighting.caster().is_some() {
            let dark = Shadows {
                method: Method::Off,
                ..content.shadows
            };
            let without = CoreScene {
                shadows: dark,
                ..*content
            };
            let lit = draw_placed(&without, &camera, &quality, 1).picture();
            let view = float_view(&view, &scene.cube);
            let radius = edge_radius(&view, &scene.cube, &content.shadows);
            let errors = shadow_errors(&picture, &lit, &reference, radius)?;
            measures.shadow_errors = Some(errors);
        }
        Ok(measures)
    });
    let measures = measures
        .transpose()
        .map_err(|_: SizeMismatch| Failure::failed("sizes differ", "report this"))?;
    let yaw = args.view.eye.is_none().then_some(view.yaw);
    let report = Report::new(output, yaw, &frame, args.frames, measures);
    print(args, &report)
}

/// Says what the scene holds.
fn describe(scene: &Scene, content: &CoreScene<'_>) -> Result<(), Failure> {
    let bytes: usize = scene
        .models
        .iter()
        .map(|model| model.asset.bytes().len())
        .sum();
    let samples: usize = content
        .instances
        .iter()
        .filter_map(|instance| instance.grid.levels().last())
        .map(|level| level.attributes.len())
        .sum();
    let shadows = match content.shadows.method {
        Method::Off => "off",
        Method::TwoPass => "two passes",
        Method::OnePass => "one pass where instances have an order",
    };
    super::super::say(format_args!(
        "{} instances of {} assets, {bytes} bytes, {samples} leaf samples; shadows {shadows}",
        content.instances.len(),
        scene.models.len(),
    ))
}
