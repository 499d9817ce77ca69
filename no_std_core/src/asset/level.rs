//! One level: views of its links, nodes and attributes, checked against the
//! levels above it.

use super::node::{halves, is_valid, occupied};
use super::section::{Section, u32_at};
use super::{AssetError, MAX_MATERIALS};

/// The cells of one depth.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a> {
    /// For each cell of depth n - 2 the index, in this level, of its first
    /// grandchild.
    pub links: &'a [u32],
    /// Node records of the cells of depth n - 1: see [`super::node`].
    pub nodes: &'a [u16],
    /// Attributes of the cells of this depth n: material << 13 | normal code.
    pub attributes: &'a [u16],
}

impl<'a> Level<'a> {
    pub(super) const EMPTY: Self = Self {
        links: &[],
        nodes: &[],
        attributes: &[],
    };

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.attributes.len()
    }

    /// Checks the level that follows `above` and gives its views.
    pub(super) fn open(
        rho: u8,
        above: &[Level<'a>],
        material_count: u8,
        section: &Section<'a>,
    ) -> Result<Self, AssetError> {
        let size_error = AssetError::LevelSize {
            offset: section.offset,
        };
        let level = Self::split(rho, above, section).ok_or(size_error)?;
        level.check_nodes(rho, above, size_error)?;
        level.check_attributes(above.len() as u8, material_count)?;
        Ok(level)
    }

    /// Cuts the section into its parts; `None` where sizes do not fit.
    fn split(rho: u8, above: &[Level<'a>], section: &Section<'a>) -> Option<Self> {
        let cells = u32_at(section.bytes, 0)? as usize;
        let parents = above.last().map_or(0, Level::cells);
        let grandparents = match above.len() {
            0 => 0,
            1 => 1,
            _ => above.get(above.len() - 2)?.cells(),
        };
        if above.is_empty() && cells != 1 {
            return None;
        }
        let rest = section.bytes.get(4..)?;
        let (links, rest) = rest.split_at_checked(grandparents.checked_mul(4)?)?;
        let node_words = parents.checked_mul(halves(rho))?;
        let (nodes, rest) = split_halves(rest, node_words)?;
        let (attributes, rest) = split_halves(rest, cells)?;
        rest.is_empty().then_some(())?;
        Some(Self {
            links: bytemuck::try_cast_slice(links).ok()?,
            nodes,
            attributes,
        })
    }

    /// Every node has subcells, links count them, and there are as many as
    /// cells.
    fn check_nodes(
        &self,
        rho: u8,
        above: &[Level<'a>],
        size_error: AssetError,
    ) -> Result<(), AssetError> {
        let depth = (above.len() as u8).wrapping_sub(1);
        let mut records = self.nodes.chunks_exact(halves(rho)).enumerate();
        let mut cells = u64::from(above.is_empty());
        for (group, &link) in self.links.iter().enumerate() {
            if u64::from(link) != cells {
                return Err(AssetError::Link {
                    // The root's children hang on a link without a cell.
                    depth: depth.saturating_sub(1),
                    index: group as u32,
                });
            }
            let siblings = sibling_count(rho, above, group);
            for (index, record) in records.by_ref().take(siblings as usize) {
                if !is_valid(rho, record) {
                    return Err(AssetError::Node {
                        depth,
                        index: index as u32,
                    });
                }
                cells += u64::from(occupied(rho, record));
            }
        }
        if cells == self.cells() as u64 {
            Ok(())
        } else {
            Err(size_error)
        }
    }

    fn check_attributes(&self, depth: u8, material_count: u8) -> Result<(), AssetError> {
        if usize::from(material_count) == MAX_MATERIALS {
            return Ok(());
        }
        let limit = u32::from(material_count) << 13;
        let bad = self
            .attributes
            .iter()
            .position(|&attribute| u32::from(attribute) >= limit);
        match bad {
            None => Ok(()),
            Some(index) => Err(AssetError::Attribute {
                depth,
                index: index as u32,
            }),
        }
    }
}

/// Number of children of cell `group` two levels above this one.
fn sibling_count(rho: u8, above: &[Level<'_>], group: usize) -> u32 {
    let halves = halves(rho);
    let record = above
        .last()
        .and_then(|parents| parents.nodes.get(group * halves..(group + 1) * halves));
    // Depth 1 has the root alone as its group.
    record.map_or(1, |record| occupied(rho, record))
}

/// Takes `count` 16-bit words and the zero that pads them to four bytes.
fn split_halves(bytes: &[u8], count: usize) -> Option<(&[u16], &[u8])> {
    let (words, rest) = bytes.split_at_checked(count.checked_mul(2)?)?;
    let words = bytemuck::try_cast_slice(words).ok()?;
    if count.is_multiple_of(2) {
        return Some((words, rest));
    }
    match rest.split_at_checked(2)? {
        ([0, 0], rest) => Some((words, rest)),
        _ => None,
    }
}

#[cfg(target_endian = "big")]
compile_error!("assets are little-endian and read in place");
