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
//! | 4 | 2 | version, 2 |
//! | 6 | 2 | header bytes H = 64 + 16 x sections |
//! | 8 | 1 | kind: 1 grid |
//! | 9 | 1 | rho, 2 to 5 |
//! | 10 | 1 | depth: subdivisions below the root cell (level + 1) |
//! | 11 | 1 | attribute bits, 16 |
//! | 12 | 1 | shell: 0 fat, 1 thin |
//! | 13 | 1 | source axis that points up: 0 x, 1 y, 2 z |
//! | 14 | 1 | flags: bit 0 two-sided |
//! | 15 | 1 | number of sections |
//! | 16 | 4 | radius around the centre, Q4.28, in half sides of the cube |
//! | 20 | 4 | zero |
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
//!
//! Nodes, drawn and attributes are each padded to four bytes with zeros. Cells
//! are stored breadth-first: children of one cell are contiguous, the drawn
//! ones first, both kinds in the order of their mask bits (x fastest, then y,
//! then z), and so are all grandchildren. Other section kinds are skipped. A
//! file cut at the end of a level is a coarser model; cut anywhere else it is
//! an error.
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

mod error;
mod level;
pub mod node;
mod section;

pub use error::AssetError;
pub use level::Level;

use crate::numbers::Length;
use level::Shape;
use section::{Sections, u8_at, u16_at, u32_at};

/// First bytes of every asset.
pub const MAGIC: [u8; 4] = *b"RHOG";
/// The format's version.
pub const VERSION: u16 = 2;
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
    radius: Length,
    materials: [Rgb; MAX_MATERIALS],
    material_count: u8,
    levels: [Level<'a>; MAX_LEVELS],
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
                SECTION_LEVEL => {
                    let (done, rest) =
                        grid.levels
                            .split_at_mut_checked(levels)
                            .ok_or(AssetError::LevelCount {
                                offset: section.offset,
                            })?;
                    let slot = rest.first_mut().ok_or(AssetError::LevelCount {
                        offset: section.offset,
                    })?;
                    let shape = Shape {
                        rho: grid.rho,
                        shell: grid.shell,
                        stores_drawn: stores_drawn(grid.shell, levels, grid.stored_depth),
                        material_count: grid.material_count,
                    };
                    *slot = Level::open(shape, done, &section)?;
                    levels += 1;
                }
                SECTION_MATERIALS => {
                    return Err(AssetError::Materials {
                        offset: section.offset,
                    });
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

    /// The header's own fields, checked.
    fn header(bytes: &[u8]) -> Result<Self, AssetError> {
        let field = |offset: usize| {
            u8_at(bytes, offset).ok_or(AssetError::Truncated {
                length: bytes.len() as u32,
            })
        };
        let kind = field(8)?;
        if kind != KIND_GRID {
            return Err(AssetError::Kind { kind });
        }
        let (rho, depth) = (field(9)?, field(10)?);
        if !(2..=5).contains(&rho) {
            return Err(AssetError::Rho { rho });
        }
        if !is_built(rho) {
            return Err(AssetError::LeftOut { rho });
        }
        if depth > max_depth(rho) {
            return Err(AssetError::Depth { depth });
        }
        if field(11)? != 16 {
            return Err(AssetError::Field { offset: 11 });
        }
        let shell = match field(12)? {
            0 => Shell::Fat,
            1 => Shell::Thin,
            _ => return Err(AssetError::Field { offset: 12 }),
        };
        if field(13)? > 2 {
            return Err(AssetError::Field { offset: 13 });
        }
        let flags = field(14)?;
        if flags > 1 {
            return Err(AssetError::Field { offset: 14 });
        }
        for offset in [20, 56] {
            if u32_at(bytes, offset) != Some(0) {
                let offset = offset as u32;
                return Err(AssetError::Field { offset });
            }
        }
        let radius = u32_at(bytes, 16).unwrap_or(0);
        // Between a touching sphere and the cube's corner, rounding included.
        if !(1..=2 << 28).contains(&radius) {
            return Err(AssetError::Field { offset: 16 });
        }
        Ok(Self {
            rho,
            depth: 0,
            stored_depth: depth,
            shell,
            two_sided: flags & 1 != 0,
            radius: Length::from_bits(i64::from(radius) << 4),
            materials: [[255; 3]; MAX_MATERIALS],
            material_count: 1,
            levels: [Level::EMPTY; MAX_LEVELS],
        })
    }

    fn read_materials(&mut self, bytes: &[u8], offset: u32) -> Result<(), AssetError> {
        let error = AssetError::Materials { offset };
        let count = u32_at(bytes, 0).ok_or(error)?;
        if !(1..=MAX_MATERIALS as u32).contains(&count) || bytes.len() != 4 + 4 * count as usize {
            return Err(error);
        }
        for (material, word) in self.materials.iter_mut().zip(bytes.chunks_exact(4).skip(1)) {
            match *word {
                [red, green, blue, 0] => *material = [red, green, blue],
                _ => return Err(error),
            }
        }
        self.material_count = count as u8;
        Ok(())
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
