//! `rhogrid info`.

use std::path::PathBuf;

use clap::Args;
use rhogrid_core::asset::coded::BASE_LINKS;
use rhogrid_core::asset::node::occupied;
use rhogrid_core::asset::{Grid, Level, Shell};
use serde::Serialize;

use super::Failure;
use crate::asset_file::AssetFile;

/// Arguments of `rhogrid info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// Asset to describe
    file: PathBuf,
    /// One JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// What an asset holds.
#[derive(Debug, Serialize)]
pub struct Description {
    kind: &'static str,
    rho: u8,
    /// Level k has rho^(k + 1) cells on an axis; -1 is the root alone.
    level: i16,
    /// The level of the whole file, where this one was cut.
    stored_level: i16,
    shell: &'static str,
    two_sided: bool,
    up: &'static str,
    /// Stored cells.
    pub cells_per_depth: Vec<usize>,
    /// Those that are drawn where drawing stops at their depth.
    pub drawn_cells_per_depth: Vec<usize>,
    /// Non-empty subcells of an intermediate cell, in the mean.
    pub alpha: Option<f64>,
    materials: Vec<[u8; 3]>,
    centre: [f64; 3],
    half_side: f64,
    radius: f64,
    attribute_bits: u8,
    /// The whole file.
    pub bytes_total: usize,
    /// What they are for.
    pub bytes: ByteCounts,
    /// Everything counted: masks, links, attributes, tables, header. A leaf
    /// sample is a drawn cell of the finest level.
    bits_per_leaf_sample: f64,
    /// How masks are written: plain, or with a dictionary.
    masks: &'static str,
    coded: Option<Coded>,
}

/// Where an asset's bytes go.
#[derive(Debug, Serialize)]
pub struct ByteCounts {
    /// Indices of first grandchildren.
    pub links: usize,
    /// Node records: occupancy, cones; or their codes.
    pub masks: usize,
    /// Drawn records, where a level has some of its own; or their codes.
    pub drawn_masks: usize,
    /// Masks that codes name by index.
    pub dictionary: usize,
    /// Records that no code stands for.
    pub escapes: usize,
    /// Attributes of all samples, with their colours.
    pub attributes: usize,
    /// Header, section table, materials, counts, padding, small tables of
    /// coded levels.
    pub rest: usize,
}

impl ByteCounts {
    fn of(grid: &Grid<'_>, total: usize) -> Self {
        let levels = || grid.levels().iter();
        let words = |of: &[u16]| 2 * of.len();
        let links = (0..grid.levels().len())
            .map(|depth| link_bytes(grid, depth))
            .sum();
        let masks = levels().map(|level| words(level.nodes)).sum();
        let drawn_masks = (0..)
            .zip(levels())
            .filter(|&(depth, _)| grid.stores_drawn(depth))
            .map(|(_, level)| words(level.drawn))
            .sum();
        let dictionary = grid.dictionary().map_or(0, |masks| 4 * masks.len());
        let escapes = 4 * escapes(grid);
        let bytes = usize::from(grid.attribute_bits() / 8);
        let attributes = levels().map(|level| bytes * level.cells()).sum();
        Self {
            links,
            masks,
            drawn_masks,
            dictionary,
            escapes,
            attributes,
            rest: total - links - masks - drawn_masks - dictionary - escapes - attributes,
        }
    }
}

fn link_bytes(grid: &Grid<'_>, depth: usize) -> usize {
    match grid.coding(depth) {
        None => 4 * grid.levels()[depth].links.len(),
        Some(coding) => 2 * coding.links() + 4 * coding.links().div_ceil(BASE_LINKS),
    }
}

/// Records that no code stands for.
fn escapes(grid: &Grid<'_>) -> usize {
    let codings = (0..grid.levels().len()).filter_map(|depth| grid.coding(depth));
    codings.map(|coding| coding.escapes()).sum()
}

/// What a file's coded masks are made of.
#[derive(Debug, Serialize)]
struct Coded {
    /// Masks of the dictionary.
    dictionary: usize,
    /// Levels whose records are codes.
    levels: Vec<i16>,
    /// Those records, nodes and drawn ones.
    records: usize,
    /// Those of them that no code stands for.
    escapes: usize,
}

impl Coded {
    fn of(grid: &Grid<'_>) -> Option<Self> {
        let dictionary = grid.dictionary()?.len();
        let levels = (0u8..).zip(grid.levels());
        let coded: Vec<_> = levels
            .filter(|&(depth, _)| grid.coding(usize::from(depth)).is_some())
            .collect();
        let records = |&(depth, level): &(u8, &Level<'_>)| {
            level.nodes.len() * (1 + usize::from(grid.stores_drawn(depth)))
        };
        Some(Self {
            dictionary,
            levels: coded
                .iter()
                .map(|&(depth, _)| i16::from(depth) - 1)
                .collect(),
            records: coded.iter().map(records).sum(),
            escapes: escapes(grid),
        })
    }
}

/// Drawn cells of every depth; the root is one.
fn drawn_cells(grid: &Grid<'_>) -> Vec<usize> {
    let rho = grid.rho();
    let below = (1..grid.levels().len()).map(|depth| {
        let records = grid.drawn_records(depth);
        records
            .map(|record| occupied(rho, record.halves()) as usize)
            .sum()
    });
    std::iter::once(1).chain(below).collect()
}

impl Description {
    /// Describes an asset.
    pub fn of(asset: &AssetFile) -> Self {
        let grid = asset.grid();
        let cells: Vec<usize> = grid.levels().iter().map(|level| level.cells()).collect();
        let drawn = drawn_cells(&grid);
        let all: usize = cells.iter().sum();
        let intermediate = all - cells.last().copied().unwrap_or(1);
        let leaves = drawn.last().copied().unwrap_or(1).max(1);
        let cube = asset.cube();
        let coded = Coded::of(&grid);
        Self {
            kind: "grid",
            rho: grid.rho(),
            level: i16::from(grid.depth()) - 1,
            stored_level: i16::from(grid.stored_depth()) - 1,
            shell: match grid.shell() {
                Shell::Fat => "fat",
                Shell::Thin => "thin",
            },
            two_sided: grid.two_sided(),
            up: asset.up().name(),
            alpha: (intermediate > 0).then(|| (all - 1) as f64 / intermediate as f64),
            cells_per_depth: cells,
            drawn_cells_per_depth: drawn,
            materials: grid.materials().to_vec(),
            centre: cube.centre.to_array(),
            half_side: cube.half_side,
            radius: cube.radius,
            attribute_bits: grid.attribute_bits(),
            bytes_total: asset.bytes().len(),
            bytes: ByteCounts::of(&grid, asset.bytes().len()),
            bits_per_leaf_sample: asset.bytes().len() as f64 * 8.0 / leaves as f64,
            masks: match coded {
                None => "plain",
                Some(_) => "dictionary",
            },
            coded,
        }
    }

    /// How masks are written, for people.
    fn masks_in_words(&self) -> String {
        match &self.coded {
            None => self.masks.into(),
            Some(coded) => format!(
                "{} of {}; levels {:?} have {} records, {} of them escapes ({:.2} %)",
                self.masks,
                coded.dictionary,
                coded.levels,
                coded.records,
                coded.escapes,
                100.0 * coded.escapes as f64 / coded.records.max(1) as f64
            ),
        }
    }

    /// One line for people.
    pub fn summary(&self) -> String {
        format!(
            "{} rho {} level {}, {} shell, {} leaf samples, {} bytes, {:.2} bits a leaf sample",
            self.kind,
            self.rho,
            self.level,
            self.shell,
            self.drawn_cells_per_depth.last().unwrap_or(&0),
            self.bytes_total,
            self.bits_per_leaf_sample
        )
    }
}

/// Opens and describes.
pub fn run(args: &InfoArgs) -> Result<(), Failure> {
    let asset = AssetFile::load(&args.file)?;
    let description = Description::of(&asset);
    if args.json {
        return super::print_json(&description);
    }
    super::say(format_args!(
        "{}: {}",
        args.file.display(),
        description.summary()
    ))?;
    if description.level < description.stored_level {
        super::say(format_args!(
            "cut: the whole file reaches level {}",
            description.stored_level
        ))?;
    }
    super::say(format_args!("shell      {}", description.shell))?;
    super::say(format_args!(
        "two-sided  {}",
        if description.two_sided { "yes" } else { "no" }
    ))?;
    super::say(format_args!("source up  {}", description.up))?;
    super::say(format_args!(
        "cells      {:?} by depth",
        description.cells_per_depth
    ))?;
    super::say(format_args!(
        "drawn      {:?} where drawing stops at a depth",
        description.drawn_cells_per_depth
    ))?;
    let bytes = &description.bytes;
    super::say(format_args!(
        "bytes      {} links, {} masks, {} drawn masks, {} dictionary, {} escapes, {} attributes, {} rest",
        bytes.links,
        bytes.masks,
        bytes.drawn_masks,
        bytes.dictionary,
        bytes.escapes,
        bytes.attributes,
        bytes.rest
    ))?;
    super::say(format_args!(
        "samples    {} bits each",
        description.attribute_bits
    ))?;
    super::say(format_args!("masks      {}", description.masks_in_words()))?;
    if let Some(alpha) = description.alpha {
        super::say(format_args!(
            "alpha      {alpha:.2} non-empty subcells a cell"
        ))?;
    }
    super::say(format_args!("materials  {:?}", description.materials))?;
    let [x, y, z] = description.centre;
    super::say(format_args!("centre     {x} {y} {z}, source units, y up"))?;
    super::say(format_args!(
        "half side  {}, radius {}",
        description.half_side, description.radius
    ))?;
    Ok(())
}
