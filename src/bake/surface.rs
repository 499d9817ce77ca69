//! What a baker needs to know of geometry.
//!
//! Source: Duguet and Drettakis 2003, 4.1 (IntersectAxisAlignedBox and
//! GetSampleAt for a geometry primitive). Coordinates are those of the cube:
//! centred, half side one.

use glam::{DVec3, Vec3};
use rhogrid_core::asset::Rgb;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// A cube around a centre.
    pub fn cube(centre: DVec3, half_side: f64) -> Self {
        Self {
            min: centre - half_side,
            max: centre + half_side,
        }
    }

    /// Whether two closed boxes share a point.
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Squared distance of a point from the box.
    pub fn distance_squared(&self, point: DVec3) -> f64 {
        (point.clamp(self.min, self.max) - point).length_squared()
    }
}

/// A point of a surface with its attributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The point itself.
    pub point: DVec3,
    /// Squared distance from the point that was asked for.
    pub distance_squared: f64,
    /// Unit shading normal.
    pub normal: Vec3,
    /// Material index.
    pub material: u8,
    /// Colour: the material's where geometry has no others.
    pub colour: Rgb,
}

/// Geometry made of primitives, numbered from zero.
pub trait Surface: Sync {
    /// Number of primitives.
    fn count(&self) -> u32;
    /// Bounds of a primitive.
    fn bounds(&self, primitive: u32) -> Aabb;
    /// Whether a primitive touches a closed box (the paper's
    /// IntersectAxisAlignedBox).
    fn touches(&self, primitive: u32, cell: &Aabb) -> bool;
    /// The point of a primitive that is nearest to `point` (the paper's
    /// GetSampleAt).
    fn sample_at(&self, primitive: u32, point: DVec3) -> Sample;
    /// The direction that a primitive faces, if it has one.
    fn facing(&self, primitive: u32) -> Option<Vec3>;
}
