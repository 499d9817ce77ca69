//! Materials of a file to the few that an attribute can name.

use std::collections::HashMap;

use crate::geometry::Material;

/// Materials that a mesh can have: 3 bits of a 16-bit attribute.
pub const MAX_MATERIALS: usize = 8;

/// Which materials stay, and which one each triangle has.
pub(super) struct Reduced {
    /// One to [`MAX_MATERIALS`] of different colours, in order of first use.
    pub materials: Vec<Material>,
    /// An index into `materials` for each triangle.
    pub of_triangles: Vec<u8>,
    /// Used colours that had to give way to a similar one.
    pub merged: usize,
}

/// A used colour.
struct Colour {
    material: Material,
    triangles: usize,
}

/// Joins materials of equal colour, drops unused ones, and keeps the
/// [`MAX_MATERIALS`] with the most triangles; each other one is replaced by
/// the kept one of the nearest colour. `of_triangles` index `materials`.
pub(super) fn reduce(materials: &[Material], of_triangles: &[u32]) -> Reduced {
    let mut colours: Vec<Colour> = Vec::new();
    let mut known = HashMap::new();
    let mut colour_of = vec![None; materials.len()];
    for &index in of_triangles {
        let material = &materials[index as usize];
        let colour = *colour_of[index as usize].get_or_insert_with(|| {
            *known.entry(material.diffuse).or_insert_with(|| {
                colours.push(Colour {
                    material: material.clone(),
                    triangles: 0,
                });
                colours.len() - 1
            })
        });
        colours[colour].triangles += 1;
    }
    let kept = most_used(&colours);
    let nearest: Vec<u8> = colours
        .iter()
        .map(|colour| nearest(&colours, &kept, colour))
        .collect();
    let code = |material: &u32| nearest[colour_of[*material as usize].unwrap_or(0)];
    Reduced {
        of_triangles: of_triangles.iter().map(code).collect(),
        materials: kept.iter().map(|&i| colours[i].material.clone()).collect(),
        merged: colours.len() - kept.len(),
    }
}

/// Indices of the colours to keep, in order of first use.
fn most_used(colours: &[Colour]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..colours.len()).collect();
    order.sort_by_key(|&i| std::cmp::Reverse(colours[i].triangles));
    order.truncate(MAX_MATERIALS);
    order.sort_unstable();
    order
}

/// The place in `kept` of the colour closest to `colour`.
fn nearest(colours: &[Colour], kept: &[usize], colour: &Colour) -> u8 {
    let distance = |i: &usize| -> u32 {
        let other = colours[*i].material.diffuse;
        let differences = colour
            .material
            .diffuse
            .into_iter()
            .zip(other)
            .map(|(a, b)| u32::from(a.abs_diff(b)));
        differences.map(|difference| difference * difference).sum()
    };
    let places = kept.iter().map(distance).zip(0..);
    places.min().map_or(0, |(_, place)| place)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn greys(values: &[u8]) -> Vec<Material> {
        values
            .iter()
            .map(|&value| Material {
                name: format!("g{value}"),
                diffuse: [value; 3],
            })
            .collect()
    }

    #[test]
    fn equal_colours_join_and_unused_ones_go() {
        let reduced = reduce(&greys(&[9, 5, 7, 5]), &[3, 2, 1, 2]);
        assert_eq!(reduced.materials, [greys(&[5]), greys(&[7])].concat());
        assert_eq!(reduced.of_triangles, [0, 1, 0, 1]);
        assert_eq!(reduced.merged, 0);
    }

    #[test]
    fn beyond_eight_the_rarest_go_to_the_nearest() {
        let mut of_triangles: Vec<u32> = (0..10).flat_map(|i| [i, i]).collect();
        of_triangles.retain(|&i| i != 4 && i != 7);
        of_triangles.extend([4, 7]);
        let reduced = reduce(
            &greys(&[0, 10, 20, 30, 41, 50, 60, 68, 80, 90]),
            &of_triangles,
        );
        let kept: Vec<u8> = reduced
            .materials
            .iter()
            .map(|material| material.diffuse[0])
            .collect();
        assert_eq!(kept, [0, 10, 20, 30, 50, 60, 80, 90]);
        assert_eq!(reduced.of_triangles[16..], [4, 5]);
        assert_eq!(reduced.merged, 2);
    }
}
