//! The oracle: an independent float renderer of the original geometry, not of
//! anything baked. Geometry, view and light in; colour, coverage and depth of
//! every pixel out.
//!
//! Same camera and shading model as the core, but nothing shared with it: a
//! regular grid of rays through every pixel, the nearest hit of each found in a
//! bounding volume hierarchy, shaded with the interpolated normal, and one more
//! ray towards each light that casts shadows. There is no near plane:
//! everything in front of the eye is seen.
//!
//! Geometry is moved to the origin and scaled to radius 1 in `f64` before it is
//! rounded, so that neither its size nor its place matters.
//!
//! Choices where the model leaves room:
//! - A facet's side is decided by its winding, never by its shading normals. A
//!   front face whose interpolated normal points away from the eye is seen, and
//!   shaded with that normal.
//! - Two-sided: the shading normal is turned to the side of the facet that is
//!   seen. What counts is the side, not the interpolated normal, which near a
//!   silhouette may point away on either side; and where a facet's corner normals
//!   oppose its winding, they say which side is theirs.
//! - Anything blocks light, whichever side it shows. Facets are flat to shadow
//!   rays: where smooth normals face the light and the facet does not, the
//!   facet lies in its own shadow.
//! - A cloud is a set of discs, one a point, sized by the local spacing of
//!   the points so that they overlap. Depth and normal are blended over the discs
//!   that lie within one radius of the first. Discs block light only beyond two
//!   radii, for overlapping neighbours would speckle each other. Detail below the
//!   discs' radius is lost.

mod hierarchy;
mod ray;
pub(crate) mod spacing;
mod surface;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::geometry::Geometry;
use crate::picture::Picture;
use crate::view::{Lamp, Lighting, View};
use ray::{Ray, Sides};
use surface::{Spot, Surface};

/// Samples on each axis of a pixel unless told otherwise: 16 in all.
pub const DEFAULT_SAMPLES_PER_AXIS: u32 = 4;

/// Geometry ready to be drawn from any view.
pub struct Scene {
    centre: DVec3,
    /// World units in one unit of scene space.
    radius: f64,
    sides: Sides,
    surface: Surface,
}

/// What a sample sees.
struct Sight {
    /// In multiples of the ray's direction, scene space.
    distance: f64,
    colour: DVec3,
    /// Lambert's cosine.
    lambert: f64,
    shadowed: bool,
}

/// A drawn reference. Pixels are row-major from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Mean of each pixel's samples, black where a sample hits nothing; rounded
    /// to the nearest.
    pub colour: Vec<[u8; 3]>,
    /// Share of each pixel's samples that hit something; exactly 1 where all do.
    pub coverage: Vec<f32>,
    /// Least depth among each pixel's hits: the distance from the eye along
    /// [`View::forward`] in world units. Infinity without hits.
    pub nearest: Vec<f32>,
    /// Largest depth among each pixel's hits; 0 without hits.
    pub farthest: Vec<f32>,
    /// Mean of Lambert's cosine over each pixel's hits, as if nothing cast
    /// shadows, of the lamp that casts, if that is one; 0 without hits.
    pub lambert: Vec<f32>,
    /// Share of that light that shadows take away; 0 where there is none.
    pub shadow: Vec<f32>,
}

impl Scene {
    /// Builds the hierarchy over a mesh's triangles or a cloud's discs. With
    /// `two_sided`, or where the geometry says so, back faces are seen too.
    /// Geometry without extent (a lone point, say) is invisible.
    pub fn new(geometry: &Geometry, two_sided: bool) -> Self {
        let (centre, radius) = geometry
            .bounds()
            .filter(|bounds| bounds.radius > 0.0)
            .map_or((DVec3::ZERO, 1.0), |bounds| {
                (bounds.centre(), bounds.radius)
            });
        let place = |position: DVec3| ((position - centre) / radius).as_vec3();
        let two_sided = two_sided || geometry.two_sided();
        Self {
            centre,
            radius,
            sides: if two_sided { Sides::Both } else { Sides::Front },
            surface: match geometry {
                Geometry::Mesh(mesh) => Surface::of_mesh(mesh, place),
                Geometry::Cloud(cloud) => Surface::of_cloud(cloud, place),
            },
        }
    }

    /// What a ray in scene space sees.
    fn look(&self, ray: &Ray, view: &View, lighting: &Lighting) -> Option<Sight> {
        let spot = self.surface.meet(ray, self.sides)?;
        let mut light = match &lighting.matcap {
            None => DVec3::splat(lighting.ambient),
            Some(matcap) => matcap.light(view, spot.normal) * lighting.ambient,
        };
        let mut sight = Sight {
            distance: spot.distance,
            colour: DVec3::ZERO,
            lambert: 0.0,
            shadowed: false,
        };
        for lamp in &lighting.lamps {
            let lambert = spot.normal.dot(lamp.towards).max(0.0);
            let shadowed = lamp.casts && lambert > 0.0 && self.is_shadowed(&spot, lamp);
            if !shadowed {
                let colour = DVec3::from_array(lamp.colour.map(f64::from)) / 255.0;
                light += colour * lamp.diffuse * lambert;
            }
            if lighting.caster() == Some(lamp) {
                (sight.lambert, sight.shadowed) = (lambert, shadowed);
            }
        }
        sight.colour = (spot.diffuse * light).clamp(DVec3::ZERO, DVec3::splat(255.0));
        Some(sight)
    }

    fn is_shadowed(&self, spot: &Spot, lamp: &Lamp) -> bool {
        let start = spot.shadow_start + lamp.towards * spot.shadow_gap;
        self.surface.blocks(&Ray::new(start, lamp.towards))
    }

    /// Samples one pixel.
    fn pixel(
        &self,
        view: &View,
        lighting: &Lighting,
        samples_per_axis: u32,
        [x, y]: [u32; 2],
    ) -> Pixel {
        let eye = (view.eye - self.centre) / self.radius;
        let within = |step: u32| (f64::from(step) + 0.5) / f64::from(samples_per_axis);
        let (mut colour, mut hits) = (DVec3::ZERO, 0);
        let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
        let (mut lambert, mut taken) = (0.0, 0.0);
        for row in 0..samples_per_axis {
            for column in 0..samples_per_axis {
                let (x_px, y_px) = (f64::from(x) + within(column), f64::from(y) + within(row));
                let ray = Ray::new(eye, view.direction(x_px, y_px));
                if let Some(sight) = self.look(&ray, view, lighting) {
                    colour += sight.colour;
                    hits += 1;
                    nearest = nearest.min(sight.distance);
                    farthest = farthest.max(sight.distance);
                    lambert += sight.lambert;
                    taken += if sight.shadowed { sight.lambert } else { 0.0 };
                }
            }
        }
        let samples = samples_per_axis.pow(2);
        let colour = colour / f64::from(samples);
        Pixel {
            colour: colour.to_array().map(|channel| channel.round() as u8),
            coverage: (f64::from(hits) / f64::from(samples)) as f32,
            // The rays' directions have a component of 1 along the view's.
            nearest: (nearest * self.radius) as f32,
            farthest: (farthest * self.radius) as f32,
            lambert: (lambert / f64::from(hits.max(1))) as f32,
            shadow: if lambert > 0.0 {
                (taken / lambert) as f32
            } else {
                0.0
            },
        }
    }
}

struct Pixel {
    colour: [u8; 3],
    coverage: f32,
    nearest: f32,
    farthest: f32,
    lambert: f32,
    shadow: f32,
}

/// Draws a scene with `samples_per_axis` squared rays a pixel (0 counts as 1),
/// at the centres of a regular grid. The same input gives the same output
/// whatever the number of threads. `progress` is told the number of rows done,
/// from any thread.
pub fn render(
    scene: &Scene,
    view: &View,
    lighting: &Lighting,
    samples_per_axis: u32,
    progress: &(dyn Fn(u32) + Sync),
) -> Reference {
    let rows_done = AtomicU32::new(0);
    let rows: Vec<Vec<Pixel>> = (0..view.height)
        .into_par_iter()
        .with_max_len(1)
        .map(|y| {
            let row = (0..view.width)
                .map(|x| scene.pixel(view, lighting, samples_per_axis.max(1), [x, y]))
                .collect();
            progress(rows_done.fetch_add(1, Ordering::Relaxed) + 1);
            row
        })
        .collect();
    let pixels = || rows.iter().flatten();
    Reference {
        width: view.width,
        height: view.height,
        colour: pixels().map(|pixel| pixel.colour).collect(),
        coverage: pixels().map(|pixel| pixel.coverage).collect(),
        nearest: pixels().map(|pixel| pixel.nearest).collect(),
        farthest: pixels().map(|pixel| pixel.farthest).collect(),
        lambert: pixels().map(|pixel| pixel.lambert).collect(),
        shadow: pixels().map(|pixel| pixel.shadow).collect(),
    }
}

impl Reference {
    /// The reference as a picture, drawn wherever a sample hits.
    pub fn picture(&self) -> Picture {
        Picture {
            width: self.width,
            height: self.height,
            rgb: self.colour.clone(),
            drawn: self
                .coverage
                .iter()
                .map(|&coverage| coverage > 0.0)
                .collect(),
        }
    }
}
