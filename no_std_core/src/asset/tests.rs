use super::*;
use crate::testing::model::seal;
use crate::testing::{File, Model, Rng, aligned};
use std::vec::Vec;

#[cfg(all(feature = "rho-3", feature = "mask-dictionary"))]
mod coded;
#[cfg(all(feature = "rho-3", feature = "colour"))]
mod colours;
mod cut;
mod left_out;
mod levels;

/// Greatest depth a grid of a rho is made with here.
const DEPTH: u8 = 3;

fn model(rho: u8, seed: u64) -> Model {
    let mut rng = Rng::with_seed(seed);
    let mut model = Model::random_fat(&mut rng, rho, DEPTH, 30.0);
    model.paint(&mut rng);
    model
}

fn thin_model(rho: u8, seed: u64) -> Model {
    let mut rng = Rng::with_seed(seed);
    let mut model = model(rho, seed);
    model.make_thin(&mut rng);
    model
}

fn bits(rho: u8, record: &[u16]) -> u128 {
    let bits = 0..usize::from(rho).pow(3);
    bits.filter(|bit| record[bit / 16] >> (bit % 16) & 1 != 0)
        .fold(0, |mask, bit| mask | 1 << bit)
}

fn small() -> File {
    model(3, 51).file()
}

fn open(bytes: &[u8]) -> Result<(), AssetError> {
    Grid::open(&aligned(bytes)).map(|_| ())
}

#[track_caller]
fn refused(bytes: &[u8], want: AssetError) {
    let got = open(bytes);
    assert_eq!(got, Err(want));
    let text = std::format!("{want}");
    assert!(text.len() > 20, "{text}");
}

/// Replaces a byte of the header and seals it again.
fn with_byte(file: &File, offset: usize, value: u8) -> Vec<u8> {
    let mut bytes = file.bytes();
    bytes[offset] = value;
    seal(&mut bytes);
    bytes
}

#[test]
fn checksum_has_the_standard_check_value() {
    assert_eq!(checksum(&[b"1234", b"56789"]), 0xcbf4_3926);
}

#[test]
fn views_are_those_of_the_model() {
    for rho in 2..=5 {
        for depth in [0, 1, 2, 3, if rho == 2 { 15 } else { max_depth(rho) }] {
            let mut rng = Rng::with_seed(u64::from(depth));
            let leaves = if depth == 0 { 1.0 } else { 60.0 };
            let mut model = Model::random_fat(&mut rng, rho, depth, leaves);
            if rng.bool() {
                model.make_thin(&mut rng);
            }
            let bytes = aligned(&model.file().bytes());
            let grid = Grid::open(&bytes).unwrap_or_else(|e| panic!("rho {rho}: {e}"));
            assert_eq!((grid.rho(), grid.depth()), (rho, depth));
            assert_eq!(grid.stored_depth(), depth);
            assert_eq!(grid.radius(), Length::ONE);
            assert_eq!(grid.shell(), model.shell);
            assert!(!grid.two_sided());
            assert_eq!(grid.materials(), [[255; 3]]);
            assert_eq!(grid.levels().len(), usize::from(depth) + 1);
            for (level, cells) in grid.levels().iter().zip(&model.levels) {
                let attributes: Vec<_> = cells.iter().map(|cell| cell.attribute).collect();
                assert_eq!(
                    (level.cells(), level.attributes),
                    (cells.len(), &*attributes)
                );
            }
            for (level, cells) in grid.levels().iter().skip(1).zip(&model.levels) {
                let records = level.nodes.chunks_exact(node::halves(rho));
                assert_eq!(records.len(), cells.len());
                for (record, cell) in records.zip(cells) {
                    let last = *record.last().expect("a record has words");
                    assert_eq!(node::Flags::from_last(rho, last), cell.flags);
                    assert_eq!(node::occupied(rho, record), cell.mask.count_ones());
                    assert_eq!(bits(rho, record), cell.mask);
                }
                let records = level.drawn.chunks_exact(node::halves(rho));
                assert_eq!(records.len(), cells.len());
                for (record, cell) in records.zip(cells) {
                    let last = *record.last().expect("a record has words");
                    assert_eq!(node::Flags::from_last(rho, last), cell.flags);
                    assert_eq!(bits(rho, record), cell.drawn);
                }
            }
            for (depth, level) in (0..).zip(grid.levels()) {
                let stores_drawn = model.stores_drawn(usize::from(depth));
                assert_eq!(grid.stores_drawn(depth), stores_drawn);
                let is_shared = level.drawn.as_ptr() == level.nodes.as_ptr();
                assert!(depth == 0 || is_shared != stores_drawn);
            }
            for depth in 2..grid.levels().len() {
                let links = grid.levels()[depth].links;
                for (index, cell) in model.levels[depth].iter().enumerate() {
                    let parent = &model.levels[depth - 1][cell.parent];
                    assert!(links[parent.parent] as usize <= index);
                    let next = links.get(parent.parent + 1);
                    assert!(next.is_none_or(|&next| next as usize > index));
                }
            }
        }
    }
}

#[test]
fn header_fields_are_read() {
    let mut file = thin_model(3, 51).file();
    file.header[14] = 1;
    file.header[16..20].copy_from_slice(&(3u32 << 27).to_le_bytes());
    let bytes = aligned(&file.bytes());
    let grid = Grid::open(&bytes).expect("valid");
    assert_eq!(grid.shell(), Shell::Thin);
    assert!(grid.two_sided());
    assert_eq!(grid.radius(), Length::lit("1.5"));
    assert_eq!(grid.materials().len(), 8);
    assert_eq!(grid.materials()[1], [36, 219, 20]);
}

#[test]
fn wrong_headers_are_named() {
    let file = small();
    assert_eq!(open(&file.bytes()), Ok(()));
    let good = aligned(&[&[0; 4], &*file.bytes()].concat());
    for offset in 1..4 {
        assert_eq!(
            Grid::open(&good[offset..]).err(),
            Some(AssetError::Misaligned)
        );
    }
    refused(&with_byte(&file, 0, b'r'), AssetError::Magic);
    refused(&with_byte(&file, 4, 1), AssetError::Version { version: 1 });
    refused(&with_byte(&file, 4, 4), AssetError::Version { version: 4 });
    refused(
        &with_byte(&file, 5, 1),
        AssetError::Version { version: 259 },
    );
    refused(&with_byte(&file, 8, 2), AssetError::Kind { kind: 2 });
    for rho in [0, 1, 6, 255] {
        refused(&with_byte(&file, 9, rho), AssetError::Rho { rho });
    }
    refused(&with_byte(&file, 10, 10), AssetError::Depth { depth: 10 });
    for (offset, value) in [(11, 24), (12, 2), (13, 3), (14, 2), (19, 0xff)] {
        let start = offset as u32 & !(u32::from(offset == 19) * 3);
        refused(
            &with_byte(&file, offset, value),
            AssetError::Field { offset: start },
        );
    }
    refused(
        &with_byte(&file, 23, 0x40),
        AssetError::Field { offset: 20 },
    );
    let mut no_radius = file.clone();
    no_radius.header[16..20].fill(0);
    refused(&no_radius.bytes(), AssetError::Field { offset: 16 });
    for offset in [6, 15] {
        let mut bytes = file.bytes();
        bytes[offset] ^= 1;
        refused(&bytes, AssetError::Field { offset: 6 });
    }
}

#[test]
fn extents_are_parts_of_the_half_side() {
    let extents = |word: u32| {
        let mut file = small();
        file.header[20..24].copy_from_slice(&word.to_le_bytes());
        let bytes = aligned(&file.bytes());
        let grid = Grid::open(&bytes).expect("valid");
        grid.extents().map(|extent| extent.to_num::<f64>())
    };
    assert_eq!(extents(0), [1.0; 3]);
    for (got, parts) in extents(1023 | 1 << 10 | 512 << 20)
        .into_iter()
        .zip([1023, 1, 512])
    {
        let want = f64::from(parts) / 1023.0;
        assert!((want..want + 1e-8).contains(&got), "{got}, not {want}");
    }
}

#[test]
fn every_flipped_bit_is_found() {
    let bytes = small().bytes();
    let header_bytes = usize::from(u16::from_le_bytes([bytes[6], bytes[7]]));
    for bit in 0..8 * bytes.len() {
        let mut damaged = bytes.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        let error = open(&damaged).expect_err("a bit is wrong");
        let named = match error {
            AssetError::Magic => bit < 32,
            AssetError::Version { .. } => (32..48).contains(&bit),
            AssetError::Field { offset: 6 } => bit / 8 == 15 || (48..64).contains(&bit),
            AssetError::Truncated { .. } => bit / 8 == 15 || (48..64).contains(&bit),
            AssetError::HeaderChecksum => bit / 8 < header_bytes,
            AssetError::SectionChecksum { offset } => bit / 8 >= offset as usize,
            _ => false,
        };
        assert!(named, "bit {bit}: {error:?}");
    }
}

#[test]
fn files_open_at_the_ends_of_levels_only() {
    for (rho, model) in (2..=5).flat_map(|rho| [(rho, model(rho, 52)), (rho, thin_model(rho, 52))])
    {
        let mut file = model.file();
        file.sections.insert(3, (77, std::vec![1; 8]));
        let bytes = file.bytes();
        let ends = file.ends();
        for length in 0..bytes.len() {
            let cut = aligned(&bytes[..length]);
            let section = ends.iter().position(|&end| end == length);
            let level = section.filter(|&section| file.sections[section].0 == SECTION_LEVEL);
            match (Grid::open(&cut), level) {
                (Ok(grid), Some(section)) => {
                    // Materials before, the unknown section third.
                    let depth = section - 1 - usize::from(section > 3);
                    assert_eq!(usize::from(grid.depth()), depth, "{length} bytes");
                    assert_eq!(grid.stored_depth(), DEPTH);
                    assert_eq!(grid.levels().len(), depth + 1);
                    assert_is_coarser(&grid, &model, depth);
                }
                (Err(AssetError::Truncated { length: got }), None) => {
                    assert_eq!(got as usize, length);
                }
                (got, _) => panic!("rho {rho}, {length} bytes: {got:?}"),
            }
        }
        let longer = [&bytes[..], &[0; 4]].concat();
        let length = longer.len() as u32;
        refused(&longer, AssetError::Truncated { length });
    }
}

/// The drawn cells of a cut file are the leaves of the coarser model.
fn assert_is_coarser(grid: &Grid<'_>, model: &Model, depth: usize) {
    let coarse = model.cut(depth);
    let level = grid.levels()[depth];
    let want: Vec<u16> = coarse.levels[depth]
        .iter()
        .map(|cell| cell.attribute)
        .collect();
    if depth == 0 {
        assert_eq!(level.attributes, want);
        return;
    }
    let mut drawn = Vec::new();
    let mut first = 0;
    let rho = grid.rho();
    for (all, part) in grid.node_records(depth).zip(grid.drawn_records(depth)) {
        let part = node::occupied(rho, part.halves()) as usize;
        drawn.extend_from_slice(&level.attributes[first..first + part]);
        first += node::occupied(rho, all.halves()) as usize;
    }
    assert_eq!(drawn, want);
}

#[test]
fn unknown_sections_are_skipped_wherever_they_stand() {
    let file = small();
    let whole = file.bytes();
    let whole = aligned(&whole);
    let want = Grid::open(&whole).expect("valid");
    for place in 0..=file.sections.len() {
        for length in [0, 4, 40] {
            let mut file = file.clone();
            file.sections
                .insert(place, (0xffff, std::vec![0xab; length]));
            let bytes = aligned(&file.bytes());
            let grid = Grid::open(&bytes).expect("skipped");
            assert_eq!(grid.depth(), want.depth());
            let attributes = |grid: &Grid<'_>| grid.levels()[3].attributes.to_vec();
            assert_eq!(attributes(&grid), attributes(&want));
        }
    }
}

#[test]
fn wrong_section_tables_are_named() {
    let file = small();
    // Offset of the second section, length of the third.
    for (entry, field, value) in [(1, 4, 4u32), (2, 8, 2), (0, 4, u32::MAX), (4, 8, u32::MAX)] {
        let mut bytes = file.bytes();
        let entry = HEADER_BYTES + SECTION_BYTES * entry;
        let word = &mut bytes[entry + field..entry + field + 4];
        let old = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        word.copy_from_slice(&old.wrapping_add(value).to_le_bytes());
        seal(&mut bytes);
        let offset = entry as u32;
        refused(&bytes, AssetError::SectionTable { offset });
    }
    let mut bytes = file.bytes();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    let ends = file.ends();
    let offset = ends[ends.len() - 2] as u32;
    refused(&bytes, AssetError::SectionChecksum { offset });
}

#[test]
fn wrong_materials_are_named() {
    let offset = (HEADER_BYTES + SECTION_BYTES * 5) as u32;
    let error = AssetError::Materials { offset };
    for bytes in [
        std::vec![],
        std::vec![0; 4],
        std::vec![9, 0, 0, 0],
        std::vec![1, 0, 0, 0],
        std::vec![1, 0, 0, 0, 1, 2, 3, 4],
        std::vec![1, 0, 0, 0, 1, 2, 3, 0, 4, 5, 6, 0],
        [&[9, 0, 0, 0], &[0; 36][..]].concat(),
    ] {
        let mut file = small();
        file.sections[0].1 = bytes;
        refused(&file.bytes(), error);
    }
    let mut late = model(3, 51);
    for cell in late.levels.iter_mut().flatten() {
        cell.attribute &= 0x1fff;
    }
    let mut file = late.file();
    file.sections.swap(0, 1);
    let offset = file.ends()[0] as u32;
    refused(&file.bytes(), AssetError::Materials { offset });
    let mut file = small();
    let again = file.sections[0].clone();
    file.sections.insert(1, again);
    let offset = file.ends()[0] as u32;
    refused(&file.bytes(), AssetError::Materials { offset });
}

#[test]
fn random_bytes_behind_valid_checksums_do_no_harm() {
    let mut rng = Rng::with_seed(57);
    let files = [0, 1, 2, 3, 4, 5, 6, 7].map(|seed| {
        let rho = 2 + seed as u8 % 4;
        match seed < 4 {
            true => model(rho, seed).file(),
            false => thin_model(rho, seed).file(),
        }
    });
    let mut accepted = 0;
    for _ in 0..20_000 {
        let mut file = rng.choice(&files).expect("not empty").clone();
        for _ in 0..rng.u32(1..4) {
            if rng.u8(..4) == 0 {
                let at = rng.usize(8..56);
                file.header[at] = rng.u8(..);
            } else {
                let section = rng.usize(..file.sections.len());
                let bytes = &mut file.sections[section].1;
                let at = rng.usize(..bytes.len());
                bytes[at] ^= 1 << rng.u8(..8);
            }
        }
        accepted += u32::from(open(&file.bytes()).is_ok());
    }
    assert!((100..19_000).contains(&accepted), "{accepted} accepted");
}
