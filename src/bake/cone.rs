//! Normal cones and two-sided flags of intermediate cells.

use glam::Vec3;
use rhogrid_core::asset::node::{APERTURE_ALL, APERTURE_COSINE};
use rhogrid_core::normal::{COMPONENT_BITS, decode};

/// Opposed faces: a leaf whose sample faces one way while another face in it
/// turns more than 101 degrees (cosine -0.2) away needs both sides.
const OPPOSED_COSINE: f32 = -0.2;

/// The direction that a normal code stands for.
pub(super) fn decoded(code: u16) -> Vec3 {
    Vec3::from_array(decode(code).map(|c| c as f32 / (1 << COMPONENT_BITS) as f32))
}

/// Bent normals: a sample whose shading normal leans more than 8 degrees
/// away from its own face would vanish while the face is still seen.
const BENT_COSINE: f32 = 0.99;

/// Whether a leaf must be drawn even where its sample's normal faces away.
/// `own` is the direction of the face that the sample lies on, `faces` those
/// of all that touch the leaf.
pub(super) fn needs_both_sides(
    sample: Vec3,
    own: Option<Vec3>,
    mut faces: impl Iterator<Item = Vec3>,
) -> bool {
    own.is_some_and(|own| own.dot(sample) < BENT_COSINE)
        || faces.any(|face| face.dot(sample) < OPPOSED_COSINE)
}

/// The smallest aperture about a code's direction that holds all faces.
pub(super) fn aperture(code: u16, faces: impl Iterator<Item = Vec3>) -> u8 {
    let axis = decoded(code).normalize();
    let cosine = faces.map(|face| face.dot(axis)).fold(1.0f32, f32::min);
    // The cosines are rounded down, which opens a cone; float errors of
    // 1e-6 stay below one unit of 1/32768.
    let fits = |&bound: &u16| cosine - 1e-6 >= f32::from(bound) / 32768.0;
    let first = APERTURE_COSINE.iter().position(fits);
    first.map_or(APERTURE_ALL, |aperture| aperture as u8)
}
