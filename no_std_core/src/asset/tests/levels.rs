//! Levels that contradict themselves or each other are named.

use super::*;

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
