//! The same grids with coded records: see [`crate::asset::coded`].

use std::vec::Vec;

use super::model::{Cell, File, Model, extend_padded};
use crate::asset::coded::{BASE_LINKS, FIRST_ESCAPE, FLAGS, START_CODES};
use crate::asset::{SECTION_CODED_LEVEL, SECTION_DICTIONARY, SECTION_LEVEL};

/// A coded level's parts.
#[derive(Clone, Debug, Default)]
pub(crate) struct CodedLevel {
    pub cells: u32,
    pub flags: Vec<u32>,
    pub bases: Vec<u32>,
    pub node_starts: Vec<u32>,
    pub drawn_starts: Vec<u32>,
    pub escapes: Vec<u32>,
    pub links: Vec<u16>,
    pub nodes: Vec<u16>,
    pub drawn: Vec<u16>,
    pub attributes: Vec<u16>,
    /// As bytes.
    pub colours: Vec<u8>,
}

impl CodedLevel {
    pub fn bytes(&self) -> Vec<u8> {
        let counts = [self.cells, self.escapes.len() as u32];
        let words = counts
            .iter()
            .chain(&self.flags)
            .chain(&self.bases)
            .chain(&self.node_starts)
            .chain(&self.drawn_starts)
            .chain(&self.escapes);
        let mut bytes: Vec<u8> = words.flat_map(|word| word.to_le_bytes()).collect();
        for halves in [&self.links, &self.nodes, &self.drawn, &self.attributes] {
            extend_padded(&mut bytes, halves.iter().copied());
        }
        bytes.extend(&self.colours);
        bytes
    }
}

/// What a model's masks are coded with.
pub(crate) struct Coder {
    /// So many of the finest levels have codes.
    pub levels: usize,
    pub masks: Vec<u32>,
}

impl Coder {
    /// Knows so many masks of a model.
    pub fn of(model: &Model, levels: usize, masks: usize) -> Self {
        assert_eq!(model.rho, 3);
        let cells = model.levels.iter().flatten();
        let mut all: Vec<u32> = cells
            .flat_map(|cell| [cell.mask as u32, cell.drawn as u32])
            .collect();
        all.sort_unstable();
        all.dedup();
        all.truncate(masks);
        Self { levels, masks: all }
    }

    /// The model as a file.
    pub fn file(&self, model: &Model) -> File {
        let mut file = model.file();
        let first = file.sections.len() - self.levels;
        for (depth, section) in file.sections.iter_mut().skip(first).enumerate() {
            assert_eq!(section.0, SECTION_LEVEL);
            let depth = model.levels.len() - self.levels + depth;
            *section = (SECTION_CODED_LEVEL, self.level(model, depth).bytes());
        }
        let counted = self.masks.iter().map(|mask| mask | mask.count_ones() << 27);
        let masks = counted.flat_map(u32::to_le_bytes);
        file.sections
            .insert(first, (SECTION_DICTIONARY, masks.collect()));
        file
    }

    /// The level of a depth that is not 0.
    pub fn level(&self, model: &Model, depth: usize) -> CodedLevel {
        let parents = &model.levels[depth - 1];
        let mut level = CodedLevel {
            cells: model.levels[depth].len() as u32,
            ..CodedLevel::default()
        };
        let word = |cell: &Cell| u32::from(cell.flags.to_last(3)) << 16;
        for flags in parents.iter().map(word) {
            if level.flags.len() < FLAGS && !level.flags.contains(&flags) {
                level.flags.push(flags);
            }
        }
        level.flags.resize(FLAGS, 0);
        for (index, link) in model.links(depth).into_iter().enumerate() {
            if index % BASE_LINKS == 0 {
                level.bases.push(link);
            }
            let base = level.bases[index / BASE_LINKS];
            level.links.push((link - base) as u16);
        }
        for (index, cell) in parents.iter().enumerate() {
            if index % START_CODES == 0 {
                level.node_starts.push(level.escapes.len() as u32);
            }
            let code = self.code(&mut level, cell.mask, word(cell));
            level.nodes.push(code);
        }
        for (index, cell) in parents.iter().enumerate() {
            if !model.stores_drawn(depth) {
                break;
            }
            if index % START_CODES == 0 {
                level.drawn_starts.push(level.escapes.len() as u32);
            }
            let code = self.code(&mut level, cell.drawn, word(cell));
            level.drawn.push(code);
        }
        let attributes = model.levels[depth].iter().map(|cell| cell.attribute);
        level.attributes = attributes.collect();
        level.colours = model.colours(&model.levels[depth]);
        level
    }

    fn code(&self, level: &mut CodedLevel, mask: u128, flags: u32) -> u16 {
        let mask = mask as u32;
        let known = self.masks.iter().position(|&known| known == mask);
        let has = level.flags.iter().position(|&has| has == flags);
        match (known, has) {
            (Some(known), Some(has)) => (known * FLAGS + has) as u16,
            _ => {
                level.escapes.push(mask | flags);
                FIRST_ESCAPE + ((level.escapes.len() - 1) % START_CODES) as u16
            }
        }
    }
}
