//! Normal cones and two-sided flags of intermediate cells.

use glam::Vec3;
use rhogrid_core::asset::node::{APERTURE_ALL, APERTURE_COSINE, Flags};
use rhogrid_core::normal::{COMPONENT_BITS, decode};

/// Opposed faces: a leaf whose sample faces one way while another face in it
/// turns more than 101 degrees (cosine -0.2) away needs both sides.
const OPPOSED_COSINE: f32 = -0.2;

/// The direction that a normal code stands for.
pub(super) fn decoded(code: u16) -> Vec3 {
    Vec3::from_array(decode(code).map(|c| c as f32 / (1 << COMPONENT_BITS) as f32))
}

/// Whether a leaf with this sample normal holds a face that turns away from
/// it.
pub(super) fn is_opposed(sample: Vec3, mut faces: impl Iterator<Item = Vec3>) -> bool {
    faces.any(|face| face.dot(sample) < OPPOSED_COSINE)
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

/// The flags of a node.
pub(super) fn flags(aperture: u8, two_sided: bool) -> Flags {
    Flags {
        aperture: if two_sided { APERTURE_ALL } else { aperture },
        two_sided,
    }
}
