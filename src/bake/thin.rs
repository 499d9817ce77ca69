//! The thin subset of a level's touched cells.
//!
//! Source: Samuli Laine, A Topological Approach to Voxelization, 2013. A
//! touched cell is *separating* if the surface meets its cross-hair: one of
//! the three segments that join the centres of its opposite faces. Where a
//! path from centre to centre, through faces, crosses the surface, it does so
//! on the cross-hair of one of both cells: the separating cells of a level are
//! 6-separating. Segments are closed and as thick as the baker's slack, so
//! that a surface between two cells counts in both.
//!
//! Changes here: wires, slivers and the rims of sheets may pass beside every
//! cross-hair. A touched cell is therefore kept, too, unless a neighbour
//! stands in for it. Its *column* is the axis that its nearest surface faces
//! most; one of both neighbours on it stands in, if the surface meets the
//! neighbour's segment along it. Of a plane every touched cell is separating
//! or has such a neighbour, so that this adds nothing to it: with a normal
//! a >= b >= c >= 0 the plane lies at most (a + b + c) / 2 <= 3 a / 2 from the
//! cell's centre, and next to it a segment along the column reaches from a / 2
//! to 3 a / 2. The subset is empty only where nothing is touched.

use glam::Vec3;
use rayon::prelude::*;

use super::surface::Aabb;

/// What a touched cell is to the thin subset of its level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    /// Which segments of its cross-hair the surface meets: along x, y and z.
    pub crossed: [bool; 3],
    /// The axis that its nearest surface faces most.
    pub column: usize,
}

/// The segments of a cell's cross-hair, as boxes; the cell's box has its
/// slack already.
pub(super) fn cross_hair(cell: &Aabb, slack: f64) -> [Aabb; 3] {
    let centre = cell.min.midpoint(cell.max);
    [0, 1, 2].map(|axis| {
        let mut segment = Aabb::cube(centre, slack);
        segment.min[axis] = cell.min[axis];
        segment.max[axis] = cell.max[axis];
        segment
    })
}

/// The axis that a direction is nearest to.
pub(super) fn column(direction: Vec3) -> usize {
    let [x, y, z] = direction.abs().to_array();
    match (x >= y && x >= z, y >= z) {
        (true, _) => 0,
        (false, true) => 1,
        (false, false) => 2,
    }
}

/// Which of all touched cells of a level, by place, are in its thin subset.
pub(super) fn thin_subset(cells: &[([u32; 3], Standing)]) -> Vec<bool> {
    // By axis the cells whose segment along it is crossed.
    let crossed = [0, 1, 2].map(|axis| {
        let crossed = cells
            .iter()
            .filter(|(_, standing)| standing.crossed[axis])
            .map(|&(place, _)| key(place));
        let mut crossed: Vec<u64> = crossed.collect();
        crossed.par_sort_unstable();
        crossed
    });
    let stands_in = |place: [u32; 3], column: usize, step: u32| {
        let mut neighbour = place;
        neighbour[column] = neighbour[column].wrapping_add(step);
        crossed[column].binary_search(&key(neighbour)).is_ok()
    };
    let is_thin = |&(place, Standing { crossed, column }): &([u32; 3], Standing)| {
        crossed.contains(&true)
            || !(stands_in(place, column, 1) || stands_in(place, column, u32::MAX))
    };
    cells.par_iter().map(is_thin).collect()
}

/// A place as one number; no cell has that of a place beyond the cube.
fn key(place: [u32; 3]) -> u64 {
    // At most 2^15 cells on an axis.
    let bits = place.map(|index| u64::from(index & 0xffff));
    bits[0] | bits[1] << 16 | bits[2] << 32
}
