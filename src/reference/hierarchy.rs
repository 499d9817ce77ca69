//! A bounding volume hierarchy: shapes in, hits out: the nearest,
//! any, or all.
//!
//! Binary, axis-aligned boxes, split by the surface area heuristic over
//! [`BINS`] bins on each axis. Nodes lie depth-first: an inner node's first
//! child follows it, its second is `link` nodes after it, so that subtrees
//! built side by side are joined by appending one to the other.

use std::array;

use glam::Vec3;

use super::ray::{Hit, Ray, Shape, Sides};

#[cfg(test)]
pub(super) mod tests;

/// Candidate splits on an axis, plus one.
const BINS: usize = 16;

/// No leaf holds more shapes than this.
const MAX_LEAF: usize = 8;

/// From this depth on, splits halve the shapes whatever their place: a tree of
/// `u32` many shapes is then at most [`STACK`] deep.
const HALVE_DEPTH: usize = 48;

/// Nodes that may wait while others are visited.
const STACK: usize = HALVE_DEPTH + 32;

/// Subtrees of at least so many shapes are built side by side.
const JOIN_SHAPES: usize = 8192;

/// Boxes grow by this on each side (coordinates are at most 1 in size): more
/// than `f64` slab tests and the `f32` of a disc's box can be wrong by.
const PAD: f32 = 1.0 / (1 << 22) as f32;

/// Cost of visiting a node relative to testing a shape.
const VISIT_COST: f32 = 0.7;

#[derive(Clone, Copy, Debug)]
struct Aabb {
    min: Vec3,
    max: Vec3,
}

impl Aabb {
    const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    fn join(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    fn with(self, point: Vec3) -> Self {
        self.join(Self {
            min: point,
            max: point,
        })
    }

    /// Half the surface; 0 when empty.
    fn area(self) -> f32 {
        let size = (self.max - self.min).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    min: Vec3,
    /// Shapes of a leaf; 0 in an inner node.
    count: u32,
    max: Vec3,
    /// A leaf's first shape; an inner node's distance to its second child.
    link: u32,
}

impl Node {
    fn new(bounds: Aabb, count: u32, link: u32) -> Self {
        Self {
            min: bounds.min - PAD,
            count,
            max: bounds.max + PAD,
            link,
        }
    }

    /// The distance at which the ray enters the box (0 from inside), or
    /// infinity where it misses the box or enters it beyond `limit`.
    fn entry(&self, ray: &Ray, limit: f64) -> f64 {
        let (mut near, mut far) = (0.0_f64, limit);
        for axis in 0..3 {
            let low = (f64::from(self.min[axis]) - ray.origin[axis]) * ray.inverse[axis];
            let high = (f64::from(self.max[axis]) - ray.origin[axis]) * ray.inverse[axis];
            let (enter, leave) = if low < high { (low, high) } else { (high, low) };
            near = if enter > near { enter } else { near };
            far = if leave < far { leave } else { far };
        }
        if near <= far { near } else { f64::INFINITY }
    }
}

/// A shape waiting for its leaf.
#[derive(Clone, Copy)]
struct Item {
    bounds: Aabb,
    middle: Vec3,
    index: u32,
}

/// Shapes in the order of their leaves, and the tree over them.
pub(super) struct Hierarchy<S> {
    nodes: Vec<Node>,
    shapes: Vec<S>,
}

impl<S: Shape + Copy> Hierarchy<S> {
    pub fn new(shapes: &[S]) -> Self {
        let mut items: Vec<Item> = shapes
            .iter()
            .zip(0..)
            .map(|(shape, index)| {
                let (min, max) = shape.bounds();
                Item {
                    bounds: Aabb { min, max },
                    middle: min.midpoint(max),
                    index,
                }
            })
            .collect();
        let nodes = if items.is_empty() {
            Vec::new()
        } else {
            build(&mut items, 0, 0)
        };
        Self {
            nodes,
            shapes: items
                .iter()
                .map(|item| shapes[item.index as usize])
                .collect(),
        }
    }

    /// The shapes, in the order of their leaves.
    #[cfg(test)]
    pub fn shapes(&self) -> &[S] {
        &self.shapes
    }

    /// The nearest hit and its shape.
    pub fn nearest(&self, ray: &Ray, sides: Sides) -> Option<(&S, Hit)> {
        let mut nearest: Option<(&S, Hit)> = None;
        self.visit(ray, f64::INFINITY, |shape, limit| {
            if let Some(hit) = shape.hit(ray, sides).filter(|hit| hit.distance < *limit) {
                *limit = hit.distance;
                nearest = Some((shape, hit));
            }
            false
        });
        nearest
    }

    /// Whether anything is on the ray, on either side.
    pub fn blocks(&self, ray: &Ray) -> bool {
        self.visit(ray, f64::INFINITY, |shape, _| {
            shape.hit(ray, Sides::Both).is_some()
        })
    }

    /// Every hit nearer than a distance, in no order.
    pub fn within(&self, ray: &Ray, sides: Sides, distance: f64) -> Vec<(&S, Hit)> {
        let mut hits = Vec::new();
        self.visit(ray, distance, |shape, _| {
            let hit = shape.hit(ray, sides);
            let near = hit.filter(|hit| hit.distance < distance);
            hits.extend(near.map(|hit| (shape, hit)));
            false
        });
        hits
    }

    /// Shows `test` the shapes whose boxes the ray meets before the limit, which
    /// `test` may lower, nearer boxes first, until it returns true.
    fn visit<'a>(
        &'a self,
        ray: &Ray,
        mut limit: f64,
        mut test: impl FnMut(&'a S, &mut f64) -> bool,
    ) -> bool {
        let Some(root) = self.nodes.first() else {
            return false;
        };
        let mut waiting = [(0_usize, root.entry(ray, limit)); STACK];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (index, entry) = waiting[depth];
            if entry >= limit {
                continue;
            }
            let node = &self.nodes[index];
            if node.count == 0 {
                let (mut near, mut far) = (index + 1, index + node.link as usize);
                let mut enter_near = self.nodes[near].entry(ray, limit);
                let mut enter_far = self.nodes[far].entry(ray, limit);
                if enter_far < enter_near {
                    (near, far) = (far, near);
                    (enter_near, enter_far) = (enter_far, enter_near);
                }
                waiting[depth] = (far, enter_far);
                depth += usize::from(enter_far < limit);
                waiting[depth] = (near, enter_near);
                depth += usize::from(enter_near < limit);
            } else {
                let first = node.link as usize;
                for shape in &self.shapes[first..first + node.count as usize] {
                    if test(shape, &mut limit) {
                        return true;
                    }
                }
            }
        }
        false
    }
}

/// The nodes of a subtree over `items`, which it sorts by leaf; the first of
/// them is shape number `first`.
fn build(items: &mut [Item], first: usize, depth: usize) -> Vec<Node> {
    let bounds = items
        .iter()
        .fold(Aabb::EMPTY, |all, item| all.join(item.bounds));
    let split = split(items, bounds, depth);
    if split == 0 {
        return vec![Node::new(bounds, items.len() as u32, first as u32)];
    }
    let large = items.len() >= JOIN_SHAPES;
    let (left, right) = items.split_at_mut(split);
    let mut build_left = || build(left, first, depth + 1);
    let mut build_right = || build(right, first + split, depth + 1);
    let (left, right) = if large {
        rayon::join(build_left, build_right)
    } else {
        (build_left(), build_right())
    };
    let mut nodes = vec![Node::new(bounds, 0, left.len() as u32 + 1)];
    nodes.extend(left);
    nodes.extend(right);
    nodes
}

/// Sorts the items into two sides and returns the size of the first side, or 0
/// where a leaf is best.
fn split(items: &mut [Item], bounds: Aabb, depth: usize) -> usize {
    let count = items.len();
    if count == 1 {
        return 0;
    }
    let middles = items
        .iter()
        .fold(Aabb::EMPTY, |all, item| all.with(item.middle));
    let size = middles.max - middles.min;
    if size.max_element() > 0.0 && depth < HALVE_DEPTH {
        let best = (0..3)
            .filter(|&axis| size[axis] > 0.0)
            .filter_map(|axis| best_on_axis(items, middles, axis))
            .min_by(|a, b| a.cost.total_cmp(&b.cost));
        if let Some(best) = best {
            let leaf_cost = count as f32 * bounds.area();
            if count <= MAX_LEAF && best.cost + VISIT_COST * bounds.area() >= leaf_cost {
                return 0;
            }
            let mut left = 0;
            for index in 0..count {
                if bin(items[index].middle, middles, best.axis) < best.bin {
                    items.swap(index, left);
                    left += 1;
                }
            }
            return left;
        }
    }
    if count <= MAX_LEAF {
        return 0;
    }
    let axis = size.max_position();
    let by_axis = |a: &Item, b: &Item| a.middle[axis].total_cmp(&b.middle[axis]);
    items.select_nth_unstable_by(count / 2, by_axis);
    count / 2
}

struct Split {
    axis: usize,
    /// The first bin of the second side.
    bin: usize,
    cost: f32,
}

/// The bin of a box's middle on an axis on which the middles differ.
fn bin(middle: Vec3, middles: Aabb, axis: usize) -> usize {
    let share = (middle[axis] - middles.min[axis]) / (middles.max[axis] - middles.min[axis]);
    ((share * BINS as f32) as usize).min(BINS - 1)
}

/// The cheapest split on an axis that leaves no side empty.
fn best_on_axis(items: &[Item], middles: Aabb, axis: usize) -> Option<Split> {
    let mut bins = [(0_u32, Aabb::EMPTY); BINS];
    for item in items {
        let (count, bounds) = &mut bins[bin(item.middle, middles, axis)];
        *count += 1;
        *bounds = bounds.join(item.bounds);
    }
    let mut from_right = (0, Aabb::EMPTY);
    let mut right: [(u32, f32); BINS] = array::from_fn(|_| (0, 0.0));
    for index in (1..BINS).rev() {
        from_right.0 += bins[index].0;
        from_right.1 = from_right.1.join(bins[index].1);
        right[index] = (from_right.0, from_right.1.area());
    }
    let mut left = (0, Aabb::EMPTY);
    let mut best: Option<Split> = None;
    for (index, &(right_count, right_area)) in right.iter().enumerate().skip(1) {
        left.0 += bins[index - 1].0;
        left.1 = left.1.join(bins[index - 1].1);
        let cost = left.0 as f32 * left.1.area() + right_count as f32 * right_area;
        let better = best.as_ref().is_none_or(|best| cost < best.cost);
        if left.0 > 0 && right_count > 0 && better {
            best = Some(Split {
                axis,
                bin: index,
                cost,
            });
        }
    }
    best
}
