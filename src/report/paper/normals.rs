//! Table 3: how exact normals are, by the level of their code.
//!
//! Source: Duguet and Drettakis 2003, 5.5: one less the dot product of a normal
//! and what its code stands for, estimated with random normals. Theirs and ours
//! are triangles of a subdivided octahedron; ours are of level 5.

use rhogrid_core::normal::{centroid, decode, encode, triangle};

use crate::report::page::Table;

/// Table 3: the error by level.
const TABLE_3: [(u32, f64); 5] = [(3, 0.017), (4, 0.004), (5, 0.001), (6, 2.6e-4), (7, 6.4e-5)];
/// The level of our code: 2^13 normals.
const OUR_LEVEL: u32 = 5;
/// Normals that are tried.
const COUNT: u32 = 200_000;

/// The table.
pub fn table() -> String {
    let columns = [
        "level",
        "normals",
        "the paper",
        "ours, at most",
        "ours, mean",
    ];
    let mut table = Table::new(&columns);
    for (level, paper) in TABLE_3 {
        let Errors { largest, mean } = errors(level);
        let normals = f64::from(8u32 << (2 * level));
        let name = format!("{level} | {normals}");
        table.line(name, [Some(paper), Some(largest), Some(mean)], 6);
    }
    format!(
        "\n## Table 3: error of a dot product by the level of normals\n\n\
        One less the cosine between a normal and what its code stands for, over {COUNT} normals \
        that are spread evenly. Level {OUR_LEVEL} is that of assets, 13 bits, as the core encodes \
        and decodes them; the others are the same triangles, subdivided less or more. No model, \
        no view.\n\n{table}"
    )
}

struct Errors {
    largest: f64,
    mean: f64,
}

fn errors(level: u32) -> Errors {
    let (mut largest, mut sum) = (0f64, 0.0);
    for index in 0..COUNT {
        let normal = direction(index);
        let own = coded(normal, level);
        let length = own.iter().map(|c| c * c).sum::<f64>().sqrt();
        let dot: f64 = normal.iter().zip(own).map(|(a, b)| a * b).sum();
        let error = 1.0 - dot / length;
        largest = largest.max(error);
        sum += error;
    }
    Errors {
        largest,
        mean: sum / f64::from(COUNT),
    }
}

/// Directions along a spiral from pole to pole, a golden angle apart.
fn direction(index: u32) -> [f64; 3] {
    let height = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(COUNT);
    let around = (1.0 - height * height).sqrt();
    let turn = f64::from(index) * 2.399_963_229_728_653;
    [around * turn.cos(), height, around * turn.sin()]
}

/// What a normal's code of a level stands for, of any length.
fn coded(normal: [f64; 3], level: u32) -> [f64; 3] {
    let fixed = normal.map(|c| (c * f64::from(1 << 24)) as i32);
    if level == OUR_LEVEL {
        return decode(encode(fixed)).map(f64::from);
    }
    let middle = centroid(triangle(fixed, level), level).map(|c| c as f64);
    [0, 1, 2].map(|axis| middle[axis].copysign(normal[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_as_exact_as_the_papers() {
        for (level, paper) in TABLE_3 {
            let ours = errors(level).largest;
            assert!(ours < paper && ours > 0.8 * paper, "{level}: {ours}");
        }
    }

    #[test]
    fn the_core_rounds_its_centroids_alone() {
        for index in (0..COUNT).step_by(1000) {
            let normal = direction(index);
            let fixed = normal.map(|c| (c * f64::from(1 << 24)) as i32);
            let exact = centroid(triangle(fixed, OUR_LEVEL), OUR_LEVEL).map(|c| c as f64);
            let length = exact.iter().map(|c| c * c).sum::<f64>().sqrt();
            let own = coded(normal, OUR_LEVEL).map(|c| c.abs() / f64::from(1 << 14));
            for (exact, own) in exact.iter().zip(own) {
                assert!((exact / length - own).abs() < 1e-4, "{normal:?}");
            }
        }
    }
}
