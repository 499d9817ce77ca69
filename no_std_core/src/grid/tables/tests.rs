use super::*;
use crate::camera::Camera;
use crate::grid::facing::EyeSpace;
use crate::numbers::{SCREEN_BITS, SCREEN_ONE};
use crate::projection::Projection;
use crate::reciprocal::reciprocal;
use crate::testing::view::{eye_unit, looking};
use crate::testing::{Exact, Rng, camera, direction};

/// A cell on a random way down.
struct Step {
    depth: u8,
    /// Its centre in its half sides, and the cells across the cube.
    place: [i64; 3],
    across: i64,
    /// The centre as traversal sums it up.
    point: Point,
    view: [i32; 3],
    eye_radius: i32,
}

/// Walks random ways from the root to cells of the greatest depth.
fn descend<const CELLS: usize, const LEVELS: usize>(
    rho: u8,
    camera: &Camera,
    rng: &mut Rng,
    mut visit: impl FnMut(&Projection, &EyeSpace, &Step),
) {
    let projection = Projection::new(camera);
    let eye_space = EyeSpace::new(camera.eye);
    let mut tables = Tables::<CELLS, LEVELS>::EMPTY;
    tables.fill(rho, LEVELS as u8, &projection.forms, eye_space.unit);
    for _ in 0..4 {
        let mut step = Step {
            depth: 0,
            place: [0; 3],
            across: 1,
            point: tables.centre,
            view: eye_space.centre,
            eye_radius: tables.root.eye_radius,
        };
        visit(&projection, &eye_space, &step);
        for level in &tables.levels {
            let bit = rng.usize(..CELLS);
            let eye = level.eye_displacements[bit];
            step = Step {
                depth: step.depth + 1,
                place: crate::testing::model::child_place(rho, step.place, bit as u32),
                across: step.across * i64::from(rho),
                point: step.point.plus(level.displacements[bit]),
                view: [0, 1, 2].map(|i| step.view[i] + eye[i]),
                eye_radius: level.eye_radius,
            };
            visit(&projection, &eye_space, &step);
        }
    }
}

/// Every rho, random views.
fn for_each_step(
    seed: u64,
    views: usize,
    farthest: f64,
    mut visit: impl FnMut(&Camera, &Projection, &EyeSpace, &Step),
) {
    let mut rng = Rng::with_seed(seed);
    for view in 0..views {
        let camera = camera(&mut rng, farthest, 4096.0);
        let rng = &mut rng;
        let visit = |p: &Projection, e: &EyeSpace, s: &Step| visit(&camera, p, e, s);
        match view % 4 {
            0 => descend::<8, 15>(2, &camera, rng, visit),
            1 => descend::<27, 9>(3, &camera, rng, visit),
            2 => descend::<64, 7>(4, &camera, rng, visit),
            _ => descend::<125, 6>(5, &camera, rng, visit),
        }
    }
}

/// The bound of a centre's error in block units.
fn block_bound(depth: u8) -> f64 {
    (f64::from(depth) + 1.0) / 2.0 + 2f64.powi(-24)
}

#[test]
fn centres_keep_their_bound_in_block_units() {
    let mut worst = 0f64;
    for_each_step(1, 20_000, 1e9, |camera, projection, _, step| {
        let got = [step.point.x, step.point.y, step.point.w];
        for (form, got) in projection.forms.iter().zip(got) {
            // Both sides times 2^32 cells across: integers.
            let sum = |place: [i64; 3]| -> i128 {
                place
                    .iter()
                    .zip(form.axes)
                    .map(|(&at, axis)| i128::from(at) * i128::from(axis))
                    .sum()
            };
            let across = i128::from(step.across);
            let exact = i128::from(form.centre) * across + sum(step.place);
            let error = ((i128::from(got) << 32) * across - exact) as f64;
            let error = error.abs() / 2f64.powi(32) / step.across as f64;
            let bound = block_bound(step.depth);
            worst = worst.max(error / bound);
            assert!(
                error <= bound,
                "depth {}: {error} > {bound} units\n{camera:?}",
                step.depth
            );
            assert!(got.abs() < 1 << 30, "{camera:?}");
        }
    });
    // The bound is not idle.
    assert!(worst > 0.5, "at most {worst} of the bound");
}

/// Pixel positions of a step: as drawn, exact, and the derived bound.
fn pixels(camera: &Camera, projection: &Projection, step: &Step) -> Option<[[f64; 3]; 2]> {
    let units = block_bound(step.depth) + 2f64.powi(-9);
    let w = f64::from(step.point.w);
    if step.point.w < projection.near || w <= 2.0 * units {
        return None;
    }
    let exact = Exact::new(camera);
    let across = step.across as f64;
    let [x, y, exact_w] = exact.forms(step.place.map(|place| place as f64 / across));
    let inverse = reciprocal(step.point.w as u32);
    let scale = 2f64.powi(projection.screen_scale);
    let axis = |point: i32, exact: f64| {
        let got = inverse.times(point, projection.screen_scale + SCREEN_BITS);
        let got = f64::from(got) / f64::from(SCREEN_ONE);
        let exact = exact / exact_w;
        let bound = units / w * (scale + exact.abs()) * (1.0 + 2f64.powi(-18))
            + exact.abs() * 2f64.powf(-18.9)
            + 1.0 / f64::from(SCREEN_ONE);
        [got, exact, bound]
    };
    Some([axis(step.point.x, x), axis(step.point.y, y)])
}

#[test]
fn pixels_keep_their_bound_and_saturate_with_the_right_sign() {
    const LIMIT: f64 = (1 << 18) as f64;
    let (mut inside, mut saturated) = (0, 0);
    for_each_step(2, 20_000, 1e6, |camera, projection, _, step| {
        for [got, exact, bound] in pixels(camera, projection, step).into_iter().flatten() {
            if exact.abs() + bound < LIMIT {
                inside += 1;
                let error = (got - exact).abs();
                assert!(
                    error <= bound,
                    "depth {}: {got} px, not {exact}: {error} > {bound}\n{camera:?}",
                    step.depth
                );
            } else if exact.abs() - bound > LIMIT {
                saturated += 1;
                assert_eq!(got.signum(), exact.signum(), "{exact} px\n{camera:?}");
                assert!(
                    (LIMIT - 0.25..=LIMIT).contains(&got.abs()),
                    "{got} for {exact} px\n{camera:?}"
                );
            }
        }
    });
    assert!(inside > 100_000 && saturated > 100, "{inside} {saturated}");
}

#[test]
fn standard_view_is_exact_to_a_thousandth_of_a_pixel() {
    let mut rng = Rng::with_seed(3);
    let (mut worst, mut widest) = (0f64, 0f64);
    for _ in 0..2000 {
        // Full view: 2.6 radii; the cube's half side is 1 to 1 / sqrt(3) radii.
        let radius = 1.0 + 0.732 * rng.f64();
        let back = direction(&mut rng);
        let eye = back.map(|c| c * 2.6 * radius);
        let camera = looking(eye, back.map(|c| -c), [0.0, 1.0, 0.0], 320.0, 240, 320);
        let mut check = |projection: &Projection, _: &EyeSpace, step: &Step| {
            let Some(axes) = pixels(&camera, projection, step) else {
                return;
            };
            let [[_, x, _], [_, y, _]] = axes;
            if x.abs() > 120.0 || y.abs() > 160.0 {
                return;
            }
            for [got, exact, bound] in axes {
                worst = worst.max((got - exact).abs());
                widest = widest.max(bound);
            }
        };
        descend::<8, 15>(2, &camera, &mut rng, &mut check);
        descend::<27, 9>(3, &camera, &mut rng, &mut check);
        descend::<125, 6>(5, &camera, &mut rng, &mut check);
    }
    std::println!("standard view: error {worst} px, bound {widest} px");
    assert!(worst <= widest && widest < 0.001, "{worst} {widest} px");
}

#[test]
fn eye_space_spheres_hold_their_cells() {
    for_each_step(4, 20_000, 2e9, |camera, _, eye_space, step| {
        let limit = (1 << 15) + 2;
        assert!(step.view.iter().all(|c| c.abs() <= limit), "{camera:?}");
        let exact_unit = eye_unit(camera);
        assert!(eye_space.unit == 0 || f64::from(eye_space.unit) == exact_unit);
        let across = step.across as f64;
        let eye = camera.eye.map(|c| c.to_num::<f64>());
        let error = [0, 1, 2].map(|i| {
            let centre = step.place[i] as f64 / across;
            f64::from(step.view[i]) - (centre - eye[i]) * exact_unit
        });
        let off_centre = error.iter().map(|e| e * e).sum::<f64>().sqrt();
        let reach = off_centre + 3f64.sqrt() * exact_unit / across;
        assert!(
            reach <= f64::from(step.eye_radius) + 1e-3,
            "depth {}: {reach} > {} units\n{camera:?}",
            step.depth,
            step.eye_radius
        );
    });
}
