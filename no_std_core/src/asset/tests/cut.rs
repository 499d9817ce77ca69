//! Cut files give the pictures of the coarser model.

use super::*;
use crate::camera::Camera;
use crate::draw::{Light, Quality, draw};
use crate::numbers::{SplatPx, Unit, Weight};
use crate::target::{Target, canvas_len};

/// Wherever drawing stops, what a cut file has besides the coarser model does
/// not show.
#[test]
fn cut_files_draw_as_the_coarser_model() {
    let mut rng = Rng::with_seed(62);
    let (mut covered, mut splats) = (0, 0);
    for case in 0..400 {
        let (rho, depth) = (rng.u8(2..=5), rng.u8(1..=3));
        let mut model = Model::random_fat(&mut rng, rho, depth, 200.0);
        model.paint(&mut rng);
        model.make_thin(&mut rng);
        let cut = rng.usize(..usize::from(depth));
        let file = model.file();
        let end = file.ends()[file.sections.len() - 1 - (usize::from(depth) - cut)];
        let camera = crate::testing::camera(&mut rng, 20.0, 48.0);
        let quality = Quality {
            splat: SplatPx::from_num(rng.u8(..3) * 4),
            ..Quality::default()
        };
        let [own, coarse] = [file.bytes()[..end].to_vec(), model.cut(cut).file().bytes()];
        let [own, coarse] = [own, coarse].map(|bytes| frame(&bytes, &camera, &quality));
        assert_eq!(
            own, coarse,
            "case {case}, rho {rho}, depth {cut} of {depth}"
        );
        covered += usize::from(own.0.iter().any(|&depth| depth > 0));
        splats += usize::from(quality.splat > 0);
    }
    assert!(covered > 200 && splats > 200, "{covered}, {splats}");
}

/// Depths and colours of a picture.
fn frame(bytes: &[u8], camera: &Camera, quality: &Quality) -> (Vec<u16>, Vec<u16>) {
    let bytes = aligned(bytes);
    let grid = Grid::open(&bytes).expect("valid");
    let pixels = usize::from(camera.width) * usize::from(camera.height);
    let (mut colour, mut depth) = (std::vec![0; pixels], std::vec![0; pixels]);
    let mut canvas = std::vec![0; canvas_len(camera.height)];
    let mut target = Target::new(camera.width, camera.height, &mut colour, &mut canvas)
        .and_then(|target| target.with_depth(&mut depth))
        .expect("buffers fit");
    let light = Light {
        towards: [Unit::ZERO, Unit::ONE, Unit::ZERO],
        ambient: Weight::ONE,
        diffuse: Weight::ZERO,
    };
    draw(&grid, camera, &light, quality, &mut [], &mut target);
    (depth, colour)
}
