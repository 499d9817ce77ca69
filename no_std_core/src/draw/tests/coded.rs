//! Grids with coded records give the pictures of plain ones.

use super::*;
use crate::testing::{Coder, File};

fn frame_of_file(file: &File, model: &Model, camera: &Camera, quality: &Quality) -> Frame {
    let bytes = aligned(&file.bytes());
    let grid = Grid::open(&bytes).expect("valid");
    let mut shades = std::vec![0; shades_len(model.materials.len())];
    let (band, rows) = (whole(camera), camera.height);
    frame_of(&grid, camera, &AMBIENT, quality, band, rows, &mut shades)
}

/// Pictures and counters, whichever levels have codes and however many records
/// have none.
#[test]
fn coded_records_draw_as_plain_ones() {
    let mut rng = Rng::with_seed(91);
    let (mut covered, mut packs) = (0, 0);
    for case in 0..1500 {
        let depth = rng.u8(1..=5);
        let leaves = magnitude(&mut rng, 10.0, 2000.0);
        let mut model = Model::random(&mut rng, 3, depth, leaves);
        model.paint(&mut rng);
        for cell in model.levels.iter_mut().flatten() {
            cell.flags.two_sided = rng.bool();
            cell.flags.aperture = rng.u8(8..16);
        }
        let levels = rng.usize(1..=usize::from(depth));
        let coder = Coder::of(&model, levels, rng.usize(..300));
        let camera = near_camera(&mut rng, 40.0, 96.0);
        let quality = match rng.u8(..3) {
            0 => quality(f64::from(rng.u8(..3))),
            1 => packed(0.5),
            _ => Quality::default(),
        };
        let [plain, coded] = [model.file(), coder.file(&model)]
            .map(|file| frame_of_file(&file, &model, &camera, &quality));
        assert_eq!(plain, coded, "case {case}");
        covered += usize::from(plain.depth.iter().any(|&depth| depth > 0));
        packs += usize::from(plain.stats.samples_drawn > plain.stats.splats_drawn);
    }
    assert!(covered > 700 && packs > 300, "{covered}, {packs}");
}
