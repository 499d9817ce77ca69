//! How far apart the points of a cloud are, and how large discs must be to
//! close its surface.
//!
//! *Spacing* of a point: the distance to its [`NEIGHBOURS`]-th nearest other
//! position. A disc's radius is [`RADIUS_PER_SPACING`] times that. On a square
//! lattice of pitch 1 the spacing is 1.41 and 0.71 would close the surface;
//! on a random scatter a spot is missed by every disc with a probability of
//! about exp(-8).

use glam::Vec3;
use rayon::prelude::*;

use crate::nearest::{Nearest, Places};

/// Neighbours that count, the point itself and its doubles apart.
const NEIGHBOURS: usize = 8;

/// Disc radius over spacing.
const RADIUS_PER_SPACING: f32 = 1.0;

/// A point's spacing counts at most this many times the median spacing of its
/// neighbours: a few stray points far from a surface stay small.
const STRAY_LIMIT: f32 = 2.0;

/// Disc radii in the order of the points. A cloud without two distinct
/// positions has no spacing: its radii are 0.
pub(crate) fn disc_radii(points: &[Vec3]) -> Vec<f32> {
    let places = Places::new(points);
    let near = places.neighbours::<NEIGHBOURS>();
    let radius = |index: usize| RADIUS_PER_SPACING * capped_spacing(&near, index);
    points
        .par_iter()
        .map(|point| places.find(point).map_or(0.0, radius))
        .collect()
}

/// A position's spacing, or less if it is a stray.
pub(crate) fn capped_spacing<const N: usize>(near: &[Nearest<N>], index: usize) -> f32 {
    let nearest = &near[index];
    let mut around = [0.0; N];
    for (spacing, &(_, other)) in around.iter_mut().zip(nearest.found()) {
        *spacing = near[other as usize].spacing();
    }
    let around = &mut around[..nearest.found().len()];
    around.sort_unstable_by(f32::total_cmp);
    // The lower one of two.
    let median = around.get(around.len().saturating_sub(1) / 2);
    nearest.spacing().min(STRAY_LIMIT * median.unwrap_or(&0.0))
}

#[cfg(test)]
mod tests {
    use super::super::hierarchy::tests::Random;
    use super::*;

    #[test]
    fn radii_follow_the_spacing() {
        // A lattice of pitch 0.5 with a double, and a stray point far off.
        let mut points: Vec<Vec3> = (0..400)
            .map(|i| Vec3::new((i % 20) as f32, (i / 20) as f32, -0.0) * 0.5)
            .collect();
        points.push(points[210] * Vec3::new(1.0, 1.0, -1.0));
        points.push(Vec3::new(5.0, 5.0, 40.0));
        let radii = disc_radii(&points);
        let diagonal = 0.5 * 2.0_f32.sqrt();
        assert!((radii[210] - diagonal).abs() < 1e-5, "{}", radii[210]);
        assert_eq!(radii[400], radii[210]);
        assert!(radii.iter().all(|&radius| radius <= 3.0), "{}", radii[401]);

        // The spacing of a scatter, point by point.
        let mut random = Random(5);
        let points: Vec<Vec3> = (0..500).map(|_| random.vector().as_vec3()).collect();
        for (&point, radius) in points.iter().zip(disc_radii(&points)) {
            let mut distances: Vec<f32> =
                points.iter().map(|other| other.distance(point)).collect();
            distances.sort_by(f32::total_cmp);
            assert!((radius - distances[8]).abs() < 1e-6, "{point}: {radius}");
        }
        assert_eq!(disc_radii(&[Vec3::ONE; 3]), [0.0; 3]);
        assert!(disc_radii(&[]).is_empty());
    }
}
