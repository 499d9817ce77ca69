use super::*;
use crate::camera::Camera;
use crate::draw::{Light, Quality, draw, shades_len};
use crate::numbers::{Length, SplatPx, Turns};
use crate::shadow::Method;
use crate::stats::Stats;
use crate::target::{Layers, Rect, Target, canvas_len};
use crate::testing::view::{looking, magnitude, signed};
use crate::testing::{Model, Rng, aligned, camera, direction};
use std::vec::Vec;

/// A picture.
#[derive(Debug, PartialEq, Eq)]
struct Frame {
    colour: Vec<u16>,
    depth: Vec<u16>,
    stats: Stats,
}

fn whole(camera: &Camera) -> Rect {
    Rect {
        left: 0,
        top: 0,
        right: camera.width,
        bottom: camera.height,
    }
}

fn frame(scene: &Scene<'_>, camera: &Camera, quality: &Quality, band: Rect, rows: u16) -> Frame {
    // What was there before must not show.
    let mut colour = std::vec![0xdead; band.pixels()];
    let mut depth = std::vec![0xbeef; band.pixels()];
    // Two words a pixel where samples have colours.
    let is_coloured = |instance: &Instance<'_>| instance.grid.attribute_bits() > 16;
    let words = 1 + usize::from(scene.instances.iter().any(is_coloured));
    let mut canvas = std::vec![0xdead_beef; words * canvas_len(rows)];
    let mut shades = std::vec![0xdead; shades_len(8)];
    let mut shadows = std::vec![0xbeef; scene.shadows.map_len() * MAX_LAMPS];
    let target = Target::band(band, &mut colour, &mut canvas)
        .and_then(|target| target.with_depth(&mut depth));
    let mut layers = target.and_then(Layers::new).expect("buffers fit");
    let memory = Memory {
        shades: &mut shades,
        shadows: &mut shadows,
    };
    let stats = draw_scene(scene, camera, quality, memory, &mut layers);
    Frame {
        colour,
        depth,
        stats,
    }
}

fn model(rng: &mut Rng) -> Model {
    let (rho, depth) = (rng.u8(2..=4), rng.u8(0..=3));
    let mut model = Model::random(rng, rho, depth, 400.0);
    model.paint(rng);
    model.attribute_bits = *rng.choice(&[16, 16, 32, 48]).expect("some");
    model
}

fn lamp(rng: &mut Rng) -> Lamp {
    Lamp {
        towards: direction(rng).map(Unit::from_num),
        colour: [rng.u8(..), 255, rng.u8(..)],
        diffuse: Weight::from_num(rng.f64()),
        casts: rng.bool(),
    }
}

fn shadows(rng: &mut Rng, method: Method) -> Shadows {
    Shadows {
        method,
        size: *rng.choice(&[16, 100, 256]).expect("some"),
        splat: SplatPx::from_num(rng.f64() * 3.0),
        bias: SplatPx::from_num(rng.f64() * 2.0),
    }
}

fn quality(rng: &mut Rng) -> Quality {
    Quality {
        splat: SplatPx::from_num(rng.f64() * 3.0),
        distortion: SplatPx::from_num(rng.f64() * 2.0),
        repair: rng.bool(),
        culling: rng.bool(),
    }
}

fn placement(rng: &mut Rng) -> Placement {
    let size = magnitude(rng, 0.1, 1.0);
    let mut turned = Placement::turned(
        Turns::from_bits(rng.u32(..)),
        Length::from_num(size),
        [0; 3].map(|_| Length::from_num(2.0 * signed(rng))),
    );
    if rng.bool() {
        // Sheared.
        turned.axes[1] = [0; 3].map(|_| Length::from_num(size * signed(rng)));
    }
    turned
}

#[test]
fn a_grid_alone_is_drawn_as_ever() {
    let mut rng = Rng::with_seed(61);
    for case in 0..150 {
        let model = model(&mut rng);
        let bytes = aligned(&model.file().bytes());
        let grid = Grid::open(&bytes).expect("models are valid");
        let camera = camera(&mut rng, 6.0, 150.0);
        let quality = quality(&mut rng);
        let lamp = Lamp {
            colour: [255; 3],
            ..lamp(&mut rng)
        };
        let light = Light {
            towards: lamp.towards,
            ambient: Weight::from_num(0.3),
            diffuse: lamp.diffuse,
        };
        let scene = Scene {
            instances: &[Instance {
                grid: &grid,
                placement: Placement::IDENTITY,
                materials: None,
            }],
            lighting: Lighting {
                ambient: light.ambient,
                matcap: None,
                lamps: &[lamp],
            },
            shadows: Shadows::default(),
        };
        let placed = frame(&scene, &camera, &quality, whole(&camera), camera.height);
        let (mut colour, mut depth) = (placed.colour.clone(), placed.depth.clone());
        let mut canvas = std::vec![0; 2 * canvas_len(camera.height)];
        let mut shades = std::vec![0; shades_len(8)];
        let mut target = Target::band(whole(&camera), &mut colour, &mut canvas)
            .and_then(|target| target.with_depth(&mut depth))
            .expect("buffers fit");
        draw(&grid, &camera, &light, &quality, &mut shades, &mut target);
        assert!(placed.depth == depth, "case {case}: depths of {camera:?}");
        let differing = placed.colour.iter().zip(&colour).filter(|(a, b)| a != b);
        // The light's direction is rounded to Q2.14 once more.
        let is_step = |(a, b): (&u16, &u16)| {
            let channels = |c: u16| [c >> 11, c >> 5 & 63, c & 31];
            let pairs = channels(*a).into_iter().zip(channels(*b));
            pairs.into_iter().all(|(a, b)| a.abs_diff(b) <= 1)
        };
        assert!(
            { differing }.all(is_step),
            "case {case}: colours of {camera:?}"
        );
    }
}

#[test]
fn one_pass_and_bands_give_the_pixels_of_two_passes() {
    let mut rng = Rng::with_seed(62);
    let mut shadowed = 0;
    for case in 0..300 {
        let models = [model(&mut rng), model(&mut rng)];
        let bytes = models
            .each_ref()
            .map(|model| aligned(&model.file().bytes()));
        let grids = bytes
            .each_ref()
            .map(|bytes| Grid::open(bytes).expect("valid"));
        let count = rng.usize(1..=4);
        let instances: Vec<_> = (0..count)
            .map(|_| Instance {
                grid: &grids[rng.usize(..2)],
                placement: placement(&mut rng),
                materials: rng.bool().then_some(&[[200, 100, 50], [9, 99, 255]]),
            })
            .collect();
        let lamps: Vec<_> = (0..rng.usize(0..=3)).map(|_| lamp(&mut rng)).collect();
        let eye = direction(&mut rng).map(|c| c * magnitude(&mut rng, 0.5, 8.0));
        let forward = direction(&mut rng);
        let towards = [0, 1, 2].map(|at| 0.3 * forward[at] - eye[at]);
        let length = towards.iter().map(|c| c * c).sum::<f64>().sqrt();
        let forward = towards.map(|c| c / length);
        let focal = magnitude(&mut rng, 50.0, 300.0);
        let (width, height) = (rng.u16(1..=300), rng.u16(1..=150));
        let camera = looking(eye, forward, direction(&mut rng), focal, width, height);
        let quality = quality(&mut rng);
        let texels: Vec<u16> = (0..64).map(|_| rng.u16(..)).collect();
        let matcap = Matcap::new(&texels).filter(|_| rng.u8(..4) == 0);
        let scene = |shadows: Shadows| Scene {
            instances: &instances,
            lighting: Lighting {
                ambient: Weight::from_num(0.1),
                matcap,
                lamps: &lamps,
            },
            shadows,
        };
        let two = shadows(&mut rng, Method::TwoPass);
        let one = Shadows {
            method: Method::OnePass,
            ..two
        };
        let off = Shadows {
            method: Method::Off,
            ..two
        };
        let draw = |shadows, band, rows| frame(&scene(shadows), &camera, &quality, band, rows);
        let all = whole(&camera);
        let [none, whole] = [off, two].map(|shadows| draw(shadows, all, height));
        assert_eq!(none.depth, whole.depth, "case {case}");
        shadowed += usize::from(none.colour != whole.colour);
        let same = draw(one, all, height);
        assert_eq!(same.depth, whole.depth, "case {case}: one pass");
        assert_eq!(same.colour, whole.colour, "case {case}: one pass");
        assert_eq!(same.stats.casters_drawn, whole.stats.casters_drawn);
        let band = Rect {
            left: rng.u16(0..width),
            top: rng.u16(0..height),
            ..all
        };
        let part = draw(one, band, rng.u16(1..=height));
        let rows = whole
            .colour
            .chunks(usize::from(width))
            .skip(usize::from(band.top));
        let want: Vec<_> = rows
            .flat_map(|row| &row[usize::from(band.left)..])
            .collect();
        assert!(part.colour.iter().eq(want), "case {case}: {band:?}");
    }
    assert!(shadowed > 30, "{shadowed} pictures have shadows");
}

#[test]
fn scenes_of_nothing_are_black() {
    let mut rng = Rng::with_seed(63);
    let camera = camera(&mut rng, 6.0, 60.0);
    let model = model(&mut rng);
    let bytes = aligned(&model.file().bytes());
    let grid = Grid::open(&bytes).expect("valid");
    let flat = Instance {
        grid: &grid,
        placement: Placement {
            axes: [[Length::ZERO; 3]; 3],
            ..Placement::IDENTITY
        },
        materials: None,
    };
    let lamps = [lamp(&mut rng)];
    for instances in [&[][..], &[flat], &[flat, flat]] {
        for method in [Method::Off, Method::TwoPass, Method::OnePass] {
            let scene = Scene {
                instances,
                lighting: Lighting {
                    ambient: Weight::ONE,
                    matcap: None,
                    lamps: &lamps,
                },
                shadows: shadows(&mut rng, method),
            };
            let quality = Quality::default();
            let frame = frame(&scene, &camera, &quality, whole(&camera), 1);
            assert!(frame.colour.iter().all(|&colour| colour == 0));
            assert!(frame.depth.iter().all(|&depth| depth == 0));
        }
    }
}
