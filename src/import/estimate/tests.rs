use std::f64::consts::TAU;

use glam::DMat3;

use super::*;

/// A generator for tests (Steele, Lea, Flood 2014: SplitMix).
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Each component from -1 to 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.unit() * 2.0 - 1.0))
    }

    fn direction(&mut self) -> DVec3 {
        std::iter::repeat_with(|| self.vector())
            .find(|vector| (0.1..1.0).contains(&vector.length()))
            .map_or(DVec3::Y, DVec3::normalize)
    }
}

/// Points with their exact outward normals.
type Sampled = Vec<(DVec3, DVec3)>;

fn sphere(random: &mut Random, count: usize) -> Sampled {
    let directions = std::iter::repeat_with(|| random.direction());
    directions
        .take(count)
        .map(|normal| (normal, normal))
        .collect()
}

/// A cube of side 2, its first axis stretched.
fn block(random: &mut Random, count: usize, height: f64) -> Sampled {
    let faces = [2.0, 2.0 * height, 2.0 * height].map(|area| area * 2.0);
    let total: f64 = faces.iter().sum();
    let mut point = || {
        let mut pick = random.unit() * total;
        let axis = faces.iter().position(|area| {
            pick -= area;
            pick < 0.0
        });
        let axis = axis.unwrap_or(2);
        let mut place = random.vector();
        let mut normal = DVec3::ZERO;
        normal[axis] = place[axis].signum();
        place[axis] = normal[axis];
        (place * DVec3::new(height, 1.0, 1.0), normal)
    };
    (0..count).map(|_| point()).collect()
}

fn torus(random: &mut Random, count: usize) -> Sampled {
    let mut point = || {
        loop {
            let [phi, theta] = [(); 2].map(|()| random.unit() * TAU);
            let around = DVec3::new(phi.cos(), 0.0, phi.sin());
            let normal = around * theta.cos() + DVec3::Y * theta.sin();
            // As dense inside as outside.
            if random.unit() * 1.4 < 1.0 + 0.4 * theta.cos() {
                return (around + normal * 0.4, normal);
            }
        }
    };
    (0..count).map(|_| point()).collect()
}

/// A sphere with bumps and dents of a fifth of its radius.
fn bumpy(random: &mut Random, count: usize) -> Sampled {
    let waves = DMat3::from_cols_array(&[4.0, 1.0, 0.5, -1.0, 5.0, 1.5, 0.5, -2.0, 4.5]);
    let point = |direction: DVec3| {
        let phases = waves * direction;
        let height = |phase: f64| 0.07 * phase.sin();
        let slope = phases.to_array().map(|phase| 0.07 * phase.cos());
        let radius = 1.0 + phases.to_array().map(height).iter().sum::<f64>();
        // Of |x| - radius(x / |x|).
        let gradient = waves.transpose() * DVec3::from_array(slope);
        let tangent = gradient - direction * gradient.dot(direction);
        (
            direction * radius,
            (direction - tangent / radius).normalize(),
        )
    };
    let directions = std::iter::repeat_with(|| random.direction());
    directions.take(count).map(point).collect()
}

/// How far estimated normals are from exact ones.
struct Score {
    /// Degrees between them, whatever the sign.
    mean: f64,
    largest: f64,
    /// How many look to the other side.
    flipped: usize,
    two_sided: bool,
}

fn score(sampled: &Sampled) -> Score {
    let positions: Vec<DVec3> = sampled.iter().map(|point| point.0).collect();
    let found = estimate(&positions).unwrap();
    assert_eq!(found.normals.len(), sampled.len());
    let cosines = found.normals.iter().zip(sampled).map(|(normal, exact)| {
        assert!((normal.length() - 1.0).abs() < 1e-6);
        normal.as_dvec3().dot(exact.1)
    });
    let angle = |cosine: f64| cosine.abs().min(1.0).acos().to_degrees();
    let cosines: Vec<f64> = cosines.collect();
    let score = Score {
        mean: cosines.iter().copied().map(angle).sum::<f64>() / cosines.len() as f64,
        largest: cosines.iter().copied().map(angle).fold(0.0, f64::max),
        flipped: cosines.iter().filter(|&&cosine| cosine < 0.0).count(),
        two_sided: found.ambiguity.is_some(),
    };
    println!(
        "mean {:.2}, largest {:.1} degrees, {} flipped, {:?}",
        score.mean, score.largest, score.flipped, found.ambiguity
    );
    score
}

fn assert_one_sided(sampled: &Sampled, mean: f64, largest: f64) {
    let score = score(sampled);
    assert!(!score.two_sided && score.flipped == 0);
    assert!(score.mean < mean && score.largest < largest);
}

#[test]
fn closed_shapes_look_outwards() {
    let mut random = Random(1);
    assert_one_sided(&sphere(&mut random, 4000), 1.0, 5.0);
    assert_one_sided(&torus(&mut random, 6000), 2.0, 10.0);
    assert_one_sided(&bumpy(&mut random, 20_000), 2.0, 15.0);
}

#[test]
fn edges_are_rounded_and_crossed() {
    let mut random = Random(2);
    let cube = block(&mut random, 6000, 1.0);
    assert_one_sided(&cube, 6.0, 90.0);
    // Farther from an edge than neighbours reach, planes are exact.
    let places: Vec<DVec3> = cube.iter().map(|point| point.0).collect();
    let found = estimate(&places).unwrap().normals;
    let mut inner = 0;
    for (normal, (place, exact)) in found.iter().zip(&cube) {
        let mut distances = place.abs().to_array();
        distances.sort_by(f64::total_cmp);
        if distances[1] < 0.8 {
            inner += 1;
            assert!(normal.as_dvec3().dot(*exact) > 0.999_999, "{place}");
        }
    }
    assert!(inner > 3000);
    // A plate five spacings thick.
    assert_one_sided(&block(&mut random, 20_000, 0.05), 4.0, 90.0);
}

#[test]
fn separate_parts_look_outwards_each() {
    let mut random = Random(3);
    let mut both = sphere(&mut random, 3000);
    let shift = |(place, normal)| (place * 0.3 + DVec3::new(2.0, 0.5, 0.0), normal);
    both.extend(sphere(&mut random, 2000).into_iter().map(shift));
    assert_one_sided(&both, 1.5, 8.0);
}

#[test]
fn noise_tilts_but_does_not_turn() {
    let mut random = Random(4);
    let mut noisy = sphere(&mut random, 8000);
    // The spacing is about 0.04.
    for (place, normal) in &mut noisy {
        *place += *normal * (random.unit() + random.unit() - 1.0) * 0.02;
    }
    assert_one_sided(&noisy, 5.0, 25.0);
}

#[test]
fn sheets_are_two_sided_and_smooth() {
    let mut random = Random(5);
    let wave = |place: DVec3| {
        let (sine, cosine) = (place.x * 3.0).sin_cos();
        let normal = DVec3::new(-0.6 * cosine, 0.0, 1.0).normalize();
        (DVec3::new(place.x, place.y, 0.2 * sine), normal)
    };
    let sheet: Sampled = (0..4000).map(|_| wave(random.vector())).collect();
    let waved = score(&sheet);
    assert!(waved.two_sided && (waved.flipped == 0 || waved.flipped == sheet.len()));
    assert!(waved.mean < 1.0);
    // Exactly flat.
    let flat = |place: DVec3| (DVec3::new(place.x, 0.25, place.y), DVec3::Y);
    let flat = score(&sheet.iter().map(|point| flat(point.0)).collect());
    assert!(flat.two_sided && flat.largest < 1e-2 && flat.flipped.is_multiple_of(sheet.len()));
}

#[test]
fn halves_of_a_sphere_are_open_and_most_of_it_is_not() {
    let mut random = Random(6);
    let whole = sphere(&mut random, 12_000);
    let above = |least: f64| -> Sampled {
        let points = whole.iter().filter(|point| point.0.y > least);
        points.copied().collect()
    };
    assert!(score(&above(0.0)).two_sided);
    assert_one_sided(&above(-0.7), 1.0, 8.0);
}

#[test]
fn a_moebius_strip_is_two_sided() {
    let mut random = Random(7);
    let mut point = || {
        let turn = random.unit() * TAU;
        let across = (random.unit() - 0.5) * 0.8;
        let around = DVec3::new(turn.cos(), 0.0, turn.sin());
        let side = around * (turn / 2.0).cos() + DVec3::Y * (turn / 2.0).sin();
        around + side * across
    };
    let strip: Vec<DVec3> = (0..4000).map(|_| point()).collect();
    assert!(estimate(&strip).unwrap().ambiguity.is_some());
}

#[test]
fn doubles_change_nothing() {
    let mut random = Random(8);
    let single: Vec<DVec3> = torus(&mut random, 2000).iter().map(|p| p.0).collect();
    let normals = estimate(&single).unwrap().normals;
    let repeats = |i: usize| std::iter::repeat_n(i, 1 + i % 3);
    let order: Vec<usize> = (0..single.len()).rev().flat_map(repeats).collect();
    let doubled: Vec<DVec3> = order.iter().map(|&i| single[i]).collect();
    let expected: Vec<Vec3> = order.iter().map(|&i| normals[i]).collect();
    assert_eq!(estimate(&doubled).unwrap().normals, expected);
}

#[test]
fn threads_scale_and_place_do_not_matter() {
    let mut random = Random(9);
    let points: Vec<DVec3> = bumpy(&mut random, 3000).iter().map(|p| p.0).collect();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| estimate(&points).unwrap().normals)
    };
    let normals = with(1);
    assert_eq!(with(5), normals);
    for (scale, shift) in [(1e-30, 0.0), (1e30, 0.0), (1e-3, 100.0)] {
        let moved = points.iter().map(|p| p * scale + DVec3::splat(shift));
        let moved = estimate(&moved.collect::<Vec<_>>()).unwrap().normals;
        let least = moved.iter().zip(&normals).map(|(a, b)| a.dot(*b));
        assert!(least.fold(1.0, f32::min) > 0.999);
    }
}

#[test]
fn points_on_a_line_have_no_normals() {
    let line = |count: i32| (0..count).map(|i| DVec3::new(0.1, 0.7, -0.3) * f64::from(i));
    for count in [0, 1, 2, 3, 50] {
        let points: Vec<DVec3> = line(count).collect();
        assert!(estimate(&points).is_none(), "{count}");
    }
    assert!(estimate(&[DVec3::ONE; 20]).is_none());
    // One point beside the line makes a plane; the line's own points guess.
    for count in [2, 3, 50] {
        let points: Vec<DVec3> = line(count).chain([DVec3::Z]).collect();
        let found = estimate(&points).unwrap();
        assert!(found.ambiguity.is_some());
        assert!(found.normals.iter().all(|normal| normal.is_normalized()));
    }
}

/// Any few points: some unit normals.
#[test]
fn small_sets_have_unit_normals() {
    let mut random = Random(10);
    for count in 3..40 {
        for levels in [1.0, 2.0, 1e6] {
            let point = || ((random.vector() * levels).round(), DVec3::Y);
            let sampled: Sampled = std::iter::repeat_with(point).take(count).collect();
            let positions: Vec<DVec3> = sampled.iter().map(|point| point.0).collect();
            if estimate(&positions).is_some() {
                score(&sampled);
            }
        }
    }
}
