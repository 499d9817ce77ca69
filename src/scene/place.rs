//! Where a model stands: from source units, y up, to the world.

use glam::{DMat3, DVec3, EulerRot, Vec3};

use super::file::{InstanceTable, Scale};
use crate::bake::Cube;

/// world = linear * source + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Invertible.
    pub linear: DMat3,
    /// World units.
    pub offset: DVec3,
}

impl Affine {
    /// The source is the world.
    pub const IDENTITY: Self = Self {
        linear: DMat3::IDENTITY,
        offset: DVec3::ZERO,
    };

    /// A point in the world.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.linear * point + self.offset
    }

    /// A unit normal in the world: by the inverse transpose.
    pub fn normal(&self, normal: Vec3) -> Vec3 {
        let normal = self.linear.inverse().transpose() * normal.as_dvec3();
        normal.normalize().as_vec3()
    }

    /// Whether it turns counter-clockwise triangles around.
    pub fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }
}

/// Where an instance of a model with a cube stands. Scale comes first, then
/// roll around z, pitch around x, yaw around y, then position.
pub(super) fn of(table: &InstanceTable, cube: &Cube) -> Result<Affine, String> {
    let scale = match (table.scale, table.size) {
        (Some(_), Some(_)) => return Err("scale and size say the same twice".into()),
        (None, None) => DVec3::ONE,
        (Some(Scale::Even(scale)), None) => DVec3::splat(scale),
        (Some(Scale::Uneven(scale)), None) => scale.into(),
        (None, Some(size)) => DVec3::splat(size / cube.radius),
    };
    let is_scale = |c: f64| c.is_normal() && (1e-9..=1e9).contains(&c.abs());
    if !scale.to_array().into_iter().all(is_scale) {
        return Err("the scale is not usable".into());
    }
    let position = DVec3::from(table.position);
    let [yaw, pitch, roll] = table.rotation.map(f64::to_radians);
    if !(position.is_finite() && [yaw, pitch, roll].iter().all(|angle| angle.is_finite())) {
        return Err("the position or rotation is not finite".into());
    }
    let turn = DMat3::from_euler(EulerRot::YXZ, yaw, pitch, roll);
    let linear = turn * DMat3::from_diagonal(scale);
    let mut offset = position - linear * cube.centre;
    if table.stand {
        let corners = cube.corners().into_iter();
        let lowest = corners.map(|corner| (linear * corner + offset).y);
        offset.y += position.y - lowest.fold(f64::INFINITY, f64::min);
    }
    Ok(Affine { linear, offset })
}
