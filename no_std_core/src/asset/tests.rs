use super::*;
use crate::testing::model::seal;
use crate::testing::{File, Model, Rng, aligned};
use std::vec::Vec;

#[cfg(all(feature = "rho-3", feature = "mask-dictionary"))]
mod coded;
mod cut;
mod left_out;

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
    refused(&with_byte(&file, 4, 3), AssetError::Version { version: 3 });
    refused(
        &with_byte(&file, 5, 1),
        AssetError::Version { version: 258 },
    );
    refused(&with_byte(&file, 8, 2), AssetError::Kind { kind: 2 });
    for rho in [0, 1, 6, 255] {
        refused(&with_byte(&file, 9, rho), AssetError::Rho { rho });
    }
    refused(&with_byte(&file, 10, 10), AssetError::Depth { depth: 10 });
    for (offset, value) in [(11, 32), (12, 2), (13, 3), (14, 2), (19, 0xff)] {
        let start = offset as u32 & !(u32::from(offset == 19) * 3);
        refused(
            &with_byte(&file, offset, value),
            AssetError::Field { offset: start },
        );
    }
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
fn wrong_level_counts_are_named() {
    let error = AssetError::LevelCount { offset: 10 };
    let mut file = small();
    file.header[10] = 4;
    refused(&file.bytes(), error);
    file.header[10] = 2;
    refused(&file.bytes(), error);
    file.sections.truncate(1);
    refused(&file.bytes(), error);
    // One level more than any grid may have.
    let mut rng = Rng::with_seed(53);
    let mut file = Model::random(&mut rng, 2, 16, 1.0).file();
    file.header[10] = 15;
    let offset = file.ends()[15] as u32;
    refused(&file.bytes(), AssetError::LevelCount { offset });
}

/// Parts of a level's bytes in a model.
struct Layout {
    links: usize,
    nodes: usize,
    drawn: usize,
}

fn layout(model: &Model, depth: usize) -> Layout {
    let links = match depth {
        0 => 0,
        1 => 1,
        _ => model.levels[depth - 2].len(),
    };
    let nodes = 4 + 4 * links;
    let parents = depth
        .checked_sub(1)
        .map_or(0, |above| model.levels[above].len());
    let drawn = nodes + (2 * node::halves(model.rho) * parents).next_multiple_of(4);
    Layout {
        links: 4,
        nodes,
        drawn,
    }
}

#[test]
fn wrong_levels_are_named() {
    for rho in 2..=5 {
        let model = model(rho, 54);
        let file = model.file();
        for depth in 0..=usize::from(DEPTH) {
            let layout = layout(&model, depth);
            let section = depth + 1;
            let offset = file.ends()[depth] as u32;
            let size = AssetError::LevelSize { offset };
            let change = |at: usize, value: u8| {
                let mut file = file.clone();
                file.sections[section].1[at] ^= value;
                file.bytes()
            };
            // Cell count, odd lengths, nothing at all.
            refused(&change(0, 1), size);
            refused(&change(3, 0x80), size);
            for bytes in [std::vec![], std::vec![1, 0, 0, 0]] {
                let mut file = file.clone();
                file.sections[section].1 = bytes;
                refused(&file.bytes(), size);
            }
            let mut longer = file.clone();
            longer.sections[section].1.extend([0; 4]);
            refused(&longer.bytes(), size);
            // Padding after an odd number of words.
            if model.levels[depth].len() % 2 == 1 {
                let last = file.sections[section].1.len() - 1;
                refused(&change(last, 1), size);
            }
            if depth == 0 {
                continue;
            }
            let above = (depth - 1) as u8;
            let link = AssetError::Link {
                depth: above.saturating_sub(1),
                index: 0,
            };
            refused(&change(layout.links, 1), link);
            let node = |index: u32| AssetError::Node {
                depth: above,
                index,
            };
            // The last record: no subcell, a bit without meaning, one less.
            let index = model.levels[depth - 1].len() - 1;
            let record_bytes = 2 * node::halves(rho);
            let at = layout.nodes + index * record_bytes;
            let mut empty = file.clone();
            empty.sections[section].1[at..at + record_bytes].fill(0);
            refused(&empty.bytes(), node(index as u32));
            let stray = match rho {
                2 => Some((1, 0x20)),
                3 => None,
                4 => Some((8, 0x20)),
                _ => Some((15, 0x20)),
            };
            if let Some((byte, bit)) = stray {
                refused(&change(at + byte, bit), node(index as u32));
            }
            let mask = model.levels[depth - 1][index].mask;
            let free = (!mask).trailing_zeros() as usize;
            if free < usize::from(rho).pow(3) {
                refused(&change(at + free / 8, 1 << (free % 8)), size);
            }
        }
    }
}

/// What a record may hold in a thin shell, and what its drawn twin may not.
#[test]
fn thin_levels_are_checked() {
    for (rho, seed) in (2..=5).flat_map(|rho| [(rho, 58), (rho, 59), (rho, 60)]) {
        let model = thin_model(rho, seed);
        let file = model.file();
        assert_eq!(open(&file.bytes()), Ok(()));
        let above = &model.levels[usize::from(DEPTH) - 1];
        // The same cells in a fat shell: no drawn records, no empty nodes.
        let mut fat = model.clone();
        fat.shell = Shell::Fat;
        match above.iter().position(|cell| cell.mask == 0) {
            None => assert_eq!(open(&fat.file().bytes()), Ok(())),
            Some(index) => {
                let (depth, index) = (DEPTH - 1, index as u32);
                refused(&fat.file().bytes(), AssetError::Node { depth, index });
            }
        }
        // A shell that the arrays contradict.
        let mut wrong = file.clone();
        wrong.header[12] = 0;
        let offset = file.ends()[1] as u32;
        refused(&wrong.bytes(), AssetError::LevelSize { offset });
        let record_bytes = 2 * node::halves(rho);
        for depth in 1..usize::from(DEPTH) {
            let drawn = layout(&model, depth).drawn;
            for (index, cell) in model.levels[depth - 1].iter().enumerate() {
                let at = drawn + index * record_bytes;
                let change = |byte: usize, bit: u8| {
                    let mut file = file.clone();
                    file.sections[depth + 1].1[at + byte] ^= bit;
                    file.bytes()
                };
                let error = AssetError::Drawn {
                    depth: (depth - 1) as u8,
                    index: index as u32,
                };
                let absent = (!cell.mask).trailing_zeros() as usize;
                if absent < usize::from(rho).pow(3) {
                    refused(&change(absent / 8, 1 << (absent % 8)), error);
                }
                for flag in 0..5 {
                    let bit = node::flags_shift(rho) as usize + flag;
                    let byte = record_bytes - 2 + bit / 8;
                    refused(&change(byte, 1 << (bit % 8)), error);
                }
                if matches!(rho, 2 | 4 | 5) {
                    refused(&change(record_bytes - 1, 0x80), error);
                }
                // Any subset of the node will do.
                let bit = cell.mask.trailing_zeros() as usize;
                if cell.mask != 0 {
                    assert_eq!(open(&change(bit / 8, 1 << (bit % 8))), Ok(()));
                }
            }
            // The padding behind an odd number of words.
            let bytes = record_bytes * model.levels[depth - 1].len();
            if !bytes.is_multiple_of(4) {
                let mut file = file.clone();
                file.sections[depth + 1].1[drawn + bytes] = 1;
                let offset = file.ends()[depth] as u32;
                refused(&file.bytes(), AssetError::LevelSize { offset });
            }
        }
    }
}

#[test]
fn a_thin_shell_may_hold_nothing_below_the_root() {
    let mut model = thin_model(3, 61);
    for depth in 1..=usize::from(DEPTH) {
        model.levels[depth].clear();
    }
    (model.levels[0][0].mask, model.levels[0][0].drawn) = (0, 0);
    assert_eq!(open(&model.file().bytes()), Ok(()));
}

#[test]
fn links_past_the_first_are_checked() {
    let model = model(4, 55);
    let file = model.file();
    for (depth, cells) in model.levels.iter().enumerate().skip(1).take(1) {
        for index in 0..cells.len() {
            let mut file = file.clone();
            file.sections[depth + 3].1[4 + 4 * index] ^= 1;
            let link = AssetError::Link {
                depth: depth as u8,
                index: index as u32,
            };
            refused(&file.bytes(), link);
        }
    }
}

#[test]
fn attributes_name_materials_that_are_there() {
    let mut model = model(3, 56);
    model.materials.truncate(3);
    for cell in model.levels.iter_mut().flatten() {
        cell.attribute = (cell.attribute % (2 << 13)) | (1 << 13);
    }
    assert_eq!(open(&model.file().bytes()), Ok(()));
    for depth in 0..=usize::from(DEPTH) {
        let mut model = model.clone();
        let index = model.levels[depth].len() / 2;
        model.levels[depth][index].attribute = 3 << 13;
        let error = AssetError::Attribute {
            depth: depth as u8,
            index: index as u32,
        };
        refused(&model.file().bytes(), error);
    }
    // Without a materials section there is one, white.
    let mut plain = model;
    plain.materials = std::vec![[255; 3]];
    let error = AssetError::Attribute { depth: 0, index: 0 };
    refused(&plain.file().bytes(), error);
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
