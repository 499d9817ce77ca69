//! How far a picture is from another, or from the reference: two pictures in,
//! numbers or a difference picture out. All on 8-bit values, undrawn pixels
//! black.

mod shadow;
mod ssim;

pub use shadow::shadow_errors;

use std::fmt;

use serde::Serialize;

use crate::picture::Picture;
use crate::reference::Reference;
pub use ssim::ssim;

/// How many times a difference picture amplifies.
const AMPLIFICATION: u8 = 4;

/// What two pictures can tell. Serialized in this order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// Peak signal-to-noise ratio in dB over the whole frame: peak 255, the
    /// three channels pooled. `None` where the pictures are identical.
    pub psnr: Option<f64>,
    /// Structural similarity of the luma, see [`ssim()`]; 1 where identical.
    pub ssim: f64,
    /// Root of the mean squared difference over all pixels and channels.
    pub rmse: f64,
    /// Largest difference of a channel.
    pub max_error: u8,
    /// Pixels that differ in any channel.
    pub differing_pixels: u64,
}

/// What a picture and the reference can tell. Serialized in this order, without
/// the nesting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReferenceMeasures {
    /// As [`Measures::psnr`], over the pixels that the reference covers fully;
    /// undrawn ones among them count as black. `None` where those are identical
    /// or there are none.
    pub psnr_inside: Option<f64>,
    /// The whole frame.
    #[serde(flatten)]
    pub frame: Measures,
    /// Pixels that the reference covers fully.
    pub inside_pixels: u64,
    /// Pixels that the picture draws.
    pub drawn_pixels: u64,
    /// Undrawn pixels whose 3x3 neighbourhood, as far as it lies in the frame,
    /// the reference covers fully.
    pub holes: u64,
    /// Drawn pixels that the reference covers fully and whose depth exceeds the
    /// reference's [`farthest`](Reference::farthest) by more than the tolerance:
    /// they show a surface that another should hide. The farthest sample counts,
    /// so that a pixel that a silhouette runs through may show either side of
    /// it. `None` without depths.
    pub see_through: Option<u64>,
    /// See [`shadow_errors`]; `None` without shadows.
    pub shadow_errors: Option<f64>,
}

/// The depths of a drawn picture, row-major like its pixels.
#[derive(Clone, Copy, Debug)]
pub struct Depths<'a> {
    /// Distance from the eye along the view's forward vector, world units; of
    /// no meaning where nothing was drawn.
    pub w: &'a [f32],
    /// How much deeper than the reference each pixel may be, world units: twice
    /// the diagonal of the cell that was drawn there.
    pub tolerance: &'a [f32],
}

/// Two pictures that cannot be compared: their sizes differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeMismatch {
    /// Width and height of the first.
    pub first: [u32; 2],
    /// Width and height of the second.
    pub second: [u32; 2],
}

impl fmt::Display for SizeMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([width, height], [other_width, other_height]) = (self.first, self.second);
        write!(
            f,
            "the pictures are {width}x{height} and {other_width}x{other_height} pixels; \
             compare pictures of one size"
        )
    }
}

impl std::error::Error for SizeMismatch {}

/// Sums of differences over pixels.
#[derive(Clone, Copy, Default)]
struct Differences {
    pixels: u64,
    /// Over the three channels; at most 2^18 a pixel.
    squares: u64,
    largest: u8,
    differing: u64,
}

impl Differences {
    fn of(pairs: impl Iterator<Item = ([u8; 3], [u8; 3])>) -> Self {
        pairs.fold(Self::default(), |sums, (a, b)| {
            let channels = [0, 1, 2].map(|channel| a[channel].abs_diff(b[channel]));
            let squares: u64 = channels.iter().map(|&d| u64::from(d).pow(2)).sum();
            Self {
                pixels: sums.pixels + 1,
                squares: sums.squares + squares,
                largest: channels.into_iter().fold(sums.largest, u8::max),
                differing: sums.differing + u64::from(a != b),
            }
        })
    }

    fn mean_square(self) -> f64 {
        self.squares as f64 / (3 * self.pixels).max(1) as f64
    }

    fn psnr(self) -> Option<f64> {
        (self.squares > 0).then(|| 10.0 * (255.0 * 255.0 / self.mean_square()).log10())
    }
}

/// Measures a picture against another; the order does not matter.
///
/// # Errors
///
/// If their sizes differ.
pub fn compare(a: &Picture, b: &Picture) -> Result<Measures, SizeMismatch> {
    check_sizes(a, [b.width, b.height])?;
    let sums = Differences::of(a.seen().zip(b.seen()));
    Ok(Measures {
        psnr: sums.psnr(),
        ssim: ssim(a, b)?,
        rmse: sums.mean_square().sqrt(),
        max_error: sums.largest,
        differing_pixels: sums.differing,
    })
}

/// Measures a picture, and its depths where it has them, against the reference
/// of the same view.
///
/// # Errors
///
/// If their sizes differ.
///
/// # Panics
///
/// If the depths are not one a pixel.
pub fn against_reference(
    picture: &Picture,
    depths: Option<Depths<'_>>,
    reference: &Reference,
) -> Result<ReferenceMeasures, SizeMismatch> {
    check_sizes(picture, [reference.width, reference.height])?;
    let inside: Vec<bool> = reference
        .coverage
        .iter()
        .map(|&share| share == 1.0)
        .collect();
    let pairs = picture.seen().zip(reference.colour.iter().copied());
    let pairs_inside = pairs
        .zip(&inside)
        .filter_map(|(pair, &inside)| inside.then_some(pair));
    Ok(ReferenceMeasures {
        psnr_inside: Differences::of(pairs_inside).psnr(),
        frame: compare(picture, &reference.picture())?,
        inside_pixels: count(&inside),
        drawn_pixels: count(&picture.drawn),
        holes: holes(picture, &inside),
        see_through: depths.map(|depths| see_through(picture, depths, reference, &inside)),
        shadow_errors: None,
    })
}

fn count(mask: &[bool]) -> u64 {
    mask.iter().filter(|&&set| set).count() as u64
}

fn holes(picture: &Picture, inside: &[bool]) -> u64 {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let deep_inside = |x: usize, y: usize| {
        (y.saturating_sub(1)..height.min(y + 2)).all(|row| {
            let (first, end) = (x.saturating_sub(1), width.min(x + 2));
            inside[row * width + first..row * width + end]
                .iter()
                .all(|&inside| inside)
        })
    };
    (0..picture.drawn.len())
        .filter(|&pixel| !picture.drawn[pixel] && deep_inside(pixel % width, pixel / width))
        .count() as u64
}

fn see_through(
    picture: &Picture,
    depths: Depths<'_>,
    reference: &Reference,
    inside: &[bool],
) -> u64 {
    assert_eq!(depths.w.len(), inside.len(), "depths");
    assert_eq!(depths.tolerance.len(), inside.len(), "tolerances");
    (0..inside.len())
        .filter(|&pixel| picture.drawn[pixel] && inside[pixel])
        .filter(|&pixel| depths.w[pixel] > reference.farthest[pixel] + depths.tolerance[pixel])
        .count() as u64
}

/// A picture of the absolute differences, four times amplified and clamped at
/// 255; every pixel drawn.
///
/// # Errors
///
/// If the sizes differ.
pub fn difference(a: &Picture, b: &Picture) -> Result<Picture, SizeMismatch> {
    check_sizes(a, [b.width, b.height])?;
    let amplified = |a: u8, b: u8| a.abs_diff(b).saturating_mul(AMPLIFICATION);
    Ok(Picture {
        width: a.width,
        height: a.height,
        rgb: a
            .seen()
            .zip(b.seen())
            .map(|(a, b)| [0, 1, 2].map(|channel| amplified(a[channel], b[channel])))
            .collect(),
        drawn: vec![true; a.drawn.len()],
    })
}

fn check_sizes(a: &Picture, second: [u32; 2]) -> Result<(), SizeMismatch> {
    let first = [a.width, a.height];
    if first == second {
        Ok(())
    } else {
        Err(SizeMismatch { first, second })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, height: u32, level: u8) -> Picture {
        let count = (width * height) as usize;
        Picture {
            width,
            height,
            rgb: vec![[level; 3]; count],
            drawn: vec![true; count],
        }
    }

    /// A reference of one colour, fully covered, two units deep.
    fn wall(width: u32, height: u32, level: u8) -> Reference {
        let count = (width * height) as usize;
        Reference {
            width,
            height,
            colour: vec![[level; 3]; count],
            coverage: vec![1.0; count],
            nearest: vec![2.0; count],
            farthest: vec![2.0; count],
            lambert: vec![1.0; count],
            shadow: vec![0.0; count],
        }
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-9, "{a} is not {b}");
    }

    #[test]
    fn identical_pictures_have_no_psnr() {
        let measures = compare(&grey(5, 4, 90), &grey(5, 4, 90)).unwrap();
        assert_eq!(measures.psnr, None);
        assert_eq!(
            (measures.rmse, measures.max_error, measures.differing_pixels),
            (0.0, 0, 0)
        );
        close(measures.ssim, 1.0);
        let json = serde_json::to_string(&measures).unwrap();
        assert!(json.starts_with(r#"{"psnr":null,"ssim":"#), "{json}");
    }

    #[test]
    fn one_channel_of_one_pixel() {
        // One of 2 * 2 * 3 values is off by 12: mean square 144 / 12 = 12.
        let mut picture = grey(2, 2, 100);
        picture.rgb[3][1] = 112;
        let measures = compare(&picture, &grey(2, 2, 100)).unwrap();
        close(measures.rmse, 12.0_f64.sqrt());
        close(measures.psnr.unwrap(), 37.338_991_148_202_85); // 10 lg(65025 / 12)
        assert_eq!((measures.max_error, measures.differing_pixels), (12, 1));
    }

    #[test]
    fn black_against_white_is_zero_db() {
        let measures = compare(&grey(3, 3, 0), &grey(3, 3, 255)).unwrap();
        close(measures.psnr.unwrap(), 0.0);
        close(measures.rmse, 255.0);
    }

    #[test]
    fn undrawn_pixels_are_black() {
        let mut picture = grey(2, 1, 200);
        picture.drawn[1] = false;
        let mut black = grey(2, 1, 200);
        black.rgb[1] = [0; 3];
        assert_eq!(compare(&picture, &black).unwrap().psnr, None);
        assert_eq!(difference(&picture, &black).unwrap(), grey(2, 1, 0));
    }

    #[test]
    fn sizes_must_agree() {
        let mismatch = compare(&grey(2, 3, 0), &grey(3, 2, 0)).unwrap_err();
        assert!(mismatch.to_string().contains("2x3 and 3x2"), "{mismatch}");
        assert!(difference(&grey(2, 3, 0), &grey(3, 2, 0)).is_err());
        assert!(against_reference(&grey(2, 3, 0), None, &wall(3, 2, 0)).is_err());
    }

    #[test]
    fn differences_are_amplified_and_clamped() {
        let mut picture = grey(2, 1, 100);
        picture.rgb = vec![[103, 100, 90], [200, 37, 36]];
        let difference = difference(&picture, &grey(2, 1, 100)).unwrap();
        assert_eq!(difference.rgb, [[12, 0, 40], [255, 252, 255]]);
    }

    #[test]
    fn inside_ignores_partly_covered_pixels() {
        // Four pixels: one wrong by 30, one wrong by 200 that is a silhouette.
        let mut reference = wall(4, 1, 100);
        reference.coverage[3] = 15.0 / 16.0;
        let mut picture = grey(4, 1, 100);
        picture.rgb[1] = [130; 3];
        picture.rgb[3] = [255; 3];
        let measures = against_reference(&picture, None, &reference).unwrap();
        close(
            measures.psnr_inside.unwrap(),
            10.0 * (65025.0_f64 / 300.0).log10(),
        );
        assert_eq!((measures.inside_pixels, measures.drawn_pixels), (3, 4));
        assert_eq!(measures.see_through, None);
        let json = serde_json::to_value(measures).unwrap();
        assert!(
            json["psnr"].is_number() && json["see_through"].is_null(),
            "{json}"
        );

        reference.coverage.fill(0.5);
        let nowhere = against_reference(&picture, None, &reference).unwrap();
        assert_eq!((nowhere.psnr_inside, nowhere.inside_pixels), (None, 0));
    }

    /// Pixels of a 7x5 frame as text: `.` undrawn, `-` partly covered by the
    /// reference, `x` both.
    fn holes_in(map: [&str; 5]) -> u64 {
        let cells: Vec<char> = map.iter().flat_map(|row| row.chars()).collect();
        let mut picture = grey(7, 5, 50);
        let mut reference = wall(7, 5, 50);
        for (pixel, cell) in cells.into_iter().enumerate() {
            picture.drawn[pixel] = !matches!(cell, '.' | 'x');
            reference.coverage[pixel] = if matches!(cell, '-' | 'x') { 0.9 } else { 1.0 };
        }
        against_reference(&picture, None, &reference).unwrap().holes
    }

    #[test]
    fn holes_lie_deep_inside() {
        let whole = ["#######", "#######", "#######", "#######", "#######"];
        assert_eq!(holes_in(whole), 0);
        let two = ["#######", "##.#.##", "#######", "#######", "#######"];
        assert_eq!(holes_in(two), 2);
        // Each of the first three touches a partly covered pixel; the last not.
        let edges = ["-#####.", "#.##.##", "#####-#", "#######", "##.###x"];
        assert_eq!(holes_in(edges), 2);
        let corner = [".######", "#######", "#######", "#######", "######."];
        assert_eq!(holes_in(corner), 2);
    }

    #[test]
    fn see_through_needs_more_than_the_tolerance() {
        let mut reference = wall(6, 1, 100);
        reference.farthest[4] = 9.0; // a silhouette: both sides are right
        reference.coverage[5] = 0.5;
        let mut picture = grey(6, 1, 100);
        picture.drawn[3] = false;
        let depths = Depths {
            w: &[2.5, 2.500_1, 0.1, 9.0, 9.0, 9.0],
            tolerance: &[0.5; 6],
        };
        let seen = |depths| against_reference(&picture, Some(depths), &reference).unwrap();
        assert_eq!(seen(depths).see_through, Some(1));
        let strict = Depths {
            tolerance: &[0.0; 6],
            ..depths
        };
        assert_eq!(seen(strict).see_through, Some(2));
    }
}
