//! Normals estimated from the vertices of scans against those of their faces.

use std::path::Path;

use glam::Vec3;
use rhogrid::geometry::Geometry;
use rhogrid::import;

use super::folder;

/// What is estimated from a mesh's vertices, against its own normals.
struct Estimate {
    two_sided: bool,
    /// Degrees between the two, whatever the sign.
    mean: f64,
    /// Share that looks to the other side.
    turned: f64,
}

fn against_mesh(model: &str) -> Option<Estimate> {
    let Geometry::Mesh(mesh) = import::load(&folder()?.join(model)).unwrap().geometry else {
        panic!("a mesh");
    };
    let mut own = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.triangles {
        for (&position, &normal) in triangle.positions.iter().zip(&triangle.normals) {
            own[position as usize] += mesh.normals[normal as usize];
        }
    }
    let line = |place: &glam::DVec3| format!("v {} {} {}\n", place.x, place.y, place.z);
    let text: String = mesh.positions.iter().map(line).collect();
    let imported = import::parse(Path::new("points.obj"), text.as_bytes()).unwrap();
    let Geometry::Cloud(cloud) = imported.geometry else {
        panic!("a cloud");
    };
    let cosines = cloud.points.iter().zip(&own);
    let cosines = cosines.map(|(point, own)| f64::from(point.normal.dot(own.normalize_or_zero())));
    let cosines: Vec<f64> = cosines.collect();
    let count = cosines.len() as f64;
    let angles = cosines.iter().map(|cosine| cosine.abs().min(1.0).acos());
    let estimate = Estimate {
        two_sided: cloud.two_sided,
        mean: angles.sum::<f64>().to_degrees() / count,
        turned: cosines.iter().filter(|&&cosine| cosine < 0.0).count() as f64 / count,
    };
    println!(
        "{model}: {:.2} degrees, {:.3}% turned over, {}-sided",
        estimate.mean,
        100.0 * estimate.turned,
        if estimate.two_sided { "two" } else { "one" }
    );
    Some(estimate)
}

#[test]
fn vertices_alone_give_the_normals_of_their_mesh() {
    for model in [
        "bunny.ply",
        "nefertiti_100k.ply",
        "skull_100k.ply",
        "turbine_blade_199k.ply",
        "dragon_res2.ply",
    ] {
        let Some(estimate) = against_mesh(model) else {
            return;
        };
        assert!(!estimate.two_sided, "{model}");
        assert!(estimate.mean < 6.0 && estimate.turned < 0.001, "{model}");
    }
}

/// Their vertices lie farther apart than what they show.
#[test]
fn vertices_that_are_too_few_are_seen_from_both_sides() {
    for model in ["buddha_100k.ply", "lucy_100k.ply", "cow.ply"] {
        let Some(estimate) = against_mesh(model) else {
            return;
        };
        assert!(estimate.two_sided, "{model}");
    }
}
