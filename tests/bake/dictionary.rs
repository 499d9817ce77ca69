//! Masks by dictionary: the same records, pictures and prefixes as plain ones.

use rhogrid::asset_file::AssetFile;
use rhogrid::bake::{self, GridOptions, Masks, writer};
use rhogrid::cli::draw_frame;
use rhogrid::geometry::{Geometry, Mesh};
use rhogrid::import::procedural::{demo, shapes};
use rhogrid_core::asset::coded::MAX_MASKS;
use rhogrid_core::asset::{Grid, SECTION_CODED_LEVEL, SECTION_DICTIONARY};
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};

use super::{options, plate, thin};

/// Plain, and with so many coded levels.
fn both(mesh: &Mesh, options: &GridOptions, levels: usize) -> [AssetFile; 2] {
    let grid = bake::grid(&Geometry::Mesh(mesh.clone()), options, &|_| {}).unwrap();
    let plain = writer::to_bytes(&grid).unwrap();
    let coded = writer::to_coded_bytes(&grid, levels).unwrap();
    [plain, coded].map(|bytes| AssetFile::new(&bytes).unwrap())
}

/// Every record and link, one by one.
fn assert_same(plain: &Grid<'_>, coded: &Grid<'_>) {
    assert_eq!(plain.depth(), coded.depth());
    for (depth, level) in plain.levels().iter().enumerate() {
        assert!(level.attributes == coded.levels()[depth].attributes);
        let nodes = plain.node_records(depth).zip(coded.node_records(depth));
        let drawn = plain.drawn_records(depth).zip(coded.drawn_records(depth));
        assert_eq!(
            plain.node_records(depth).len(),
            coded.node_records(depth).len()
        );
        for (plain, coded) in nodes.chain(drawn) {
            assert_eq!(plain.halves(), coded.halves());
        }
        for (cell, &link) in level.links.iter().enumerate() {
            assert_eq!(coded.link(depth, cell), link);
        }
    }
}

/// Colours, depths and counters of views from all sides, near and far, of
/// leaves and of coarser cells.
fn assert_same_pictures(plain: &Grid<'_>, coded: &Grid<'_>) {
    let light = Light {
        towards: [Unit::lit("0.6"), Unit::lit("0.8"), Unit::ZERO],
        ambient: Weight::lit("0.2"),
        diffuse: Weight::lit("0.8"),
    };
    let views = [
        (0, "2.6"),
        (70, "9"),
        (140, "1.4"),
        (250, "0.6"),
        (300, "30"),
    ];
    for (yaw, distance) in views {
        let orbit = Orbit {
            yaw: Turns::from_bits(((yaw << 32) / 360u64) as u32),
            pitch: Turns::from_bits(1 << 27),
            distance: distance.parse::<Length>().unwrap() * plain.radius(),
        };
        let camera = Camera::orbit(&orbit, FocalPx::from_num(160), 120, 160);
        for splat in ["0", "1", "6"] {
            let quality = Quality {
                splat: splat.parse::<SplatPx>().unwrap(),
                ..Quality::default()
            };
            let [plain, coded] =
                [plain, coded].map(|grid| draw_frame(grid, &camera, &light, &quality, 1));
            assert!(plain.colour == coded.colour && plain.depth == coded.depth);
            assert_eq!(plain.stats, coded.stats);
        }
    }
}

#[test]
fn records_and_pictures_are_the_plain_ones() {
    let meshes = [
        (demo(), 3),
        (shapes::sphere(24), 3),
        (shapes::torus(48, 24), 3),
        (shapes::cube(), 2),
        (shapes::quad(), 3),
        (plate(0.05), 2),
    ];
    for (mesh, level) in meshes {
        for options in [options(3, level), thin(3, level)] {
            for levels in 1..=usize::from(level) + 1 {
                let [plain, coded] = both(&mesh, &options, levels);
                let (plain, coded) = (plain.grid(), coded.grid());
                assert!(plain.dictionary().is_none() && coded.dictionary().is_some());
                let depths = 0..=usize::from(level) + 1;
                let are_coded = depths.filter(|&depth| coded.coding(depth).is_some());
                assert_eq!(are_coded.count(), levels);
                assert_same(&plain, &coded);
                assert_same_pictures(&plain, &coded);
            }
        }
    }
}

/// Kind and end of each section.
fn sections(bytes: &[u8]) -> Vec<(u32, usize)> {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let entries = (0..usize::from(bytes[15])).map(|index| 64 + 16 * index);
    entries
        .map(|at| (word(at), (word(at + 4) + word(at + 8)) as usize))
        .collect()
}

#[test]
fn prefixes_are_those_of_plain_files() {
    for options in [options(3, 3), thin(3, 3)] {
        let [plain, coded] = both(&shapes::torus(48, 24), &options, 2);
        let levels = |of: &AssetFile| -> Vec<usize> {
            let sections = sections(of.bytes()).into_iter();
            let is_level = |&(kind, _): &(u32, usize)| kind == 2 || kind == SECTION_CODED_LEVEL;
            sections.filter(is_level).map(|(_, end)| end).collect()
        };
        let ends = levels(&plain).into_iter().zip(levels(&coded));
        assert_eq!(ends.len(), 5);
        for (plain_end, coded_end) in ends {
            let plain = AssetFile::new(&plain.bytes()[..plain_end]).unwrap();
            let coded = AssetFile::new(&coded.bytes()[..coded_end]).unwrap();
            assert_same(&plain.grid(), &coded.grid());
            assert_same_pictures(&plain.grid(), &coded.grid());
        }
    }
}

/// A dictionary is written where it saves bytes, and not where it does not.
#[test]
fn the_smallest_file_is_written() {
    let bake = |level, masks| {
        let options = GridOptions {
            masks,
            ..options(3, level)
        };
        let geometry = Geometry::Mesh(shapes::torus(96, 48));
        bake::grid(&geometry, &options, &|_| {}).unwrap()
    };
    for level in 0..=4 {
        let plain = writer::to_bytes(&bake(level, Masks::Plain)).unwrap();
        let grid = bake(level, Masks::Dictionary);
        let own = writer::to_bytes(&grid).unwrap();
        let sizes = (0..=usize::from(level).min(2) + 1)
            .map(|levels| writer::to_coded_bytes(&grid, levels).unwrap().len());
        assert_eq!(Some(own.len()), sizes.min());
        let dictionary = sections(&own)
            .iter()
            .filter(|(kind, _)| *kind == SECTION_DICTIONARY)
            .count();
        match own.len() < plain.len() {
            true => assert_eq!(dictionary, 1),
            false => assert!(dictionary == 0 && own == plain),
        }
        if level == 4 {
            assert!(own.len() < plain.len());
            let own = AssetFile::new(&own).unwrap();
            let masks = own.grid().dictionary().unwrap().len();
            assert!((500..=MAX_MASKS).contains(&masks), "{masks} masks");
        }
    }
    let error = bake::grid(
        &Geometry::Mesh(shapes::cube()),
        &GridOptions {
            masks: Masks::Dictionary,
            ..options(2, 2)
        },
        &|_| {},
    );
    assert!(error.unwrap_err().to_string().contains("--masks"));
}
