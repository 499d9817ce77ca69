//! A scene as one thing: its box, and its geometry as one mesh.

use glam::DVec3;

use super::{Instance, Model, Scene};
use crate::bake::Cube;
use crate::geometry::{Geometry, Material, Mesh, Triangle};

/// The box of everything, and the farthest that anything reaches from its
/// middle: vertices where they are known, else the corners of boxes.
pub fn bounds(models: &[Model], instances: &[Instance]) -> Cube {
    let points = || {
        instances.iter().flat_map(|instance| {
            let model = &models[instance.model];
            let points = match &model.geometry {
                Some(geometry) => geometry.points(),
                None => model.asset.cube().corners(),
            };
            let place = instance.place;
            points.into_iter().map(move |point| place.point(point))
        })
    };
    let (min, max) = points().fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(min, max), point| (min.min(point), max.max(point)),
    );
    let centre = min.midpoint(max);
    let radius = points()
        .map(|point| point.distance(centre))
        .fold(f64::MIN_POSITIVE, f64::max);
    Cube {
        centre,
        extents: max - centre,
        half_side: radius,
        radius,
    }
}

impl Scene {
    /// Everything as one mesh in the world, for the reference; `None` where a
    /// model's geometry is not known or is a cloud.
    pub fn merged(&self) -> Option<Mesh> {
        let mut merged = Mesh::default();
        for instance in &self.instances {
            let Some(Geometry::Mesh(mesh)) = &self.models[instance.model].geometry else {
                return None;
            };
            instance.add_to(mesh, &mut merged)?;
        }
        Some(merged)
    }
}

impl Instance {
    fn add_to(&self, mesh: &Mesh, merged: &mut Mesh) -> Option<()> {
        let first = |length: usize| u32::try_from(length).ok();
        let position = first(merged.positions.len())?;
        let normal = first(merged.normals.len())?;
        let material = u8::try_from(merged.materials.len()).ok()?;
        u8::try_from(merged.materials.len() + mesh.materials.len()).ok()?;
        let positions = mesh.positions.iter();
        merged
            .positions
            .extend(positions.map(|&position| self.place.point(position)));
        let normals = mesh.normals.iter();
        merged
            .normals
            .extend(normals.map(|&normal| self.place.normal(normal)));
        let turn = |corners: [u32; 3], first: u32| {
            let [a, b, c] = corners.map(|corner| first + corner);
            if self.place.mirrors() {
                [a, c, b]
            } else {
                [a, b, c]
            }
        };
        let triangles = mesh.triangles.iter().map(|triangle| Triangle {
            positions: turn(triangle.positions, position),
            normals: turn(triangle.normals, normal),
            material: material + triangle.material,
        });
        merged.triangles.extend(triangles);
        let diffuse = |index: usize| match &self.materials {
            None => mesh.materials[index].diffuse,
            Some(given) => given.get(index).copied().unwrap_or([0; 3]),
        };
        let own = mesh.colours.iter().filter(|_| self.materials.is_none());
        let own = own.map(Some).chain(std::iter::repeat(None));
        let colours = mesh
            .triangles
            .iter()
            .zip(own)
            .map(|(triangle, own)| match own {
                Some(&[a, b, c]) if self.place.mirrors() => [a, c, b],
                Some(&colours) => colours,
                None => [diffuse(usize::from(triangle.material)); 3],
            });
        merged.colours.extend(colours);
        for (index, own) in mesh.materials.iter().enumerate() {
            merged.materials.push(Material {
                diffuse: diffuse(index),
                ..own.clone()
            });
        }
        Some(())
    }
}
