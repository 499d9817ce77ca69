//! Normals of a cloud that has none: estimated from each point's neighbours.
//!
//! ```text
//! positions -> nearest 16 -> plane of each -> signs by a spanning tree
//!                                          -> outside by winding numbers
//! ```
//!
//! Based on: H. Hoppe et al., Surface Reconstruction from Unorganized Points,
//! 1992 (`orient`), with what makes clear which side is outside (`outside`).
//! Where nothing does, because a component is an open sheet or its signs do
//! not fit together, the cloud is drawn from both sides.
//!
//! Only correctly rounded operations, in an order of their own: the same bits
//! on every machine, with any number of threads.

mod orient;
mod outside;
mod plane;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;
use std::path::Path;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use self::orient::{Oriented, orient};
use self::outside::{Dipole, winding};
use self::plane::Plane;
use super::normals::single;
use super::surface::count;
use crate::error::Error;
use crate::geometry::{Bounds, Cloud, OrientedPoint};
use crate::nearest::{Nearest, Places};
use crate::reference::spacing::capped_spacing;

/// Neighbours that a plane is laid through.
const NEIGHBOURS: usize = 16;

/// A component whose mean winding number is nearer to zero is open: one sees its
/// inside. Scattered points give 0.46 on closed shapes and 0.29 on half a sphere.
const CLOSED: f64 = 0.35;

/// Shares of points or edges up to which a cloud is still one-sided. Scans that
/// come out right tear less than 0.06% of their edges; where more than 0.25% are
/// torn, 2% to 9% of the points look to the wrong side.
const MAX_OPEN: f64 = 0.05;
const MAX_TORN: f64 = 0.0015;
const MAX_LINES: f64 = 0.05;

/// What came out.
#[derive(Clone, Debug)]
struct Estimate {
    /// Unit normals in the order of the points.
    normals: Vec<Vec3>,
    /// Why the cloud must be drawn from both sides, if it must.
    ambiguity: Option<String>,
}

/// Estimates normals of finite points. `None` if they all lie on one line.
fn estimate(positions: &[DVec3]) -> Option<Estimate> {
    let bounds = Bounds::of(positions.iter().copied())?;
    let scale = bounds.half_side();
    let placed = |position: &DVec3| ((position - bounds.centre()) / scale).as_vec3();
    let placed: Vec<Vec3> = positions.par_iter().map(placed).collect();
    if scale <= 0.0 || is_line(&placed) {
        return None;
    }
    let places = Places::new(&placed);
    let near = places.neighbours::<NEIGHBOURS>();
    let points: Vec<DVec3> = places.distinct().iter().map(|p| p.as_dvec3()).collect();
    let planes: Vec<Plane> = (0..points.len())
        .into_par_iter()
        .map(|index| {
            let others = near[index].found().iter();
            let others = others.map(|&(_, other)| points[other as usize]);
            Plane::through(std::iter::once(points[index]).chain(others))
        })
        .collect();
    let mut normals: Vec<DVec3> = planes.iter().map(|plane| plane.normal).collect();
    let oriented = orient(&points, &normals, &near);
    let open = turn_outwards(&points, &mut normals, &oriented, &near);
    let lines = planes.iter().filter(|plane| plane.is_line()).count();
    let share = |count: usize| count as f64 / points.len() as f64;
    Some(Estimate {
        ambiguity: ambiguity(share(open), oriented.torn, share(lines)),
        normals: placed
            .par_iter()
            .map(|point| single(places.find(point).map_or(DVec3::Y, |index| normals[index])))
            .collect(),
    })
}

/// Whether points, in the cube of half side 1, are within rounding of a line.
fn is_line(points: &[Vec3]) -> bool {
    let [_, middle, largest] =
        Plane::through(points.iter().map(|point| point.as_dvec3())).variances;
    middle <= 1e-12 * largest
}

/// Turns the components outwards, and counts the points of those that have no
/// outside.
fn turn_outwards(
    points: &[DVec3],
    normals: &mut [DVec3],
    oriented: &Oriented,
    near: &[Nearest<NEIGHBOURS>],
) -> usize {
    let mut members = vec![Vec::new(); oriented.count];
    for (index, &component) in oriented.components.iter().enumerate() {
        members[component as usize].push(index);
    }
    let mut open = 0;
    for members in members {
        let dipole = |&index: &usize| Dipole {
            position: points[index],
            normal: normals[index] * oriented.signs[index],
            area: area(near, index),
        };
        let dipoles: Vec<Dipole> = members.iter().map(dipole).collect();
        let winding = winding(&dipoles);
        if winding.abs() < CLOSED {
            open += members.len();
        }
        let outwards = if winding < 0.0 { -1.0 } else { 1.0 };
        for (index, dipole) in members.into_iter().zip(dipoles) {
            normals[index] = dipole.normal * outwards;
        }
    }
    open
}

/// A point's share of the surface: of the disc that its neighbours fill.
fn area(near: &[Nearest<NEIGHBOURS>], index: usize) -> f64 {
    let radius = f64::from(capped_spacing(near, index));
    PI * radius * radius / (near[index].found().len() + 1) as f64
}

/// What keeps a cloud from having one side, given shares of its points on
/// components without an outside, of clear edges between opposite signs, and
/// of points whose neighbours are on a line.
fn ambiguity(open: f64, torn: f64, lines: f64) -> Option<String> {
    let percent = |share: f64| format!("{:.0}%", (share * 100.0).ceil());
    if open > MAX_OPEN {
        let points = percent(open);
        Some(format!("{points} of the points are on open sheets"))
    } else if torn > MAX_TORN {
        let pairs = percent(torn);
        Some(format!("{pairs} of the neighbours face opposite sides"))
    } else if lines > MAX_LINES {
        let points = percent(lines);
        Some(format!(
            "{points} of the points have neighbours on one line"
        ))
    } else {
        None
    }
}

/// The cloud of points without normals.
///
/// # Errors
///
/// When all points lie on one line or in one place.
pub(super) fn cloud(
    file: &Path,
    positions: &[DVec3],
    notes: &mut Vec<String>,
) -> Result<Cloud, Error> {
    check_extent(file, positions)?;
    let Some(Estimate { normals, ambiguity }) = estimate(positions) else {
        let points = count(positions.len(), "point");
        let what = format!("no normals, and none to be estimated: {points} on one line");
        let remedy = "give normals (nx ny nz in PLY), or check the coordinates";
        return Err(Error::file(file, what, remedy));
    };
    notes.push(match &ambiguity {
        None => "no normals: estimated, looking outwards".to_owned(),
        Some(why) => {
            format!("no normals: estimated, but {why}: drawn from both sides")
        }
    });
    let points = positions.iter().zip(normals);
    let points = points.map(|(&position, normal)| OrientedPoint {
        position: position + DVec3::ZERO,
        normal,
    });
    Ok(Cloud {
        points: points.collect(),
        colours: Vec::new(),
        two_sided: ambiguity.is_some(),
    })
}

/// Refuses clouds in one place.
pub(super) fn check_extent(file: &Path, positions: &[DVec3]) -> Result<(), Error> {
    let mut others = positions.iter().skip(1);
    if others.all(|position| *position == positions[0]) {
        let points = count(positions.len(), "point");
        let what = format!("nothing to draw: {points} at one place");
        return Err(Error::file(file, what, "a cloud needs two places or more"));
    }
    Ok(())
}
