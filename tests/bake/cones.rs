//! Normal cones and two-sided flags of intermediate cells.

use glam::{DQuat, DVec3, EulerRot};
use rhogrid::bake::GridOptions;
use rhogrid::import::procedural::shapes;
use rhogrid_core::asset::node::APERTURE_ALL;

use super::cells::{Cell, cells};
use super::twin::{Face, bounds, faces, touches};
use super::{baked, moved, options, plate};

const LEVELS: [(u8, u8); 4] = [(2, 4), (3, 2), (4, 2), (5, 1)];

/// The intermediate cells of every depth with the cells on an axis.
fn intermediate(depths: &[Vec<Cell>], rho: u8) -> impl Iterator<Item = (&Cell, u32)> {
    depths
        .iter()
        .take(depths.len() - 1)
        .enumerate()
        .flat_map(move |(depth, own)| {
            own.iter()
                .map(move |cell| (cell, u32::from(rho).pow(depth as u32)))
        })
}

/// What a cone holds is [the twin's](super::filter).
#[test]
fn most_cones_of_simple_shapes_are_narrow() {
    for (rho, level) in LEVELS {
        for (name, mesh) in [
            ("sphere", shapes::sphere(12)),
            ("torus", shapes::torus(24, 12)),
            ("cube", shapes::cube()),
            ("quad", shapes::quad()),
        ] {
            let depths = cells(&baked(&mesh, &options(rho, level)).grid());
            let apertures = intermediate(&depths, rho).map(|(cell, _)| cell.flags(rho).aperture);
            let apertures: Vec<u8> = apertures.collect();
            let narrow = apertures.iter().filter(|&&own| own < APERTURE_ALL).count();
            assert!(
                2 * narrow >= apertures.len(),
                "{name}, rho {rho}: {narrow} cones of {} cells",
                apertures.len()
            );
        }
    }
}

#[test]
fn plates_thinner_than_a_leaf_are_two_sided_and_never_skipped() {
    // Rho odd: the middle slice holds both sheets.
    for (rho, level) in [(3, 2), (5, 1)] {
        let leaf = 2.0 / f64::from(rho).powi(i32::from(level) + 1);
        let asset = baked(&plate(leaf / 8.0), &options(rho, level));
        let depths = cells(&asset.grid());
        let parents = &depths[depths.len() - 2];
        assert!(
            parents.iter().all(|cell| cell.flags(rho).two_sided),
            "rho {rho}"
        );
        for (cell, _) in intermediate(&depths, rho) {
            assert_eq!(
                cell.flags(rho).aperture,
                APERTURE_ALL,
                "rho {rho}: {:?}",
                cell.place
            );
        }
        assert!(
            !asset.grid().two_sided(),
            "the asset as a whole stays one-sided"
        );
    }
}

/// A leaf that holds opposed faces lies in a two-sided node, wherever the
/// sides of cells cut the plate.
#[test]
fn tilted_plates_are_two_sided_where_a_leaf_holds_both_sheets() {
    for (rho, level) in LEVELS {
        let axis = u32::from(rho).pow(u32::from(level) + 1);
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.2, 0.1);
        let mesh = moved(&plate(0.25 / f64::from(axis)), |position| turn * position);
        let depths = cells(&baked(&mesh, &options(rho, level)).grid());
        let faces = faces(&mesh);
        let fronts = |cell: &Cell| -> Vec<DVec3> {
            let cell = bounds(cell.place, axis);
            let touching = faces
                .iter()
                .filter(|face| touches(&face.corners, cell, 0.0));
            touching
                .map(
                    |Face {
                         corners: [a, b, c], ..
                     }| (b - a).cross(c - a).normalize(),
                )
                .collect()
        };
        let (mut opposed, mut all) = (0, 0);
        for parent in &depths[depths.len() - 2] {
            for leaf in &depths[depths.len() - 1][parent.children.clone()] {
                let fronts = fronts(leaf);
                let is_opposed = fronts.iter().any(|front| front.dot(fronts[0]) < 0.0);
                assert!(
                    !is_opposed || parent.flags(rho).two_sided,
                    "rho {rho}: {:?}",
                    leaf.place
                );
                opposed += u32::from(is_opposed);
                all += 1;
            }
        }
        assert!(2 * opposed > all, "rho {rho}: {opposed} of {all} leaves");
    }
}

#[test]
fn solid_shapes_need_no_second_side() {
    for (rho, level) in LEVELS {
        for mesh in [shapes::sphere(24), shapes::cube(), shapes::quad()] {
            let depths = cells(&baked(&mesh, &options(rho, level)).grid());
            let mut flags = intermediate(&depths, rho).map(|(cell, _)| cell.flags(rho));
            assert!(flags.all(|flags| !flags.two_sided), "rho {rho}");
        }
    }
}

#[test]
fn two_sided_assets_say_so_in_every_node() {
    for (rho, level) in LEVELS {
        let mesh = shapes::sphere(12);
        let both = GridOptions {
            two_sided: true,
            ..options(rho, level)
        };
        let (one, two) = (baked(&mesh, &options(rho, level)), baked(&mesh, &both));
        assert!(two.grid().two_sided() && !one.grid().two_sided());
        let depths = cells(&two.grid());
        for (cell, _) in intermediate(&depths, rho) {
            assert!(cell.flags(rho).two_sided);
            assert_eq!(cell.flags(rho).aperture, APERTURE_ALL);
        }
        for (a, b) in one.grid().levels().iter().zip(two.grid().levels()) {
            assert_eq!(a.attributes, b.attributes, "the flag changes no sample");
        }
    }
}
