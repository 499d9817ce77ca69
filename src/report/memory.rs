//! What a leaf sample costs in memory, by rho.
//!
//! Source: Duguet and Drettakis 2003, 4.3 and table 1, which is computed: S =
//! (sigma + rho^3) / (rho^d - 1) bits, with d = 2 for a surface. That counts
//! rho^3 bits and one attribute for each intermediate cell, and no attributes
//! of leaves. Here cells are counted in baked shells, and what a file needs
//! beyond a mask's bits counts too: flags, padding, links, header.

use rhogrid_core::asset::{Shell, max_depth};

use super::page::Table;
use super::row::{Row, Setting, Subject, shell_name};
use super::{Chapter, Means, Model};
use crate::bake::GridOptions;
use crate::cli::Description;
use crate::error::Error;

pub(super) const CHAPTER: Chapter = Chapter {
    name: NAME,
    title: "Memory a leaf sample (the paper's table 1)",
    measure,
    write,
    introduction: "\
Bits a leaf sample, for sigma bits an attribute. *Paper* is its table 1, computed for
alpha = rho^2. *Counted* is the paper's sum, (sigma + rho^3) bits an intermediate cell, over
the cells of a baked fat shell. *File* is what the baked file takes apart from its leaves'
attributes: masks with their flags and padding, links, header, and sigma bits an intermediate
sample; *thin* holds about half of the leaves, and a second mask for every intermediate cell
above the last. Add sigma for the leaves' own attributes. Alpha is the mean number of non-empty
subcells: of all intermediate cells, and of those above the leaves.
",
    plot: None,
};

const NAME: &str = "memory";
/// The subdivisions that are compared.
pub(super) const RHOS: [u8; 4] = [2, 3, 4, 5];
/// Table 1: bits an attribute, and the paper's bits a leaf sample by rho.
const TABLE_1: [(u8, [f64; RHOS.len()]); 7] = [
    (0, [2.66, 3.38, 4.26, 5.21]),
    (4, [4.0, 3.88, 4.53, 5.375]),
    (8, [5.33, 4.38, 4.8, 5.54]),
    (12, [6.67, 4.88, 5.06, 5.71]),
    (16, [8.0, 5.38, 5.33, 5.88]),
    (32, [13.33, 7.38, 6.4, 6.54]),
    (48, [18.67, 9.38, 7.47, 7.21]),
];
/// Bits of a file's attributes.
const FILE_BITS: u8 = 16;

const COUNTED: &str = "counted_bits_per_leaf_sample";
const FILE: &str = "file_bits_per_leaf_sample";
const WHOLE: &str = "whole_file_bits_per_leaf_sample";
const ALPHA: &str = "alpha";
const LAST_ALPHA: &str = "alpha_of_last_level";
const LEAVES: &str = "leaf_samples";
const AXIS: &str = "cells_per_axis";

/// The level of a rho whose number of cells on an axis is nearest to `cells`,
/// by ratio.
pub(super) fn comparable(rho: u8, cells: u32) -> u8 {
    let distance = |level: u8| {
        let own = f64::from(rho).powi(i32::from(level) + 1);
        (own / f64::from(cells)).ln().abs()
    };
    let levels = 0..max_depth(rho);
    levels
        .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(0)
}

/// How assets are baked that are compared by rho.
pub(super) fn bake_at(rho: u8, shell: Shell, cells: u32) -> GridOptions {
    GridOptions {
        rho,
        level: comparable(rho, cells),
        shell,
        ..GridOptions::default()
    }
}

fn measure(model: &Model, means: Means<'_>) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for (at, rho) in RHOS.into_iter().enumerate() {
        for shell in [Shell::Fat, Shell::Thin] {
            let options = bake_at(rho, shell, means.effort.cells);
            let baked = model.baked(options, means.progress)?;
            let counts = Counts::of(&Description::of(&baked.asset));
            rows.extend(counts.rows(model, options, at));
        }
    }
    Ok(rows)
}

/// What a file holds.
struct Counts {
    leaves: f64,
    intermediate: f64,
    /// Intermediate cells above the leaves.
    last: f64,
    /// Leaves and what is stored beside them.
    stored_last: f64,
    alpha: f64,
    /// Bits of the file without attributes.
    structure: f64,
    whole: f64,
}

impl Counts {
    fn of(description: &Description) -> Self {
        let cells: Vec<f64> = description
            .cells_per_depth
            .iter()
            .map(|&n| n as f64)
            .collect();
        let drawn = description.drawn_cells_per_depth.last();
        let stored_last = cells.last().copied().unwrap_or(1.0);
        let bytes = description.bytes_total - description.bytes.attributes;
        Self {
            leaves: drawn.map_or(1.0, |&drawn| drawn as f64).max(1.0),
            intermediate: cells.iter().sum::<f64>() - stored_last,
            last: cells.iter().rev().nth(1).copied().unwrap_or(1.0),
            stored_last,
            alpha: description.alpha.unwrap_or(0.0),
            structure: 8.0 * bytes as f64,
            whole: 8.0 * description.bytes_total as f64,
        }
    }

    fn rows(&self, model: &Model, bake: GridOptions, at: usize) -> Vec<Row> {
        let row = |bits: Option<u8>, measure, value, unit, paper| Row {
            chapter: NAME,
            model: model.name.clone(),
            view: "",
            setting: Setting {
                attribute_bits: bits,
                ..Setting::file(bake)
            },
            measure,
            value,
            unit,
            paper,
        };
        let rho = f64::from(bake.rho);
        let alpha = rho.powi(2);
        let axis = rho.powi(i32::from(bake.level) + 1);
        let mut rows = vec![
            row(None, AXIS, axis, "cells", None),
            row(None, LEAVES, self.leaves, "samples", None),
            row(None, ALPHA, self.alpha, "cells", Some(alpha)),
            row(
                None,
                LAST_ALPHA,
                self.stored_last / self.last,
                "cells",
                Some(alpha),
            ),
            row(
                Some(FILE_BITS),
                WHOLE,
                self.whole / self.leaves,
                "bits",
                None,
            ),
        ];
        for (bits, paper) in TABLE_1 {
            let (sigma, paper) = (f64::from(bits), Some(paper[at]));
            if bake.shell == Shell::Fat {
                let counted = (sigma + rho.powi(3)) * self.intermediate / self.leaves;
                rows.push(row(Some(bits), COUNTED, counted, "bits", paper));
            }
            let file = (self.structure + sigma * self.intermediate) / self.leaves;
            rows.push(row(Some(bits), FILE, file, "bits", paper));
        }
        rows
    }
}

fn write(rows: &[&Row]) -> String {
    let find = |rho: u8, shell: Shell, bits: Option<u8>, measure: &str| {
        rows.iter().find(|row| {
            let Setting {
                subject,
                bake,
                attribute_bits,
                ..
            } = row.setting;
            let is_own = bake.is_some_and(|bake| (bake.rho, bake.shell) == (rho, shell));
            subject == Subject::File && is_own && attribute_bits == bits && row.measure == measure
        })
    };
    let mut table = Table::new(&["", "rho = 2", "rho = 3", "rho = 4", "rho = 5"]);
    let mut line = |name: String, shell, bits, measure: &str, digits| {
        table.line(
            name,
            RHOS.map(|rho| find(rho, shell, bits, measure).map(|row| row.value)),
            digits,
        );
    };
    line("cells on an axis".into(), Shell::Fat, None, AXIS, 0);
    for shell in [Shell::Fat, Shell::Thin] {
        let name = shell_name(shell);
        line(format!("leaf samples, {name}"), shell, None, LEAVES, 0);
        line(format!("alpha, {name}"), shell, None, ALPHA, 2);
        line(
            format!("alpha above the leaves, {name}"),
            shell,
            None,
            LAST_ALPHA,
            2,
        );
    }
    for (bits, _) in TABLE_1 {
        let paper = RHOS.map(|rho| find(rho, Shell::Fat, Some(bits), COUNTED)?.paper);
        table.line(format!("sigma = {bits}: paper"), paper, 2);
        let mut line = |name: &str, shell, measure: &str| {
            let values = RHOS.map(|rho| find(rho, shell, Some(bits), measure).map(|row| row.value));
            table.line(name.into(), values, 2);
        };
        line("counted, fat", Shell::Fat, COUNTED);
        line("file, fat", Shell::Fat, FILE);
        line("file, thin", Shell::Thin, FILE);
    }
    for shell in [Shell::Fat, Shell::Thin] {
        let whole = RHOS.map(|rho| find(rho, shell, Some(FILE_BITS), WHOLE).map(|row| row.value));
        let name = shell_name(shell);
        table.line(
            format!("all of the file, {name}, sigma = {FILE_BITS}"),
            whole,
            2,
        );
    }
    table.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comparable_levels_have_the_nearest_numbers_of_cells() {
        let axes =
            |cells: u32| RHOS.map(|rho| u32::from(rho).pow(u32::from(comparable(rho, cells)) + 1));
        assert_eq!(axes(729), [1024, 729, 1024, 625]);
        assert_eq!(axes(243), [256, 243, 256, 125]);
        assert_eq!(axes(1), [2, 3, 4, 5]);
        assert_eq!(axes(u32::MAX), [1 << 15, 19683, 1 << 14, 15625]);
    }
}
