//! The section table: bounds, order and checksums.

use super::{
    AssetError, HEADER_BYTES, HEADER_CRC_OFFSET, SECTION_BYTES, SECTION_CODED_LEVEL, SECTION_LEVEL,
    check_magic, checksum,
};

/// A byte at an offset.
pub(super) fn u8_at(bytes: &[u8], offset: usize) -> Option<u8> {
    bytes.get(offset).copied()
}

/// A little-endian 16-bit word at an offset.
pub(super) fn u16_at(bytes: &[u8], offset: usize) -> Option<u16> {
    let word = bytes.get(offset..)?.first_chunk::<2>()?;
    Some(u16::from_le_bytes(*word))
}

/// A little-endian 32-bit word at an offset.
pub(super) fn u32_at(bytes: &[u8], offset: usize) -> Option<u32> {
    let word = bytes.get(offset..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*word))
}

/// One section, its checksum verified.
pub(super) struct Section<'a> {
    /// What it holds.
    pub kind: u32,
    /// Where it starts in the file.
    pub offset: u32,
    /// Its bytes.
    pub bytes: &'a [u8],
}

/// The sections that a file holds, which may be fewer than its table names.
pub(super) struct Sections<'a> {
    bytes: &'a [u8],
    table: &'a [u8],
    present: usize,
}

impl<'a> Sections<'a> {
    /// Checks alignment, magic, the header's checksum and the table.
    pub fn open(bytes: &'a [u8]) -> Result<Self, AssetError> {
        if bytes.as_ptr().align_offset(4) != 0 {
            return Err(AssetError::Misaligned);
        }
        check_magic(bytes)?;
        let truncated = AssetError::Truncated {
            length: bytes.len() as u32,
        };
        let header_bytes = usize::from(u16_at(bytes, 6).ok_or(truncated)?);
        let count = usize::from(u8_at(bytes, 15).ok_or(truncated)?);
        if header_bytes != HEADER_BYTES + SECTION_BYTES * count {
            return Err(AssetError::Field { offset: 6 });
        }
        let header = bytes.get(..header_bytes).ok_or(truncated)?;
        let (before, rest) = header
            .split_at_checked(HEADER_CRC_OFFSET)
            .ok_or(truncated)?;
        let (stored, table) = rest.split_at_checked(4).ok_or(truncated)?;
        if u32_at(stored, 0) != Some(checksum(&[before, table])) {
            return Err(AssetError::HeaderChecksum);
        }
        let present = count_present(table, header_bytes, bytes.len())?;
        Ok(Self {
            bytes,
            table,
            present,
        })
    }

    /// Whether every section of the table is in the file.
    pub fn is_whole(&self) -> bool {
        self.present * SECTION_BYTES == self.table.len()
    }

    /// The sections in the file, in order.
    pub fn iter(&self) -> impl Iterator<Item = Result<Section<'a>, AssetError>> {
        let bytes = self.bytes;
        self.table
            .chunks_exact(SECTION_BYTES)
            .take(self.present)
            .map(move |entry| {
                let [kind, offset, length, stored] = words(entry);
                let error = AssetError::SectionChecksum { offset };
                let start = offset as usize;
                let end = start.checked_add(length as usize).ok_or(error)?;
                let section = bytes.get(start..end).ok_or(error)?;
                if checksum(&[section]) != stored {
                    return Err(error);
                }
                Ok(Section {
                    kind,
                    offset,
                    bytes: section,
                })
            })
    }
}

/// The four words of a table entry.
fn words(entry: &[u8]) -> [u32; 4] {
    [0, 4, 8, 12].map(|offset| u32_at(entry, offset).unwrap_or(0))
}

/// How many sections the file's length covers: all of them, or those up to
/// the end of a level.
fn count_present(table: &[u8], start: usize, length: usize) -> Result<usize, AssetError> {
    let mut end = start as u64;
    let length = length as u64;
    let mut present = None;
    for (index, entry) in table.chunks_exact(SECTION_BYTES).enumerate() {
        let [kind, offset, bytes, _] = words(entry);
        if u64::from(offset) != end || bytes % 4 != 0 {
            let entry_offset = HEADER_BYTES + index * SECTION_BYTES;
            return Err(AssetError::SectionTable {
                offset: entry_offset as u32,
            });
        }
        end += u64::from(bytes);
        let is_level = matches!(kind, SECTION_LEVEL | SECTION_CODED_LEVEL);
        if end == length && is_level && present.is_none() {
            present = Some(index + 1);
        }
    }
    if end == length {
        present = Some(table.len() / SECTION_BYTES);
    }
    present.ok_or(AssetError::Truncated {
        length: length as u32,
    })
}
