//! Structural similarity of two pictures' luma.
//!
//! Based on: Wang, Bovik, Sheikh, Simoncelli, Image Quality Assessment: From
//! Error Visibility to Structural Similarity, 2004.
//! Changes here: (1) every pixel of the frame has a window; at the borders only
//! the part inside the frame counts, its weights scaled to sum 1. The paper's
//! mean leaves out pixels whose window leaves the frame. (2) The Gaussian is
//! applied to columns and rows in turn, which is the same: what lies inside the
//! frame is a rectangle.

use std::array;

use super::{SizeMismatch, check_sizes};
use crate::picture::Picture;

/// Pixels on either side of a window's middle: 11x11 in all.
const REACH: usize = 5;

/// Standard deviation of the window's Gaussian in pixels.
const SIGMA: f64 = 1.5;

/// (K1 L)^2 and (K2 L)^2 with K1 = 0.01, K2 = 0.03, L = 255.
const C1: f64 = 2.55 * 2.55;
const C2: f64 = 7.65 * 7.65;

/// Mean structural similarity over the whole frame: luma 0.299 R + 0.587 G +
/// 0.114 B from 0 to 255, 11x11 Gaussian windows of standard deviation 1.5, cut
/// off at the frame's borders and scaled to weight 1. At most 1, which is what
/// identical pictures have; an empty frame too.
///
/// # Errors
///
/// If the sizes differ.
pub fn ssim(a: &Picture, b: &Picture) -> Result<f64, SizeMismatch> {
    check_sizes(a, [b.width, b.height])?;
    // Per pixel: both lumas, their squares and their product.
    let moments: Vec<[f64; 5]> = luma(a)
        .zip(luma(b))
        .map(|(a, b)| [a, b, a * a, b * b, a * b])
        .collect();
    if moments.is_empty() {
        return Ok(1.0);
    }
    let (width, height) = (a.width as usize, a.height as usize);
    let means = blur(&blur(&moments, width, 1), height, width);
    Ok(means.iter().map(similarity).sum::<f64>() / means.len() as f64)
}

fn luma(picture: &Picture) -> impl Iterator<Item = f64> {
    picture.seen().map(|rgb| {
        let [red, green, blue] = rgb.map(f64::from);
        0.299 * red + 0.587 * green + 0.114 * blue
    })
}

/// Means to similarity, equation (13).
fn similarity(&[a, b, aa, bb, ab]: &[f64; 5]) -> f64 {
    let covariance = ab - a * b;
    let variances = (aa - a * a) + (bb - b * b);
    (2.0 * a * b + C1) * (2.0 * covariance + C2) / ((a * a + b * b + C1) * (variances + C2))
}

/// Weighted means along lines of `length` pixels that lie `stride` apart.
fn blur(plane: &[[f64; 5]], length: usize, stride: usize) -> Vec<[f64; 5]> {
    let weights: [f64; REACH + 1] =
        array::from_fn(|offset| (-0.5 * (offset as f64 / SIGMA).powi(2)).exp());
    (0..plane.len())
        .map(|pixel| {
            let place = pixel / stride % length;
            let (mut sums, mut total) = ([0.0; 5], 0.0);
            for other in place.saturating_sub(REACH)..length.min(place + REACH + 1) {
                let weight = weights[other.abs_diff(place)];
                let moments = plane[pixel - place * stride + other * stride];
                total += weight;
                sums.iter_mut()
                    .zip(moments)
                    .for_each(|(sum, moment)| *sum += weight * moment);
            }
            sums.map(|sum| sum / total)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pictures that differ by noise; the same on every run.
    fn noisy_pair(width: u32, height: u32) -> [Picture; 2] {
        let mut state = 12345_u64;
        let mut random = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 56) as u8
        };
        let count = (width * height) as usize;
        let first: Vec<[u8; 3]> = (0..count)
            .map(|pixel| [(pixel % 256) as u8, random(), random() / 2])
            .collect();
        let second = first
            .iter()
            .map(|rgb| rgb.map(|channel| channel.saturating_add(random() / 4)))
            .collect();
        [first, second].map(|rgb| Picture {
            width,
            height,
            rgb,
            drawn: vec![true; count],
        })
    }

    /// The definition, word for word: every window summed on its own, variances
    /// as means of squared distances from the mean.
    fn direct(a: &Picture, b: &Picture) -> f64 {
        let (width, height) = (i64::from(a.width), i64::from(a.height));
        let (luma_a, luma_b): (Vec<f64>, Vec<f64>) = (luma(a).collect(), luma(b).collect());
        let mut sum = 0.0;
        for y in 0..height {
            for x in 0..width {
                let mut window = Vec::new();
                for dy in -5..=5_i64 {
                    for dx in -5..=5_i64 {
                        let (u, v) = (x + dx, y + dy);
                        if (0..width).contains(&u) && (0..height).contains(&v) {
                            let weight = (-((dx * dx + dy * dy) as f64) / 4.5).exp();
                            let pixel = (v * width + u) as usize;
                            window.push((weight, luma_a[pixel], luma_b[pixel]));
                        }
                    }
                }
                let total: f64 = window.iter().map(|entry| entry.0).sum();
                let mean = |value: &dyn Fn(f64, f64) -> f64| {
                    window.iter().map(|&(w, a, b)| w * value(a, b)).sum::<f64>() / total
                };
                let (mean_a, mean_b) = (mean(&|a, _| a), mean(&|_, b| b));
                let var_a = mean(&|a, _| (a - mean_a).powi(2));
                let var_b = mean(&|_, b| (b - mean_b).powi(2));
                let covariance = mean(&|a, b| (a - mean_a) * (b - mean_b));
                sum += (2.0 * mean_a * mean_b + 6.5025) * (2.0 * covariance + 58.5225)
                    / ((mean_a.powi(2) + mean_b.powi(2) + 6.5025) * (var_a + var_b + 58.5225));
            }
        }
        sum / (width * height) as f64
    }

    #[test]
    fn equals_the_direct_definition() {
        // Larger than a window, narrower than one, and a single pixel.
        for (width, height) in [(23, 17), (4, 30), (1, 1), (11, 11)] {
            let [a, b] = noisy_pair(width, height);
            let (fast, slow) = (ssim(&a, &b).unwrap(), direct(&a, &b));
            assert!(
                (fast - slow).abs() < 1e-9,
                "{width}x{height}: {fast} is not {slow}"
            );
            assert!(fast < 0.999, "{width}x{height}: the noise goes unnoticed");
            assert!((ssim(&a, &a).unwrap() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn even_pictures_differ_by_their_means() {
        let even = |level: u8| Picture {
            width: 8,
            height: 6,
            rgb: vec![[level; 3]; 48],
            drawn: vec![true; 48],
        };
        // (2 * 100 * 150 + 6.5025) / (100^2 + 150^2 + 6.5025), no variance.
        let expected = 30006.5025 / 32506.5025;
        let measured = ssim(&even(100), &even(150)).unwrap();
        assert!(
            (measured - expected).abs() < 1e-9,
            "{measured} is not {expected}"
        );
    }

    #[test]
    fn an_empty_frame_is_identical() {
        let empty = Picture {
            width: 0,
            height: 7,
            rgb: Vec::new(),
            drawn: Vec::new(),
        };
        assert_eq!(ssim(&empty, &empty), Ok(1.0));
    }
}
