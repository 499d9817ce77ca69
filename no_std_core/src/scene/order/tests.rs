use super::*;
use crate::asset::Grid;
use crate::numbers::{Length, Turns, Unit};
use crate::placement::Placement;
use crate::shadow::Sphere;
use crate::testing::view::signed;
use crate::testing::{Model, Rng, aligned, direction, dot};
use std::vec::Vec;

fn cube(rng: &mut Rng) -> crate::testing::model::Aligned {
    aligned(&Model::random(rng, 3, 1, 9.0).file().bytes())
}

fn at(yaw: f64, half_side: f64, origin: [f64; 3]) -> Placement {
    Placement::turned(
        Turns::from_num(yaw),
        Length::from_num(half_side),
        origin.map(Length::from_num),
    )
}

fn order(grid: &Grid<'_>, placements: &[Placement], towards: [f64; 3]) -> Option<Vec<usize>> {
    let instance = |&placement: &Placement| Instance {
        grid,
        placement,
        materials: None,
    };
    let instances: Vec<_> = placements.iter().map(instance).collect();
    let towards = towards.map(Unit::from_num);
    let space = LightSpace::new(towards, Sphere::around(&instances), 256);
    along(&space, &instances).map(|order| order[..instances.len()].to_vec())
}

#[test]
fn what_is_nearer_to_the_light_comes_first() {
    let mut rng = Rng::with_seed(81);
    let bytes = cube(&mut rng);
    let grid = Grid::open(&bytes).expect("valid");
    for _ in 0..200 {
        let towards = direction(&mut rng);
        let count = rng.usize(2..=8);
        // A row along the light, shuffled; spheres around cubes do not touch.
        let mut steps: Vec<usize> = (0..count).collect();
        rng.shuffle(&mut steps);
        let placements: Vec<_> = steps
            .iter()
            .map(|&step| at(rng.f64(), 0.5, towards.map(|c| c * step as f64 * 2.0)))
            .collect();
        let got = order(&grid, &placements, towards).expect("apart");
        let nearness: Vec<_> = got.iter().map(|&index| steps[index]).collect();
        assert!(nearness.is_sorted_by(|a, b| a > b), "{steps:?}: {got:?}");
    }
}

#[test]
fn a_shadow_falls_on_what_comes_later() {
    let mut rng = Rng::with_seed(82);
    let bytes = cube(&mut rng);
    let grid = Grid::open(&bytes).expect("valid");
    let (mut ordered, mut checked) = (0, 0);
    for case in 0..400 {
        let towards = direction(&mut rng);
        let placements: Vec<_> = (0..rng.usize(2..=6))
            .map(|_| {
                let origin = [0; 3].map(|_| 3.0 * signed(&mut rng));
                at(rng.f64(), 0.2 + rng.f64(), origin)
            })
            .collect();
        let Some(got) = order(&grid, &placements, towards) else {
            continue;
        };
        ordered += 1;
        // A point of a later one, moved along the light, must not lie deep in an
        // earlier one's box on the far side.
        for (place, &first) in got.iter().enumerate() {
            for &second in &got[place + 1..] {
                for _ in 0..50 {
                    let inside = |rng: &mut Rng| [0; 3].map(|_| 0.9 * signed(rng));
                    let world = |placement: &Placement, p: [f64; 3]| {
                        [0, 1, 2].map(|at| {
                            let parts = placement.axes.iter().zip(p);
                            let sum: f64 =
                                parts.map(|(axis, p)| axis[at].to_num::<f64>() * p).sum();
                            sum + placement.origin[at].to_num::<f64>()
                        })
                    };
                    let a = world(&placements[first], inside(&mut rng));
                    let b = world(&placements[second], inside(&mut rng));
                    let apart = [0, 1, 2].map(|at| b[at] - a[at]);
                    let along = dot(apart, towards);
                    let across = [0, 1, 2].map(|at| apart[at] - along * towards[at]);
                    checked += 1;
                    // On one ray of light the later one is not nearer to it.
                    let is_on_one_ray = dot(across, across) < 1e-4;
                    assert!(!is_on_one_ray || along < 0.2, "case {case}: {got:?}");
                }
            }
        }
    }
    assert!(
        ordered > 40 && checked > 1000,
        "{ordered} ordered, {checked}"
    );
}

#[test]
fn what_interpenetrates_has_no_order() {
    let mut rng = Rng::with_seed(83);
    let bytes = cube(&mut rng);
    let grid = Grid::open(&bytes).expect("valid");
    let placements = [at(0.0, 1.0, [0.0; 3]), at(0.1, 0.5, [0.6, 0.1, 0.2])];
    assert_eq!(order(&grid, &placements, [0.6, 0.8, 0.0]), None);
    let crowd = [placements[0]; MOST + 1];
    assert_eq!(order(&grid, &crowd, [0.6, 0.8, 0.0]), None);
    assert_eq!(order(&grid, &[], [0.6, 0.8, 0.0]), Some(std::vec![]));
}

#[test]
fn the_ground_comes_after_what_stands_on_it() {
    let mut rng = Rng::with_seed(84);
    let mut file = Model::random(&mut rng, 3, 1, 9.0).file();
    // As flat as a 1023rd part.
    let extents = 1023u32 | 1 << 10 | 1023 << 20;
    file.header[20..24].copy_from_slice(&extents.to_le_bytes());
    let (ground, solid) = (aligned(&file.bytes()), cube(&mut rng));
    let [ground, solid] = [&ground, &solid].map(|bytes| Grid::open(bytes).expect("valid"));
    let instance = |grid, placement| Instance {
        grid,
        placement,
        materials: None,
    };
    let instances = [
        instance(&ground, at(0.0, 4.0, [0.0; 3])),
        instance(&solid, at(0.1, 0.5, [1.0, 0.5, 0.0])),
        instance(&solid, at(0.3, 0.5, [-1.0, 0.5, 1.0])),
    ];
    for towards in [[0.6, 0.64, 0.48], [0.99, 0.1, 0.1], [0.0, 1.0, 0.0]] {
        let length = dot(towards, towards).sqrt();
        let towards = towards.map(|c| Unit::from_num(c / length));
        let space = LightSpace::new(towards, Sphere::around(&instances), 256);
        let order = along(&space, &instances).expect("the ground is a plane");
        assert_eq!(order[2], 0);
    }
}
