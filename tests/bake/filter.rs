//! Intermediate samples and cones against a slow twin: every cell anew from
//! all that lies below it, as the asset tells.

use glam::DVec3;
use rhogrid::bake::{GridOptions, Normals};
use rhogrid::geometry::Mesh;
use rhogrid::import::procedural::{demo, shapes};
use rhogrid_core::asset::node::{APERTURE_ALL, APERTURE_COSINE};
use rhogrid_core::normal::encode;

use super::cells::{Cell, cells};
use super::twin::{
    CODE_COSINE, Face, LEVELS, bounds, check_material, check_sample, decoded, faces, torus, touches,
};
use super::{Random, baked, moved, options, slivers, soup, thin};

/// The leaves' mean normal must be longer than this to replace the nearest
/// point's.
const SHORTEST_MEAN: f64 = 0.7;
/// Normals are opposed from here on.
const OPPOSED_COSINE: f64 = -0.2;

/// All cells of an asset with its faces.
struct Twin {
    rho: u8,
    normals: Normals,
    depths: Vec<Vec<Cell>>,
    faces: Vec<Face>,
}

impl Twin {
    fn new(mesh: &Mesh, options: &GridOptions) -> Self {
        Self {
            rho: options.rho,
            normals: options.normals,
            depths: cells(&baked(mesh, options).grid()),
            faces: faces(mesh),
        }
    }

    /// The cells below a cell with their depths.
    fn below(&self, depth: usize, cell: &Cell) -> Vec<(usize, &Cell)> {
        let mut found = Vec::new();
        for child in &self.depths[depth + 1][cell.children.clone()] {
            found.push((depth + 1, child));
            if !child.record.is_empty() {
                found.extend(self.below(depth + 1, child));
            }
        }
        found
    }

    /// The intermediate cells with their depths.
    fn intermediate(&self) -> impl Iterator<Item = (usize, &Cell)> {
        let above = self.depths.iter().enumerate().take(self.depths.len() - 1);
        above.flat_map(|(depth, own)| own.iter().map(move |cell| (depth, cell)))
    }

    fn axis(&self, depth: usize) -> u32 {
        u32::from(self.rho).pow(depth as u32)
    }

    /// The mean normal of the drawn leaves, by its length, or the nearest
    /// point's, as all are where that is asked for; its material.
    fn check_attribute(&self, depth: usize, cell: &Cell, below: &[(usize, &Cell)]) {
        let axis = self.axis(depth);
        if self.normals == Normals::Nearest {
            return check_sample(&self.faces, cell.place, axis, cell.attribute);
        }
        let leaves = below
            .iter()
            .filter(|(_, cell)| cell.record.is_empty() && cell.is_drawn);
        let leaves: Vec<DVec3> = leaves.map(|(_, cell)| decoded(cell.attribute)).collect();
        let mean = leaves.iter().sum::<DVec3>() / leaves.len().max(1) as f64;
        check_material(&self.faces, cell.place, axis, cell.attribute);
        if mean.length() > SHORTEST_MEAN + 1e-4 {
            let cosine = mean.normalize().dot(decoded(cell.attribute));
            assert!(cosine >= CODE_COSINE, "mean {mean}, cosine {cosine}");
        } else if mean.length() < SHORTEST_MEAN - 1e-4 {
            check_sample(&self.faces, cell.place, axis, cell.attribute);
        }
    }

    /// The cell's aperture is the smallest that holds its samples, or larger
    /// for the faces of sheets below. Gives whether it was a matter of samples
    /// alone.
    fn check_cone(&self, cell: &Cell, below: &[(usize, &Cell)]) -> bool {
        let flags = cell.flags(self.rho);
        let own = decoded(cell.attribute);
        let drawn = below.iter().filter(|(_, cell)| cell.is_drawn);
        let samples = drawn.map(|(_, cell)| own.dot(decoded(cell.attribute)));
        let samples = samples.fold(1.0, f64::min);
        let is_narrowest = |cosine: f64| {
            let of = |cosine: f64| {
                let fits = |&bound: &u16| cosine >= f64::from(bound) / 32768.0;
                let first = APERTURE_COSINE.iter().position(fits);
                first.map_or(APERTURE_ALL, |aperture| aperture as u8)
            };
            (of(cosine + 2e-6)..=of(cosine - 2e-6)).contains(&flags.aperture)
        };
        if flags.is_sheet() {
            return false;
        }
        let sheets: Vec<_> = below
            .iter()
            .filter(|(_, cell)| !cell.record.is_empty() && cell.flags(self.rho).is_sheet())
            .collect();
        if sheets.is_empty() {
            assert!(is_narrowest(samples), "{flags:?}, cosine {samples}");
            return true;
        }
        let mut all = samples;
        for (depth, sheet) in sheets {
            let cell = bounds(sheet.place, self.axis(*depth));
            for face in &self.faces {
                if touches(&face.corners, cell, 1e-9) {
                    all = all.min(own.dot(decoded(face_code(face))));
                }
            }
        }
        let bound = |aperture: u8| {
            APERTURE_COSINE
                .get(usize::from(aperture))
                .map_or(-1.0, |&cosine| f64::from(cosine) / 32768.0)
        };
        assert!(
            samples >= bound(flags.aperture) - 1e-6,
            "{flags:?}, cosine {samples}"
        );
        let is_needed = flags.aperture == 0 || all < bound(flags.aperture - 1) + 2e-6;
        assert!(is_needed, "{flags:?}, cosine {all}");
        false
    }

    /// A cell one of whose drawn children is opposed to what may be drawn below
    /// it is a sheet.
    fn check_sides(&self, depth: usize, cell: &Cell) {
        for child in &self.depths[depth + 1][cell.children.clone()] {
            if child.record.is_empty() || !child.is_drawn {
                continue;
            }
            let own = decoded(child.attribute);
            let is_opposed = self
                .below(depth + 1, child)
                .iter()
                .filter(|(_, cell)| cell.is_drawn)
                .any(|(_, cell)| own.dot(decoded(cell.attribute)) < OPPOSED_COSINE - 1e-6);
            assert!(!is_opposed || cell.flags(self.rho).is_sheet());
        }
    }
}

fn face_code(face: &Face) -> u16 {
    let [a, b, c] = face.corners;
    let front = (b - a).cross(c - a).normalize_or_zero();
    encode((front * f64::from(1 << 26)).to_array().map(|c| c as i32))
}

/// Gives how many cones were a matter of samples alone, of how many.
#[track_caller]
fn check(name: &str, mesh: &Mesh, options: &GridOptions) -> (usize, usize) {
    let twin = Twin::new(mesh, options);
    let (mut exact, mut all) = (0, 0);
    for (depth, cell) in twin.intermediate() {
        let below = twin.below(depth, cell);
        let checked = std::panic::catch_unwind(|| {
            twin.check_attribute(depth, cell, &below);
            twin.check_sides(depth, cell);
            twin.check_cone(cell, &below)
        });
        let Ok(is_exact) = checked else {
            panic!(
                "{name}, {options:?}: cell {:?} of depth {depth}",
                cell.place
            );
        };
        exact += usize::from(is_exact);
        all += 1;
    }
    (exact, all)
}

#[test]
fn curved_shapes_have_the_twins_filtered_samples_and_cones() {
    for (rho, level) in LEVELS {
        for options in [options(rho, level), thin(rho, level)] {
            for (name, mesh) in [("torus", torus()), ("sphere", shapes::sphere(12))] {
                let (exact, all) = check(name, &mesh, &options);
                assert!(2 * exact > all, "{name}, {options:?}: {exact} of {all}");
            }
        }
    }
}

#[test]
fn nearest_normals_stay_and_have_cones_of_their_own() {
    for (rho, level) in LEVELS {
        let options = GridOptions {
            normals: Normals::Nearest,
            ..thin(rho, level)
        };
        let (exact, all) = check("torus", &torus(), &options);
        assert!(2 * exact > all, "{options:?}: {exact} of {all}");
    }
}

#[test]
fn random_slivers_have_the_twins_filtered_samples_and_cones() {
    let mut random = Random(0x510e_527f_ade6_82d1);
    for round in 0..12 {
        let mesh = soup(&slivers(&mut random));
        let (rho, level) = LEVELS[round % 4];
        let level = level.min(2);
        check(&format!("round {round}"), &mesh, &options(rho, level));
        check(&format!("round {round}"), &mesh, &thin(rho, level));
    }
}

/// Spheres whose corners are pushed in and out at random, with normals of
/// their faces.
#[test]
fn random_closed_surfaces_have_the_twins_filtered_samples_and_cones() {
    let mut random = Random(0x9b05_688c_2b3e_6c1f);
    for round in 0..8 {
        let mut mesh = shapes::sphere(3 + round % 5);
        for position in &mut mesh.positions {
            *position *= 1.0 + 0.4 * random.next();
        }
        let corners = mesh.triangles.iter().map(|triangle| {
            let at = triangle.positions;
            at.map(|index| mesh.positions[index as usize])
        });
        let mesh = moved(&soup(&corners.collect::<Vec<_>>()), |position| position);
        let (rho, level) = LEVELS[round as usize % 4];
        check(&format!("round {round}"), &mesh, &options(rho, level));
        check(&format!("round {round}"), &mesh, &thin(rho, level));
    }
}

/// Four bits lose little: of the leaves that cones of exact angles about the
/// same axes would keep, quantized ones keep a tenth more at most.
#[test]
fn quantized_cones_keep_few_leaves_more_than_exact_ones() {
    let twin = Twin::new(&demo(), &thin(3, 4));
    let above_leaves = twin.depths.len() - 2;
    let axis = twin.axis(above_leaves);
    let (mut kept, mut exact) = (0, 0);
    for view in 0..12 {
        let yaw = f64::from(view) * 30f64.to_radians();
        let (sin, cos) = yaw.sin_cos();
        let eye = DVec3::new(sin, 0.27, cos) * 2.6;
        for cell in &twin.depths[above_leaves] {
            let (min, max) = bounds(cell.place, axis);
            let own = decoded(cell.attribute);
            // Sine of the angle by which the axis leans away.
            let away = own.dot(((min + max) / 2.0 - eye).normalize());
            let leaves: Vec<&Cell> = twin.depths[above_leaves + 1][cell.children.clone()]
                .iter()
                .filter(|leaf| leaf.is_drawn)
                .collect();
            let aperture = usize::from(cell.flags(3).aperture);
            let quantized = APERTURE_COSINE
                .get(aperture)
                .map_or(-1.0, |&cosine| f64::from(cosine) / 32768.0);
            let cosines = leaves.iter().map(|leaf| own.dot(decoded(leaf.attribute)));
            let least = match quantized < 0.0 {
                true => -1.0,
                false => cosines.fold(1.0, f64::min),
            };
            let keeps = |cosine: f64| cosine < 0.0 || away <= (1.0 - cosine * cosine).sqrt();
            kept += leaves.len() * usize::from(keeps(quantized));
            exact += leaves.len() * usize::from(keeps(least));
        }
    }
    assert!(kept >= exact && 10 * kept <= 11 * exact, "{kept}, {exact}");
}
