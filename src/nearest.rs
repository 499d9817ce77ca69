//! Nearest neighbours in a set of points: a k-d tree of distinct positions.
//!
//! Based on: J. L. Bentley, Multidimensional Binary Search Trees Used for
//! Associative Searching, 1975. The tree is built by one thread and read by
//! any number: the same points give the same answers everywhere.

use std::cmp::Ordering;

use glam::Vec3;
use rayon::prelude::*;

/// Below so many points a subtree is searched point by point.
const LEAF_POINTS: usize = 8;

/// The distinct positions of a set of points, ready for searching.
pub struct Places {
    /// Ascending.
    distinct: Vec<Vec3>,
    /// The same with their places, arranged as a tree.
    tree: Vec<(Vec3, u32)>,
}

impl Places {
    /// Sorts and arranges finite points, fewer than 2^32.
    pub fn new(points: &[Vec3]) -> Self {
        let mut distinct: Vec<Vec3> = points.iter().map(same_zero).collect();
        distinct.par_sort_unstable_by(order);
        distinct.dedup();
        let mut tree: Vec<(Vec3, u32)> = distinct.iter().copied().zip(0..).collect();
        arrange(&mut tree, 0);
        Self { distinct, tree }
    }

    /// The distinct positions, by x, then y, then z.
    pub fn distinct(&self) -> &[Vec3] {
        &self.distinct
    }

    /// The place of a position among the distinct ones.
    pub fn find(&self, point: &Vec3) -> Option<usize> {
        let found = self
            .distinct
            .binary_search_by(|known| order(known, &same_zero(point)));
        found.ok()
    }

    /// The `N` distinct positions nearest to each, in the order of
    /// [`Places::distinct`].
    pub fn neighbours<const N: usize>(&self) -> Vec<Nearest<N>> {
        let places = self.distinct.par_iter().zip(0..self.distinct.len() as u32);
        places
            .map(|(&point, index)| {
                let mut nearest = Nearest::default();
                search(&self.tree, 0, (point, index), &mut nearest);
                nearest
            })
            .collect()
    }
}

/// Adding zero turns -0 into 0, so that equal positions have equal bits.
fn same_zero(point: &Vec3) -> Vec3 {
    *point + Vec3::ZERO
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
fn search<const N: usize>(
    points: &[(Vec3, u32)],
    depth: usize,
    from: (Vec3, u32),
    nearest: &mut Nearest<N>,
) {
    let offer = |&(point, index): &(Vec3, u32), nearest: &mut Nearest<N>| {
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

/// The nearest positions found: squared distance and place, ascending.
#[derive(Clone, Copy)]
pub struct Nearest<const N: usize> {
    list: [(f32, u32); N],
    count: usize,
}

impl<const N: usize> Default for Nearest<N> {
    fn default() -> Self {
        Self {
            list: [(0.0, 0); N],
            count: 0,
        }
    }
}

impl<const N: usize> Nearest<N> {
    /// Fewer than `N` where there are no more.
    pub fn found(&self) -> &[(f32, u32)] {
        &self.list[..self.count]
    }

    /// Distance of the farthest of them; 0 without any.
    pub fn spacing(&self) -> f32 {
        self.found().last().map_or(0.0, |last| last.0.sqrt())
    }

    /// Squared distance from which on nothing is of interest.
    fn reach(&self) -> f32 {
        if self.count < N {
            f32::INFINITY
        } else {
            self.list[N - 1].0
        }
    }

    fn offer(&mut self, squared: f32, index: u32) {
        let place = self.found().partition_point(|known| known.0 <= squared);
        if place < N {
            self.count = (self.count + 1).min(N);
            self.list[place..self.count].rotate_right(1);
            self.list[place] = (squared, index);
        }
    }
}
