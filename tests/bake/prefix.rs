//! Progressive loading: bytes up to the end of a level are the coarser model.

use rhogrid::asset_file::AssetFile;
use rhogrid::cli::draw_frame;
use rhogrid::geometry::Mesh;
use rhogrid::import::procedural::shapes;
use rhogrid_core::asset::node::{flags_shift, halves};
use rhogrid_core::asset::{AssetError, HEADER_BYTES, SECTION_BYTES, SECTION_LEVEL};
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};

use super::cells::cells;
use super::{baked, options, plate, thin};

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

/// Node records without their flags.
fn occupancy(rho: u8, nodes: &[u16]) -> Vec<u16> {
    let size = halves(rho);
    let flags = 31 << flags_shift(rho);
    let without = |(index, &half): (usize, &u16)| match (index + 1) % size {
        0 => half & !flags,
        _ => half,
    };
    nodes.iter().enumerate().map(without).collect()
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
            // The longer file's normals and cones are those of its finest
            // samples.
            let materials = |of: &[u16]| -> Vec<u16> { of.iter().map(|own| own >> 13).collect() };
            assert_eq!(materials(a.attributes), materials(b.attributes));
            assert_eq!(a.links, b.links);
            assert_eq!(occupancy(rho, a.nodes), occupancy(rho, b.nodes));
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

/// Of every depth, in file order: places and materials of what is drawn.
fn drawn(asset: &AssetFile) -> Vec<Vec<([u32; 3], u16)>> {
    let of = |depth: Vec<super::cells::Cell>| {
        let drawn = depth.into_iter().filter(|cell| cell.is_drawn);
        drawn
            .map(|cell| (cell.place, cell.attribute >> 13))
            .collect()
    };
    cells(&asset.grid()).into_iter().map(of).collect()
}

/// Which pixels a view covers.
fn picture(asset: &AssetFile, yaw: f64, distance: f64, splat: u16) -> Vec<bool> {
    let orbit = Orbit {
        yaw: Turns::from_bits((yaw / 360.0 * 2f64.powi(32)) as u32),
        pitch: Turns::from_bits(1 << 27),
        distance: Length::from_num(distance),
    };
    let camera = Camera::orbit(&orbit, FocalPx::from_num(80), 60, 80);
    let light = Light {
        towards: [Unit::ZERO, Unit::ZERO, Unit::ONE],
        ambient: Weight::lit("0.2"),
        diffuse: Weight::lit("0.8"),
    };
    let quality = Quality {
        splat: SplatPx::from_num(splat),
        ..Quality::default()
    };
    let frame = draw_frame(&asset.grid(), &camera, &light, &quality, 1);
    frame.depth.iter().map(|&depth| depth > 0).collect()
}

fn check_thin(mesh: &Mesh, rho: u8, level: u8) {
    let whole = baked(mesh, &thin(rho, level));
    for (depth, &end) in level_ends(whole.bytes()).iter().enumerate().skip(1) {
        let cut = AssetFile::new(&whole.bytes()[..end]).unwrap();
        assert_eq!(usize::from(cut.grid().depth()), depth);
        let coarse = baked(mesh, &thin(rho, depth as u8 - 1));
        let (own, want) = (drawn(&cut), drawn(&coarse));
        for (own, want) in own.iter().zip(&want) {
            let sorted = |cells: &[([u32; 3], u16)]| {
                let mut cells = cells.to_vec();
                cells.sort_unstable();
                cells
            };
            assert!(sorted(own) == sorted(want), "rho {rho}, depth {depth}");
        }
        for (yaw, distance, splat) in [(20.0, 3.5, 0), (130.0, 3.0, 1), (250.0, 9.0, 6)] {
            // Next to the silhouette a filtered normal may face the other way.
            let own = picture(&cut, yaw, distance, splat);
            let want = picture(&coarse, yaw, distance, splat);
            let differing = own.iter().zip(&want).filter(|(own, want)| own != want);
            let covered = want.iter().filter(|&&is_covered| is_covered).count();
            let differing = differing.count();
            assert!(
                20 * differing <= covered,
                "rho {rho}, depth {depth}, yaw {yaw}: {differing} of {covered} pixels"
            );
        }
    }
}

#[test]
fn every_level_boundary_of_a_thin_shell_ends_a_coarser_model() {
    for (rho, level) in [(2, 5), (3, 3), (4, 2), (5, 1)] {
        check_thin(&shapes::torus(24, 12), rho, level);
        check_thin(&plate(0.05), rho, level);
        check_thin(&shapes::quad(), rho, level);
    }
}

#[test]
fn every_other_cut_is_an_error() {
    for (rho, level) in [(2, 2), (3, 1), (4, 0), (5, 0)] {
        for options in [options(rho, level), thin(rho, level)] {
            let whole = baked(&shapes::torus(12, 6), &options);
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
}
