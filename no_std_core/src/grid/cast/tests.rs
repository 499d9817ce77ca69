use super::*;
use crate::numbers::{Length, SplatPx, Unit};
use crate::placement::Placement;
use crate::shadow::{LightSpace, Sphere};
use crate::testing::{Model, Rng, aligned, direction, dot};
use std::vec::Vec;

/// What a place may be off, texels: sixteenths for the block, the row and two
/// steps.
const OFF: f64 = 3.0 / 16.0;
/// What a depth may be off: a step for each sum.
const DEEP: i32 = 6;

/// u, v in texels and depth of the cells that are drawn at a depth, exactly.
fn places(model: &Model, depth: usize, space: &LightSpace, radius: f64) -> Vec<[f64; 3]> {
    let middle = f64::from(space.size) / 2.0;
    let axes = space.axes.map(|axis| axis.map(|c| c.to_num::<f64>()));
    let reaches = space.reaches().map(|reach| reach as f64);
    let level = &model.levels[depth];
    let is_drawn = |cell: &&crate::testing::model::Cell| match depth {
        0 => true,
        _ => model.levels[depth - 1][cell.parent].drawn >> cell.bit & 1 != 0,
    };
    let place = |cell: &crate::testing::model::Cell| {
        let centre = model.centre(depth, cell);
        let along = |at: usize| dot(axes[at], centre) / radius * reaches[at];
        [middle + along(0), middle + along(1), 32768.0 + along(2)]
    };
    level.iter().filter(is_drawn).map(place).collect()
}

/// The depths of a map in which squares are larger or smaller by what places
/// may be off.
fn brute_force(places: &[[f64; 3]], size: usize, side: usize, grown: f64) -> Vec<i32> {
    let mut map = std::vec![0; size * size];
    let half = side as f64 / 2.0 + grown;
    for &[u, v, depth] in places {
        // Texels whose centres lie in the square.
        let range = |at: f64| {
            let first = (at - half - 0.5).ceil().max(0.0) as usize;
            let end = (at + half - 0.5).ceil().max(0.0) as usize;
            first..end.min(size)
        };
        for row in range(v) {
            for column in range(u) {
                let texel: &mut i32 = &mut map[row * size + column];
                *texel = (*texel).max(depth as i32);
            }
        }
    }
    map
}

#[test]
fn maps_are_those_of_all_cells() {
    let mut rng = Rng::with_seed(71);
    let mut windowed = 0;
    for case in 0..600 {
        let (rho, depth) = (rng.u8(2..=5), rng.u8(0..=3));
        let mut model = Model::random(&mut rng, rho, depth, 300.0);
        model.make_thin(&mut rng);
        let bytes = aligned(&model.file().bytes());
        let grid = Grid::open(&bytes).expect("models are valid");
        let radius = 1.8 * 20f64.powf(rng.f64());
        let sphere = Sphere {
            centre: [Length::ZERO; 3],
            radius: Length::from_num(radius),
        };
        let size = *rng.choice(&[64u16, 256, 256, 300]).expect("some");
        let space = LightSpace::new(direction(&mut rng).map(Unit::from_num), sphere, size);
        let splat = SplatPx::from_num(0.5 * 6f64.powf(rng.f64()));
        let forms = CastForms::new(&space, &grid, &Placement::IDENTITY, splat);
        let mut texels = std::vec![0u16; usize::from(size).pow(2)];
        let mut stats = Stats::default();
        let mut map = Map::new(&mut texels, size);
        windowed += usize::from(map.has_windows() && forms.side <= WINDOW_SIDE && forms.bottom > 0);
        cast(&grid, &forms, None, &mut map, &mut stats);

        let places = places(&model, usize::from(forms.bottom), &space, radius);
        assert_eq!(stats.casters_drawn as usize, places.len(), "case {case}");
        let bound = |grown| brute_force(&places, usize::from(size), forms.side, grown);
        let (least, most) = (bound(-OFF), bound(OFF));
        for (at, &got) in texels.iter().enumerate() {
            let range = least[at] - DEEP..=most[at] + DEEP;
            assert!(
                range.contains(&i32::from(got)) && (got == 0) >= (most[at] == 0),
                "case {case}, texel {at}: {got} is not in {range:?}"
            );
        }
    }
    assert!(windowed > 50, "{windowed} of one addition a cell");
}

#[test]
fn what_faces_away_casts_nothing_with_what_is_below() {
    let mut rng = Rng::with_seed(72);
    let mut fewer = 0;
    for case in 0..100 {
        let rho = rng.u8(2..=5);
        let mut model = Model::random(&mut rng, rho, 2, 300.0);
        model.paint(&mut rng);
        for cell in model.levels.iter_mut().flatten() {
            cell.flags.aperture = rng.u8(..16);
        }
        let bytes = aligned(&model.file().bytes());
        let grid = Grid::open(&bytes).expect("models are valid");
        let towards = direction(&mut rng);
        let sphere = Sphere {
            centre: [Length::ZERO; 3],
            radius: Length::from_num(1.8),
        };
        let space = LightSpace::new(towards.map(Unit::from_num), sphere, 256);
        let forms = CastForms::new(&space, &grid, &Placement::IDENTITY, SplatPx::ONE);
        let draw = |away| {
            let mut texels = std::vec![0u16; 256 * 256];
            let mut stats = Stats::default();
            cast(
                &grid,
                &forms,
                away,
                &mut Map::new(&mut texels, 256),
                &mut stats,
            );
            (texels, stats.casters_drawn)
        };
        let away = towards.map(|c| (c * -16384.0) as i32);
        let ((all, drawn), (facing, kept)) = (draw(None), draw(Some(away)));
        assert!(facing.iter().zip(&all).all(|(a, b)| a <= b), "case {case}");
        assert!(kept <= drawn, "case {case}");
        fewer += usize::from(kept < drawn);
    }
    assert!(fewer > 10, "{fewer} leave something out");
}
