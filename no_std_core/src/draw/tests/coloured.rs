//! Samples whose colours are their materials' give the pictures of materials.

use super::*;
use crate::testing::{Coder, direction};

/// Colours and depths on a canvas for so many rows.
fn shown(model: &Model, view: (&Camera, &Light, &Quality), rows: u16, shades: usize) -> Frame {
    let bytes = aligned(&model.file().bytes());
    shown_of(&bytes, view, rows, shades)
}

fn shown_of(
    bytes: &[u8],
    (camera, light, quality): (&Camera, &Light, &Quality),
    rows: u16,
    shades: usize,
) -> Frame {
    let grid = Grid::open(bytes).expect("models are valid");
    let mut shades = std::vec![0xdead; shades];
    frame_of(
        &grid,
        camera,
        light,
        quality,
        whole(camera),
        rows,
        &mut shades,
    )
}

fn random_quality(rng: &mut Rng) -> Quality {
    match rng.u8(..3) {
        0 => quality(f64::from(rng.u8(..3))),
        1 => packed(0.5),
        _ => Quality::default(),
    }
}

/// With one white light brightness is tabulated or not, as materials are.
#[test]
fn colours_of_materials_give_the_pictures_of_materials() {
    let mut rng = Rng::with_seed(95);
    let mut covered = 0;
    for case in 0..1500 {
        let leaves = magnitude(&mut rng, 1.0, 2000.0);
        let mut model = model(&mut rng, leaves);
        // What 5:6:5 bits hold.
        for material in &mut model.materials {
            let [red, green, blue] = *material;
            *material = [
                red & 0xf8 | red >> 5,
                green & 0xfc | green >> 6,
                blue & 0xf8 | blue >> 5,
            ];
        }
        let camera = near_camera(&mut rng, 40.0, 96.0);
        let quality = random_quality(&mut rng);
        let light = Light {
            towards: direction(&mut rng).map(Unit::from_num),
            ambient: Weight::from_num(rng.f64()),
            diffuse: Weight::from_num(rng.f64()),
        };
        let view = (&camera, &light, &quality);
        let shades = if rng.bool() { shades_len(8) } else { 0 };
        let want = shown(&model, view, camera.height, shades);
        for bits in [32, 48] {
            model.attribute_bits = bits;
            // Two words a pixel: half as many rows in a strip, or less.
            let rows = camera.height + rng.u16(..80);
            let got = shown(&model, view, rows, shades);
            assert_eq!(got.colour, want.colour, "case {case}, {bits} bits");
            assert_eq!(got.depth, want.depth, "case {case}, {bits} bits");
        }
        covered += usize::from(want.depth.iter().any(|&depth| depth > 0));
    }
    assert!(covered > 700, "{covered}");
}

#[cfg(all(feature = "rho-3", feature = "mask-dictionary"))]
#[test]
fn coded_levels_have_colours() {
    let mut rng = Rng::with_seed(96);
    for case in 0..200 {
        let depth = rng.u8(1..=4);
        let mut model = Model::random(&mut rng, 3, depth, 300.0);
        model.paint(&mut rng);
        model.attribute_bits = *rng.choice(&[32, 48]).expect("some");
        let camera = near_camera(&mut rng, 20.0, 64.0);
        let quality = Quality::default();
        let view = (&camera, &AMBIENT, &quality);
        let coder = Coder::of(&model, usize::from(depth), 40);
        let coded = aligned(&coder.file(&model).bytes());
        let (rows, shades) = (camera.height, shades_len(1));
        let plain = shown(&model, view, rows, shades);
        assert_eq!(plain, shown_of(&coded, view, rows, shades), "case {case}");
    }
}

/// With a colour that no material has, so that it tells what is shown.
#[test]
fn a_canvas_too_short_for_colours_shows_materials() {
    let mut rng = Rng::with_seed(98);
    let mut model = Model::random(&mut rng, 3, 2, 100.0);
    model.attribute_bits = 48;
    let mut file = model.file();
    for (_, section) in &mut file.sections {
        let samples = u32::from_le_bytes(section[..4].try_into().expect("four bytes")) as usize;
        let colours = section.len() - 4 * samples;
        for colour in section[colours..].chunks_exact_mut(4) {
            colour.copy_from_slice(&[255, 0, 0, 0]);
        }
    }
    let bytes = aligned(&file.bytes());
    let camera = looking(
        [0.0, 0.0, 3.0],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        40.0,
        64,
        64,
    );
    let quality = Quality::default();
    let frame = |rows| shown_of(&bytes, (&camera, &AMBIENT, &quality), rows, 0);
    let (short, long) = (frame(36), frame(37));
    assert_eq!(short.depth, long.depth);
    let shows = |frame: &Frame, colour| {
        let pixels = frame.colour.iter().filter(|&&shown| shown != 0);
        pixels.clone().count() > 100 && pixels.clone().all(|&shown| shown == colour)
    };
    assert!(shows(&short, 0xffff) && shows(&long, 0xf800));
}
