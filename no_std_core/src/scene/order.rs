//! In which order instances are drawn in one pass: whatever may cast a shadow
//! on another comes before it.
//!
//! Source: Duguet and Drettakis 2003, 5.3, who order cells. Instances are
//! ordered by their boxes: where a plane lies between two of them, the one on
//! the light's side comes first. Planes are sought along the boxes' faces and
//! along the light; where there is none, the two count as interpenetrating.

use super::Instance;
use crate::numbers::shift_round;
use crate::shadow::LightSpace;

/// Most instances that are ordered.
pub(super) const MOST: usize = 32;

/// Units of a sphere's radius.
const RADIUS: i64 = 1 << 14;
/// How far boxes may overlap and still be apart: a texel and a half of a map of
/// 256, which is less than what shadows are biased by.
const OVERLAP: i64 = RADIUS * 3 / 256;

type Vector = [i64; 3];

/// A box around an instance, in light space: centre, and from there to three
/// sides. Below 2^16.
#[derive(Clone, Copy)]
struct Solid {
    centre: Vector,
    halves: [Vector; 3],
}

/// Indices of instances, those that may cast shadows on others first. `None` if
/// two interpenetrate, shadow each other in a ring, or there are more than
/// [`MOST`].
pub(super) fn along(space: &LightSpace, instances: &[Instance<'_>]) -> Option<[usize; MOST]> {
    let count = instances.len();
    if count > MOST {
        return None;
    }
    let mut solids = [Solid {
        centre: [0; 3],
        halves: [[0; 3]; 3],
    }; MOST];
    for (solid, instance) in solids.iter_mut().zip(instances) {
        *solid = Solid::of(space, instance);
    }
    // By instance, a bit for each that comes before it.
    let mut before = [0u32; MOST];
    for (a, first) in solids.iter().enumerate().take(count) {
        for (b, second) in solids.iter().enumerate().take(count).skip(a + 1) {
            match first.relation(second)? {
                Relation::Apart => {}
                Relation::First => *before.get_mut(b)? |= 1 << a,
                Relation::Second => *before.get_mut(a)? |= 1 << b,
            }
        }
    }
    let mut order = [0; MOST];
    let mut placed = 0u32;
    for place in order.iter_mut().take(count) {
        let mut waiting = before.iter().enumerate().take(count);
        let (index, _) =
            waiting.find(|&(index, before)| placed >> index & 1 == 0 && before & !placed == 0)?;
        *place = index;
        placed |= 1 << index;
    }
    Some(order)
}

/// Which of two comes first.
enum Relation {
    Apart,
    First,
    Second,
}

impl Solid {
    fn of(space: &LightSpace, instance: &Instance<'_>) -> Self {
        let placement = &instance.placement;
        let origin = space.relative_to_middle(placement.origin);
        let rows = space.axes.map(|axis| placement.row(axis, origin));
        let unit = |length: i128| -> i64 {
            let share = space.over_radius((length >> 30) * i128::from(RADIUS), 0);
            share.clamp(-(1 << 20), 1 << 20)
        };
        let extents = instance.grid.extents().map(|extent| extent.to_bits());
        let mut halves = [[0; 3]; 3];
        for (axis, (half, extent)) in halves.iter_mut().zip(extents).enumerate() {
            let extent = i128::from(extent);
            *half = rows.map(|(_, axes)| {
                unit(i128::from(shift_round((axes[axis] >> 30) * extent, 32)) << 30)
            });
        }
        Self {
            centre: rows.map(|(centre, _)| unit(centre)),
            halves,
        }
    }

    /// `None` where no plane is found between the two.
    fn relation(&self, other: &Self) -> Option<Relation> {
        let [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
        if self.side(other, x).is_some() || self.side(other, y).is_some() {
            return Some(Relation::Apart);
        }
        let faces = |solid: &Self| {
            let [a, b, c] = solid.halves;
            [cross(a, b), cross(b, c), cross(c, a)]
        };
        let normals = [z].into_iter().chain(faces(self)).chain(faces(other));
        for normal in normals {
            // The light lies along z.
            match (self.side(other, normal), normal[2].signum()) {
                (None, _) => {}
                (Some(_), 0) => return Some(Relation::Apart),
                (Some(side), towards) if side == towards => return Some(Relation::First),
                _ => return Some(Relation::Second),
            }
        }
        None
    }

    /// On which side of a plane with this normal another one lies this one, if
    /// one fits between them.
    fn side(&self, other: &Self, normal: Vector) -> Option<i64> {
        let apart = [0, 1, 2].map(|at| self.centre[at] - other.centre[at]);
        let distance = dot(apart, normal);
        let reach = |solid: &Self| -> i64 {
            solid
                .halves
                .iter()
                .map(|&half| dot(half, normal).abs())
                .sum()
        };
        let length = dot(normal, normal).unsigned_abs().isqrt() as i64;
        let is_apart = distance.abs() + OVERLAP * length >= reach(self) + reach(other);
        (is_apart && length > 0).then_some(distance.signum())
    }
}

fn dot(a: Vector, b: Vector) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Scaled down, so that its products fit.
fn cross(a: Vector, b: Vector) -> Vector {
    [
        (a[1] * b[2] - a[2] * b[1]) >> 14,
        (a[2] * b[0] - a[0] * b[2]) >> 14,
        (a[0] * b[1] - a[1] * b[0]) >> 14,
    ]
}

#[cfg(test)]
mod tests;
