//! How far apart the points of a cloud are, and how large discs must be to
//! close its surface.
//!
//! *Spacing* of a point: the distance to its [`NEIGHBOURS`]-th nearest other
//! position. A disc's radius is [`RADIUS_PER_SPACING`] times that. On a square
//! lattice of pitch 1 the spacing is 1.41 and 0.71 would close the surface;
//! on a random scatter a spot is missed by every disc with a probability of
//! about exp(-8).

use std::cmp::Ordering;

use glam::Vec3;
use rayon::prelude::*;

/// Neighbours that count, the point itself and its doubles apart.
const NEIGHBOURS: usize = 8;

/// Disc radius over spacing.
const RADIUS_PER_SPACING: f32 = 1.0;

/// A point's spacing counts at most this many times the largest spacing among
/// its neighbours: a stray point far from a surface stays small.
const STRAY_LIMIT: f32 = 2.0;

/// Below so many points a subtree is searched point by point.
const LEAF_POINTS: usize = 8;

/// Disc radii in the order of the points. A cloud without two distinct
/// positions has no spacing: its radii are 0.
pub(crate) fn disc_radii(points: &[Vec3]) -> Vec<f32> {
    // Adding zero turns -0 into 0, so that equal positions have equal bits.
    let place = |point: &Vec3| *point + Vec3::ZERO;
    let mut distinct: Vec<Vec3> = points.iter().map(place).collect();
    distinct.par_sort_unstable_by(order);
    distinct.dedup();

    let mut tree: Vec<(Vec3, u32)> = distinct.iter().copied().zip(0..).collect();
    arrange(&mut tree, 0);
    let near: Vec<Nearest> = (0..distinct.len() as u32)
        .into_par_iter()
        .map(|index| {
            let mut nearest = Nearest::default();
            search(&tree, 0, (distinct[index as usize], index), &mut nearest);
            nearest
        })
        .collect();
    let radius = |nearest: &Nearest| {
        let around = nearest
            .found()
            .iter()
            .map(|&(_, other)| near[other as usize].spacing());
        let limit = STRAY_LIMIT * around.fold(0.0, f32::max);
        RADIUS_PER_SPACING * nearest.spacing().min(limit)
    };
    points
        .par_iter()
        .map(|point| {
            let found = distinct.binary_search_by(|known| order(known, &place(point)));
            found.map_or(0.0, |index| radius(&near[index]))
        })
        .collect()
}

fn order(a: &Vec3, b: &Vec3) -> Ordering {
    let by_xy = a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
    by_xy.then(a.z.total_cmp(&b.z))
}

/// Arranges points as a k-d tree: the middle one parts the others on the axis
/// of its depth, and so on in both halves.
fn arrange(points: &mut [(Vec3, u32)], depth: usize) {
    if points.len() <= LEAF_POINTS {
        return;
    }
    let axis = depth % 3;
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
    let (left, right) = points.split_at_mut(middle);
    arrange(left, depth + 1);
    arrange(&mut right[1..], depth + 1);
}

/// Offers all points of an arranged subtree that may be among the nearest.
fn search(points: &[(Vec3, u32)], depth: usize, from: (Vec3, u32), nearest: &mut Nearest) {
    let offer = |&(point, index): &(Vec3, u32), nearest: &mut Nearest| {
        if index != from.1 {
            nearest.offer(point.distance_squared(from.0), index);
        }
    };
    if points.len() <= LEAF_POINTS {
        points.iter().for_each(|point| offer(point, nearest));
        return;
    }
    let axis = depth % 3;
    let middle = points.len() / 2;
    let beyond = from.0[axis] - points[middle].0[axis];
    let (left, right) = (&points[..middle], &points[middle + 1..]);
    let (near, far) = if beyond < 0.0 {
        (left, right)
    } else {
        (right, left)
    };
    search(near, depth + 1, from, nearest);
    offer(&points[middle], nearest);
    if beyond * beyond < nearest.reach() {
        search(far, depth + 1, from, nearest);
    }
}

/// The nearest positions found so far: squared distance and index, ascending.
#[derive(Clone, Copy, Default)]
struct Nearest {
    list: [(f32, u32); NEIGHBOURS],
    count: usize,
}

impl Nearest {
    fn found(&self) -> &[(f32, u32)] {
        &self.list[..self.count]
    }

    fn spacing(&self) -> f32 {
        self.found().last().map_or(0.0, |last| last.0.sqrt())
    }

    /// Squared distance from which on nothing is of interest.
    fn reach(&self) -> f32 {
        if self.count < NEIGHBOURS {
            f32::INFINITY
        } else {
            self.list[NEIGHBOURS - 1].0
        }
    }

    fn offer(&mut self, squared: f32, index: u32) {
        let place = self.found().partition_point(|known| known.0 <= squared);
        if place < NEIGHBOURS {
            self.count = (self.count + 1).min(NEIGHBOURS);
            self.list[place..self.count].rotate_right(1);
            self.list[place] = (squared, index);
        }
    }
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
