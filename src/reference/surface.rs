//! The surface that rays meet: a mesh's facets, or a cloud's discs blended into
//! one. Geometry and its placing in, what there is to shade at a point out.

use glam::{DVec3, Vec3};
use rhogrid_core::asset::Rgb;

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
    Cloud {
        discs: Hierarchy<Disc>,
        /// In the order of the cloud; empty for white.
        colours: Vec<Rgb>,
    },
}

/// What a triangle looks like.
pub(super) struct Coat {
    /// Unit normals at the corners.
    normals: [Vec3; 3],
    /// Colours at the corners.
    colours: [DVec3; 3],
}

/// What there is to shade where a ray meets the surface, scene space.
pub(super) struct Spot {
    /// In multiples of the ray's direction.
    pub distance: f64,
    /// Unit shading normal; zero where it is undefined.
    pub normal: DVec3,
    /// Of the surface there, 0 to 255 a channel.
    pub diffuse: DVec3,
    /// Where a shadow ray starts ...
    pub shadow_start: DVec3,
    /// ... but so far towards the light.
    pub shadow_gap: f64,
}

impl Surface {
    /// What a ray meets first.
    pub fn meet(&self, ray: &Ray, sides: Sides) -> Option<Spot> {
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
                    diffuse: coat.colour(weights),
                    shadow_start: facet.point(weights) + seen_side * FACET_SHADOW_GAP,
                    shadow_gap: 0.0,
                })
            }
            Self::Cloud { discs, colours } => {
                let Blend {
                    distance,
                    normal,
                    diffuse,
                    radius,
                } = blend(discs, colours, ray, sides)?;
                Some(Spot {
                    distance,
                    normal,
                    diffuse,
                    shadow_start: ray.at(distance),
                    shadow_gap: radius * CLOUD_SHADOW_GAP,
                })
            }
        }
    }

    /// Whether anything is on the ray, on either side.
    pub fn blocks(&self, ray: &Ray) -> bool {
        match self {
            Self::Mesh { facets, .. } => facets.blocks(ray),
            Self::Cloud { discs, .. } => discs.blocks(ray),
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
            .zip(0..)
            .map(|(triangle, index): (_, usize)| {
                let material = mesh.materials[usize::from(triangle.material)].diffuse;
                let own = mesh.colours.get(index).copied();
                Coat {
                    normals: triangle.normals.map(|normal| mesh.normals[normal as usize]),
                    colours: own.unwrap_or([material; 3]).map(channels),
                }
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
            .zip(0..)
            .map(|((point, (&centre, radius)), source)| Disc {
                centre,
                normal: point.normal,
                radius,
                source,
            })
            .collect();
        Self::Cloud {
            discs: Hierarchy::new(&discs),
            colours: cloud.colours.clone(),
        }
    }
}

fn channels(colour: Rgb) -> DVec3 {
    DVec3::from_array(colour.map(f64::from))
}

impl Coat {
    /// Exactly the corners' colour where they have but one.
    fn colour(&self, weights: DVec3) -> DVec3 {
        let [a, b, c] = self.colours;
        a + (b - a) * weights.y + (c - a) * weights.z
    }

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

/// What overlapping discs make.
struct Blend {
    distance: f64,
    normal: DVec3,
    diffuse: DVec3,
    /// The first disc's.
    radius: f64,
}

/// The surface that overlapping discs make: distance, unit normal and colour are
/// means over the discs that the ray meets less than one radius behind the
/// first, weighted by nearness to their centres.
fn blend(discs: &Hierarchy<Disc>, colours: &[Rgb], ray: &Ray, sides: Sides) -> Option<Blend> {
    let white = Material::white().diffuse;
    let colour = |disc: &Disc| channels(*colours.get(disc.source as usize).unwrap_or(&white));
    let (first, first_hit) = discs.nearest(ray, sides)?;
    let radius = f64::from(first.radius);
    let reach = first_hit.distance + radius / ray.direction.length();
    let (mut distance, mut total) = (0.0, 0.0);
    // From the first disc's colour, which stays exact where all have it.
    let (mut normal, mut apart) = (DVec3::ZERO, DVec3::ZERO);
    for (disc, hit) in discs.within(ray, sides, reach) {
        let weight = disc.weight(ray.at(hit.distance));
        distance += weight * hit.distance;
        normal += weight * disc.seen_normal(hit);
        apart += weight * (colour(disc) - colour(first));
        total += weight;
    }
    Some(if total > 0.0 {
        Blend {
            distance: distance / total,
            normal: normal.normalize_or_zero(),
            diffuse: colour(first) + apart / total,
            radius,
        }
    } else {
        // Only rims.
        Blend {
            distance: first_hit.distance,
            normal: first.seen_normal(first_hit),
            diffuse: colour(first),
            radius,
        }
    })
}
