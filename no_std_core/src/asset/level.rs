//! One level: views of its links, records and attributes, checked against the
//! levels above it.

use super::node::{halves, has_stray_bits, is_part, occupied};
use super::section::{Section, u32_at};
use super::{AssetError, MAX_MATERIALS, Shell};

/// The cells of one depth.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a> {
    /// For each cell of depth n - 2 the index, in this level, of its first
    /// grandchild.
    pub links: &'a [u32],
    /// Node records of the cells of depth n - 1: see [`super::node`].
    pub nodes: &'a [u16],
    /// For each cell of depth n - 1 a record with the same flags and with
    /// those children that are drawn where drawing stops at this depth n: the
    /// first of its children. The same slice as `nodes` where that is all of
    /// them.
    pub drawn: &'a [u16],
    /// Attributes of the cells of this depth n: material << 13 | normal code.
    pub attributes: &'a [u16],
    /// `nodes` and `drawn` of tri-grids, whose records are words; else empty.
    pub(crate) words: [&'a [u32]; 2],
}

/// What a level's layout depends on besides the levels above.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    pub rho: u8,
    pub shell: Shell,
    /// Whether it has an array of drawn records besides its nodes.
    pub stores_drawn: bool,
    pub material_count: u8,
}

impl<'a> Level<'a> {
    pub(super) const EMPTY: Self = Self {
        links: &[],
        nodes: &[],
        drawn: &[],
        attributes: &[],
        words: [&[]; 2],
    };

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.attributes.len()
    }

    /// Checks the level that follows `above` and gives its views.
    pub(super) fn open(
        shape: Shape,
        above: &[Level<'a>],
        section: &Section<'a>,
    ) -> Result<Self, AssetError> {
        let size_error = AssetError::LevelSize {
            offset: section.offset,
        };
        let level = Self::split(shape, above, section).ok_or(size_error)?;
        level.check_nodes(shape, above, size_error)?;
        if shape.stores_drawn {
            level.check_drawn(shape.rho, above.len() as u8)?;
        }
        level.check_attributes(above.len() as u8, shape.material_count)?;
        Ok(level)
    }

    /// Cuts the section into its parts; `None` where sizes do not fit.
    fn split(shape: Shape, above: &[Level<'a>], section: &Section<'a>) -> Option<Self> {
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
        let node_words = parents.checked_mul(halves(shape.rho))?;
        let (nodes, rest) = split_halves(rest, node_words)?;
        let (drawn, rest) = match shape.stores_drawn {
            true => split_halves(rest, node_words)?,
            false => (nodes, rest),
        };
        let (attributes, rest) = split_halves(rest, cells)?;
        rest.is_empty().then_some(())?;
        Some(Self {
            links: bytemuck::try_cast_slice(links).ok()?,
            nodes,
            drawn,
            attributes,
            words: match shape.rho {
                3 => [
                    bytemuck::try_cast_slice(nodes).ok()?,
                    bytemuck::try_cast_slice(drawn).ok()?,
                ],
                _ => [&[]; 2],
            },
        })
    }

    /// No node has bits without meaning, those of a fat shell have subcells,
    /// links count them, and there are as many as cells.
    fn check_nodes(
        &self,
        shape: Shape,
        above: &[Level<'a>],
        size_error: AssetError,
    ) -> Result<(), AssetError> {
        let rho = shape.rho;
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
                let subcells = occupied(rho, record);
                let is_empty = subcells == 0 && shape.shell == Shell::Fat;
                if is_empty || has_stray_bits(rho, record) {
                    return Err(AssetError::Node {
                        depth,
                        index: index as u32,
                    });
                }
                cells += u64::from(subcells);
            }
        }
        if cells == self.cells() as u64 {
            Ok(())
        } else {
            Err(size_error)
        }
    }

    /// Only children that are there are drawn, and flags are the nodes'.
    fn check_drawn(&self, rho: u8, depth: u8) -> Result<(), AssetError> {
        let size = halves(rho);
        let nodes = self.nodes.chunks_exact(size);
        let bad = nodes
            .zip(self.drawn.chunks_exact(size))
            .position(|(node, drawn)| !is_part(rho, drawn, node));
        match bad {
            None => Ok(()),
            Some(index) => Err(AssetError::Drawn {
                depth: depth.saturating_sub(1),
                index: index as u32,
            }),
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
