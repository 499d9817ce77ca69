use super::*;
use crate::numbers::Length;
use crate::target::{Rect, canvas_len};
use crate::testing::view::{looking, magnitude};
use crate::testing::{Model, Rng, aligned, camera, direction};
use std::vec::Vec;

#[cfg(all(feature = "rho-3", feature = "mask-dictionary"))]
mod coded;
#[cfg(feature = "colour")]
mod coloured;
mod hidden;
mod twin;

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Frame {
    colour: Vec<u16>,
    depth: Vec<u16>,
    stats: Stats,
}

const AMBIENT: Light = Light {
    towards: [Unit::ZERO, Unit::ONE, Unit::ZERO],
    ambient: Weight::ONE,
    diffuse: Weight::ZERO,
};

/// Every leaf projected exactly.
fn quality(splat: f64) -> Quality {
    Quality {
        splat: SplatPx::from_num(splat),
        distortion: SplatPx::ZERO,
        repair: false,
        culling: true,
    }
}

/// Every leaf drawn, subtrees packed up to an error.
fn packed(distortion: f64) -> Quality {
    Quality {
        splat: SplatPx::ZERO,
        distortion: SplatPx::from_num(distortion),
        repair: false,
        culling: true,
    }
}

fn frame_of(
    grid: &Grid<'_>,
    camera: &Camera,
    light: &Light,
    quality: &Quality,
    band: Rect,
    rows: u16,
    shades: &mut [u16],
) -> Frame {
    // What was there before must not show.
    let mut colour = std::vec![0xdead; band.pixels()];
    let mut depth = std::vec![0xbeef; band.pixels()];
    let mut canvas = std::vec![0xdead_beef; canvas_len(rows)];
    let mut target = Target::band(band, &mut colour, &mut canvas)
        .and_then(|target| target.with_depth(&mut depth))
        .expect("buffers fit");
    let stats = draw(grid, camera, light, quality, shades, &mut target);
    Frame {
        colour,
        depth,
        stats,
    }
}

fn whole(camera: &Camera) -> Rect {
    Rect {
        left: 0,
        top: 0,
        right: camera.width,
        bottom: camera.height,
    }
}

fn frame(model: &Model, camera: &Camera, splat: f64) -> Frame {
    frame_with(model, camera, &quality(splat))
}

fn frame_with(model: &Model, camera: &Camera, quality: &Quality) -> Frame {
    let bytes = aligned(&model.file().bytes());
    let grid = Grid::open(&bytes).expect("models are valid");
    let mut shades = std::vec![0; shades_len(model.materials.len())];
    let band = whole(camera);
    frame_of(
        &grid,
        camera,
        &AMBIENT,
        quality,
        band,
        camera.height,
        &mut shades,
    )
}

/// A random small grid with painted cells; some of its blocks two-sided.
fn model(rng: &mut Rng, leaves: f64) -> Model {
    let (rho, depth) = (rng.u8(2..=5), rng.u8(0..=3));
    let mut model = Model::random(rng, rho, depth, leaves);
    model.paint(rng);
    for cell in model.levels.iter_mut().flatten() {
        cell.flags.two_sided = rng.bool();
    }
    model
}

/// A camera that may have a near plane of some weight.
fn near_camera(rng: &mut Rng, farthest: f64, size: f64) -> Camera {
    let mut camera = camera(rng, farthest, size);
    if rng.u8(..3) == 0 {
        camera.near = Length::from_num(magnitude(rng, 1e-3, 4.0));
    }
    camera
}

#[test]
fn pictures_are_those_of_the_float_twin() {
    let mut rng = Rng::with_seed(61);
    let (mut pixels, mut covered, mut open, mut doubtful) = (0, 0, 0, 0);
    for case in 0..2500 {
        let leaves = magnitude(&mut rng, 1.0, 200.0);
        let model = model(&mut rng, leaves);
        let camera = near_camera(&mut rng, 200.0, 48.0);
        let frame = frame(&model, &camera, 0.0);
        match twin::compare(&model, &camera, 0.0, &frame.colour, &frame.depth) {
            None => doubtful += 1,
            Some(Ok(verdict)) => {
                // From inside, many cells share the ends of the depth range;
                // pictures are held to what is left, but do not count here.
                let square: f64 = camera.eye.iter().map(|c| c.to_num::<f64>().powi(2)).sum();
                if square > 4.0 && camera.near == Camera::NEAR {
                    pixels += frame.depth.len();
                    covered += verdict.covered;
                    open += verdict.open;
                }
            }
            Some(Err(reason)) => panic!(
                "case {case}: {reason}\nrho {}, depth {}\n{camera:?}",
                model.rho,
                model.depth()
            ),
        }
    }
    let share = open as f64 / covered as f64;
    std::println!(
        "twin: {covered} of {pixels} pixels covered, {share:.5} open, {doubtful} doubtful"
    );
    assert!(covered > pixels / 20 && doubtful < 30);
    assert!(share < 0.01, "too much left open: {share}");
}

#[test]
fn packed_subtrees_keep_their_bounds() {
    let mut rng = Rng::with_seed(69);
    let mut moved = 0;
    for case in 0..2000 {
        let leaves = magnitude(&mut rng, 1.0, 200.0);
        let model = model(&mut rng, leaves);
        let camera = near_camera(&mut rng, 200.0, 48.0);
        let distortion = magnitude(&mut rng, 0.01, 8.0);
        let frame = frame_with(&model, &camera, &packed(distortion));
        moved += usize::from(frame.depth != frame_with(&model, &camera, &quality(0.0)).depth);
        let verdict = twin::compare(&model, &camera, distortion, &frame.colour, &frame.depth);
        if let Some(Err(reason)) = verdict {
            panic!(
                "case {case}, distortion {distortion}: {reason}\nrho {}, depth {}\n{camera:?}",
                model.rho,
                model.depth()
            );
        }
    }
    assert!(moved > 200, "only {moved} pictures had anything to bound");
}

#[test]
fn bands_give_the_pixels_of_the_whole() {
    let mut rng = Rng::with_seed(62);
    for case in 0..900 {
        let mut model = model(&mut rng, 300.0);
        model.paint(&mut rng);
        let camera = near_camera(&mut rng, 200.0, 64.0);
        let splat = [0.0, 1.0, 4.0][case % 3];
        let quality = match case % 2 {
            0 => quality(splat),
            _ => Quality {
                splat: SplatPx::from_num(splat),
                ..Quality::default()
            },
        };
        let bytes = aligned(&model.file().bytes());
        let grid = Grid::open(&bytes).expect("models are valid");
        let all = frame_of(
            &grid,
            &camera,
            &AMBIENT,
            &quality,
            whole(&camera),
            camera.height,
            &mut [],
        );
        let mut cuts = |size: u16| {
            let mut cuts = std::vec![0, size];
            cuts.extend((0..rng.u8(..3)).map(|_| rng.u16(..size)));
            cuts.sort_unstable();
            cuts.dedup();
            cuts
        };
        let (columns, rows) = (cuts(camera.width), cuts(camera.height));
        for (top, bottom) in rows.iter().zip(&rows[1..]) {
            for (left, right) in columns.iter().zip(&columns[1..]) {
                let band = Rect {
                    left: *left,
                    top: *top,
                    right: *right,
                    bottom: *bottom,
                };
                let rows = rng.u16(1..=camera.height);
                let part = frame_of(&grid, &camera, &AMBIENT, &quality, band, rows, &mut []);
                for (own, pixel) in (0..band.pixels()).map(|own| {
                    let row = usize::from(band.top) + own / band.width();
                    let column = usize::from(band.left) + own % band.width();
                    (own, row * usize::from(camera.width) + column)
                }) {
                    assert_eq!(
                        (part.colour[own], part.depth[own]),
                        (all.colour[pixel], all.depth[pixel]),
                        "case {case}, {band:?}, pixel {pixel}\n{camera:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn shading_without_memory_gives_the_same_bytes() {
    let mut rng = Rng::with_seed(63);
    let mut tables = 0;
    for case in 0..200 {
        let mut model = model(&mut rng, 200.0);
        if rng.bool() {
            model.materials.truncate(1);
            for cell in model.levels.iter_mut().flatten() {
                cell.attribute &= CODES as u16 - 1;
            }
        }
        let camera = near_camera(&mut rng, 3.0, 1024.0);
        let light = Light {
            towards: direction(&mut rng).map(Unit::from_num),
            ambient: Weight::from_num(rng.f64()),
            diffuse: Weight::from_num(rng.f64()),
        };
        let bytes = aligned(&model.file().bytes());
        let grid = Grid::open(&bytes).expect("models are valid");
        tables += u32::from(Plan::new(&grid, &camera, &quality(1.0)).tabulates);
        let length = shades_len(model.materials.len());
        let draw = |length: usize| {
            let mut shades = std::vec![0x5555; length];
            frame_of(
                &grid,
                &camera,
                &light,
                &quality(1.0),
                whole(&camera),
                camera.height,
                &mut shades,
            )
        };
        let want = draw(length);
        for length in [0, length - 1, length + 7] {
            assert_eq!(draw(length), want, "case {case}: {length} words");
        }
    }
    assert!((20..180).contains(&tables), "{tables} of 200 with a table");
}

#[test]
fn nothing_behind_the_eye_is_drawn() {
    let mut rng = Rng::with_seed(64);
    for case in 0..300 {
        let model = model(&mut rng, 100.0);
        let back = direction(&mut rng);
        let eye = back.map(|c| c * (1.75 + 3.0 * rng.f64()));
        let camera = looking(eye, back, direction(&mut rng), 20.0, 40, 30);
        let drawn = frame(&model, &camera, 1.0);
        assert!(drawn.depth.iter().all(|&depth| depth == 0), "case {case}");
        assert!(drawn.colour.iter().all(|&colour| colour == 0));
        assert_eq!(drawn.stats.samples_drawn, 0, "case {case}");
    }
    // All before the near plane, from any side.
    for _ in 0..300 {
        let model = model(&mut rng, 100.0);
        let mut camera = camera(&mut rng, 10.0, 40.0);
        camera.near = Length::from_num(30);
        let drawn = frame(&model, &camera, 1.0);
        assert!(drawn.depth.iter().all(|&depth| depth == 0), "{camera:?}");
    }
}

#[test]
fn extreme_views_do_no_harm() {
    let mut rng = Rng::with_seed(65);
    let mut drawn = 0;
    for case in 0..2500 {
        let (rho, depth) = [(2, 15), (3, 9), (4, 7), (5, 6), (3, 2)][case % 5];
        let mut model = Model::random(&mut rng, rho, depth, 20.0);
        model.paint(&mut rng);
        let mut camera = camera(&mut rng, 1e9, 24.0);
        if rng.bool() {
            // An eye right at a leaf, to the last bit.
            let leaves = &model.levels[usize::from(depth)];
            let leaf = rng.choice(leaves).expect("never empty");
            let centre = model.centre(usize::from(depth), leaf);
            camera.eye = centre.map(|c| {
                let away = magnitude(&mut rng, 1e-10, 1e-2);
                Length::from_num(c) + Length::from_num(away * (2.0 * rng.f64() - 1.0))
            });
        }
        match rng.u8(..4) {
            0 => camera.near = Length::DELTA,
            1 => camera.near = Length::from_num(magnitude(&mut rng, 1e-9, 1e-2)),
            _ => {}
        }
        match rng.u8(..8) {
            0 => camera.focal_px = Length::MAX,
            1 => camera.focal_px = Length::DELTA,
            2 => camera.focal_px = Length::from_num(magnitude(&mut rng, 1.0, 1e9)),
            _ => {}
        }
        let splat = [0.0, 1.0, 65535.9][case % 3];
        let frame = frame(&model, &camera, splat);
        drawn += u32::from(frame.depth.iter().any(|&depth| depth > 0));
        for (colour, depth) in frame.colour.iter().zip(&frame.depth) {
            assert!(*depth > 0 || *colour == 0, "{camera:?}");
        }
    }
    assert!(drawn > 200, "{drawn} pictures are not empty");
}

#[test]
fn far_away_everything_is_one_splat() {
    let mut rng = Rng::with_seed(66);
    for _ in 0..200 {
        let model = model(&mut rng, 200.0);
        let back = direction(&mut rng);
        let forward = back.map(|c| -c);
        let eye = back.map(|c| c * 1e6);
        let camera = looking(eye, forward, direction(&mut rng), 300.0, 33, 33);
        let drawn = frame(&model, &camera, 1.0);
        assert_eq!(drawn.stats.samples_drawn, 1);
        let pixels = drawn.depth.iter().filter(|&&depth| depth > 0).count();
        assert_eq!(pixels, 1);
        assert!(drawn.depth[16 * 33 + 16] > 0);
    }
}

#[test]
fn counters_count_masks() {
    let mut rng = Rng::with_seed(67);
    for _ in 0..300 {
        // All of it is in the picture and nothing can face away.
        let (rho, depth) = (rng.u8(2..=5), rng.u8(1..=4));
        let model = Model::random(&mut rng, rho, depth, 400.0);
        let back = direction(&mut rng);
        let upwards = direction(&mut rng);
        let view = |distance: f64| {
            let eye = back.map(|c| c * distance);
            looking(eye, back.map(|c| -c), upwards, 40.0, 96, 96)
        };
        let masks = model
            .levels
            .iter()
            .rev()
            .skip(1)
            .map(Vec::len)
            .sum::<usize>();
        let leaves = model.levels[usize::from(depth)].len();
        // Nor is anything hidden.
        let everything = Quality {
            culling: false,
            ..quality(0.0)
        };
        let all = frame_with(&model, &view(4.0), &everything).stats;
        assert_eq!(all.nodes_visited as usize, masks);
        assert_eq!(all.samples_drawn as usize, leaves);
        assert_eq!((all.nodes_outside, all.nodes_back_facing), (0, 0));
        let far = frame(&model, &view(60.0), 1.0).stats;
        let near = frame(&model, &view(4.0), 1.0).stats;
        assert!(near.nodes_visited <= all.nodes_visited);
        assert!(far.nodes_visited <= near.nodes_visited);
        if depth > 2 && rho > 2 {
            assert!(far.nodes_visited < all.nodes_visited, "{far:?} {all:?}");
        }
    }
}

#[test]
fn what_the_plan_leaves_out_is_not_done() {
    let mut rng = Rng::with_seed(70);
    let (mut without_sides, mut without_faces) = (0, 0);
    for case in 0..600 {
        let mut file = model(&mut rng, 200.0).file();
        file.header[14] = u8::from(rng.bool());
        let bytes = aligned(&file.bytes());
        let grid = Grid::open(&bytes).expect("models are valid");
        let camera = match rng.bool() {
            true => near_camera(&mut rng, 30.0, 96.0),
            false => {
                // Far enough for the picture to hold the cube, or nearly.
                let (back, upwards) = (direction(&mut rng), direction(&mut rng));
                let eye = back.map(|c| c * (2.0 + 8.0 * rng.f64()));
                looking(eye, back.map(|c| -c), upwards, 60.0, 64, 64)
            }
        };
        let band = whole(&camera);
        let quality = Quality {
            culling: rng.u8(..) >= 64,
            ..Quality::default()
        };
        let plan = Plan::new(&grid, &camera, &quality);
        let rows = camera.height;
        let stats = frame_of(&grid, &camera, &AMBIENT, &quality, band, rows, &mut []).stats;
        let tests = [stats.side_tests, stats.facing_tests];
        let case = std::format!("case {case}: {plan}{stats:?}");
        assert!(plan.culls || tests[0] == 0, "{case}");
        assert!(plan.faces || tests[1] == 0, "{case}");
        assert!(plan.culls || stats.nodes_outside == 0, "{case}");
        assert!(plan.faces || stats.nodes_back_facing == 0, "{case}");
        assert!(plan.hides || stats.nodes_hidden == 0, "{case}");
        without_sides += u32::from(!plan.culls && stats.nodes_visited > 1);
        without_faces += u32::from(!plan.faces && stats.nodes_visited > 1);
    }
    assert!(without_sides > 20, "{without_sides} frames without sides");
    assert!(without_faces > 100, "{without_faces} frames without faces");
}

#[test]
fn back_facing_cones_hide_exactly_what_leaves_would() {
    // A sphere's cells: culling by cones must not change the picture.
    let mut rng = Rng::with_seed(68);
    let code = |place: [i64; 3]| crate::normal::encode(place.map(|at| at as i32 * 64));
    let mut culled = 0;
    for case in 0..60 {
        let (rho, depth) = [(2, 4), (3, 3), (4, 2), (5, 2)][case % 4];
        let across = |level: usize| i64::from(rho).pow(level as u32);
        let touches = |place: [i64; 3], level: usize| {
            let half = across(level);
            let axis = |f: &dyn Fn(i64) -> i64| place.iter().map(|&at| f(at)).sum::<i64>();
            let least = axis(&|at| (at.abs() - 1).max(0).pow(2));
            let most = axis(&|at| (at.abs() + 1).pow(2));
            (least..=most).contains(&(half * half * 4 / 5))
        };
        let mut model = Model::grow(
            rho,
            depth,
            |level, cell| {
                let subcells = 0..u32::from(rho).pow(3);
                let place = |bit: u32| crate::testing::model::child_place(rho, cell.place, bit);
                subcells
                    .filter(|&bit| touches(place(bit), level + 1))
                    .fold(0, |mask, bit| mask | 1u128 << bit)
            },
            |cell| cell.attribute = code(cell.place),
        );
        let open = model.clone();
        // Apertures that hold every leaf's normal below.
        for level in (0..usize::from(depth)).rev() {
            let below = model.levels[level + 1].clone();
            for (index, cell) in model.levels[level].iter_mut().enumerate() {
                let float = |attribute| crate::normal::decode(attribute).map(f64::from);
                let axis = float(cell.attribute);
                let children = below.iter().filter(|child| child.parent == index);
                let aperture = children.map(|child| {
                    let normal = float(child.attribute);
                    let dot = crate::testing::dot;
                    let cosine = dot(axis, normal) / (dot(axis, axis) * dot(normal, normal)).sqrt();
                    let spread = cosine.min(1.0).acos().to_degrees() + 0.1;
                    let own = if child.mask == 0 {
                        0.0
                    } else {
                        6.0 * (f64::from(child.flags.aperture) + 1.0)
                    };
                    (((spread + own) / 6.0).ceil() as u8).clamp(1, 16) - 1
                });
                cell.flags.aperture = aperture.max().unwrap_or(15);
                cell.flags.two_sided = false;
            }
        }
        let mut one_sided = open;
        for cell in one_sided.levels.iter_mut().flatten() {
            cell.flags.two_sided = false;
        }
        let camera = near_camera(&mut rng, 20.0, 64.0);
        let with_cones = frame(&model, &camera, 0.0);
        let without = frame(&one_sided, &camera, 0.0);
        culled += with_cones.stats.nodes_back_facing;
        // Leaves keep a margin that cones do not, so pictures may differ
        // where only such leaves show: never nearer, never another colour.
        for (pixel, (with, all)) in with_cones.depth.iter().zip(&without.depth).enumerate() {
            assert!(with <= all, "case {case}, pixel {pixel}\n{camera:?}");
        }
    }
    assert!(culled > 100, "{culled} nodes culled");
}
