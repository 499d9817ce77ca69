//! `.rho` files: bytes in flash -> checked, zero-copy views.
//!
//! A file is read in place. [`Grid::open`] validates all of it once; after
//! that no index can be out of range and drawing cannot fail.
//!
//! # Format
//!
//! Little-endian; every section starts at a multiple of four bytes.
//!
//! | offset | bytes | header field |
//! |---|---|---|
//! | 0 | 4 | magic `RHOG` |
//! | 4 | 2 | version, 3 |
//! | 6 | 2 | header bytes H = 64 + 16 x sections |
//! | 8 | 1 | kind: 1 grid |
//! | 9 | 1 | rho, 2 to 5 |
//! | 10 | 1 | depth: subdivisions below the root cell (level + 1) |
//! | 11 | 1 | attribute bits: 16, 32 with a 16-bit colour, 48 with a 24-bit colour |
//! | 12 | 1 | shell: 0 fat, 1 thin |
//! | 13 | 1 | source axis that points up: 0 x, 1 y, 2 z |
//! | 14 | 1 | flags: bit 0 two-sided |
//! | 15 | 1 | number of sections |
//! | 16 | 4 | radius around the centre, Q4.28, in half sides of the cube |
//! | 20 | 4 | extents: how far the geometry reaches from the centre along x, y, z, in 1023rds of the half side, rounded up, from bits 0, 10 and 20 on; zero: the whole cube |
//! | 24 | 24 | centre x, y, z in source units, y up (IEEE double; for tools) |
//! | 48 | 8 | half side of the cube in source units (IEEE double; for tools) |
//! | 56 | 4 | zero |
//! | 60 | 4 | CRC-32 of the header without this field |
//! | 64 | 16 each | section table: kind, offset, bytes, CRC-32 |
//!
//! Sections follow the header and each other without gaps, in table order.
//! Kind 1, materials (at most one, before the levels): a count of 1 to 8 and
//! as many words, red | green << 8 | blue << 16. Kind 2, a level: the n-th of
//! them describes the cells of depth n = 0, 1, ..., depth:
//!
//! | level of depth n | length |
//! |---|---|
//! | number of cells N(n) | one 32-bit word |
//! | links: for each cell of depth n - 2 the index of its first grandchild (one zero where n = 1) | N(n - 2) 32-bit words, 1 where n = 1, none where n = 0 |
//! | nodes: occupancy of each cell of depth n - 1 (see [`node`]) | N(n - 1) records |
//! | drawn: which of these children are drawn at this depth; see below | N(n - 1) records, none in a fat asset, where n = 0, and where n is the header's depth |
//! | attributes: material << 13 \| normal code of each cell of depth n | N(n) 16-bit words |
//! | colours, of 32-bit attributes: red << 11 \| green << 5 \| blue of each | N(n) 16-bit words |
//! | colours, of 48-bit attributes: red \| green << 8 \| blue << 16 of each | N(n) 32-bit words |
//!
//! Nodes, drawn, attributes and colours are each padded to four bytes with zeros. Cells
//! are stored breadth-first: children of one cell are contiguous, the drawn
//! ones first, both kinds in the order of their mask bits (x fastest, then y,
//! then z), and so are all grandchildren. Kinds 3 and 4, of tri-grids alone,
//! are a dictionary of masks and a level whose records are [coded]; such a
//! level stands for one of kind 2. Other section kinds are skipped. A file cut
//! at the end of a level is a coarser model; cut anywhere else it is an error.
//!
//! # Shells
//!
//! A *fat* asset holds every cell that the surface touches, and draws all of
//! them. A *thin* one draws on every level a 6-separating subset: no path of
//! cells that share faces leads through the surface around it (Samuli Laine,
//! A Topological Approach to Voxelization, 2013). The thin subset of a level
//! does not lie below that of the level above alone, so that an intermediate
//! level of a thin asset holds two kinds of cells:
//!
//! | cell of depth n | its bit in nodes | in drawn |
//! |---|---|---|
//! | is in the thin subset of its depth | 1 | 1 |
//! | is not, but has a descendant that is stored | 1 | 0 |
//!
//! Where drawing stops at depth n, cells of the first kind are drawn, and
//! those of the second are not. The first kind may have no children: a node
//! of a thin asset may be empty, one of a fat asset is not. A drawn record
//! repeats its node's flags, so that the blocks of the finest level need no
//! other. The finest level of the whole file holds the first kind alone and no
//! second array: nodes are what is drawn, as they are in fat assets. Where a
//! file is cut, its finest level has both kinds, and its leaves are the drawn.

pub mod coded;
mod colours;
mod error;
mod header;
mod level;
pub mod node;
mod records;
mod section;

pub use colours::Colours;
pub(crate) use colours::expanded;
pub use error::AssetError;
pub use level::Level;
pub use records::{Record, Records};

use crate::numbers::Length;
use coded::{Coding, Codings, Dictionary};
use level::{Shape, Stored};
use section::{Section, Sections, u16_at};

/// First bytes of every asset.
pub const MAGIC: [u8; 4] = *b"RHOG";
/// The format's version.
pub const VERSION: u16 = 3;
/// Header bytes before the section table.
pub const HEADER_BYTES: usize = 64;
/// Bytes of one entry of the section table.
pub const SECTION_BYTES: usize = 16;
/// Where the header's checksum stands.
pub const HEADER_CRC_OFFSET: usize = 60;
/// Kind of a grid.
pub const KIND_GRID: u8 = 1;
/// Section kind of materials.
pub const SECTION_MATERIALS: u32 = 1;
/// Section kind of a level.
pub const SECTION_LEVEL: u32 = 2;
/// Section kind of a dictionary of masks: see [`coded`].
pub const SECTION_DICTIONARY: u32 = 3;
/// Section kind of a level with coded records: see [`coded`].
pub const SECTION_CODED_LEVEL: u32 = 4;
/// Most materials of an asset: three bits of an attribute.
pub const MAX_MATERIALS: usize = 8;
/// Most levels of any grid: depth 0 to 15.
pub const MAX_LEVELS: usize = 16;

/// Greatest depth for a rho: at most 2^15 cells on an axis.
pub const fn max_depth(rho: u8) -> u8 {
    match rho {
        2 => 15,
        3 => 9,
        4 => 7,
        _ => 6,
    }
}

/// Whether this build draws grids of a rho: its features say so.
pub fn is_built(rho: u8) -> bool {
    const BUILT: [(u8, bool); 4] = [
        (2, cfg!(feature = "rho-2")),
        (3, cfg!(feature = "rho-3")),
        (4, cfg!(feature = "rho-4")),
        (5, cfg!(feature = "rho-5")),
    ];
    BUILT.contains(&(rho, true))
}

#[cfg(not(any(
    feature = "rho-2",
    feature = "rho-3",
    feature = "rho-4",
    feature = "rho-5"
)))]
compile_error!("enable at least one of the features rho-2, rho-3, rho-4 and rho-5");

/// Which cells of the surface's neighbourhood an asset holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shell {
    /// Every cell that the surface touches.
    Fat,
    /// On every level a 6-separating subset of them, and what leads to finer
    /// ones.
    Thin,
}

/// Diffuse red, green and blue of a material.
pub type Rgb = [u8; 3];

/// A validated rho-grid.
#[derive(Clone, Debug)]
pub struct Grid<'a> {
    rho: u8,
    depth: u8,
    stored_depth: u8,
    shell: Shell,
    two_sided: bool,
    attribute_bits: u8,
    radius: Length,
    extents: [Length; 3],
    materials: [Rgb; MAX_MATERIALS],
    material_count: u8,
    dictionary: Option<Dictionary<'a>>,
    levels: [Level<'a>; MAX_LEVELS],
    codings: Codings<'a>,
}

impl<'a> Grid<'a> {
    /// Checks an asset and gives views into it.
    ///
    /// `bytes` start at a multiple of four (an `include_bytes!` inside a
    /// `#[repr(align(4))]` struct does) and end where the file does.
    ///
    /// # Errors
    /// Whatever is wrong first, and where: see [`AssetError`].
    pub fn open(bytes: &'a [u8]) -> Result<Self, AssetError> {
        let sections = Sections::open(bytes)?;
        let mut grid = Self::header(bytes)?;
        let mut levels = 0usize;
        let mut has_materials = false;
        for section in sections.iter() {
            let section = section?;
            match section.kind {
                SECTION_MATERIALS if levels == 0 && !has_materials => {
                    grid.read_materials(section.bytes, section.offset)?;
                    has_materials = true;
                }
                SECTION_MATERIALS => {
                    return Err(AssetError::Materials {
                        offset: section.offset,
                    });
                }
                SECTION_DICTIONARY => grid.read_dictionary(&section)?,
                SECTION_LEVEL | SECTION_CODED_LEVEL => {
                    grid.read_level(levels, &section)?;
                    levels += 1;
                }
                _ => {}
            }
        }
        let whole = sections.is_whole();
        if levels == 0
            || levels > usize::from(grid.stored_depth) + 1
            || (whole && levels != usize::from(grid.stored_depth) + 1)
        {
            return Err(AssetError::LevelCount { offset: 10 });
        }
        grid.depth = (levels - 1) as u8;
        Ok(grid)
    }

    /// One at most, of a tri-grid; what uses it comes later.
    fn read_dictionary(&mut self, section: &Section<'a>) -> Result<(), AssetError> {
        if self.rho != 3 || self.dictionary.is_some() {
            let offset = section.offset;
            return Err(AssetError::Dictionary { offset });
        }
        self.dictionary = Some(Dictionary::open(section)?);
        Ok(())
    }

    /// The level that follows so many.
    fn read_level(&mut self, levels: usize, section: &Section<'a>) -> Result<(), AssetError> {
        let shape = Shape {
            rho: self.rho,
            shell: self.shell,
            stores_drawn: stores_drawn(self.shell, levels, self.stored_depth),
            material_count: self.material_count,
            attribute_bits: self.attribute_bits,
        };
        let offset = section.offset;
        let (done, rest) = self
            .levels
            .split_at_mut_checked(levels)
            .ok_or(AssetError::LevelCount { offset })?;
        let slot = rest.first_mut().ok_or(AssetError::LevelCount { offset })?;
        let above = levels.checked_sub(1);
        let coding_above = above.and_then(|above| self.codings.get(above).copied());
        let stored = Stored::open(shape, done, coding_above, section, self.dictionary)?;
        *slot = stored.level;
        if let Some(coding) = stored.coding {
            self.codings.set(levels, coding);
        }
        Ok(())
    }

    /// How far the geometry that the grid was baked from reaches from the
    /// centre along x, y and z.
    pub fn extents(&self) -> [Length; 3] {
        self.extents
    }

    /// Subdivision of each axis, 2 to 5.
    pub fn rho(&self) -> u8 {
        self.rho
    }

    /// Depth of the finest cells here; less than [`Grid::stored_depth`] where
    /// the file was cut at a level.
    pub fn depth(&self) -> u8 {
        self.depth
    }

    /// Depth of the finest cells of the whole file.
    pub fn stored_depth(&self) -> u8 {
        self.stored_depth
    }

    /// Which cells there are.
    pub fn shell(&self) -> Shell {
        self.shell
    }

    /// Whether the level of a depth holds cells that are not drawn where
    /// drawing stops there: a file has a second array of records for it, and
    /// [`Level::drawn`] is not [`Level::nodes`].
    pub fn stores_drawn(&self, depth: u8) -> bool {
        stores_drawn(self.shell, usize::from(depth), self.stored_depth)
    }

    /// Whether every surface is drawn from both sides.
    pub fn two_sided(&self) -> bool {
        self.two_sided
    }

    /// Bits of a sample's attribute: 16, or with a colour of its own 32 or 48.
    pub fn attribute_bits(&self) -> u8 {
        self.attribute_bits
    }

    /// Distance of the farthest vertex from the centre, in half sides of the
    /// cube: at most the square root of three.
    pub fn radius(&self) -> Length {
        self.radius
    }

    /// Diffuse colours, one to eight.
    pub fn materials(&self) -> &[Rgb] {
        self.materials
            .get(..usize::from(self.material_count))
            .unwrap_or(&[])
    }

    /// The masks that coded records name by index, where the file has some.
    pub fn dictionary(&self) -> Option<&'a [u32]> {
        self.dictionary.map(|dictionary| dictionary.masks())
    }

    /// What the codes of the level of a depth stand for, where it is coded.
    #[inline(always)]
    pub fn coding(&self, depth: usize) -> Option<&Coding<'a>> {
        // Grids without a dictionary look no further.
        self.dictionary.and_then(|_| self.codings.get(depth))
    }

    fn stored(&self, depth: usize) -> Stored<'a> {
        Stored {
            level: *self.levels.get(depth).unwrap_or(&Level::EMPTY),
            coding: self.coding(depth).copied(),
        }
    }

    /// The records of [`Level::nodes`] of a depth; none where it has none.
    pub fn node_records(&self, depth: usize) -> Records<'a> {
        self.stored(depth).node_records(self.rho)
    }

    /// The records of [`Level::drawn`] of a depth, the same.
    pub fn drawn_records(&self, depth: usize) -> Records<'a> {
        self.stored(depth).drawn_records(self.rho)
    }

    /// Index, in the level of a depth, of the first grandchild of a cell two
    /// levels above; zero where there is no such cell.
    pub fn link(&self, depth: usize, cell: usize) -> u32 {
        self.stored(depth).link(cell)
    }

    /// Levels from the root (depth 0) to the finest.
    pub fn levels(&self) -> &[Level<'a>] {
        self.levels.get(..=usize::from(self.depth)).unwrap_or(&[])
    }
}

/// Whether a level has a second array of records.
fn stores_drawn(shell: Shell, depth: usize, stored_depth: u8) -> bool {
    shell == Shell::Thin && (1..usize::from(stored_depth)).contains(&depth)
}

/// A CRC-32/ISO-HDLC of the asset's bytes.
pub fn checksum(parts: &[&[u8]]) -> u32 {
    let crc = crc::Crc::<u32, crc::Table<1>>::new(&crc::CRC_32_ISO_HDLC);
    let mut digest = crc.digest();
    for part in parts {
        digest.update(part);
    }
    digest.finalize()
}

/// The 16-bit fields that precede everything: magic and version.
fn check_magic(bytes: &[u8]) -> Result<(), AssetError> {
    let length = bytes.len() as u32;
    let magic = bytes
        .first_chunk::<4>()
        .ok_or(AssetError::Truncated { length })?;
    if *magic != MAGIC {
        return Err(AssetError::Magic);
    }
    match u16_at(bytes, 4) {
        Some(VERSION) => Ok(()),
        Some(version) => Err(AssetError::Version { version }),
        None => Err(AssetError::Truncated { length }),
    }
}

#[cfg(test)]
mod tests;
