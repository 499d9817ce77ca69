//! Features: what a build leaves out does not open. `tests/run` runs this
//! with one rho alone, too.

use super::*;
use crate::asset::is_built;

#[test]
fn exactly_what_is_built_opens() {
    let mut rng = Rng::with_seed(53);
    for rho in 2..=5 {
        let bytes = aligned(&Model::random(&mut rng, rho, 2, 20.0).file().bytes());
        let opened = Grid::open(&bytes).map(|grid| grid.rho());
        let want = if is_built(rho) {
            Ok(rho)
        } else {
            Err(AssetError::LeftOut { rho })
        };
        assert_eq!(opened, want);
    }
}
