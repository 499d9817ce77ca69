//! Progressive loading: bytes up to the end of a level are the coarser model.

use rhogrid::asset_file::AssetFile;
use rhogrid::geometry::Mesh;
use rhogrid::import::procedural::shapes;
use rhogrid_core::asset::{AssetError, HEADER_BYTES, SECTION_BYTES, SECTION_LEVEL};

use super::{baked, options, plate};

fn word(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// Where each level ends.
fn level_ends(bytes: &[u8]) -> Vec<usize> {
    (0..usize::from(bytes[15]))
        .map(|index| HEADER_BYTES + SECTION_BYTES * index)
        .filter(|&entry| word(bytes, entry) == SECTION_LEVEL as usize)
        .map(|entry| word(bytes, entry + 4) + word(bytes, entry + 8))
        .collect()
}

fn check(mesh: &Mesh, rho: u8, level: u8) {
    let whole = baked(mesh, &options(rho, level));
    let ends = level_ends(whole.bytes());
    assert_eq!(ends.len(), usize::from(level) + 2);
    assert_eq!(ends.last(), Some(&whole.bytes().len()));
    for (depth, &end) in ends.iter().enumerate() {
        let cut = AssetFile::new(&whole.bytes()[..end]).unwrap();
        let grid = cut.grid();
        assert_eq!(usize::from(grid.depth()), depth);
        assert_eq!(grid.stored_depth(), level + 1);
        assert_eq!(grid.radius(), whole.grid().radius());
        assert_eq!(cut.cube(), whole.cube());
        if depth == 0 {
            continue;
        }
        let coarse = baked(mesh, &options(rho, depth as u8 - 1));
        for (a, b) in grid.levels().iter().zip(coarse.grid().levels()) {
            assert_eq!(a.attributes, b.attributes, "rho {rho}, depth {depth}");
            assert_eq!(a.links, b.links);
            assert_eq!(a.nodes, b.nodes, "rho {rho}, depth {depth}");
        }
        assert_eq!(grid.levels().len(), coarse.grid().levels().len());
    }
}

#[test]
fn every_level_boundary_ends_a_coarser_model() {
    for (rho, level) in [(2, 5), (3, 3), (4, 2), (5, 1)] {
        check(&shapes::torus(24, 12), rho, level);
        // Thinner than coarse leaves, thicker than fine ones.
        check(&plate(0.05), rho, level);
        check(&shapes::quad(), rho, level);
    }
}

#[test]
fn every_other_cut_is_an_error() {
    for (rho, level) in [(2, 2), (3, 1), (4, 0), (5, 0)] {
        let whole = baked(&shapes::torus(12, 6), &options(rho, level));
        let bytes = whole.bytes();
        let ends = level_ends(bytes);
        for length in (0..bytes.len()).filter(|length| !ends.contains(length)) {
            let error = AssetFile::new(&bytes[..length]).unwrap_err();
            assert!(
                matches!(error, AssetError::Truncated { length: at } if at as usize == length),
                "rho {rho}, {length} bytes: {error}"
            );
        }
        for more in 1..9 {
            let longer = [bytes, &vec![0; more]].concat();
            assert!(
                AssetFile::new(&longer).is_err(),
                "{more} bytes behind the end"
            );
        }
    }
}
