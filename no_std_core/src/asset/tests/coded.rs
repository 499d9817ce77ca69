//! Coded levels: what they stand for, and what is refused.

use super::*;
use crate::asset::coded::{FIRST_ESCAPE, MAX_MASKS};
use crate::testing::Coder;
use crate::testing::coded::CodedLevel;

/// Records by value.
fn halves(records: Records<'_>) -> Vec<Vec<u16>> {
    records.map(|record| record.halves().to_vec()).collect()
}

/// Opens both and compares all that a level has.
#[track_caller]
fn assert_same(plain: &File, coded: &File) {
    let [plain, coded] = [plain, coded].map(|file| aligned(&file.bytes()));
    let open = |bytes| Grid::open(bytes).expect("valid");
    let [plain, coded] = [&plain, &coded].map(|bytes| open(bytes));
    assert_eq!(plain.levels().len(), coded.levels().len());
    for (depth, level) in plain.levels().iter().enumerate() {
        assert_eq!(level.attributes, coded.levels()[depth].attributes);
        assert!(halves(plain.node_records(depth)) == halves(coded.node_records(depth)));
        assert!(halves(plain.drawn_records(depth)) == halves(coded.drawn_records(depth)));
        for (cell, &link) in level.links.iter().enumerate() {
            assert_eq!(
                [&plain, &coded].map(|grid| grid.link(depth, cell)),
                [link; 2]
            );
        }
        let past = level.links.len();
        assert_eq!([&plain, &coded].map(|grid| grid.link(depth, past)), [0; 2]);
    }
    for depth in plain.levels().len()..20 {
        assert_eq!(
            [&plain, &coded].map(|grid| grid.node_records(depth).len()),
            [0; 2]
        );
    }
}

#[test]
fn coded_levels_are_the_plain_ones() {
    let mut rng = Rng::with_seed(81);
    let (mut escapes, mut codes) = (0, 0);
    for case in 0..300 {
        let depth = rng.u8(1..=4);
        let mut model = Model::random(&mut rng, 3, depth, 300.0);
        for cell in model.levels.iter_mut().flatten() {
            cell.flags = node::Flags {
                aperture: rng.u8(..16),
                two_sided: rng.bool(),
            };
        }
        let coder = Coder::of(&model, rng.usize(1..=usize::from(depth)), rng.usize(..60));
        let (plain, coded) = (model.file(), coder.file(&model));
        assert_same(&plain, &coded);
        let level = coder.level(&model, usize::from(depth));
        escapes += level.escapes.len();
        codes += level.nodes.len();
        if case % 10 == 0 {
            let mut unused = coded.clone();
            let last = unused.sections.len() - 1 - coder.levels;
            unused.sections[last]
                .1
                .extend(u32::to_le_bytes(7 | 3 << 27));
            assert_same(&plain, &unused);
        }
    }
    assert!(
        escapes > 3000 && codes > escapes + 3000,
        "{escapes} of {codes}"
    );
}

/// More codes than share a start, more links than share a base.
#[test]
fn large_levels_need_every_start() {
    let mut rng = Rng::with_seed(82);
    let mut fat = Model::random_fat(&mut rng, 3, 4, 100_000.0);
    let mut thin = fat.clone();
    thin.make_thin(&mut rng);
    for model in [&mut fat, &mut thin] {
        for (masks, least) in [(0, 2500), (2000, 500)] {
            let coder = Coder::of(model, 2, masks);
            let level = coder.level(model, 4);
            assert!(level.escapes.len() > least && level.bases.len() > 3);
            assert!(level.node_starts.len() > 2);
            assert_same(&model.file(), &coder.file(model));
        }
    }
}

#[test]
fn cut_files_with_a_dictionary_open_as_the_coarser_model() {
    for model in [model(3, 83), thin_model(3, 83)] {
        let file = Coder::of(&model, 2, 20).file(&model);
        let (bytes, ends) = (file.bytes(), file.ends());
        // Materials, depths 0 and 1, dictionary, depths 2 and 3.
        for (section, depth) in [(1, 0), (2, 1), (4, 2), (5, 3)] {
            let cut = aligned(&bytes[..ends[section]]);
            let grid = Grid::open(&cut).expect("a level's end");
            assert_eq!(usize::from(grid.depth()), depth);
            assert_eq!(
                grid.dictionary().map(<[u32]>::len),
                (depth > 1).then_some(20)
            );
            assert_is_coarser(&grid, &model, depth);
        }
        let length = ends[3] as u32;
        refused(&bytes[..ends[3]], AssetError::Truncated { length });
    }
}

#[test]
fn wrong_dictionaries_are_named() {
    let model = model(3, 84);
    let coder = Coder::of(&model, 2, 10);
    let file = coder.file(&model);
    let at = file.sections.len() - 3;
    let own = file.ends()[at - 1] as u32;
    let error = |offset| AssetError::Dictionary { offset };
    let with = |masks: &[u32]| {
        let mut file = file.clone();
        file.sections[at].1 = masks.iter().flat_map(|mask| mask.to_le_bytes()).collect();
        file.bytes()
    };
    for bit in 27..32 {
        refused(
            &with(&[1 | 1 << 27, (5 | 2 << 27) ^ (1 << bit)]),
            error(own),
        );
    }
    refused(&with(&[0, 4]), error(own));
    let most = std::vec![0; MAX_MASKS + 1];
    refused(&with(&most), error(own));
    let mut again = file.clone();
    let section = again.sections[at].clone();
    again.sections.insert(at + 1, section);
    refused(&again.bytes(), error(again.ends()[at] as u32));
    // None before the first level that needs it.
    let mut late = file.clone();
    late.sections.swap(at, at + 1);
    refused(&late.bytes(), error(late.ends()[at - 1] as u32));
    for rho in [2, 4, 5] {
        let mut other = super::model(rho, 84).file();
        other.sections.insert(1, (SECTION_DICTIONARY, Vec::new()));
        refused(&other.bytes(), error(other.ends()[0] as u32));
        other.sections.remove(1);
        other.sections[2].0 = SECTION_CODED_LEVEL;
        refused(&other.bytes(), error(other.ends()[1] as u32));
    }
}

/// Masks of its dictionary.
const MASKS: usize = 150;

/// A thin model's level of depth 2 with codes and escapes of both kinds.
fn level() -> (File, usize, CodedLevel) {
    let mut rng = Rng::with_seed(85);
    let mut model = Model::random_fat(&mut rng, 3, DEPTH, 3000.0);
    model.make_thin(&mut rng);
    let coder = Coder::of(&model, 2, MASKS);
    let file = coder.file(&model);
    let at = file.sections.len() - 2;
    let level = coder.level(&model, 2);
    assert!(level.nodes.iter().any(|&code| code < FIRST_ESCAPE));
    assert!(level.escapes.len() > 3);
    assert!(level.drawn.iter().any(|&code| code >= FIRST_ESCAPE));
    assert_eq!(file.sections[at].1, level.bytes());
    assert_eq!(open(&file.bytes()), Ok(()));
    (file, at, level)
}

/// With that level changed.
fn changed(change: impl FnOnce(&mut CodedLevel)) -> (Vec<u8>, u32) {
    let (mut file, at, mut level) = level();
    let offset = file.ends()[at - 1] as u32;
    change(&mut level);
    file.sections[at].1 = level.bytes();
    (file.bytes(), offset)
}

#[test]
fn wrong_coded_levels_are_named() {
    for bit in 0..27 {
        let (bytes, offset) = changed(|level| level.flags[15] = 1 << bit);
        refused(&bytes, AssetError::Flags { offset });
    }
    let sizes: [fn(&mut CodedLevel); 8] = [
        |level| level.cells ^= 1,
        |level| level.escapes.push(1),
        |level| level.escapes.extend([1, 1]),
        |level| level.bases.push(0),
        |level| level.node_starts.push(0),
        |level| level.nodes.extend([0, 0]),
        |level| level.drawn.clear(),
        |level| level.attributes.extend([0, 0]),
    ];
    for change in sizes {
        let (bytes, offset) = changed(change);
        refused(&bytes, AssetError::LevelSize { offset });
    }
    let (bytes, _) = changed(|level| level.links[0] = 1);
    refused(&bytes, AssetError::Link { depth: 0, index: 0 });
    let (bytes, _) = changed(|level| level.bases[0] = u32::MAX);
    refused(&bytes, AssetError::Link { depth: 0, index: 0 });
}

#[test]
fn wrong_codes_are_named() {
    let code = |index: usize| AssetError::Code {
        depth: 1,
        index: index as u32,
    };
    let (_, _, good) = level();
    let last = good.nodes.len() - 1;
    // One mask more than there are, with any flags.
    for flags in 0..16 {
        let (bytes, _) = changed(|level| level.nodes[last] = (MASKS * 16 + flags) as u16);
        refused(&bytes, code(last));
    }
    let first = |codes: &[u16]| codes.iter().position(|&code| code >= FIRST_ESCAPE);
    let nodes = first(&good.nodes).expect("an escape");
    let drawn = first(&good.drawn).expect("an escape");
    for other in [1, 2, 1023] {
        let (bytes, _) = changed(|level| level.nodes[nodes] ^= other);
        refused(&bytes, code(nodes));
        let (bytes, _) = changed(|level| level.drawn[drawn] ^= other);
        refused(&bytes, code(drawn));
    }
    let (bytes, _) = changed(|level| level.node_starts[0] = 1);
    refused(&bytes, code(0));
    let (bytes, _) = changed(|level| level.drawn_starts[0] ^= 1);
    refused(&bytes, code(0));
    // One escape less than codes say.
    let (bytes, _) = changed(|level| {
        level.escapes.pop();
    });
    let last = |codes: &[u16]| codes.iter().rposition(|&code| code >= FIRST_ESCAPE);
    refused(&bytes, code(last(&good.drawn).expect("an escape")));
}

#[test]
fn decoded_records_are_checked_as_plain_ones_are() {
    let (_, _, good) = level();
    let node = (0..good.nodes.len())
        .find(|&index| good.nodes[index] >= FIRST_ESCAPE)
        .expect("an escape");
    // The drawn record of the same cell contradicts it, or cells are missing.
    for bit in 27..32 {
        let (bytes, _) = changed(|level| level.escapes[0] ^= 1 << bit);
        let (depth, index) = (1, node as u32);
        refused(&bytes, AssetError::Drawn { depth, index });
    }
    for bit in 0..27 {
        let (bytes, offset) = changed(|level| level.escapes[0] ^= 1 << bit);
        let error = open(&bytes).expect_err("another number of cells");
        let size = AssetError::LevelSize { offset };
        assert!(
            error == size || matches!(error, AssetError::Link { .. }),
            "{error}"
        );
    }
    // Fat shells have no empty nodes.
    let fat = model(3, 86);
    let mut coder = Coder::of(&fat, 1, 1);
    coder.masks.clear();
    let mut file = coder.file(&fat);
    let mut level = coder.level(&fat, 3);
    let last = level.escapes.len() - 1;
    level.escapes[last] &= !0x07ff_ffff;
    let at = file.sections.len() - 1;
    file.sections[at].1 = level.bytes();
    let (depth, index) = (2, last as u32);
    refused(&file.bytes(), AssetError::Node { depth, index });
}

#[test]
fn random_bits_of_coded_levels_do_no_harm() {
    let mut rng = Rng::with_seed(87);
    let files = [0, 1, 2, 3].map(|seed| {
        let model = match seed < 2 {
            true => model(3, seed),
            false => thin_model(3, seed),
        };
        Coder::of(&model, 1 + seed as usize % 3, 15).file(&model)
    });
    let mut accepted = 0;
    for _ in 0..20_000 {
        let mut file = rng.choice(&files).expect("not empty").clone();
        for _ in 0..rng.u32(1..4) {
            let section = rng.usize(..file.sections.len());
            let bytes = &mut file.sections[section].1;
            let at = rng.usize(..bytes.len());
            bytes[at] ^= 1 << rng.u8(..8);
        }
        accepted += u32::from(open(&file.bytes()).is_ok());
    }
    assert!((100..19_000).contains(&accepted), "{accepted} accepted");
}
