//! A hundred thousand damaged assets, their checksums made right again: none
//! panics, none draws out of bounds.
//!
//! Overflow traps in the profile that tests run in, so every sum and shift is
//! watched, too. The target's slices are exactly as long as its band and are
//! cut out of the middle of larger buffers: the core has no unsafe code and
//! cannot reach past a slice, and the words on either side are compared all
//! the same.

mod layout;
mod mutate;
mod scene;

use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::prelude::*;
use rhogrid::asset_file::AssetFile;
use rhogrid::bake::writer::seal;
use rhogrid_core::asset::Grid;
use rhogrid_core::numbers::Length;

use layout::Layout;
use mutate::{Mutant, Random};
use scene::{Buffers, Drawn, INSIDE, OUTSIDE};

const RUNS: u64 = 100_000;
const SEED: u64 = 0x5eed_0f0a_55e7;

#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    opened: u64,
    drawn: u64,
    with_samples: u64,
    with_pixels: u64,
}

impl Tally {
    fn plus(self, other: Self) -> Self {
        Self {
            opened: self.opened + other.opened,
            drawn: self.drawn + other.drawn,
            with_samples: self.with_samples + other.with_samples,
            with_pixels: self.with_pixels + other.with_pixels,
        }
    }
}

/// One damaged asset, opened and drawn.
fn run(assets: &[Layout], distances: &[Length], index: u64, buffers: &mut Buffers) -> Tally {
    let mut random = Random::of(SEED, index);
    let asset = &assets[random.below(assets.len())];
    let mut mutant = Mutant::new(asset);
    let done = catch_unwind(AssertUnwindSafe(|| {
        mutant.damage(asset, &mut random);
        seal(&mut mutant.bytes);
        draw(&mutant.bytes, distances, &mut random, buffers)
    }));
    done.unwrap_or_else(|_| {
        panic!(
            "seed {SEED:#x}, index {index}, asset {}: {:?}",
            asset.name, mutant.log
        )
    })
}

fn draw(bytes: &[u8], distances: &[Length], random: &mut Random, buffers: &mut Buffers) -> Tally {
    // The words of the tool's file object keep the bytes aligned.
    buffers.words.clear();
    buffers.words.resize(bytes.len().div_ceil(4), 0);
    bytemuck::cast_slice_mut(&mut buffers.words)[..bytes.len()].copy_from_slice(bytes);
    let words = std::mem::take(&mut buffers.words);
    let aligned = &bytemuck::cast_slice(&words)[..bytes.len()];
    let opened = Grid::open(aligned);
    // What the tool refuses beyond the core are numbers for tools alone.
    assert!(opened.is_ok() || AssetFile::new(bytes).is_err());
    let tally = match opened {
        Err(error) => {
            assert!(!error.to_string().is_empty());
            Tally::default()
        }
        Ok(grid) => {
            let drawn = buffers.draw(&grid, distances, random);
            let Drawn { samples, pixels } = drawn;
            Tally {
                opened: 1,
                drawn: 1,
                with_samples: u64::from(samples > 0),
                with_pixels: u64::from(pixels > 0),
            }
        }
    };
    buffers.words = words;
    tally
}

/// Draws so many mutants.
fn tally(runs: u64, distances: &[Length]) -> Tally {
    let assets = scene::assets();
    let tally = (0..runs)
        .into_par_iter()
        .map_init(Buffers::default, |buffers, index| {
            run(&assets, distances, index, buffers)
        })
        .reduce(Tally::default, Tally::plus);
    println!("{runs} mutants: {tally:?}");
    tally
}

#[test]
fn no_mutant_panics_or_draws_out_of_bounds() {
    let tally = tally(RUNS, &OUTSIDE);
    // Most must get past the checks, or the test shows little.
    assert!(tally.opened * 5 >= RUNS, "{tally:?}");
    assert!(tally.with_pixels * 5 >= RUNS, "{tally:?}");
    assert!(tally.opened * 20 <= RUNS * 19, "too tame: {tally:?}");
}

#[test]

fn no_mutant_panics_around_the_eye() {
    let tally = tally(RUNS / 4, &INSIDE);
    assert!(tally.with_pixels * 20 >= RUNS, "{tally:?}");
}

/// Without damage every asset opens and draws: the generator's own check.
#[test]
fn untouched_assets_draw() {
    let mut buffers = Buffers::default();
    for asset in scene::assets() {
        let mut bytes = asset.bytes.clone();
        seal(&mut bytes);
        assert_eq!(
            bytes, asset.bytes,
            "{}: sealing changes nothing",
            asset.name
        );
        for index in 0..20 {
            let tally = draw(&bytes, &OUTSIDE, &mut Random::of(1, index), &mut buffers);
            assert_eq!(tally.drawn, 1, "{}", asset.name);
        }
    }
}
