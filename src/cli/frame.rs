//! One frame: from options to the core's fixed-point camera and light, and to
//! the float twins that the reference draws with.

use glam::DVec3;
use rhogrid_core::asset::Grid;
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light as CoreLight, Quality, draw, shades_len};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};
use rhogrid_core::placement::Placement;
use rhogrid_core::scene::{Instance, Lamp, Lighting, Memory, Scene, draw_scene};
use rhogrid_core::shadow::{Method, Shadows};
use rhogrid_core::stats::Stats;
use rhogrid_core::target::{Layers, Target, canvas_len, frame_hash};

use super::args::{CullingChoice, QualityArgs, RepairChoice, ShadowChoice, ViewArgs};
use crate::bake::Cube;
use crate::picture::Picture;
use crate::view::{Light, View};

/// Ambient weight of the default light.
const AMBIENT: f64 = 0.2;
/// Diffuse weight of the default light.
const DIFFUSE: f64 = 0.8;

/// The core's camera for a model or a scene of a radius, in half sides of its
/// cube: angles and distance go through the core's own orbit, an eye position is
/// moved into the cube.
pub fn core_camera(view: &ViewArgs, radius: Length, cube: &Cube) -> Camera {
    let focal_px =
        FocalPx::saturating_from_num(View::focal_px(view.fov, u32::from(view.size.height)));
    let (width, height) = (view.size.width, view.size.height);
    match view.eye {
        None => {
            let orbit = Orbit {
                yaw: turns(view.yaw),
                pitch: turns(view.pitch),
                distance: Length::saturating_from_num(view.distance * radius.to_num::<f64>()),
            };
            Camera::orbit(&orbit, focal_px, width, height)
        }
        Some(_) => {
            let float = float_view(view, cube);
            let eye = (float.eye - cube.centre) / cube.half_side;
            let unit = |v: DVec3| v.to_array().map(Unit::from_num);
            Camera {
                eye: eye.to_array().map(Length::saturating_from_num),
                right: unit(float.right),
                up: unit(float.up),
                forward: unit(float.forward),
                focal_px,
                width,
                height,
                near: Camera::NEAR,
            }
        }
    }
}

/// The float camera for a model.
pub fn float_view(view: &ViewArgs, cube: &Cube) -> View {
    let (eye, right, forward) = match view.eye {
        None => {
            let (sin_yaw, cos_yaw) = view.yaw.to_radians().sin_cos();
            let (sin_pitch, cos_pitch) = view.pitch.to_radians().sin_cos();
            let back = DVec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
            let eye = cube.centre + back * view.distance * cube.radius;
            (eye, DVec3::new(cos_yaw, 0.0, -sin_yaw), -back)
        }
        Some(eye) => {
            let towards = view.look_at.map_or(cube.centre, |at| at.0) - eye.0;
            let forward = towards.try_normalize().unwrap_or(DVec3::NEG_Z);
            // Looking along the y axis, x stays to the right.
            let right = forward.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X);
            (eye.0, right, forward)
        }
    };
    View {
        eye,
        right,
        up: right.cross(forward),
        forward,
        focal_px: View::focal_px(view.fov, u32::from(view.size.height)),
        width: u32::from(view.size.width),
        height: u32::from(view.size.height),
    }
}

/// Degrees to turns, modulo one.
fn turns(degrees: f64) -> Turns {
    let turns = (degrees / 360.0).rem_euclid(1.0);
    Turns::from_bits((turns * 4_294_967_296.0).round() as u64 as u32)
}

/// The core's light.
pub fn core_light(quality: &QualityArgs) -> CoreLight {
    CoreLight {
        towards: quality.towards().normalize().to_array().map(Unit::from_num),
        ambient: Weight::from_num(AMBIENT),
        diffuse: Weight::from_num(DIFFUSE),
    }
}

/// The reference's light.
pub fn float_light(quality: &QualityArgs) -> Light {
    Light {
        towards: quality.towards().normalize(),
        ambient: AMBIENT,
        diffuse: DIFFUSE,
        casts: quality
            .shadows
            .is_some_and(|choice| choice != ShadowChoice::Off),
    }
}

/// The core's knobs.
pub fn core_quality(quality: &QualityArgs) -> Quality {
    Quality {
        splat: SplatPx::saturating_from_num(quality.splat),
        distortion: quality.distortion(),
        repair: quality.repair == RepairChoice::On,
        culling: quality.culling == CullingChoice::On,
    }
}

/// The core's shadows, of the kind that is asked for or of another.
pub fn core_shadows(quality: &QualityArgs, unless_said: ShadowChoice) -> Shadows {
    Shadows {
        method: match quality.shadows.unwrap_or(unless_said) {
            ShadowChoice::Off => Method::Off,
            ShadowChoice::TwoPass => Method::TwoPass,
            ShadowChoice::OnePass => Method::OnePass,
        },
        size: quality.shadow_size,
        splat: SplatPx::saturating_from_num(quality.shadow_splat),
        bias: SplatPx::saturating_from_num(quality.shadow_bias),
    }
}

/// A drawn frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// RGB565, row-major.
    pub colour: Vec<u16>,
    /// 16-bit depth, zero where nothing is drawn.
    pub depth: Vec<u16>,
    /// Work done.
    pub stats: Stats,
    /// Median time of the draw call.
    pub time_ns: u64,
}

impl Frame {
    /// The hash that is equal on every machine.
    pub fn hash(&self) -> u32 {
        frame_hash(&self.colour)
    }

    /// The frame as a picture.
    pub fn picture(&self) -> Picture {
        let drawn = self.depth.iter().map(|&depth| depth != 0).collect();
        Picture::from_rgb565(
            u32::from(self.width),
            u32::from(self.height),
            &self.colour,
            drawn,
        )
    }
}

/// Draws a frame `repeats` times (at least once) and keeps the median time.
pub fn draw_frame(
    grid: &Grid<'_>,
    camera: &Camera,
    light: &CoreLight,
    quality: &Quality,
    repeats: u32,
) -> Frame {
    let mut shades = vec![0; shades_len(grid.materials().len())];
    timed(camera, repeats, |mut target| {
        draw(grid, camera, light, quality, &mut shades, &mut target)
    })
}

/// The same for a grid whose light casts shadows.
pub fn draw_shadowed(
    grid: &Grid<'_>,
    camera: &Camera,
    light: &CoreLight,
    quality: &Quality,
    shadows: &Shadows,
    repeats: u32,
) -> Frame {
    let instances = [Instance {
        grid,
        placement: Placement::IDENTITY,
        materials: None,
    }];
    let lamps = [Lamp {
        towards: light.towards,
        colour: [255; 3],
        diffuse: light.diffuse,
        casts: true,
    }];
    let lighting = Lighting {
        ambient: light.ambient,
        matcap: None,
        lamps: &lamps,
    };
    let scene = Scene {
        instances: &instances,
        lighting,
        shadows: *shadows,
    };
    draw_placed(&scene, camera, quality, repeats)
}

/// The same for a scene.
pub fn draw_placed(scene: &Scene<'_>, camera: &Camera, quality: &Quality, repeats: u32) -> Frame {
    let materials = scene.instances.iter().map(|instance| {
        let own = instance.materials.unwrap_or(instance.grid.materials());
        own.len()
    });
    let mut shades = vec![0; shades_len(materials.max().unwrap_or(0))];
    let casting = scene.lighting.lamps.iter().filter(|lamp| lamp.casts);
    let mut maps = vec![0; scene.shadows.map_len() * casting.count()];
    timed(camera, repeats, |target| {
        let mut layers = Layers::new(target).expect("the target has depths");
        let memory = Memory {
            shades: &mut shades,
            shadows: &mut maps,
        };
        draw_scene(scene, camera, quality, memory, &mut layers)
    })
}

fn timed(camera: &Camera, repeats: u32, mut draw: impl FnMut(Target<'_>) -> Stats) -> Frame {
    let pixels = usize::from(camera.width) * usize::from(camera.height);
    let (mut colour, mut depth) = (vec![0; pixels], vec![0; pixels]);
    let mut canvas = vec![0; canvas_len(camera.height)];
    let mut stats = Stats::default();
    let mut times = Vec::new();
    for _ in 0..repeats.max(1) {
        let target = Target::new(camera.width, camera.height, &mut colour, &mut canvas)
            .and_then(|target| target.with_depth(&mut depth))
            .expect("buffers are as long as the picture");
        let start = std::time::Instant::now();
        stats = draw(target);
        times.push(start.elapsed().as_nanos() as u64);
    }
    times.sort_unstable();
    Frame {
        width: camera.width,
        height: camera.height,
        colour,
        depth,
        stats,
        time_ns: times[times.len() / 2],
    }
}
