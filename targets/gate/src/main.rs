//! The panic gate: an image that calls every entry of the core (and of the
//! frame file's reader) with inputs of which the compiler knows nothing. Its
//! panic handler calls a function that does not exist, so the image links
//! exactly if the optimiser found every panic to be unreachable. It is never
//! run.
#![no_std]
#![no_main]

#[expect(
    unsafe_code,
    reason = "an entry for the linker, and a symbol it never finds"
)]
mod board;

use core::hint::black_box;

use rhogrid_core::asset::Grid;
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light, Quality, draw, shades_len};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};
use rhogrid_core::placement::Placement;
use rhogrid_core::scene::{Instance, Lamp, Lighting, Matcap, Memory, Scene, draw_scene};
use rhogrid_core::shadow::{Method, Shadows};
use rhogrid_core::target::{Layers, Rect, Target, frame_hash};
use rhogrid_frame::Frame;

/// Bytes of whatever length and content.
fn unknown_bytes() -> &'static [u8] {
    black_box(&[])
}

/// Words of whatever length and content.
fn unknown_words() -> &'static mut [u16] {
    black_box(&mut [])
}

/// The same, twice as wide.
fn unknown_canvas() -> &'static mut [u32] {
    black_box(&mut [])
}

/// A camera that the caller made up.
fn unknown_camera() -> Camera {
    let unit = || black_box(Unit::ZERO);
    let length = || black_box(Length::ZERO);
    let vector = || [unit(), unit(), unit()];
    Camera {
        eye: [length(), length(), length()],
        right: vector(),
        up: vector(),
        forward: vector(),
        focal_px: black_box(FocalPx::ZERO),
        width: black_box(0),
        height: black_box(0),
        near: length(),
    }
}

/// Every entry once, on a whole picture and on a band.
fn every_entry() {
    if let Ok(frame) = Frame::open(unknown_bytes()) {
        black_box((frame.settings(), frame.assets().last(), frame.lone_light()));
        black_box((frame.instances().last(), frame.lamps().last()));
        black_box(frame.views().last());
    }
    let orbit = Orbit {
        yaw: black_box(Turns::ZERO),
        pitch: black_box(Turns::ZERO),
        distance: black_box(Length::ZERO),
    };
    let focal_px = black_box(FocalPx::ZERO);
    black_box(Camera::orbit(&orbit, focal_px, black_box(0), black_box(0)));

    let whole = Target::new(
        black_box(0),
        black_box(0),
        unknown_words(),
        unknown_canvas(),
    );
    let whole = whole.and_then(|target| target.with_depth(unknown_words()));
    let band = Rect {
        left: black_box(0),
        top: black_box(0),
        right: black_box(0),
        bottom: black_box(0),
    };
    let part = Target::band(band, unknown_words(), unknown_canvas());
    draw_unknown(whole.ok());
    draw_unknown(part.ok());
    draw_unknown_scene();
    black_box(frame_hash(unknown_words()));

    if cfg!(feature = "planted") {
        black_box(unknown_bytes()[black_box(0)]);
    }
}

fn draw_unknown(target: Option<Target<'_>>) {
    let (Ok(grid), Some(mut target)) = (Grid::open(unknown_bytes()), target) else {
        return;
    };
    let unit = || black_box(Unit::ZERO);
    let light = Light {
        towards: [unit(), unit(), unit()],
        ambient: black_box(Weight::ZERO),
        diffuse: black_box(Weight::ZERO),
    };
    let quality = Quality {
        splat: black_box(SplatPx::ZERO),
        distortion: black_box(SplatPx::ZERO),
        repair: black_box(true),
        culling: black_box(true),
    };
    black_box(grid.radius());
    black_box(shades_len(grid.materials().len()));
    black_box((grid.levels().len(), grid.rho(), grid.depth()));
    let depth = black_box(0);
    for records in [grid.node_records(depth), grid.drawn_records(depth)] {
        records.for_each(|record| {
            black_box(record.halves());
        });
    }
    black_box((grid.link(depth, black_box(0)), grid.dictionary()));
    black_box(
        grid.coding(depth)
            .map(|coding| (coding.links(), coding.escapes())),
    );
    black_box(draw(
        &grid,
        &unknown_camera(),
        &light,
        &quality,
        unknown_words(),
        &mut target,
    ));
}

fn draw_unknown_scene() {
    let layers = Target::new(
        black_box(0),
        black_box(0),
        unknown_words(),
        unknown_canvas(),
    )
    .and_then(|target| Layers::new(target.with_depth(unknown_words())?));
    let (Ok(grid), Ok(mut layers)) = (Grid::open(unknown_bytes()), layers) else {
        return;
    };
    let lengths = || [0; 3].map(|_| black_box(Length::ZERO));
    let turned = Placement::turned(black_box(Turns::ZERO), black_box(Length::ZERO), lengths());
    let placed = Placement {
        axes: [lengths(), lengths(), lengths()],
        origin: lengths(),
    };
    let instances = [turned, placed].map(|placement| Instance {
        grid: &grid,
        placement,
        materials: black_box(None),
    });
    let lamp = || Lamp {
        towards: [0; 3].map(|_| black_box(Unit::ZERO)),
        colour: black_box([0; 3]),
        diffuse: black_box(Weight::ZERO),
        casts: black_box(true),
    };
    let scene = Scene {
        instances: &instances,
        lighting: Lighting {
            ambient: black_box(Weight::ZERO),
            matcap: Matcap::new(unknown_words()),
            lamps: &[lamp(), lamp(), lamp()],
        },
        shadows: Shadows {
            method: black_box(Method::OnePass),
            size: black_box(0),
            splat: black_box(SplatPx::ZERO),
            bias: black_box(SplatPx::ZERO),
        },
    };
    let memory = Memory {
        shades: unknown_words(),
        shadows: unknown_words(),
    };
    let quality = black_box(Quality::default());
    black_box(draw_scene(
        &scene,
        &unknown_camera(),
        &quality,
        memory,
        &mut layers,
    ));
}
