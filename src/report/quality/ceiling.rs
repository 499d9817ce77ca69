//! What one sample a pixel can reach: the mesh itself.

use super::super::row::{Row, Setting, Subject};
use super::super::{Means, Model};
use super::{PSNR, row};
use crate::picture::{Picture, rgb565, widen_rgb565};

/// The reference's pictures with one sample a pixel, and what RGB565 alone
/// costs.
pub(super) fn measure(model: &Model, means: Means<'_>) -> Vec<Row> {
    let once: Vec<Picture> = model.rendered(1).iter().map(|own| own.picture()).collect();
    let often = model.references(means.progress).iter();
    let often: Vec<Picture> = often.map(|own| quantised(own.picture())).collect();
    let narrow: Vec<Picture> = once.iter().cloned().map(quantised).collect();
    let of = |subject, pictures: &[Picture]| {
        let score = model.score(pictures, means.progress);
        row(model, Setting::of(subject), PSNR, score.psnr_inside, "dB")
    };
    vec![
        of(Subject::Mesh, &narrow),
        of(Subject::MeshTrueColour, &once),
        of(Subject::Rgb565, &often),
    ]
}

/// A picture in the nearest colours that a frame has.
fn quantised(picture: Picture) -> Picture {
    let nearest = |colour: [u8; 3]| widen_rgb565(rgb565(colour.map(f64::from)));
    Picture {
        rgb: picture.rgb.iter().copied().map(nearest).collect(),
        ..picture
    }
}
