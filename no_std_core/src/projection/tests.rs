use super::*;
use crate::numbers::Unit;
use crate::reciprocal::reciprocal;
use crate::testing::{Exact, Rng, camera, direction};

/// Half sides in a block unit of w, and pixels x half sides in one of X, Y.
fn units(projection: &Projection) -> [f64; 3] {
    let w = 2f64.powi(projection.w_scale);
    let screen = 2f64.powi(projection.screen_scale) * w;
    [screen, screen, w]
}

#[test]
fn forms_are_within_their_bound() {
    let mut rng = Rng::with_seed(21);
    let guard = 2f64.powi(GUARD_BITS);
    for _ in 0..50_000 {
        let camera = camera(&mut rng, 1e9, 4096.0);
        let projection = Projection::new(&camera);
        let exact = Exact::new(&camera);
        let mut largest = [0f64; 3];
        for _ in 0..8 {
            let corner = [0, 1, 2].map(|_| f64::from(rng.i8(..) | 1).signum());
            let units = units(&projection);
            let want = exact.forms(corner);
            for (row, form) in projection.forms.iter().enumerate() {
                let sum: f64 = (0..3).map(|i| form.axes[i] as f64 * corner[i]).sum();
                let got = (form.centre as f64 + sum) / guard;
                let want = want[row] / units[row];
                // X and Y: the eye's product to 2^-40 half sides, the focal
                // length to 31 bits. The float twin adds 2^-18.
                let bound = if row < 2 {
                    2f64.powi(-10) + want.abs() * 2f64.powi(-31)
                } else {
                    2f64.powi(-31)
                } + 2f64.powi(-18);
                let error = (got - want).abs();
                assert!(error <= bound, "row {row}: {error} > {bound}\n{camera:?}");
                assert!(got.abs() < 2f64.powi(BLOCK_BITS), "{camera:?}");
                let reach = form.axes.iter().map(|axis| axis.abs()).sum::<i64>();
                let reach = (form.centre.abs() + reach) as f64 / guard;
                largest[row] = largest[row].max(reach);
            }
        }
        // The width is used to the last two bits.
        let screen = largest[0].max(largest[1]);
        let least = 2f64.powi(BLOCK_BITS - 1) * (255.0 / 256.0);
        assert!(screen >= least && largest[2] >= least, "{camera:?}");
    }
}

#[test]
fn extreme_and_senseless_cameras_do_no_harm() {
    let lengths = [
        Length::MIN,
        Length::MAX,
        Length::ZERO,
        Length::DELTA,
        -Length::DELTA,
        Length::ONE,
    ];
    let units = [
        Unit::MIN,
        Unit::MAX,
        Unit::ZERO,
        Unit::DELTA,
        Unit::ONE,
        -Unit::ONE,
    ];
    let mut rng = Rng::with_seed(22);
    for _ in 0..100_000 {
        let mut length = || *rng.choice(&lengths).expect("not empty");
        let eye = [length(), length(), length()];
        let (focal_px, near) = (length(), length());
        let mut unit = || *rng.choice(&units).expect("not empty");
        let camera = Camera {
            eye,
            right: [unit(), unit(), unit()],
            up: [unit(), unit(), unit()],
            forward: [unit(), unit(), unit()],
            focal_px,
            width: 4096,
            height: 1,
            near,
        };
        let projection = Projection::new(&camera);
        for w in [1, 2, 1 << 15, 1 << 30] {
            let depth = projection.depth(reciprocal(w));
            assert!(depth >= 1, "{camera:?}");
        }
        let range = DepthRange::of(&camera);
        assert!(range.near > 0 && range.far > 0, "{camera:?}");
    }
}

/// The exact depth of a w, not limited, and q = far / (far - near).
fn exact_depth(projection: &Projection, w: f64) -> (f64, f64) {
    let [near, far] = projection.depth.range.map(|w| w as f64);
    let depth = 1.0 + 65534.0 * (1.0 / w - 1.0 / far) / (1.0 / near - 1.0 / far);
    (depth, far / (far - near))
}

#[test]
fn depth_is_monotone_and_within_its_bound() {
    let mut rng = Rng::with_seed(23);
    for _ in 0..400 {
        let camera = camera(&mut rng, 1e5, 4096.0);
        let projection = Projection::new(&camera);
        let [near, far] = projection.depth.range;
        if far <= near {
            continue;
        }
        let depth = |w: i64| projection.depth(reciprocal(w as u32));
        assert_eq!(depth(far), 1, "{camera:?}");
        let mut above = depth(1);
        assert_eq!(above, 65535, "{camera:?}");
        let mut w = 1;
        while w < 1 << 31 {
            let got = depth(w);
            assert!(got <= above && got > 0, "grows at w = {w}\n{camera:?}");
            above = got;
            if (near..=far).contains(&w) {
                let (want, ratio) = exact_depth(&projection, w as f64);
                // The table's error here and at the far end; two roundings.
                let share = near as f64 / w as f64 + near as f64 / far as f64;
                let bound = 2.0 + 65534.0 * ratio * share * 2f64.powf(-18.8);
                let error = (f64::from(got) - want.min(65535.0)).abs();
                assert!(error <= bound, "w = {w}: {got}, not {want}\n{camera:?}");
            }
            // Neighbours, then strides.
            w += if rng.u8(..4) > 0 {
                1
            } else {
                1 + rng.i64(0..=w / 256 + (far - near) / 256)
            };
        }
    }
}

#[test]
fn depth_is_65535_at_near_and_1_at_far_of_the_range() {
    let mut rng = Rng::with_seed(24);
    for _ in 0..20_000 {
        let camera = camera(&mut rng, 100.0, 4096.0);
        let projection = Projection::new(&camera);
        let range = DepthRange::of(&camera);
        let [near, far] = projection.depth.range;
        if far <= near {
            continue;
        }
        let unit = 2f64.powi(projection.w_scale);
        for (got, want) in [(range.near, near), (range.far, far)] {
            let want = want as f64 * unit;
            let error = (got.to_num::<f64>() - want).abs();
            assert!(error <= 2f64.powi(-32), "{got}, not {want}\n{camera:?}");
        }
        // The cube's nearest and farthest corners, but at least far / 128
        // and the camera's near distance.
        let exact = Exact::new(&camera);
        let reach: f64 = exact.half_edges(1.0).iter().map(|edge| edge[2].abs()).sum();
        let centre = exact.forms([0.0; 3])[2];
        let want_far = centre + reach;
        let least = (want_far / 128.0).max(2f64.powi(-20));
        let want_near = (centre - reach).max(least);
        let slack = 8.0 * unit;
        assert!((far as f64 * unit - want_far).abs() < slack, "{camera:?}");
        assert!((near as f64 * unit - want_near).abs() < slack, "{camera:?}");
        let depth = |w: i64| projection.depth(reciprocal(w as u32));
        assert_eq!(depth(far), 1, "{camera:?}");
        assert_eq!(depth(far + far / 8), 1, "{camera:?}");
        let (_, ratio) = exact_depth(&projection, near as f64);
        let bound = 65535.0 - 2.0 - 65534.0 * ratio * 2f64.powf(-17.8);
        assert!(f64::from(depth(near)) >= bound, "{camera:?}");
        assert_eq!(depth(near - near / 8), 65535, "{camera:?}");
    }
}

#[test]
fn depth_resolves_what_the_documentation_says() {
    // Steps of w at the far end: far / 65534 at 1:2, far / 516 at 1:128.
    for (distance, inverse_step) in [(3.0, 65534.0), (0.5, 516.0)] {
        let eye = [0.0, 0.0, distance];
        let camera =
            crate::testing::view::looking(eye, [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 320.0, 240, 320);
        let projection = Projection::new(&camera);
        let [near, far] = projection.depth.range;
        let ratio = far as f64 / near as f64;
        assert!((ratio - 2.0).abs() < 1e-6 || (ratio - 128.0).abs() < 1e-4);
        let depth = |w: i64| projection.depth(reciprocal(w as u32));
        // Sixteen steps from the far end.
        let first = far - far / 4;
        let mut range = [first, far];
        while range[1] - range[0] > 1 {
            let middle = (range[0] + range[1]) / 2;
            let end = usize::from(depth(middle) <= 17);
            range[end] = middle;
        }
        let step = (far - range[1]) as f64 / 16.0;
        let got = far as f64 / step;
        let tolerance = 0.05 + 16.0 / inverse_step;
        assert!(
            (got / inverse_step - 1.0).abs() < tolerance,
            "1:{ratio}: far / {got}, not far / {inverse_step}"
        );
    }
}

#[test]
fn far_eyes_keep_the_order_of_depths() {
    let mut rng = Rng::with_seed(25);
    for exponent in 1..=6 {
        let distance = 10f64.powi(exponent);
        let back = direction(&mut rng);
        let camera = crate::testing::view::looking(
            back.map(|c| c * distance),
            back.map(|c| -c),
            direction(&mut rng),
            1000.0 * distance,
            1000,
            1000,
        );
        let projection = Projection::new(&camera);
        let [near, far] = projection.depth.range;
        let depth = |w: i64| i32::from(projection.depth(reciprocal(w as u32)));
        let quarters = [0, 1, 2, 3, 4].map(|i| depth(near + (far - near) * i / 4));
        std::println!("distance {distance}: depths {quarters:?}");
        for pair in quarters.windows(2) {
            let step = pair[0] - pair[1];
            // Exact: 16384, bent by perspective at the nearest distance.
            assert!((8000..30000).contains(&step), "{distance}: {quarters:?}");
        }
    }
}

#[test]
fn the_part_of_the_picture_holds_every_point_of_the_cube() {
    let mut rng = Rng::with_seed(24);
    let mut smaller = 0;
    for case in 0..20_000 {
        let camera = camera(&mut rng, 1e3, 4096.0);
        let projection = Projection::new(&camera);
        let exact = Exact::new(&camera);
        let picture = Rect {
            left: 0,
            top: 0,
            right: camera.width,
            bottom: camera.height,
        };
        let part = projection.part(picture, 0);
        assert_eq!(part, picture.intersection(part), "case {case}");
        smaller += usize::from(part != picture);
        for _ in 0..8 {
            let point = [0; 3].map(|_| rng.f64() * 2.0 - 1.0);
            let forms = exact.forms(point);
            let [x, y] = exact.screen(forms);
            let is_seen = forms[2] > 0.0
                && (0.0..f64::from(camera.width)).contains(&x)
                && (0.0..f64::from(camera.height)).contains(&y);
            let within =
                |at: f64, low: u16, high: u16| at >= f64::from(low) && at < f64::from(high);
            assert!(
                !is_seen || within(x, part.left, part.right) && within(y, part.top, part.bottom),
                "case {case}: {x}, {y} is not in {part:?}\n{camera:?}"
            );
        }
    }
    assert!(
        smaller > 2000,
        "{smaller} parts are smaller than the picture"
    );
}
