//! The hierarchy against its naive twin, and where it is deepest.

use glam::DVec3;

use super::super::ray::{Disc, Facet};
use super::*;

/// A generator for tests (Steele, Lea, Flood 2014: SplitMix).
pub(in crate::reference) struct Random(pub u64);

impl Random {
    /// From -1 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

/// The naive twin: every shape asked in turn.
fn agrees_with_all_shapes<S: Shape + Copy>(shapes: &[S], random: &mut Random) {
    let hierarchy = Hierarchy::new(shapes);
    assert_eq!(hierarchy.shapes().len(), shapes.len());
    let mut hits = 0;
    for number in 0..1000 {
        // At some shape, from anywhere around.
        let target = shapes
            .get(number % shapes.len().max(1))
            .map_or(Vec3::ZERO, |shape| {
                let (min, max) = shape.bounds();
                min.midpoint(max)
            });
        let origin = random.vector() * 3.0;
        let aim = target.as_dvec3() + random.vector() * 0.02;
        let mut ray = Ray::new(origin, (aim - origin) * (1.5 + random.next()));
        if number % 4 == 0 {
            // Along an axis, where slabs are met at infinity or not at all.
            let axis = [DVec3::X, DVec3::NEG_Y, DVec3::Z][number % 3];
            ray = Ray::new(aim - axis * 2.0, axis);
        }
        for sides in [Sides::Front, Sides::Both] {
            let all = shapes.iter().filter_map(|shape| shape.hit(&ray, sides));
            let expected = all.map(|hit| hit.distance).reduce(f64::min);
            let found = hierarchy.nearest(&ray, sides).map(|(_, hit)| hit.distance);
            assert_eq!(found, expected, "{number}: {ray:?}, {sides:?}");
            hits += usize::from(expected.is_some());
            let reach = expected.map_or(1.0, |distance| distance * 1.2);
            let all = shapes.iter().filter_map(|shape| shape.hit(&ray, sides));
            let near = all.filter(|hit| hit.distance < reach).count();
            assert_eq!(
                hierarchy.within(&ray, sides, reach).len(),
                near,
                "{number}: {ray:?}"
            );
        }
        let any = shapes
            .iter()
            .any(|shape| shape.hit(&ray, Sides::Both).is_some());
        assert_eq!(hierarchy.blocks(&ray), any, "{number}: {ray:?}");
    }
    assert!(shapes.is_empty() || hits > 50, "only {hits} hits");
}

#[test]
fn hierarchy_agrees_with_all_facets() {
    let mut random = Random(1);
    // From many small facets to few large ones; more than a join's worth; all
    // in one place, which no split parts.
    for (count, size) in [(2000, 0.05), (300, 0.6), (9, 1.0), (1, 1.0), (9000, 0.02)] {
        let facets: Vec<Facet> = (0..count)
            .map(|source| {
                let middle = random.vector();
                let corners = [(); 3].map(|()| (middle + random.vector() * size).as_vec3());
                Facet { corners, source }
            })
            .collect();
        agrees_with_all_shapes(&facets, &mut random);
        agrees_with_all_shapes(&facets[..1].repeat(50), &mut random);
    }
    agrees_with_all_shapes::<Facet>(&[], &mut random);
}

#[test]
fn hierarchy_agrees_with_all_discs() {
    let mut random = Random(2);
    for (count, radius) in [(2000, 0.05), (100, 0.5)] {
        let discs: Vec<Disc> = (0..count)
            .map(|_| Disc {
                centre: random.vector().as_vec3(),
                normal: random.vector().normalize().as_vec3(),
                radius,
                source: 0,
            })
            .collect();
        agrees_with_all_shapes(&discs, &mut random);
    }
}

/// Places that halve towards the origin until they are equal: splits by area
/// part off a few at a time.
#[test]
fn lopsided_scenes_fit_the_stack() {
    let facets: Vec<Facet> = (0..5000)
        .map(|source| {
            let corner = Vec3::splat(0.97_f32.powi(source));
            Facet {
                corners: [corner, corner * 0.98, corner * Vec3::new(1.0, 0.98, 0.99)],
                source: source as u32,
            }
        })
        .collect();
    let hierarchy = Hierarchy::new(&facets);
    for direction in [DVec3::ONE, DVec3::NEG_ONE] {
        // The diagonal meets every box.
        let mut met = vec![0; facets.len()];
        hierarchy.visit(
            &Ray::new(direction * -3.0, direction),
            f64::INFINITY,
            |facet, _| {
                met[facet.source as usize] += 1;
                false
            },
        );
        assert_eq!(met.iter().position(|&times| times != 1), None);
    }
}
