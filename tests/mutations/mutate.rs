//! How assets are damaged.

use std::ops::Range;

use rhogrid_core::asset::coded::{FIRST_ESCAPE, FLAGS};
use rhogrid_core::asset::node::{flags_shift, halves};
use rhogrid_core::asset::{HEADER_BYTES, SECTION_BYTES};

use super::layout::{Layout, Level};

/// Steele's splitmix64: any two seeds give unrelated sequences.
pub struct Random(u64);

impl Random {
    pub fn of(seed: u64, index: u64) -> Self {
        Self(seed ^ index.wrapping_mul(0xd134_2543_de82_ef95))
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }
}

/// A damaged copy and what was done to it.
pub struct Mutant {
    pub bytes: Vec<u8>,
    pub log: Vec<String>,
}

const WORDS: [u32; 16] = [
    0,
    1,
    2,
    4,
    0x7f,
    0xff,
    0x7fff,
    0x8000,
    0xffff,
    0x1_0000,
    0x7fff_fffc,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_fff0,
    0xffff_fffc,
    0xffff_ffff,
];

impl Mutant {
    pub fn new(asset: &Layout) -> Self {
        Self {
            bytes: asset.bytes.clone(),
            log: Vec::new(),
        }
    }

    /// One to four changes. In half of the cases only such that keep the
    /// asset's shape, so that they reach the drawing.
    pub fn damage(&mut self, asset: &Layout, random: &mut Random) {
        let is_gentle = random.below(2) == 0;
        for _ in 0..=random.below(4) {
            if is_gentle {
                self.gentle(asset, random);
            } else {
                self.rough(asset, random);
            }
        }
    }

    fn set(&mut self, at: usize, with: &[u8]) {
        self.log.push(format!("{with:02x?} at {at}"));
        if let Some(place) = self.bytes.get_mut(at..at + with.len()) {
            place.copy_from_slice(with);
        }
    }

    fn half(&self, at: usize) -> u16 {
        let half = self.bytes.get(at..at + 2);
        half.map_or(0, |half| u16::from_le_bytes([half[0], half[1]]))
    }

    /// A random 16-bit word of a range.
    fn place(range: &Range<usize>, random: &mut Random) -> usize {
        range.start + 2 * random.below(range.len() / 2)
    }

    fn gentle(&mut self, asset: &Layout, random: &mut Random) {
        let level = &asset.levels[random.below(asset.levels.len())];
        let record = 2 * halves(asset.rho);
        if !level.tables.is_empty() && random.below(2) == 0 {
            return self.gentle_codes(asset, level, random);
        }
        let is_coded = !level.tables.is_empty();
        match random.below(7) {
            0 => {
                let normal = random.next() as u16 & 0x1fff;
                let at = Self::place(&level.attributes, random);
                let material = self.half(at) & 0xe000;
                self.set(at, &(material | normal).to_le_bytes());
            }
            1 => {
                // May name a material that is not there.
                let at = Self::place(&level.attributes, random);
                self.set(at, &(random.next() as u16).to_le_bytes());
            }
            2 if !level.nodes.is_empty() && !is_coded => {
                let at =
                    level.nodes.start + record * random.below(level.nodes.len() / record) + record
                        - 2;
                let flags = 31 << flags_shift(asset.rho);
                let new = random.next() as u16 & flags;
                let own = self.half(at) & !flags;
                self.set(at, &(own | new).to_le_bytes());
                // Both records of a node have the same flags.
                if !level.drawn.is_empty() {
                    let at = at - level.nodes.start + level.drawn.start;
                    let own = self.half(at) & !flags;
                    self.set(at, &(own | new).to_le_bytes());
                }
            }
            3 if !level.nodes.is_empty() && level.drawn.is_empty() && !is_coded => {
                self.rotate_mask(asset.rho, &level.nodes, random)
            }
            6 if !level.drawn.is_empty() && !is_coded => {
                // Fewer children are drawn; flags stay.
                let at = Self::place(&level.drawn, random);
                let mut mask = random.next() as u16;
                if (at - level.drawn.start) % record == record - 2 {
                    mask |= 31 << flags_shift(asset.rho);
                }
                let own = self.half(at);
                self.set(at, &(own & mask).to_le_bytes());
            }
            4 => self.set(16, &(1 + random.next() as u32 % (2 << 28)).to_le_bytes()),
            _ => {
                let end = asset.levels[random.below(asset.levels.len())].end;
                self.log.push(format!("cut at {end}"));
                self.bytes.truncate(end);
            }
        }
    }

    /// Other flags, for one record or for all that share them; a mask of as
    /// many other cells.
    fn gentle_codes(&mut self, asset: &Layout, level: &Level, random: &mut Random) {
        match random.below(3) {
            0 => {
                let at = Self::place(&level.nodes, random);
                let codes = [at, at - level.nodes.start + level.drawn.start];
                let arrays = if level.drawn.is_empty() { 1 } else { 2 };
                let flags = random.below(FLAGS) as u16;
                let codes = &codes[..arrays];
                if codes.iter().all(|&at| self.half(at) < FIRST_ESCAPE) {
                    for &at in codes {
                        let own = self.half(at) & !15;
                        self.set(at, &(own | flags).to_le_bytes());
                    }
                }
            }
            1 => {
                let at = level.tables.start + 4 * random.below(FLAGS);
                self.set(at, &((random.next() as u32) << 27).to_le_bytes());
            }
            _ if !asset.dictionary.is_empty() => {
                let at = asset.dictionary.start + 4 * random.below(asset.dictionary.len() / 4);
                let own = u32::from(self.half(at)) | u32::from(self.half(at + 2)) << 16;
                let (count, mask) = (own >> 27 << 27, own & 0x7ff_ffff);
                let turn = random.below(27);
                let turned = (mask << turn | mask >> (27 - turn)) & 0x7ff_ffff;
                self.set(at, &(count | turned).to_le_bytes());
            }
            _ => {}
        }
    }

    /// Moves the cells of a node and keeps their number.
    fn rotate_mask(&mut self, rho: u8, nodes: &Range<usize>, random: &mut Random) {
        let size = halves(rho);
        let at = nodes.start + 2 * size * random.below(nodes.len() / 2 / size);
        let bits = usize::from(rho).pow(3);
        let read: Vec<bool> = (0..bits)
            .map(|bit| self.half(at + bit / 16 * 2) >> (bit % 16) & 1 == 1)
            .collect();
        let turn = random.below(bits);
        for word in 0..size {
            let mut half = self.half(at + 2 * word);
            for bit in (16 * word..16 * word + 16).filter(|&bit| bit < bits) {
                half =
                    half & !(1 << (bit % 16)) | u16::from(read[(bit + turn) % bits]) << (bit % 16);
            }
            self.set(at + 2 * word, &half.to_le_bytes());
        }
    }

    fn rough(&mut self, asset: &Layout, random: &mut Random) {
        let length = self.bytes.len().max(1);
        let at = random.below(length);
        let level = &asset.levels[random.below(asset.levels.len())];
        match random.below(16) {
            0 => {
                let flipped = self.bytes.get(at).copied().unwrap_or(0) ^ 1 << random.below(8);
                self.set(at, &[flipped]);
            }
            1 => self.set(at, &[random.next() as u8]),
            2 => self.set(at & !1, &(random.pick(&WORDS) as u16).to_le_bytes()),
            3 => self.set(at & !3, &random.pick(&WORDS).to_le_bytes()),
            4 => {
                self.log.push(format!("cut at {at}"));
                self.bytes.truncate(at);
            }
            5 => {
                let more = 1 + random.below(64);
                self.log.push(format!("{more} bytes more"));
                self.bytes.extend((0..more).map(|_| random.next() as u8));
            }
            6 => {
                let other = random.below(length);
                self.log.push(format!("{at} and {other} swapped"));
                if at.max(other) < self.bytes.len() {
                    self.bytes.swap(at, other);
                }
            }
            7 => {
                // A section's kind, offset, length or checksum.
                let sections = usize::from(asset.bytes[15]);
                let at =
                    HEADER_BYTES + SECTION_BYTES * random.below(sections) + 4 * random.below(4);
                let own = asset.bytes[at..at + 4]
                    .try_into()
                    .map_or(0, u32::from_le_bytes);
                let near = [
                    own.wrapping_add(4),
                    own.wrapping_sub(4),
                    own ^ 3,
                    own.wrapping_mul(2),
                ];
                let value = if random.below(2) == 0 {
                    random.pick(&near)
                } else {
                    random.pick(&WORDS)
                };
                self.set(at, &value.to_le_bytes());
            }
            8 => {
                // Two entries of the table change places.
                let sections = usize::from(asset.bytes[15]);
                let entry = |index: usize| HEADER_BYTES + SECTION_BYTES * index;
                let (a, b) = (entry(random.below(sections)), entry(random.below(sections)));
                let [first, second] = [a, b].map(|at| asset.bytes[at..at + SECTION_BYTES].to_vec());
                self.set(a, &second);
                self.set(b, &first);
            }
            9 => {
                // The header's small fields: version to section count.
                let at = 4 + random.below(12);
                self.set(at, &[random.next() as u8 % 18]);
            }
            10 if !level.drawn.is_empty() => {
                let at = Self::place(&level.drawn, random);
                self.set(at, &(random.next() as u16).to_le_bytes());
            }
            11 if !level.links.is_empty() => {
                let at = level.links.start + 4 * random.below(level.links.len() / 4);
                self.set(at, &random.pick(&WORDS).to_le_bytes());
            }
            12 if !level.tables.is_empty() => {
                let at = level.tables.start + 4 * random.below(level.tables.len() / 4);
                self.set(at, &random.pick(&WORDS).to_le_bytes());
            }
            13 if !level.tables.is_empty() => {
                let at = Self::place(&level.nodes, random);
                self.set(at, &(random.next() as u16).to_le_bytes());
            }
            14 if !asset.dictionary.is_empty() => {
                let at = asset.dictionary.start + 4 * random.below(asset.dictionary.len() / 4);
                self.set(at, &random.pick(&WORDS).to_le_bytes());
            }
            _ => {
                // Radius, centre and half side: any bits, NaN among them.
                let at = 16 + 8 * random.below(6);
                let value =
                    random.pick(&[0, u64::MAX, 1, 0x7ff0_0000_0000_0000, 1 << 63, random.0]);
                self.set(at, &value.to_le_bytes());
            }
        }
    }
}
