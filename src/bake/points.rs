//! An oriented cloud as a surface: points in the cube's coordinates.

use glam::{DVec3, Vec3};

use super::Cube;
use super::surface::{Aabb, Sample, Surface};
use crate::geometry::{Cloud, OrientedPoint};

/// The points of a cloud.
pub(super) struct CloudSurface {
    points: Vec<OrientedPoint>,
}

impl CloudSurface {
    /// Moves a cloud into the cube.
    pub fn new(cloud: &Cloud, cube: &Cube) -> Self {
        let points = cloud.points.iter().map(|point| OrientedPoint {
            position: (point.position - cube.centre) / cube.half_side,
            normal: point.normal,
        });
        Self {
            points: points.collect(),
        }
    }

    fn point(&self, primitive: u32) -> &OrientedPoint {
        &self.points[primitive as usize]
    }
}

impl Surface for CloudSurface {
    fn count(&self) -> u32 {
        self.points.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Aabb {
        Aabb::cube(self.point(primitive).position, 0.0)
    }

    fn touches(&self, primitive: u32, cell: &Aabb) -> bool {
        self.bounds(primitive).meets(cell)
    }

    fn sample_at(&self, primitive: u32, point: DVec3) -> Sample {
        let own = self.point(primitive);
        Sample {
            distance_squared: (own.position - point).length_squared(),
            normal: own.normal,
            material: 0,
        }
    }

    fn facing(&self, primitive: u32) -> Option<Vec3> {
        Some(self.point(primitive).normal)
    }
}
