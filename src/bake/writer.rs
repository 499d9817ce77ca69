//! The one writer of `.rho` files: see [`rhogrid_core::asset`] for the
//! format.

use rhogrid_core::asset::node::{halves, occupied};
use rhogrid_core::asset::{
    HEADER_BYTES, HEADER_CRC_OFFSET, KIND_GRID, MAGIC, SECTION_BYTES, SECTION_LEVEL,
    SECTION_MATERIALS, Shell, VERSION, checksum,
};

use super::{Attributes, BakedGrid, BakedLevel, Cube, Masks, dictionary};
use crate::error::{Error, Place};
use crate::geometry::Up;
use crate::picture::rgb565;

/// Serializes a grid.
///
/// # Errors
/// When the asset would not fit the format's 32-bit offsets.
pub fn to_bytes(grid: &BakedGrid) -> Result<Vec<u8>, Error> {
    let levels = linked(grid);
    let sections = match grid.masks {
        Masks::Plain => levels.iter().map(plain).collect(),
        Masks::Dictionary => dictionary::smallest(&levels),
    };
    with_header(grid, sections)
}

/// Serializes a tri-grid with so many of its finest levels coded, whether
/// that saves bytes or not.
///
/// # Errors
/// When the asset would not fit the format's 32-bit offsets.
pub fn to_coded_bytes(grid: &BakedGrid, levels: usize) -> Result<Vec<u8>, Error> {
    let sections = dictionary::sections(&linked(grid), levels);
    with_header(grid, sections)
}

fn with_header(grid: &BakedGrid, levels: Vec<(u32, Vec<u8>)>) -> Result<Vec<u8>, Error> {
    let mut sections = vec![(SECTION_MATERIALS, materials(grid))];
    sections.extend(levels);
    let header_bytes = HEADER_BYTES + SECTION_BYTES * sections.len();
    let total = header_bytes
        + sections
            .iter()
            .map(|(_, section)| section.len())
            .sum::<usize>();
    if u32::try_from(total).is_err() {
        return Err(Error {
            file: None,
            place: Place::Whole,
            what: format!("the asset would take {total} bytes, more than 4 GiB"),
            remedy: "lower --level".into(),
        });
    }
    let mut bytes = header(grid, header_bytes, sections.len());
    let mut offset = header_bytes;
    for (kind, section) in &sections {
        for word in [*kind, offset as u32, section.len() as u32, 0] {
            bytes.extend(word.to_le_bytes());
        }
        offset += section.len();
    }
    for (_, section) in &sections {
        bytes.extend(section);
    }
    seal(&mut bytes);
    Ok(bytes)
}

/// Writes the checksums of all sections and of the header, as far as the
/// table describes bytes that are there.
pub fn seal(bytes: &mut [u8]) {
    let word = |bytes: &[u8], at: usize| {
        bytes
            .get(at..at + 4)
            .and_then(|w| w.try_into().ok())
            .map(u32::from_le_bytes)
    };
    let count = bytes.get(15).copied().unwrap_or(0);
    for index in 0..usize::from(count) {
        let entry = HEADER_BYTES + SECTION_BYTES * index;
        let (Some(offset), Some(length)) = (word(bytes, entry + 4), word(bytes, entry + 8)) else {
            break;
        };
        let (start, length) = (offset as usize, length as usize);
        if let Some(section) = bytes.get(start..start.saturating_add(length)) {
            let crc = checksum(&[section]).to_le_bytes();
            if let Some(place) = bytes.get_mut(entry + 12..entry + 16) {
                place.copy_from_slice(&crc);
            }
        }
    }
    let end = HEADER_BYTES + SECTION_BYTES * usize::from(count);
    if let (Some(before), Some(table)) = (
        bytes.get(..HEADER_CRC_OFFSET),
        bytes.get(HEADER_CRC_OFFSET + 4..end),
    ) {
        let crc = checksum(&[before, table]).to_le_bytes();
        bytes[HEADER_CRC_OFFSET..HEADER_CRC_OFFSET + 4].copy_from_slice(&crc);
    }
}

fn header(grid: &BakedGrid, header_bytes: usize, sections: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((header_bytes as u16).to_le_bytes());
    let up = match grid.up {
        Up::X => 0,
        Up::Y => 1,
        Up::Z => 2,
    };
    let shell = match grid.shell {
        Shell::Fat => 0,
        Shell::Thin => 1,
    };
    let depth = grid.levels.len() as u8 - 1;
    bytes.extend([KIND_GRID, grid.rho, depth, attribute_bits(grid.attributes)]);
    bytes.extend([shell, up, u8::from(grid.two_sided), sections as u8]);
    let radius = (grid.cube.radius / grid.cube.half_side * f64::from(1 << 28)).ceil();
    bytes.extend((radius as u32).to_le_bytes());
    bytes.extend(extents(&grid.cube).to_le_bytes());
    for value in grid
        .cube
        .centre
        .to_array()
        .into_iter()
        .chain([grid.cube.half_side])
    {
        bytes.extend(value.to_le_bytes());
    }
    bytes.resize(HEADER_BYTES, 0);
    bytes
}

fn attribute_bits(attributes: Attributes) -> u8 {
    match attributes {
        Attributes::Bits16 => 16,
        Attributes::Bits32 => 32,
        Attributes::Bits48 => 48,
    }
}

/// In 1023rds of the half side, rounded up: x, y and z from bits 0, 10 and 20
/// on.
fn extents(cube: &Cube) -> u32 {
    let parts = (cube.extents / cube.half_side * 1023.0).ceil();
    let parts = parts.to_array().map(|part| part.clamp(0.0, 1023.0) as u32);
    parts[0] | parts[1] << 10 | parts[2] << 20
}

fn materials(grid: &BakedGrid) -> Vec<u8> {
    let mut bytes = (grid.materials.len() as u32).to_le_bytes().to_vec();
    for [red, green, blue] in &grid.materials {
        bytes.extend([*red, *green, *blue, 0]);
    }
    bytes
}

/// A level with its links.
pub(super) struct Linked<'a> {
    pub level: &'a BakedLevel,
    pub attributes: Attributes,
    /// The first grandchild of each cell two levels above.
    pub links: Vec<u32>,
}

fn linked(grid: &BakedGrid) -> Vec<Linked<'_>> {
    let size = halves(grid.rho);
    let counts = |nodes: &[u16]| -> Vec<u32> {
        nodes
            .chunks_exact(size)
            .map(|record| occupied(grid.rho, record))
            .collect()
    };
    let mut above: Vec<u32> = Vec::new();
    let mut linked = Vec::new();
    for (depth, level) in grid.levels.iter().enumerate() {
        let own = counts(&level.nodes);
        // Siblings in each group: one root, then the children of each cell.
        let groups = if depth == 1 { vec![1] } else { above };
        let mut links = Vec::new();
        let (mut first, mut cells) = (0usize, 0u32);
        for &siblings in groups.iter().take(if depth == 0 { 0 } else { usize::MAX }) {
            links.push(cells);
            let end = first + siblings as usize;
            cells += own[first..end].iter().sum::<u32>();
            first = end;
        }
        linked.push(Linked {
            level,
            attributes: grid.attributes,
            links,
        });
        above = own;
    }
    linked
}

/// A level as it is.
pub(super) fn plain(linked: &Linked<'_>) -> (u32, Vec<u8>) {
    let Linked { level, links, .. } = linked;
    let mut bytes = Vec::new();
    extend_words(&mut bytes, &[level.attributes.len() as u32]);
    extend_words(&mut bytes, links);
    extend_padded(&mut bytes, &level.nodes);
    extend_padded(&mut bytes, &level.drawn);
    extend_padded(&mut bytes, &level.attributes);
    extend_colours(&mut bytes, linked);
    (SECTION_LEVEL, bytes)
}

/// The colours that a level's attributes are wide enough for.
pub(super) fn extend_colours(bytes: &mut Vec<u8>, linked: &Linked<'_>) {
    let colours = linked.level.colours.iter();
    match linked.attributes {
        Attributes::Bits16 => {}
        Attributes::Bits32 => {
            let narrow: Vec<u16> = colours
                .map(|&colour| rgb565(colour.map(f64::from)))
                .collect();
            extend_padded(bytes, &narrow);
        }
        Attributes::Bits48 => {
            bytes.extend(colours.flat_map(|&[red, green, blue]| [red, green, blue, 0]));
        }
    }
}

pub(super) fn extend_words(bytes: &mut Vec<u8>, words: &[u32]) {
    bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
}

pub(super) fn extend_padded(bytes: &mut Vec<u8>, words: &[u16]) {
    bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}
