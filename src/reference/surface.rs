//! The surface that rays meet: a mesh's facets, or a cloud's discs blended into
//! one. Geometry and its placing in, what there is to shade at a point out.

use glam::{DVec3, Vec3};

use super::hierarchy::Hierarchy;
use super::ray::{Disc, Facet, Ray, Sides};
use super::spacing;
use crate::geometry::{Cloud, Material, Mesh};

/// Shadow rays start this far above a facet, in radii of the scene: four times
/// what rounding positions to `f32` can lift a neighbour by, and far below a
/// pixel.
const FACET_SHADOW_GAP: f64 = 1e-6;

/// Shadow rays from a disc start this far towards the light, in disc radii.
const CLOUD_SHADOW_GAP: f64 = 2.0;

/// A mesh or a cloud in scene space.
pub(super) enum Surface {
    Mesh {
        facets: Hierarchy<Facet>,
        /// In the order of the mesh.
        coats: Vec<Coat>,
    },
    Cloud(Hierarchy<Disc>),
}

/// What a triangle looks like.
pub(super) struct Coat {
    /// Unit normals at the corners.
    normals: [Vec3; 3],
    diffuse: [u8; 3],
}

/// What there is to shade where a ray meets the surface, scene space.
pub(super) struct Spot {
    /// In multiples of the ray's direction.
    pub distance: f64,
    /// Unit shading normal; zero where it is undefined.
    pub normal: DVec3,
    /// Of the material.
    pub diffuse: [u8; 3],
    /// Where a shadow ray starts.
    pub shadow_start: DVec3,
}

impl Surface {
    /// What a ray meets first. `towards` is the direction of a possible shadow
    /// ray.
    pub fn meet(&self, ray: &Ray, sides: Sides, towards: DVec3) -> Option<Spot> {
        match self {
            Self::Mesh { facets, coats } => {
                let (facet, hit) = facets.nearest(ray, sides)?;
                let coat = &coats[facet.source as usize];
                let weights = facet.weights(ray);
                let seen_side = facet.normal() * if hit.front { 1.0 } else { -1.0 };
                Some(Spot {
                    distance: hit.distance,
                    normal: match sides {
                        Sides::Front => coat.normal(weights),
                        Sides::Both => coat.normal_on(seen_side, weights),
                    },
                    diffuse: coat.diffuse,
                    shadow_start: facet.point(weights) + seen_side * FACET_SHADOW_GAP,
                })
            }
            Self::Cloud(discs) => {
                let (distance, normal, radius) = blend(discs, ray, sides)?;
                Some(Spot {
                    distance,
                    normal,
                    diffuse: Material::white().diffuse,
                    shadow_start: ray.at(distance) + towards * radius * CLOUD_SHADOW_GAP,
                })
            }
        }
    }

    /// Whether anything is on the ray, on either side.
    pub fn blocks(&self, ray: &Ray) -> bool {
        match self {
            Self::Mesh { facets, .. } => facets.blocks(ray),
            Self::Cloud(discs) => discs.blocks(ray),
        }
    }

    pub fn of_mesh(mesh: &Mesh, place: impl Fn(DVec3) -> Vec3) -> Self {
        let facets: Vec<Facet> = mesh
            .triangles
            .iter()
            .zip(0..)
            .map(|(triangle, source)| Facet {
                corners: triangle
                    .positions
                    .map(|corner| place(mesh.positions[corner as usize])),
                source,
            })
            .collect();
        let coats = mesh
            .triangles
            .iter()
            .map(|triangle| Coat {
                normals: triangle.normals.map(|normal| mesh.normals[normal as usize]),
                diffuse: mesh.materials[usize::from(triangle.material)].diffuse,
            })
            .collect();
        Self::Mesh {
            facets: Hierarchy::new(&facets),
            coats,
        }
    }

    pub fn of_cloud(cloud: &Cloud, place: impl Fn(DVec3) -> Vec3) -> Self {
        let centres: Vec<Vec3> = cloud
            .points
            .iter()
            .map(|point| place(point.position))
            .collect();
        let radii = spacing::disc_radii(&centres);
        let discs: Vec<Disc> = cloud
            .points
            .iter()
            .zip(centres.iter().zip(radii))
            .map(|(point, (&centre, radius))| Disc {
                centre,
                normal: point.normal,
                radius,
            })
            .collect();
        Self::Cloud(Hierarchy::new(&discs))
    }
}

impl Coat {
    /// The interpolated unit normal; zero where the corners' normals cancel out.
    fn normal(&self, weights: DVec3) -> DVec3 {
        let [a, b, c] = self.normals.map(Vec3::as_dvec3);
        (a * weights.x + b * weights.y + c * weights.z).normalize_or_zero()
    }

    /// The same on the side that a vector points to: turned over where the
    /// corners' normals are on the other side.
    fn normal_on(&self, side: DVec3, weights: DVec3) -> DVec3 {
        let own_side: Vec3 = self.normals.iter().sum();
        let normal = self.normal(weights);
        if own_side.as_dvec3().dot(side) < 0.0 {
            -normal
        } else {
            normal
        }
    }
}

/// The surface that overlapping discs make: distance and unit normal are means
/// over the discs that the ray meets less than one radius behind the first,
/// weighted by nearness to their centres. With the first disc's radius.
fn blend(discs: &Hierarchy<Disc>, ray: &Ray, sides: Sides) -> Option<(f64, DVec3, f64)> {
    let (first, first_hit) = discs.nearest(ray, sides)?;
    let radius = f64::from(first.radius);
    let reach = first_hit.distance + radius / ray.direction.length();
    let (mut distance, mut normal, mut total) = (0.0, DVec3::ZERO, 0.0);
    for (disc, hit) in discs.within(ray, sides, reach) {
        let weight = disc.weight(ray.at(hit.distance));
        distance += weight * hit.distance;
        normal += weight * disc.seen_normal(hit);
        total += weight;
    }
    Some(if total > 0.0 {
        (distance / total, normal.normalize_or_zero(), radius)
    } else {
        (first_hit.distance, first.seen_normal(first_hit), radius) // only rims
    })
}
