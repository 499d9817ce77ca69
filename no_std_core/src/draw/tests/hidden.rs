//! What culling leaves out would not show.

use super::*;
use crate::normal::encode;

/// A view from a direction in which a cell of the last level is about so many
/// pixels wide.
fn view(rng: &mut Rng, model: &Model, pixels: f64) -> Camera {
    let (back, upwards) = (direction(rng), direction(rng));
    let distance = 3.0 + 4.0 * rng.f64();
    let cells = model.cells_per_axis(usize::from(model.depth())) as f64;
    let focal = pixels * cells / 2.0 * distance;
    let eye = back.map(|c| c * distance);
    looking(eye, back.map(|c| -c), upwards, focal, 64, 48)
}

fn drawn(model: &Model, two_sided: bool, camera: &Camera, quality: &Quality, rows: u16) -> Frame {
    let mut file = model.file();
    file.header[14] = u8::from(two_sided);
    let bytes = aligned(&file.bytes());
    let grid = Grid::open(&bytes).expect("models are valid");
    let band = whole(camera);
    frame_of(&grid, camera, &AMBIENT, quality, band, rows, &mut [])
}

/// Dense models, of which most lies behind the first cells: without facing
/// tests, culling leaves out what is hidden and nothing else.
#[test]
fn what_is_hidden_does_not_show() {
    let mut rng = Rng::with_seed(71);
    // Of packed subtrees, and of blocks that are projected exactly.
    let mut hidden = [0; 2];
    for case in 0..200 {
        let (rho, depth) = [(2, 5), (3, 3), (4, 2), (5, 2)][case % 4];
        let cells = f64::from(rho).powi(3 * i32::from(depth));
        let share = 0.3 + 0.7 * rng.f64();
        let mut model = Model::random(&mut rng, rho, depth, cells * share);
        model.paint(&mut rng);
        for cell in model.levels.iter_mut().flatten() {
            // A cone of its own would turn away, and a sheet turn over.
            cell.flags.aperture = 14;
        }
        let is_exact = rng.bool();
        let pixels = if is_exact { 8.0 } else { 1.2 };
        let pixels = 0.3 + pixels * rng.f64();
        let camera = view(&mut rng, &model, pixels);
        let on = Quality {
            repair: rng.bool(),
            ..match is_exact {
                true => quality(0.0),
                false => packed(magnitude(&mut rng, 0.25, 8.0)),
            }
        };
        let off = Quality {
            culling: false,
            ..on
        };
        let rows = *rng.choice(&[8, 17, camera.height]).expect("not empty");
        let [with, without] =
            [&on, &off].map(|quality| drawn(&model, true, &camera, quality, rows));
        assert!(with.colour == without.colour, "case {case}: colours differ");
        assert!(with.depth == without.depth, "case {case}: depths differ");
        assert_eq!(without.stats.nodes_hidden, 0, "case {case}");
        hidden[usize::from(is_exact)] += with.stats.nodes_hidden;
    }
    assert!(
        hidden.iter().all(|&nodes| nodes > 2000),
        "{hidden:?} nodes are hidden"
    );
}

/// Cones of every width whose samples all face away: packed, not one is drawn.
#[test]
fn samples_that_face_away_are_not_drawn() {
    let mut rng = Rng::with_seed(72);
    let mut packed_ones = 0;
    for case in 0..200 {
        let (rho, depth) = (rng.u8(2..=5), rng.u8(1..=3));
        let mut model = Model::random(&mut rng, rho, depth, 300.0);
        let camera = view(&mut rng, &model, 0.8);
        let away = encode(camera.forward.map(|c| c.to_bits() >> 4));
        for cell in model.levels.iter_mut().flatten() {
            cell.attribute = away;
            cell.flags.aperture = rng.u8(7..=15);
            cell.flags.two_sided = false;
        }
        let on = packed(8.0);
        let off = Quality {
            culling: false,
            ..on
        };
        let [with, without] =
            [&on, &off].map(|quality| drawn(&model, false, &camera, quality, camera.height));
        // Only a splat may lie behind its block's horizon and show.
        let Stats {
            samples_drawn,
            splats_drawn,
            ..
        } = with.stats;
        assert_eq!(samples_drawn, splats_drawn, "case {case}");
        packed_ones += without.stats.samples_drawn - without.stats.splats_drawn;
    }
    assert!(
        packed_ones > 10_000,
        "{packed_ones} are packed without culling"
    );
}
