//! Exact triangle/box overlap by separating axes.
//!
//! Based on: Tomas Akenine-Moeller, Fast 3D Triangle-Box Overlap Testing,
//! 2001 (the thirteen axes). A triangle that only touches a face, edge or
//! corner of the box overlaps it. Points, segments and needles overlap as what
//! they are. The box may be a segment: as thick as twice the baker's slack,
//! 1e-12 and more, far above what rounding takes from the projections, 1e-16.

use super::surface::Aabb;
use glam::DVec3;

/// Whether a triangle and a closed box share a point.
pub(super) fn triangle_touches(corners: &[DVec3; 3], cell: &Aabb) -> bool {
    let centre = cell.min.midpoint(cell.max);
    let half = (cell.max - cell.min) / 2.0;
    let low = corners[0].min(corners[1]).min(corners[2]);
    let high = corners[0].max(corners[1]).max(corners[2]);
    if !(low.cmple(cell.max).all() && high.cmpge(cell.min).all()) {
        return false;
    }
    let local = corners.map(|corner| corner - centre);
    let edges = [
        local[1] - local[0],
        local[2] - local[1],
        local[0] - local[2],
    ];
    // Of a needle's normal only rounding is left; with all corners projected,
    // an axis that separates is right whatever its direction.
    if separates(edges[0].cross(edges[1]), &local, half) {
        return false;
    }
    let units = [DVec3::X, DVec3::Y, DVec3::Z];
    edges.iter().all(|edge| {
        units
            .iter()
            .all(|unit| !separates(unit.cross(*edge), &local, half))
    })
}

/// Whether the projections on an axis are disjoint.
fn separates(axis: DVec3, local: &[DVec3; 3], half: DVec3) -> bool {
    let at = local.map(|corner| axis.dot(corner));
    let reach = axis.abs().dot(half);
    let low = at[0].min(at[1]).min(at[2]);
    let high = at[0].max(at[1]).max(at[2]);
    low > reach || high < -reach
}
