//! Signs of normals: one side for all points that hang together.
//!
//! Based on: H. Hoppe, T. DeRose, T. Duchamp, J. McDonald and W. Stuetzle,
//! Surface Reconstruction from Unorganized Points, 1992: the sign travels
//! along a minimum spanning tree of the neighbour graph, over those edges
//! first across which normals tell most. Changes here:
//! 1. Two normals agree if one is the other's mirror image in the plane
//!    between their points (H. Xie et al., Piecewise C1 Continuous Surface
//!    Reconstruction of Noisy Point Clouds via Local Implicit Quadric
//!    Regression, 2003): right for flat parts as before, and for edges of 90
//!    degrees and for the two sides of a plate, too.
//! 2. An edge's weight grows with the square of its slope against the tangent planes, so
//!    that signs go along a surface before they cross to one close to it, or
//!    between points that noise has set above each other.
//! 3. A forest of sets with signs (Kruskal) takes the place of the walk.

use glam::DVec3;
use rayon::prelude::*;

use crate::nearest::Nearest;

/// An edge whose weight is below this says clearly whether its ends agree.
const CLEAR: f32 = 0.5;

/// Normals with one sign in each component.
pub struct Oriented {
    /// Sign of each normal: 1 or -1.
    pub signs: Vec<f64>,
    /// Component of each, counted from 0.
    pub components: Vec<u32>,
    /// How many components there are.
    pub count: usize,
    /// Share of the clear edges whose ends face opposite sides.
    pub torn: f64,
}

/// Two neighbours.
#[derive(Clone, Copy)]
struct Edge {
    /// Small where the sign is sure.
    weight: f32,
    ends: [u32; 2],
    agree: bool,
}

/// Orients unit normals along the neighbour graph.
pub fn orient<const N: usize>(
    points: &[DVec3],
    normals: &[DVec3],
    near: &[Nearest<N>],
) -> Oriented {
    let mut edges = edges(points, normals, near);
    edges.par_sort_unstable_by(|a, b| a.weight.total_cmp(&b.weight).then(a.ends.cmp(&b.ends)));
    let mut forest = Forest::new(points.len());
    for edge in &edges {
        forest.join(edge);
    }
    let found: Vec<(u32, bool)> = (0..points.len() as u32).map(|i| forest.find(i)).collect();
    let turned = |end: u32| found[end as usize].1;
    let is_torn = |edge: &&Edge| (turned(edge.ends[0]) == turned(edge.ends[1])) != edge.agree;
    let clear = &edges[..edges.partition_point(|edge| edge.weight < CLEAR)];
    let torn = clear.par_iter().filter(is_torn).count() as f64 / clear.len().max(1) as f64;
    let mut numbers = vec![u32::MAX; points.len()];
    let mut count = 0;
    let components = found.iter().map(|&(root, _)| {
        let number = &mut numbers[root as usize];
        if *number == u32::MAX {
            *number = count;
            count += 1;
        }
        *number
    });
    Oriented {
        components: components.collect(),
        signs: found
            .iter()
            .map(|&(_, turned)| if turned { -1.0 } else { 1.0 })
            .collect(),
        count: count as usize,
        torn,
    }
}

/// Each pair once, if either is a neighbour of the other.
fn edges<const N: usize>(points: &[DVec3], normals: &[DVec3], near: &[Nearest<N>]) -> Vec<Edge> {
    let knows = |from: u32, to: u32| {
        let found = near[from as usize].found();
        found.iter().any(|&(_, other)| other == to)
    };
    (0..points.len() as u32)
        .into_par_iter()
        .flat_map_iter(|from| {
            let others = near[from as usize].found().iter().map(|&(_, other)| other);
            others
                .filter(move |&to| from < to || !knows(to, from))
                .map(move |to| edge(points, normals, [from.min(to), from.max(to)]))
        })
        .collect()
}

fn edge(points: &[DVec3], normals: &[DVec3], ends: [u32; 2]) -> Edge {
    let [a, b] = ends.map(|end| normals[end as usize]);
    let [from, to] = ends.map(|end| points[end as usize]);
    let along = (to - from).normalize_or_zero();
    let (slope_a, slope_b) = (along.dot(a), along.dot(b));
    let cosine = a.dot(b) - 2.0 * slope_a * slope_b;
    let slope = slope_a.abs().max(slope_b.abs());
    let weight = 1.0 - cosine.abs() + slope * slope;
    Edge {
        weight: weight as f32,
        ends,
        agree: cosine >= 0.0,
    }
}

/// Disjoint sets whose members are turned over or not against their root.
struct Forest {
    /// Parent, and whether turned against it; roots are their own.
    parents: Vec<(u32, bool)>,
    sizes: Vec<u32>,
}

impl Forest {
    fn new(count: usize) -> Self {
        Self {
            parents: (0..count as u32).map(|i| (i, false)).collect(),
            sizes: vec![1; count],
        }
    }

    /// The root, and whether turned against it. Paths are halved on the way.
    fn find(&mut self, mut member: u32) -> (u32, bool) {
        let mut turned = false;
        loop {
            let (parent, by_parent) = self.parents[member as usize];
            if parent == member {
                return (member, turned);
            }
            let (grandparent, by_grandparent) = self.parents[parent as usize];
            let both = by_parent != by_grandparent;
            self.parents[member as usize] = (grandparent, both);
            (member, turned) = (grandparent, turned != both);
        }
    }

    /// Joins the sets of an edge's ends, so that these agree or disagree.
    fn join(&mut self, edge: &Edge) {
        let [(a, turned_a), (b, turned_b)] = edge.ends.map(|end| self.find(end));
        if a == b {
            return;
        }
        let (small, large) = if self.sizes[a as usize] < self.sizes[b as usize] {
            (a, b)
        } else {
            (b, a)
        };
        let turned = (turned_a != turned_b) == edge.agree;
        self.parents[small as usize] = (large, turned);
        self.sizes[large as usize] += self.sizes[small as usize];
    }
}
