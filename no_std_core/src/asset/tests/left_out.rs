//! Features: what a build leaves out does not open. `tests/run` runs this
//! with one rho alone, too.

use super::*;
use crate::asset::is_built;
#[cfg(feature = "rho-3")]
use crate::testing::Coder;

#[test]
fn exactly_what_is_built_opens() {
    let mut rng = Rng::with_seed(53);
    for rho in 2..=5 {
        let bytes = aligned(&Model::random(&mut rng, rho, 2, 20.0).file().bytes());
        let opened = Grid::open(&bytes).map(|grid| grid.rho());
        let want = if is_built(rho) {
            Ok(rho)
        } else {
            Err(AssetError::LeftOut {
                offset: 9,
                feature: ["rho-2", "rho-3", "rho-4", "rho-5"][usize::from(rho) - 2],
            })
        };
        assert_eq!(opened, want);
    }
}

/// Where colours are left out, what has some does not open.
#[test]
#[cfg(feature = "rho-3")]
fn colours_open_where_they_are_built() {
    let mut rng = Rng::with_seed(55);
    let mut model = Model::random(&mut rng, 3, 2, 20.0);
    for bits in [32, 48] {
        model.attribute_bits = bits;
        let bytes = aligned(&model.file().bytes());
        let want = match cfg!(feature = "colour") {
            true => Ok(bits),
            false => Err(AssetError::LeftOut {
                offset: 11,
                feature: "colour",
            }),
        };
        assert_eq!(Grid::open(&bytes).map(|grid| grid.attribute_bits()), want);
    }
}

/// A file with a dictionary opens where its feature is built; cut before the
/// dictionary, everywhere.
#[test]
#[cfg(feature = "rho-3")]
fn dictionaries_open_where_they_are_built() {
    let mut rng = Rng::with_seed(54);
    let model = Model::random(&mut rng, 3, 3, 80.0);
    let file = Coder::of(&model, 2, 8).file(&model);
    let bytes = aligned(&file.bytes());
    // The root, depth 1, dictionary, depth 2, depth 3.
    let offset = file.ends()[1];
    let want = match cfg!(feature = "mask-dictionary") {
        true => Ok(3),
        false => Err(AssetError::LeftOut {
            offset: offset as u32,
            feature: "mask-dictionary",
        }),
    };
    assert_eq!(Grid::open(&bytes).map(|grid| grid.depth()), want);
    let cut = aligned(&file.bytes()[..offset]);
    assert_eq!(Grid::open(&cut).map(|grid| grid.depth()), Ok(1));
}
