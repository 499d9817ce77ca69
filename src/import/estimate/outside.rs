//! Which side of a component is outside, and whether it has one.
//!
//! Based on: G. Barill, N. G. Dickson, R. Schmidt, D. I. W. Levin and A.
//! Jacobson, Fast Winding Numbers for Soups and Clouds, 2018. The winding
//! number of oriented points, each with its share of the surface, is the
//! signed solid angle that they fill over 4 pi. At a point of a closed surface
//! it is 1/2 if the normals look out and -1/2 if they look in; at one of a
//! flat sheet it is 0. (Hoppe et al. turn a component by the one point that is
//! highest, which noise can lead astray and which tells nothing of sheets.)

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

/// Points of a component at which its winding number is taken: at most.
const PROBES: usize = 256;

/// A point of a component.
#[derive(Clone, Copy, Debug)]
pub struct Dipole {
    pub position: DVec3,
    /// Unit.
    pub normal: DVec3,
    /// Of the surface, square units.
    pub area: f64,
}

/// The mean winding number at points of a component: near 0.5 for a closed one
/// that looks out, -0.5 for one that looks in, 0 for a sheet.
pub fn winding(component: &[Dipole]) -> f64 {
    let stride = component.len().div_ceil(PROBES).max(1);
    let probes: Vec<usize> = (0..component.len()).step_by(stride).collect();
    let numbers: Vec<f64> = probes
        .par_iter()
        .map(|&probe| winding_at(component, probe))
        .collect();
    // Summed in order, whatever the number of threads.
    numbers.iter().sum::<f64>() / numbers.len().max(1) as f64
}

fn winding_at(component: &[Dipole], probe: usize) -> f64 {
    let from = component[probe].position;
    let angles = component.iter().map(|dipole| {
        let offset = dipole.position - from;
        // Its own disc fills no angle at its rim: bounds what close ones give.
        let squared = offset.length_squared() + dipole.area / PI;
        if squared > 0.0 {
            dipole.area * dipole.normal.dot(offset) / (squared * squared.sqrt())
        } else {
            0.0
        }
    });
    angles.sum::<f64>() / (4.0 * PI)
}
