//! Rays and the two shapes they meet: facets of a mesh and discs of a cloud.
//!
//! Everything is in scene space: the geometry's centre at the origin, its
//! radius 1. Shapes are stored in `f32` (error at most 2^-24 radii), rays and
//! every intersection are `f64`.
//!
//! Based on: Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, 2013.
//! Changes here: (1) the corners are projected along the ray on two axes
//! across it instead of being permuted and sheared; (2) `f64` makes the
//! fallback for zero edge functions superfluous.

use glam::{DVec2, DVec3, Vec3};

/// Which sides of a shape a ray meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sides {
    /// Front faces only: back faces are as if absent.
    Front,
    /// Both.
    Both,
}

/// A half-line with what every intersection needs of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub origin: DVec3,
    /// Any length but zero; distances are multiples of it.
    pub direction: DVec3,
    /// One over each component of the direction, at most 1e30 in size, so
    /// that no product with it is a NaN.
    pub inverse: DVec3,
    /// Two axes across the ray; their cross product points at the origin, so
    /// that front faces are counter-clockwise in them.
    across: [DVec3; 2],
    /// The direction over its squared length: measures distance.
    along: DVec3,
}

impl Ray {
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        let u = direction.any_orthogonal_vector().normalize();
        let invert = |d: f64| {
            if d.abs() < 1e-30 {
                1e30_f64.copysign(d)
            } else {
                1.0 / d
            }
        };
        Self {
            origin,
            direction,
            inverse: DVec3::new(
                invert(direction.x),
                invert(direction.y),
                invert(direction.z),
            ),
            across: [u, u.cross(direction).normalize()],
            along: direction / direction.length_squared(),
        }
    }

    /// The point at a distance.
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }
}

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// In multiples of the ray's direction, above 0.
    pub distance: f64,
    /// Whether it is the front that is met.
    pub front: bool,
}

/// A shape of a hierarchy.
pub(super) trait Shape: Send + Sync {
    /// A box around it: smallest and largest coordinates.
    fn bounds(&self) -> (Vec3, Vec3);
    /// Where the ray meets it, at a distance above 0.
    fn hit(&self, ray: &Ray, sides: Sides) -> Option<Hit>;
}

/// A triangle, counter-clockwise seen from its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    pub corners: [Vec3; 3],
    /// Its index in the mesh.
    pub source: u32,
}

impl Facet {
    /// Edge functions seen along the ray (twice the areas that the ray cuts
    /// the facet into, positive for a front face) and the corners' distances.
    ///
    /// A corner's projection depends on the corner and the ray alone, and an
    /// edge function changes its sign exactly when its ends are exchanged: two
    /// facets that share an edge never leave a gap along it.
    fn edges(&self, ray: &Ray) -> (DVec3, DVec3) {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3() - ray.origin);
        let flat = |v: DVec3| DVec2::new(v.dot(ray.across[0]), v.dot(ray.across[1]));
        let (p, q, r) = (flat(a), flat(b), flat(c));
        let edges = DVec3::new(q.perp_dot(r), r.perp_dot(p), p.perp_dot(q));
        let distances = DVec3::new(a.dot(ray.along), b.dot(ray.along), c.dot(ray.along));
        (edges, distances)
    }

    /// The corners' weights (sum 1) at the point that the ray meets.
    pub fn weights(&self, ray: &Ray) -> DVec3 {
        let (edges, _) = self.edges(ray);
        edges / edges.element_sum()
    }

    /// The point of the facet with these weights.
    pub fn point(&self, weights: DVec3) -> DVec3 {
        let [a, b, c] = self.corners.map(Vec3::as_dvec3);
        a * weights.x + b * weights.y + c * weights.z
    }

    /// Unit normal of the winding; zero for a degenerate facet.
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners.map(Vec3::as_dvec3);
        (b - a).cross(c - a).normalize_or_zero()
    }
}

impl Shape for Facet {
    fn bounds(&self) -> (Vec3, Vec3) {
        let [a, b, c] = self.corners;
        (a.min(b).min(c), a.max(b).max(c))
    }

    fn hit(&self, ray: &Ray, sides: Sides) -> Option<Hit> {
        let (edges, distances) = self.edges(ray);
        let inside =
            edges.min_element() >= 0.0 || (sides == Sides::Both && edges.max_element() <= 0.0);
        let area = edges.element_sum();
        if !inside || area == 0.0 {
            return None; // outside, culled, or seen exactly from its edge
        }
        let distance = edges.dot(distances) / area;
        (distance > 0.0).then_some(Hit {
            distance,
            front: area > 0.0,
        })
    }
}

/// An oriented disc: a point of a cloud with an extent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    pub centre: Vec3,
    /// Unit normal of the front.
    pub normal: Vec3,
    pub radius: f32,
    /// Index of its point.
    pub source: u32,
}

impl Disc {
    /// The normal turned to the side that a ray met.
    pub fn seen_normal(&self, hit: Hit) -> DVec3 {
        let normal = self.normal.as_dvec3();
        if hit.front { normal } else { -normal }
    }

    /// From 1 at the centre to 0 at the rim.
    pub fn weight(&self, point: DVec3) -> f64 {
        let squared = (point - self.centre.as_dvec3()).length_squared();
        (1.0 - squared / f64::from(self.radius).powi(2)).max(0.0)
    }
}

impl Shape for Disc {
    fn bounds(&self) -> (Vec3, Vec3) {
        let extent = (Vec3::ONE - self.normal * self.normal).max(Vec3::ZERO);
        let extent = self.radius * Vec3::new(extent.x.sqrt(), extent.y.sqrt(), extent.z.sqrt());
        (self.centre - extent, self.centre + extent)
    }

    fn hit(&self, ray: &Ray, sides: Sides) -> Option<Hit> {
        let normal = self.normal.as_dvec3();
        let fall = ray.direction.dot(normal);
        let front = fall < 0.0;
        if fall == 0.0 || (sides == Sides::Front && !front) {
            return None;
        }
        let to_centre = self.centre.as_dvec3() - ray.origin;
        let distance = to_centre.dot(normal) / fall;
        let offset = ray.direction * distance - to_centre;
        let inside = offset.length_squared() <= f64::from(self.radius).powi(2);
        (inside && distance > 0.0).then_some(Hit { distance, front })
    }
}
