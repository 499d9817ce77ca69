//! Polygons in any plane to triangles by ear clipping.
//!
//! Based on: G. H. Meisters, Polygons Have Ears, 1975; the polygon's plane is
//! the one of its Newell normal. Holes come as keyholes (a bridge walked both
//! ways), so vertices may coincide and edges may touch. The result depends on
//! the order of the vertices alone.

use glam::{DVec2, DVec3};

/// A Newell normal this short, relative to the square of the polygon's size,
/// is rounding noise.
const FLATNESS: f64 = 1e-12;

/// Vertices looked at for one polygon before it counts as too intricate: a
/// second or so, enough for 10,000 vertices of any shape.
const SEARCH_BUDGET: u64 = 1 << 28;

/// Cuts a polygon into triangles of indices into `ring`, wound as the ring.
/// Empty when the polygon has no area. A polygon that crosses itself gives
/// some triangles over its vertices. `None` when the search takes too long.
pub(super) fn triangulate(ring: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let kept = without_repeats(ring);
    let sound = |corners: &[usize; 3]| has_area(ring, *corners);
    let Some(plane) = flatten(ring, &kept) else {
        return Some(fan(&kept).filter(sound).collect());
    };
    if is_convex(&plane) {
        return Some(fan(&kept).collect());
    }
    let (ears, rest) = Clipper::new(&plane).clip()?;
    let rest: Vec<usize> = rest.into_iter().map(|i| kept[i]).collect();
    let ears = ears.into_iter().map(|ear| ear.map(|i| kept[i]));
    Some(ears.chain(fan(&rest).filter(sound)).collect())
}

/// Indices of `ring` without vertices that repeat their predecessor.
fn without_repeats(ring: &[DVec3]) -> Vec<usize> {
    let before = |i: usize| ring[i.checked_sub(1).unwrap_or(ring.len() - 1)];
    (0..ring.len()).filter(|&i| ring[i] != before(i)).collect()
}

/// The triangles from the first vertex.
fn fan(ring: &[usize]) -> impl Iterator<Item = [usize; 3]> {
    ring.windows(2)
        .skip(1)
        .map(|edge| [ring[0], edge[0], edge[1]])
}

/// Whether three vertices span a triangle, judged in space.
fn has_area(ring: &[DVec3], [a, b, c]: [usize; 3]) -> bool {
    super::normals::face_normal([ring[a], ring[b], ring[c]]).is_some()
}

/// The kept vertices in the plane's own coordinates, counter-clockwise, or
/// `None` without area. Dropping the axis closest to the normal keeps
/// coordinates exact, and sidedness is all that clipping asks for.
fn flatten(ring: &[DVec3], kept: &[usize]) -> Option<Vec<DVec2>> {
    let origin = ring[*kept.first()?];
    let local = |i: &usize| ring[*i] - origin;
    let following = kept.iter().skip(1).chain(kept.first());
    let normal: DVec3 = kept
        .iter()
        .zip(following)
        .map(|(a, b)| local(a).cross(local(b)))
        .sum();
    let size = kept
        .iter()
        .map(|i| local(i).length_squared())
        .fold(0.0, f64::max);
    let DVec3 { x, y, z } = normal.abs();
    if x.max(y).max(z) <= FLATNESS * size {
        return None;
    }
    let (side, plane): (f64, fn(DVec3) -> DVec2) = if z >= x && z >= y {
        (normal.z, |p| DVec2::new(p.x, p.y))
    } else if x >= y {
        (normal.x, |p| DVec2::new(p.y, p.z))
    } else {
        (normal.y, |p| DVec2::new(p.z, p.x))
    };
    let facing = |p: DVec2| if side < 0.0 { DVec2::new(p.y, p.x) } else { p };
    Some(kept.iter().map(|i| facing(plane(local(i)))).collect())
}

/// Twice the signed area of a triangle: positive for counter-clockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether every corner turns left and the ring winds once: the x direction
/// of a convex ring's edges changes sign twice, that of a star more often.
fn is_convex(ring: &[DVec2]) -> bool {
    let n = ring.len();
    let at = |i: usize| ring[i % n];
    let left = (0..n).all(|i| turn(at(i), at(i + 1), at(i + 2)) > 0.0);
    let rightward =
        |i: usize| at(i + 1).x > at(i).x || (at(i + 1).x == at(i).x && at(i + 1).y > at(i).y);
    left && (0..n).filter(|&i| rightward(i) != rightward(i + 1)).count() == 2
}

/// What an ear may contain, from careful to desperate.
#[derive(Clone, Copy, PartialEq)]
enum Rule {
    /// No other vertex, not even on its border.
    Clear,
    /// No other vertex in its inside.
    Touching,
    /// Anything: for rings that cross themselves.
    Any,
}

/// Ears in the order of cutting, and the ring that is left.
type Clipped = (Vec<[usize; 3]>, Vec<usize>);

/// A ring of which ears are cut.
struct Clipper<'a> {
    points: &'a [DVec2],
    previous: Vec<usize>,
    next: Vec<usize>,
    /// A vertex that kept this one from being an ear, if one did.
    witnesses: Vec<Option<usize>>,
    is_cut: Vec<bool>,
    budget: u64,
}

impl<'a> Clipper<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let n = points.len();
        Self {
            points,
            previous: (0..n).map(|i| (i + n - 1) % n).collect(),
            next: (0..n).map(|i| (i + 1) % n).collect(),
            witnesses: vec![None; n],
            is_cut: vec![false; n],
            budget: SEARCH_BUDGET,
        }
    }

    /// Cuts ears until one triangle is left, or more corners when nothing in
    /// the ring turns left. `None` when the budget is spent.
    fn clip(mut self) -> Option<Clipped> {
        let mut ears = Vec::new();
        let (mut here, mut left, mut seen, mut rule) = (0, self.points.len(), 0, Rule::Clear);
        while left > 3 {
            if self.is_ear(here, rule)? {
                ears.push([self.previous[here], here, self.next[here]]);
                here = self.cut(here);
                (left, seen) = (left - 1, 0);
                self.set_rule(&mut rule, Rule::Clear);
            } else {
                here = self.next[here];
                seen += 1;
            }
            if seen == left {
                seen = 0;
                match rule {
                    Rule::Clear => self.set_rule(&mut rule, Rule::Touching),
                    Rule::Touching => self.set_rule(&mut rule, Rule::Any),
                    Rule::Any => break,
                }
            }
        }
        let rest = std::iter::successors(Some(here), |&i| Some(self.next[i]));
        Some((ears, rest.take(left).collect()))
    }

    /// Takes a vertex out. Returns the one to go on with: past the neighbour,
    /// so that the next ear is not a sliver beside this one.
    fn cut(&mut self, here: usize) -> usize {
        let (before, after) = (self.previous[here], self.next[here]);
        self.next[before] = after;
        self.previous[after] = before;
        self.is_cut[here] = true;
        self.witnesses[before] = None;
        self.witnesses[after] = None;
        self.next[after]
    }

    fn set_rule(&mut self, rule: &mut Rule, new: Rule) {
        if *rule != new {
            *rule = new;
            self.witnesses.fill(None);
        }
    }

    fn is_ear(&mut self, here: usize, rule: Rule) -> Option<bool> {
        self.budget = self.budget.checked_sub(1)?;
        if !self.is_left(here) {
            return Some(false);
        }
        if rule == Rule::Any {
            return Some(true);
        }
        // Still in the ring, and still turning right: still in the way.
        if self.witnesses[here].is_some_and(|i| !self.is_cut[i] && !self.is_left(i)) {
            return Some(false);
        }
        let corners = [self.previous[here], here, self.next[here]];
        let [a, b, c] = corners.map(|i| self.points[i]);
        let mut i = self.next[corners[2]];
        while i != corners[0] {
            self.budget = self.budget.checked_sub(1)?;
            let p = self.points[i];
            // A vertex at a corner is the other end of a keyhole's bridge.
            let elsewhere = p != a && p != b && p != c;
            if elsewhere && is_inside(p, [a, b, c], rule) && !self.is_left(i) {
                self.witnesses[here] = Some(i);
                return Some(false);
            }
            i = self.next[i];
        }
        Some(true)
    }

    /// Whether the ring turns left at a vertex; one that does cannot be the
    /// only vertex inside an ear.
    fn is_left(&self, i: usize) -> bool {
        turn(
            self.points[self.previous[i]],
            self.points[i],
            self.points[self.next[i]],
        ) > 0.0
    }
}

fn is_inside(p: DVec2, [a, b, c]: [DVec2; 3], rule: Rule) -> bool {
    let smallest = turn(a, b, p).min(turn(b, c, p)).min(turn(c, a, p));
    if rule == Rule::Clear {
        smallest >= 0.0
    } else {
        smallest > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]], lift: fn(f64, f64) -> DVec3) -> Vec<DVec3> {
        points.iter().map(|&[x, y]| lift(x, y)).collect()
    }

    fn double_area(ring: &[DVec3], triangles: &[[usize; 3]]) -> (DVec3, f64) {
        let cross = |t: &[usize; 3]| (ring[t[1]] - ring[t[0]]).cross(ring[t[2]] - ring[t[0]]);
        (
            triangles.iter().map(cross).sum(),
            triangles.iter().map(|t| cross(t).length()).sum(),
        )
    }

    /// Triangles cover the polygon once: their areas sum to the shoelace area,
    /// and none is turned over.
    fn assert_covers(ring: &[DVec3]) {
        let triangles = triangulate(ring).unwrap();
        let whole: DVec3 = (0..ring.len())
            .map(|i| ring[i].cross(ring[(i + 1) % ring.len()]))
            .sum();
        let (directed, plain) = double_area(ring, &triangles);
        let scale = whole.length();
        assert!(
            (directed - whole).length() < 1e-9 * scale,
            "{:?}",
            &ring[..ring.len().min(20)]
        );
        assert!(
            (plain - scale).abs() < 1e-9 * scale,
            "{:?}",
            &ring[..ring.len().min(20)]
        );
    }

    const LIFTS: [fn(f64, f64) -> DVec3; 4] = [
        |x, y| DVec3::new(x, y, 5.0),
        |x, y| DVec3::new(5.0, y, x),
        |x, y| DVec3::new(x + y, x - y, 2.0 * x + 3.0 * y),
        |x, y| DVec3::new(y * 1e-3 + 4e3, x * 1e-3, 1e-3 * x),
    ];

    #[test]
    fn concave_rings_are_covered_once() {
        let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
        let comb = [
            [0.0, 0.0],
            [7.0, 0.0],
            [7.0, 3.0],
            [6.0, 3.0],
            [6.0, 1.0],
            [5.0, 1.0],
            [5.0, 3.0],
            [4.0, 3.0],
            [4.0, 1.0],
            [3.0, 1.0],
            [3.0, 3.0],
            [0.0, 3.0],
        ];
        // A square with a square hole, walked through a bridge.
        let keyhole = [
            [0.0, 0.0],
            [9.0, 0.0],
            [9.0, 9.0],
            [0.0, 9.0],
            [0.0, 0.0],
            [3.0, 3.0],
            [3.0, 6.0],
            [6.0, 6.0],
            [6.0, 3.0],
            [3.0, 3.0],
        ];
        let collinear = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [2.0, 2.0],
            [0.0, 2.0],
        ];
        let repeated = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 0.0],
            [1.0, 1.0],
            [2.0, 2.0],
            [0.0, 2.0],
        ];
        let touching = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]];
        for lift in LIFTS {
            for points in [
                &arrow[..],
                &comb,
                &keyhole,
                &collinear,
                &repeated,
                &touching,
            ] {
                let mut ring = ring(points, lift);
                for _ in 0..points.len() {
                    assert_covers(&ring);
                    ring.rotate_left(1);
                }
                ring.reverse();
                assert_covers(&ring);
            }
        }
    }

    #[test]
    fn rings_without_area_give_nothing() {
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]];
        for lift in &LIFTS[..3] {
            assert_eq!(triangulate(&ring(&line, *lift)), Some(vec![]));
            assert_eq!(triangulate(&ring(&[[1.0, 1.0]; 5], *lift)), Some(vec![]));
        }
        assert_eq!(triangulate(&[]), Some(vec![]));
    }

    #[test]
    fn crossing_rings_end_with_some_triangles() {
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let star: Vec<[f64; 2]> = (0..5)
            .map(|i| f64::from(i) * 4.0 * std::f64::consts::PI / 5.0)
            .map(|angle| [angle.cos(), angle.sin()])
            .collect();
        for lift in LIFTS {
            assert!(!triangulate(&ring(&bow_tie, lift)).unwrap().is_empty());
            assert!(!triangulate(&ring(&star, lift)).unwrap().is_empty());
        }
    }

    #[test]
    fn a_ring_of_ten_thousand_vertices_is_covered() {
        let zigzag = (0..5000).map(|i| [f64::from(i), f64::from(i % 2)]);
        let back = (0..5000)
            .rev()
            .map(|i| [f64::from(i), f64::from(i % 2) + 0.5]);
        assert_covers(&ring(&zigzag.chain(back).collect::<Vec<_>>(), LIFTS[0]));
    }
    #[test]
    fn a_search_without_end_is_given_up() {
        let zigzag = (0..100_000).map(|i| [f64::from(i), f64::from(i % 2)]);
        let back = (0..100_000)
            .rev()
            .map(|i| [f64::from(i), f64::from(i % 2) + 0.5]);
        let ring = ring(&zigzag.chain(back).collect::<Vec<_>>(), LIFTS[0]);
        assert_eq!(triangulate(&ring), None);
    }
}
