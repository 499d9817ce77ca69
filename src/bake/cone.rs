//! Normal cones and two-sided flags of intermediate cells.

use glam::Vec3;
use rhogrid_core::asset::node::{APERTURE_ALL, APERTURE_COSINE};
use rhogrid_core::normal::{CODE_MASK, CODES, decode, encode};

/// Opposed normals: a sample that faces one way while a face or another sample
/// in its cell turns more than 101 degrees (cosine -0.2) away.
pub(super) const OPPOSED_COSINE: f32 = -0.2;

/// Bent normals: a sample whose shading normal leans more than 8 degrees
/// away from its own face would vanish while the face is still seen.
const BENT_COSINE: f32 = 0.99;

/// Why a leaf must be drawn even where its sample's normal faces away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sides {
    /// It need not.
    Front,
    /// Its normal is bent beyond the face that it lies on.
    Bent,
    /// It holds faces of opposed directions.
    Opposed,
}

/// Which sides of a leaf are drawn. `own` is the direction of the face that
/// the sample lies on, `faces` those of all that touch the leaf.
pub(super) fn sides(
    sample: Vec3,
    own: Option<Vec3>,
    mut faces: impl Iterator<Item = Vec3>,
) -> Sides {
    if faces.any(|face| face.dot(sample) < OPPOSED_COSINE) {
        Sides::Opposed
    } else if own.is_some_and(|own| own.dot(sample) < BENT_COSINE) {
        Sides::Bent
    } else {
        Sides::Front
    }
}

/// The normal code of a direction of unit length.
pub(super) fn code(direction: Vec3) -> u16 {
    let scaled = direction.to_array();
    encode(scaled.map(|c| (f64::from(c) * f64::from(1 << 26)) as i32))
}

/// The directions of all normal codes, unit length.
pub(super) struct Directions(Vec<Vec3>);

impl Directions {
    pub fn new() -> Self {
        let of = |code| Vec3::from_array(decode(code).map(|c| c as f32)).normalize();
        Self((0..CODES as u16).map(of).collect())
    }

    /// The direction of an attribute.
    fn of(&self, attribute: u16) -> Vec3 {
        self.0[usize::from(attribute & CODE_MASK)]
    }

    /// The cosine of the largest angle between an attribute's direction and
    /// those of codes.
    pub fn least_cosine(&self, attribute: u16, codes: &[u16]) -> f32 {
        let axis = self.of(attribute);
        let cosines = codes.iter().map(|&code| self.of(code).dot(axis));
        cosines.fold(1.0, f32::min)
    }
}

/// The smallest aperture for the cosine of the largest angle in a cone.
pub(super) fn aperture(cosine: f32) -> u8 {
    // The cosines are rounded down, which opens a cone; float errors of
    // 1e-6 stay below one unit of 1/32768.
    let fits = |&bound: &u16| cosine - 1e-6 >= f32::from(bound) / 32768.0;
    let first = APERTURE_COSINE.iter().position(fits);
    first.map_or(APERTURE_ALL, |aperture| aperture as u8)
}
