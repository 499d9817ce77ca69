//! An oriented cloud as a surface: square tiles in the cube's coordinates,
//! one around each point, large enough to close the surface.

use glam::{DVec3, Vec3};
use rhogrid_core::asset::Rgb;

use super::Cube;
use super::overlap::triangle_touches;
use super::surface::{Aabb, Sample, Surface};
use crate::geometry::Cloud;
use crate::reference::spacing::disc_radii;

/// Half a tile's side over the radius of the disc that the reference draws:
/// between the disc's inscribed square, 0.71, and the one around it.
const HALF_SIDE: f64 = 0.75;

/// A square in the plane of its point.
struct Tile {
    centre: DVec3,
    normal: DVec3,
    /// Half of its sides.
    sides: [DVec3; 2],
    colour: Rgb,
}

/// The points of a cloud.
pub(super) struct CloudSurface {
    tiles: Vec<Tile>,
}

impl CloudSurface {
    /// Moves a cloud into the cube.
    pub fn new(cloud: &Cloud, cube: &Cube) -> Self {
        let places = cloud
            .points
            .iter()
            .map(|point| (point.position - cube.centre) / cube.half_side);
        let places: Vec<DVec3> = places.collect();
        let rounded: Vec<Vec3> = places.iter().map(|place| place.as_vec3()).collect();
        let radii = disc_radii(&rounded);
        let tiles = cloud.points.iter().zip(places).zip(radii).zip(0..).map(
            |(((point, centre), radius), index): (_, usize)| {
                let normal = point.normal.as_dvec3().normalize();
                let first = normal.any_orthonormal_vector();
                let half = f64::from(radius) * HALF_SIDE;
                Tile {
                    centre,
                    normal,
                    sides: [first * half, normal.cross(first) * half],
                    colour: cloud.colours.get(index).copied().unwrap_or([255; 3]),
                }
            },
        );
        Self {
            tiles: tiles.collect(),
        }
    }

    fn tile(&self, primitive: u32) -> &Tile {
        &self.tiles[primitive as usize]
    }
}

impl Tile {
    /// The tile's point nearest to `point`.
    fn nearest(&self, point: DVec3) -> DVec3 {
        let offset = point - self.centre;
        let along = |side: DVec3| {
            let share = side.dot(offset) / side.length_squared();
            // A tile without extent is its centre.
            side * if share.is_finite() {
                share.clamp(-1.0, 1.0)
            } else {
                0.0
            }
        };
        self.centre + along(self.sides[0]) + along(self.sides[1])
    }

    fn corners(&self) -> [DVec3; 4] {
        let [first, second] = self.sides;
        [
            self.centre - first - second,
            self.centre + first - second,
            self.centre + first + second,
            self.centre - first + second,
        ]
    }
}

impl Surface for CloudSurface {
    fn count(&self) -> u32 {
        self.tiles.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Aabb {
        let [a, b, c, d] = self.tile(primitive).corners();
        Aabb {
            min: a.min(b).min(c).min(d),
            max: a.max(b).max(c).max(d),
        }
    }

    fn touches(&self, primitive: u32, cell: &Aabb) -> bool {
        let [a, b, c, d] = self.tile(primitive).corners();
        triangle_touches(&[a, b, c], cell) || triangle_touches(&[a, c, d], cell)
    }

    fn sample_at(&self, primitive: u32, point: DVec3) -> Sample {
        let tile = self.tile(primitive);
        let nearest = tile.nearest(point);
        Sample {
            point: nearest,
            distance_squared: (nearest - point).length_squared(),
            normal: tile.normal.as_vec3(),
            material: 0,
            colour: tile.colour,
        }
    }

    fn facing(&self, primitive: u32) -> Option<Vec3> {
        Some(self.tile(primitive).normal.as_vec3())
    }
}
