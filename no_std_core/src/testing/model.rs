//! Small grids, and the files that hold them.

use std::vec::Vec;

use super::Rng;
use crate::asset::node::{APERTURE_ALL, Flags, halves};
use crate::asset::{
    HEADER_BYTES, HEADER_CRC_OFFSET, KIND_GRID, MAGIC, Rgb, SECTION_BYTES, SECTION_LEVEL,
    SECTION_MATERIALS, Shell, VERSION, checksum,
};

/// One cell of a model.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    /// Twice the cell's coordinates, plus one, minus the cells per axis: its
    /// centre in units of its half side.
    pub place: [i64; 3],
    /// Its parent's index in the level above, and which subcell it is.
    pub parent: usize,
    pub bit: u32,
    pub attribute: u16,
    /// Occupied subcells; zero on the last level.
    pub mask: u128,
    /// Those that are drawn where drawing stops there: all in a fat shell and
    /// on the last level.
    pub drawn: u128,
    pub flags: Flags,
}

/// A grid before it becomes bytes: all cells of every depth, in file order.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub rho: u8,
    pub shell: Shell,
    pub materials: Vec<Rgb>,
    /// Of a sample; of more than 16, its colour is its material's.
    pub attribute_bits: u8,
    pub levels: Vec<Vec<Cell>>,
}

impl Model {
    /// Grows a grid: `occupy` says for each cell of each depth which subcells
    /// it has (limited to rho^3, never none), `dress` sets attribute and
    /// flags. The shell is fat.
    pub fn grow(
        rho: u8,
        depth: u8,
        mut occupy: impl FnMut(usize, &Cell) -> u128,
        mut dress: impl FnMut(&mut Cell),
    ) -> Self {
        let subcells = u32::from(rho).pow(3);
        let all = u128::MAX >> (128 - subcells);
        let mut root = Cell {
            place: [0; 3],
            parent: 0,
            bit: 0,
            attribute: 0,
            mask: 0,
            drawn: 0,
            flags: Flags {
                aperture: APERTURE_ALL,
                two_sided: true,
            },
        };
        dress(&mut root);
        let mut levels = std::vec![std::vec![root]];
        for above in 0..usize::from(depth) {
            let mut next = Vec::new();
            for (parent, cell) in levels[above].iter_mut().enumerate() {
                let mask = occupy(above, cell) & all;
                cell.mask = if mask == 0 { 1 } else { mask };
                cell.drawn = cell.mask;
                for bit in (0..subcells).filter(|bit| cell.mask >> bit & 1 != 0) {
                    let mut child = Cell {
                        place: child_place(rho, cell.place, bit),
                        parent,
                        bit,
                        mask: 0,
                        drawn: 0,
                        ..cell.clone()
                    };
                    dress(&mut child);
                    next.push(child);
                }
            }
            levels.push(next);
        }
        Self {
            rho,
            shell: Shell::Fat,
            materials: std::vec![[255; 3]],
            attribute_bits: 16,
            levels,
        }
    }

    /// Random cells with random normals, all two-sided with open cones;
    /// about `leaves` leaves. Every third shell is thin.
    pub fn random(rng: &mut Rng, rho: u8, depth: u8, leaves: f64) -> Self {
        let mut model = Self::random_fat(rng, rho, depth, leaves);
        if rng.u8(..3) == 0 {
            model.make_thin(rng);
        }
        model
    }

    /// The same, with a fat shell.
    pub fn random_fat(rng: &mut Rng, rho: u8, depth: u8, leaves: f64) -> Self {
        let children = leaves.powf(1.0 / f64::from(depth.max(1)));
        let subcells = u32::from(rho).pow(3);
        let share = (children / f64::from(subcells)).min(1.0);
        let mut attributes = Rng::with_seed(rng.u64(..));
        Self::grow(
            rho,
            depth,
            |_, _| {
                let picked = (0..subcells).filter(|_| rng.f64() < share);
                let mask = picked.fold(0, |mask, bit| mask | 1u128 << bit);
                match mask {
                    0 => 1u128 << rng.u32(..subcells),
                    _ => mask,
                }
            },
            |cell| cell.attribute = attributes.u16(..1 << 13),
        )
    }

    /// Draws random children alone where drawing stops above the last level,
    /// and takes all children from some cells above the last level.
    pub fn make_thin(&mut self, rng: &mut Rng) {
        self.shell = Shell::Thin;
        let last = self.levels.len() - 1;
        for cell in self.levels.iter_mut().rev().skip(2).flatten() {
            cell.drawn = cell.mask & rng.u128(..);
        }
        if let Some(above) = last.checked_sub(1) {
            let keeper = rng.usize(..self.levels[above].len());
            let bare: Vec<bool> = (0..self.levels[above].len())
                .map(|index| index != keeper && rng.u8(..6) == 0)
                .collect();
            self.levels[last].retain(|cell| !bare[cell.parent]);
            for (cell, _) in self.levels[above]
                .iter_mut()
                .zip(bare)
                .filter(|(_, bare)| *bare)
            {
                (cell.mask, cell.drawn) = (0, 0);
            }
        }
        self.sort();
    }

    /// Puts cells into file order: by parents, drawn ones first, by bits.
    fn sort(&mut self) {
        for depth in 1..self.levels.len() {
            let (above, below) = self.levels.split_at_mut(depth);
            let (parents, cells) = (&above[depth - 1], &mut below[0]);
            let mut order: Vec<usize> = (0..cells.len()).collect();
            order.sort_by_key(|&index| {
                let cell = &cells[index];
                let is_drawn = parents[cell.parent].drawn >> cell.bit & 1 != 0;
                (cell.parent, !is_drawn, cell.bit)
            });
            let sorted = order.iter().map(|&index| cells[index].clone()).collect();
            *cells = sorted;
            let mut places = std::vec![0; order.len()];
            for (place, index) in order.into_iter().enumerate() {
                places[index] = place;
            }
            for cell in below.get_mut(1).into_iter().flatten() {
                cell.parent = places[cell.parent];
            }
        }
    }

    /// The model that a file cut behind a level is: without what is not drawn
    /// there.
    pub fn cut(&self, depth: usize) -> Self {
        let mut cut = self.clone();
        cut.levels.truncate(depth + 1);
        if let Some(above) = depth.checked_sub(1) {
            let (parents, leaves) = cut.levels.split_at_mut(depth);
            let parents = &mut parents[above];
            leaves[0].retain(|cell| parents[cell.parent].drawn >> cell.bit & 1 != 0);
            for parent in parents {
                parent.mask = parent.drawn;
            }
        }
        for leaf in &mut cut.levels[depth] {
            (leaf.mask, leaf.drawn) = (0, 0);
        }
        cut
    }

    /// Whether the level of a depth stores drawn records of its own.
    pub fn stores_drawn(&self, depth: usize) -> bool {
        self.shell == Shell::Thin && depth > 0 && depth + 1 < self.levels.len()
    }

    /// Gives every cell one of eight materials.
    pub fn paint(&mut self, rng: &mut Rng) {
        self.materials = (0..8).map(|i| [i * 36, 255 - i * 36, i * 20]).collect();
        for cell in self.levels.iter_mut().flatten() {
            cell.attribute = (cell.attribute & 0x1fff) | rng.u16(..8) << 13;
        }
    }

    /// Deepest level.
    pub fn depth(&self) -> u8 {
        (self.levels.len() - 1) as u8
    }

    /// Cells across the cube at a depth.
    pub fn cells_per_axis(&self, depth: usize) -> i64 {
        i64::from(self.rho).pow(depth as u32)
    }

    /// A cell's centre in half sides of the cube.
    pub fn centre(&self, depth: usize, cell: &Cell) -> [f64; 3] {
        let across = self.cells_per_axis(depth) as f64;
        cell.place.map(|place| place as f64 / across)
    }

    fn record(&self, mask: u128, flags: Flags) -> Vec<u16> {
        let count = halves(self.rho);
        let mut record: Vec<u16> = (0..count.min(8))
            .map(|half| (mask >> (16 * half)) as u16)
            .collect();
        record.resize(count, 0);
        record[count - 1] |= flags.to_last(self.rho);
        record
    }

    /// The links of a level.
    pub fn links(&self, depth: usize) -> Vec<u32> {
        match depth {
            0 => Vec::new(),
            1 => std::vec![0],
            _ => {
                let (parents, cells) = (&self.levels[depth - 1], &self.levels[depth]);
                let first = |grandparent| {
                    cells.partition_point(|cell| parents[cell.parent].parent < grandparent) as u32
                };
                (0..self.levels[depth - 2].len()).map(first).collect()
            }
        }
    }

    fn level(&self, depth: usize) -> Vec<u8> {
        let cells = &self.levels[depth];
        let mut bytes = Vec::new();
        bytes.extend((cells.len() as u32).to_le_bytes());
        bytes.extend(self.links(depth).into_iter().flat_map(u32::to_le_bytes));
        if depth >= 1 {
            let parents = || self.levels[depth - 1].iter();
            let nodes = parents().flat_map(|cell| self.record(cell.mask, cell.flags));
            extend_padded(&mut bytes, nodes);
            if self.stores_drawn(depth) {
                let drawn = parents().flat_map(|cell| self.record(cell.drawn, cell.flags));
                extend_padded(&mut bytes, drawn);
            }
        }
        extend_padded(&mut bytes, cells.iter().map(|cell| cell.attribute));
        bytes.extend(self.colours(cells));
        bytes
    }

    /// The colours of cells as a level holds them.
    pub fn colours(&self, cells: &[Cell]) -> Vec<u8> {
        let colours = cells.iter().map(|cell| {
            let material = self.materials.get(usize::from(cell.attribute >> 13));
            material.copied().unwrap_or([0; 3])
        });
        let mut bytes = Vec::new();
        match self.attribute_bits {
            32 => extend_padded(
                &mut bytes,
                colours.map(|[red, green, blue]| {
                    let [red, green, blue] = [red >> 3, green >> 2, blue >> 3].map(u16::from);
                    red << 11 | green << 5 | blue
                }),
            ),
            48 => bytes.extend(colours.flat_map(|[red, green, blue]| [red, green, blue, 0])),
            _ => {}
        }
        bytes
    }

    /// The model as a file.
    pub fn file(&self) -> File {
        let mut header = [0; HEADER_BYTES];
        header[..4].copy_from_slice(&MAGIC);
        header[4..6].copy_from_slice(&VERSION.to_le_bytes());
        header[8] = KIND_GRID;
        header[9] = self.rho;
        header[10] = self.depth();
        header[11] = self.attribute_bits;
        header[12] = u8::from(self.shell == Shell::Thin);
        header[13] = 1;
        header[16..20].copy_from_slice(&(1u32 << 28).to_le_bytes());
        let mut sections = Vec::new();
        if self.materials != [[255; 3]] {
            let mut bytes = Vec::from((self.materials.len() as u32).to_le_bytes());
            for &[red, green, blue] in &self.materials {
                bytes.extend([red, green, blue, 0]);
            }
            sections.push((SECTION_MATERIALS, bytes));
        }
        sections.extend((0..self.levels.len()).map(|depth| (SECTION_LEVEL, self.level(depth))));
        File { header, sections }
    }
}

/// The place of a cell's subcell.
pub(crate) fn child_place(rho: u8, place: [i64; 3], bit: u32) -> [i64; 3] {
    let (rho, bit) = (i64::from(rho), i64::from(bit));
    let subcell = [bit % rho, bit / rho % rho, bit / rho / rho];
    [0, 1, 2].map(|axis| place[axis] * rho + 2 * subcell[axis] - rho + 1)
}

pub(crate) fn extend_padded(bytes: &mut Vec<u8>, words: impl Iterator<Item = u16>) {
    bytes.extend(words.flat_map(u16::to_le_bytes));
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}

/// A file before its checksums: parts may be damaged first.
#[derive(Clone, Debug)]
pub(crate) struct File {
    pub header: [u8; HEADER_BYTES],
    pub sections: Vec<(u32, Vec<u8>)>,
}

impl File {
    /// The file's bytes with offsets, lengths and checksums filled in.
    pub fn bytes(&self) -> Vec<u8> {
        let count = self.sections.len();
        let header_bytes = HEADER_BYTES + SECTION_BYTES * count;
        let mut bytes = Vec::from(self.header);
        bytes[6..8].copy_from_slice(&(header_bytes as u16).to_le_bytes());
        bytes[15] = count as u8;
        let mut offset = header_bytes;
        for (kind, section) in &self.sections {
            for word in [
                *kind,
                offset as u32,
                section.len() as u32,
                checksum(&[section]),
            ] {
                bytes.extend(word.to_le_bytes());
            }
            offset += section.len();
        }
        seal(&mut bytes);
        bytes.extend(self.sections.iter().flat_map(|(_, section)| section));
        bytes
    }

    /// Where each section ends.
    pub fn ends(&self) -> Vec<usize> {
        let start = HEADER_BYTES + SECTION_BYTES * self.sections.len();
        let ends = self.sections.iter().scan(start, |end, (_, section)| {
            *end += section.len();
            Some(*end)
        });
        ends.collect()
    }
}

/// Writes the header's checksum over whatever the header holds.
pub(crate) fn seal(bytes: &mut [u8]) {
    let header_bytes = usize::from(u16::from_le_bytes([bytes[6], bytes[7]])).min(bytes.len());
    let table = &bytes[HEADER_CRC_OFFSET + 4..header_bytes];
    let sum = checksum(&[&bytes[..HEADER_CRC_OFFSET], table]);
    bytes[HEADER_CRC_OFFSET..HEADER_CRC_OFFSET + 4].copy_from_slice(&sum.to_le_bytes());
}

/// A copy of bytes that starts at a multiple of four.
pub(crate) struct Aligned {
    words: Vec<u32>,
    length: usize,
}

pub(crate) fn aligned(bytes: &[u8]) -> Aligned {
    let mut words = std::vec![0; bytes.len().div_ceil(4) + 1];
    bytemuck::cast_slice_mut(&mut words)[..bytes.len()].copy_from_slice(bytes);
    Aligned {
        words,
        length: bytes.len(),
    }
}

impl core::ops::Deref for Aligned {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }
}
