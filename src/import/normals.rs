//! Shading normals: the file's own, or implied by the faces around a
//! position.
//!
//! An implied normal is the sum of the normals of the faces around a
//! position, each weighted by its angle there (G. Thürmer and C. A. Wüthrich,
//! Computing Vertex Normals from Polygonal Facets, 1998), over the faces that
//! turn from the corner's own face by no more than the crease angle: a scan
//! is smooth, a cube has flat faces.

use glam::{DVec3, Vec3};

use super::unit;
use crate::geometry::Triangle;

/// Cosine of the crease angle, 60 degrees. Faces that meet at a sharper angle
/// do not share an implied normal. A little below one half, so that the sides
/// of a hexagonal prism count as smooth in spite of rounding.
pub const CREASE_COSINE: f64 = 0.4999;

/// The place of a normal that the file does not give.
pub(super) const NO_NORMAL: u32 = u32::MAX;

/// More faces than this around one position are shaded flat there: the tips
/// of needles, and scans that put their failed samples at the origin. It
/// bounds the pairs to compare.
const MAX_FACES_AROUND: usize = 1024;

/// Height of a triangle, relative to its longest edge, that is rounding noise.
const FLATNESS: f64 = 1e-14;

/// The unit normal of a triangle, or `None` without area.
pub(super) fn face_normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let longest = ab
        .length_squared()
        .max(bc.length_squared())
        .max(ca.length_squared());
    let cross = ab.cross(-ca);
    if cross.abs().max_element() <= FLATNESS * longest {
        None
    } else {
        unit(cross)
    }
}

/// Replaces the corners' indices into the file's normals (or [`NO_NORMAL`])
/// by indices into the returned unit normals, and counts the corners whose
/// file normal is zero: they get implied normals. `facets` are the face
/// normals of the triangles.
pub(super) fn resolve(
    positions: &[DVec3],
    triangles: &mut [Triangle],
    facets: &[Option<DVec3>],
    file: &[DVec3],
) -> (Vec<Vec3>, usize) {
    let units: Vec<Option<DVec3>> = file.iter().map(|&normal| unit(normal)).collect();
    let mut places = vec![NO_NORMAL; file.len()];
    let mut normals = Vec::new();
    let (mut zero, mut missing) = (0, false);
    for index in triangles
        .iter_mut()
        .flat_map(|triangle| &mut triangle.normals)
    {
        let place = match units.get(*index as usize) {
            Some(Some(normal)) => {
                let place = &mut places[*index as usize];
                if *place == NO_NORMAL {
                    *place = push(&mut normals, single(*normal));
                }
                *place
            }
            Some(None) => {
                zero += 1;
                NO_NORMAL
            }
            None => NO_NORMAL,
        };
        missing |= place == NO_NORMAL;
        *index = place;
    }
    if missing {
        imply(positions, triangles, facets, &mut normals);
    }
    (normals, zero)
}

/// Appends a normal; the caller bounds corners by `u32`.
fn push(normals: &mut Vec<Vec3>, normal: Vec3) -> u32 {
    normals.push(normal);
    normals.len() as u32 - 1
}

/// A unit vector in single precision, still of unit length.
pub(super) fn single(unit: DVec3) -> Vec3 {
    unit.as_vec3().normalize()
}

/// One corner of a position: its face's normal and its angle.
struct Wedge {
    triangle: usize,
    corner: usize,
    facet: Option<DVec3>,
    angle: f64,
}

/// Gives every corner without a normal an implied one.
fn imply(
    positions: &[DVec3],
    triangles: &mut [Triangle],
    facets: &[Option<DVec3>],
    normals: &mut Vec<Vec3>,
) {
    let (starts, corners) = corners_by_position(positions.len(), triangles);
    let mut wedges = Vec::new();
    for range in starts.windows(2) {
        wedges.clear();
        wedges.extend(corners[range[0]..range[1]].iter().map(|&id| {
            let (triangle, corner) = (id as usize / 3, id as usize % 3);
            let [here, next, last] = [0, 1, 2]
                .map(|i| positions[triangles[triangle].positions[(corner + i) % 3] as usize]);
            let facet = facets[triangle];
            let angle = facet.map_or(0.0, |_| angle_between(next - here, last - here));
            Wedge {
                triangle,
                corner,
                facet,
                angle,
            }
        }));
        imply_around(&wedges, triangles, normals);
    }
}

/// Corner numbers (3 * triangle + corner) grouped by position: those of
/// position `i` are `corners[starts[i]..starts[i + 1]]`, in file order.
fn corners_by_position(positions: usize, triangles: &[Triangle]) -> (Vec<usize>, Vec<u32>) {
    let mut starts = vec![0; positions + 2];
    for &position in triangles.iter().flat_map(|triangle| &triangle.positions) {
        starts[position as usize + 2] += 1;
    }
    for i in 2..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut corners = vec![0; triangles.len() * 3];
    let order = triangles.iter().flat_map(|triangle| &triangle.positions);
    for (id, &position) in order.enumerate() {
        let place = &mut starts[position as usize + 1];
        corners[*place] = id as u32;
        *place += 1;
    }
    starts.pop();
    (starts, corners)
}

/// Sets the missing normals of one position's corners, sharing equal ones.
fn imply_around(wedges: &[Wedge], triangles: &mut [Triangle], normals: &mut Vec<Vec3>) {
    let first = normals.len();
    let sum = |near: &dyn Fn(DVec3) -> bool| -> DVec3 {
        let faces = wedges
            .iter()
            .filter_map(|wedge| Some((wedge.facet?, wedge.angle)));
        faces
            .filter(|(facet, _)| near(*facet))
            .map(|(facet, angle)| facet * angle)
            .sum()
    };
    for wedge in wedges {
        let index = &mut triangles[wedge.triangle].normals[wedge.corner];
        if *index != NO_NORMAL {
            continue;
        }
        let normal = match wedge.facet {
            Some(own) if wedges.len() > MAX_FACES_AROUND => own,
            Some(own) => unit(sum(&|facet| facet.dot(own) >= CREASE_COSINE)).unwrap_or(own),
            None if wedges.len() > MAX_FACES_AROUND => DVec3::Y,
            None => unit(sum(&|_| true)).unwrap_or(DVec3::Y),
        };
        let normal = single(normal);
        let known = normals[first..]
            .iter()
            .take(MAX_SHARED)
            .position(|known| *known == normal);
        *index = match known {
            Some(place) => (first + place) as u32,
            None => push(normals, normal),
        };
    }
}

/// Different normals of one position that are searched for an equal one.
const MAX_SHARED: usize = 64;

/// The angle between two vectors in radians, for weights: within 1e-9, and
/// the same on every machine, which `atan2` is not.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    let (Some(a), Some(b)) = (unit(a), unit(b)) else {
        return 0.0;
    };
    let (sine, cosine) = (a.cross(b).length(), a.dot(b));
    if sine == 0.0 {
        return 0.0;
    }
    // tan(x/2), then halved thrice more: the series is left with |t| < 0.2.
    let half = if cosine >= 0.0 {
        sine / (1.0 + cosine)
    } else {
        (1.0 - cosine) / sine
    };
    let t = (0..3).fold(half, |t, _| t / (1.0 + (1.0 + t * t).sqrt()));
    let t2 = t * t;
    let series =
        1.0 - t2 * (1.0 / 3.0 - t2 * (1.0 / 5.0 - t2 * (1.0 / 7.0 - t2 * (1.0 / 9.0 - t2 / 11.0))));
    16.0 * t * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_match_the_arc_tangent() {
        for i in 1..=1000 {
            let angle = std::f64::consts::PI * f64::from(i) / 1001.0;
            let other = DVec3::new(angle.cos(), angle.sin(), 0.0) * 1e30;
            let error = angle_between(DVec3::X * 1e-30, other) - angle;
            assert!(error.abs() < 2e-9, "{angle}: {error}");
        }
        assert_eq!(angle_between(DVec3::X, DVec3::ZERO), 0.0);
    }

    fn implied(positions: &[DVec3], faces: &[[u32; 3]]) -> (Vec<Vec3>, Vec<Triangle>) {
        let triangle = |&positions| Triangle {
            positions,
            normals: [NO_NORMAL; 3],
            material: 0,
        };
        let mut triangles: Vec<Triangle> = faces.iter().map(triangle).collect();
        let facet = |face: &[u32; 3]| face_normal(face.map(|i| positions[i as usize]));
        let facets: Vec<Option<DVec3>> = faces.iter().map(facet).collect();
        let (normals, zero) = resolve(positions, &mut triangles, &facets, &[]);
        assert_eq!(zero, 0);
        (normals, triangles)
    }

    /// Two triangles that share the edge from origin to z, bent by `angle`.
    fn hinge(degrees: f64) -> Vec<Vec3> {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let positions = [
            DVec3::ZERO,
            DVec3::Z,
            DVec3::X,
            DVec3::new(-cosine, sine, 0.0),
        ];
        implied(&positions, &[[0, 1, 2], [0, 3, 1]]).0
    }

    #[test]
    fn creases_split_normals_beyond_sixty_degrees() {
        // Two flat corners, and one normal on each end of the edge.
        assert_eq!(hinge(59.0).len(), 4);
        assert_eq!(hinge(60.0).len(), 4);
        assert_eq!(hinge(61.0).len(), 6);
    }

    #[test]
    fn degenerate_faces_take_the_average_or_up() {
        let positions = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::NEG_Z,
            DVec3::ONE,
            DVec3::ONE * 2.0,
        ];
        let (normals, triangles) = implied(&positions, &[[0, 1, 2], [0, 1, 1], [3, 4, 4]]);
        for triangle in &triangles {
            assert!(
                triangle
                    .normals
                    .iter()
                    .all(|&i| normals[i as usize] == Vec3::Y)
            );
        }
    }

    #[test]
    fn opposite_faces_keep_their_own_normals() {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::NEG_Z];
        let (normals, triangles) = implied(&positions, &[[0, 1, 2], [2, 1, 0]]);
        assert!(
            triangles[0]
                .normals
                .iter()
                .all(|&i| normals[i as usize] == Vec3::Y)
        );
        assert!(
            triangles[1]
                .normals
                .iter()
                .all(|&i| normals[i as usize] == Vec3::NEG_Y)
        );
    }

    #[test]
    fn triangles_without_area_have_no_normal() {
        let line = [0.1, 0.2, 0.3].map(|x| DVec3::new(x, 3.0 * x, -7.0 * x));
        assert_eq!(face_normal(line), None);
        let tiny = [DVec3::ZERO, DVec3::X * 1e-38, DVec3::NEG_Z * 1e-38];
        assert_eq!(face_normal(tiny), Some(DVec3::Y));
    }
}
