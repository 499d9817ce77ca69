//! One level: views of its links, records and attributes, checked against the
//! levels above it.

use super::coded::{Coding, Dictionary};
use super::colours::Colours;
use super::node::{halves, has_stray_bits, is_part, occupied};
use super::records::Records;
use super::section::{Section, u32_at};
use super::{AssetError, MAX_MATERIALS, SECTION_CODED_LEVEL, Shell};

/// The cells of one depth.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a> {
    /// For each cell of depth n - 2 the index, in this level, of its first
    /// grandchild. A [coded](super::coded) level has none here.
    pub links: &'a [u32],
    /// Node records of the cells of depth n - 1: see [`super::node`]. Where the
    /// level is coded, their codes.
    pub nodes: &'a [u16],
    /// For each cell of depth n - 1 a record with the same flags and with
    /// those children that are drawn where drawing stops at this depth n: the
    /// first of its children. The same slice as `nodes` where that is all of
    /// them; codes where those are.
    pub drawn: &'a [u16],
    /// Attributes of the cells of this depth n: material << 13 | normal code.
    pub attributes: &'a [u16],
    /// As many colours, if samples have some.
    pub colours: Colours<'a>,
    /// `nodes` and `drawn` of tri-grids that are not coded, whose records are
    /// words; else empty.
    pub(crate) words: [&'a [u32]; 2],
}

/// A level, and what it means where it is coded.
#[derive(Clone, Copy)]
pub(super) struct Stored<'a> {
    pub level: Level<'a>,
    pub coding: Option<Coding<'a>>,
}

/// What a level's layout depends on besides the levels above.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    pub rho: u8,
    pub shell: Shell,
    /// Whether it has an array of drawn records besides its nodes.
    pub stores_drawn: bool,
    pub material_count: u8,
    pub attribute_bits: u8,
}

/// What follows from the levels above.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub links: usize,
    /// Of one array.
    pub records: usize,
}

impl Counts {
    fn below(above: &[Level<'_>]) -> Self {
        let links = match above {
            [] => 0,
            [_] => 1,
            [.., grandparents, _] => grandparents.cells(),
        };
        let records = above.last().map_or(0, Level::cells);
        Self { links, records }
    }
}

impl<'a> Level<'a> {
    pub(super) const EMPTY: Self = Self {
        links: &[],
        nodes: &[],
        drawn: &[],
        attributes: &[],
        colours: Colours::None,
        words: [&[]; 2],
    };

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.attributes.len()
    }
}

impl<'a> Stored<'a> {
    /// Number of links.
    fn links(&self) -> usize {
        self.coding
            .map_or(self.level.links.len(), |coding| coding.links())
    }

    /// A link; zero where there is none.
    pub fn link(&self, group: usize) -> u32 {
        match self.coding {
            Some(coding) => coding.link(group),
            None => self.level.links.get(group).copied().unwrap_or(0),
        }
    }

    /// The records of a grid of a rho.
    pub fn node_records(&self, rho: u8) -> Records<'a> {
        match self.coding {
            Some(coding) => Records::coded(self.level.nodes, coding, coding.node_starts()),
            None => Records::stored(self.level.nodes, halves(rho)),
        }
    }

    /// The drawn records, the same.
    pub fn drawn_records(&self, rho: u8) -> Records<'a> {
        match self.coding {
            Some(coding) => Records::coded(self.level.drawn, coding, coding.drawn_starts()),
            None => Records::stored(self.level.drawn, halves(rho)),
        }
    }

    /// Checks the level that follows `above`, the coding of the last of which
    /// is `coding_above`, and gives its views.
    pub fn open(
        shape: Shape,
        above: &[Level<'a>],
        coding_above: Option<Coding<'a>>,
        section: &Section<'a>,
        dictionary: Option<Dictionary<'a>>,
    ) -> Result<Self, AssetError> {
        let offset = section.offset;
        let size_error = AssetError::LevelSize { offset };
        let counts = Counts::below(above);
        let depth = above.len() as u8;
        let stored = if section.kind == SECTION_CODED_LEVEL {
            let dictionary = dictionary.ok_or(AssetError::Dictionary { offset })?;
            Coding::split(shape, counts, section, dictionary)
        } else {
            Self::split(shape, counts, section)
        };
        let stored = stored.ok_or(size_error)?;
        if above.is_empty() && stored.level.cells() != 1 {
            return Err(size_error);
        }
        if let Some(coding) = stored.coding {
            let depth = depth.saturating_sub(1);
            coding.check(&stored.level, shape.stores_drawn, depth, offset)?;
        }
        let parents = above.last().map(|&level| Self {
            level,
            coding: coding_above,
        });
        stored.check_nodes(shape, depth, parents, size_error)?;
        if shape.stores_drawn {
            stored.check_drawn(shape.rho, depth)?;
        }
        stored.check_attributes(depth, shape.material_count)?;
        stored.level.colours.check(depth)?;
        Ok(stored)
    }

    /// Cuts the section into its parts; `None` where sizes do not fit.
    fn split(shape: Shape, counts: Counts, section: &Section<'a>) -> Option<Self> {
        let cells = u32_at(section.bytes, 0)? as usize;
        let rest = section.bytes.get(4..)?;
        let (links, rest) = rest.split_at_checked(counts.links.checked_mul(4)?)?;
        let node_words = counts.records.checked_mul(halves(shape.rho))?;
        let (nodes, rest) = split_halves(rest, node_words)?;
        let (drawn, rest) = match shape.stores_drawn {
            true => split_halves(rest, node_words)?,
            false => (nodes, rest),
        };
        let (attributes, rest) = split_halves(rest, cells)?;
        let (colours, rest) = Colours::split(rest, shape.attribute_bits, cells)?;
        rest.is_empty().then_some(())?;
        let level = Level {
            links: bytemuck::try_cast_slice(links).ok()?,
            nodes,
            drawn,
            attributes,
            colours,
            words: match shape.rho {
                3 => [
                    bytemuck::try_cast_slice(nodes).ok()?,
                    bytemuck::try_cast_slice(drawn).ok()?,
                ],
                _ => [&[]; 2],
            },
        };
        Some(Self {
            level,
            coding: None,
        })
    }

    /// No node has bits without meaning, those of a fat shell have subcells,
    /// links count them, and there are as many as cells.
    fn check_nodes(
        &self,
        shape: Shape,
        depth: u8,
        parents: Option<Self>,
        size_error: AssetError,
    ) -> Result<(), AssetError> {
        let rho = shape.rho;
        let mut records = self.node_records(rho).enumerate();
        let mut siblings = parents.map(|parents| parents.node_records(rho));
        let mut cells = u64::from(parents.is_none());
        let depth = depth.wrapping_sub(1);
        for group in 0..self.links() {
            if u64::from(self.link(group)) != cells {
                return Err(AssetError::Link {
                    // The root's children hang on a link without a cell.
                    depth: depth.saturating_sub(1),
                    index: group as u32,
                });
            }
            // Depth 1 has the root alone as its group.
            let parents = siblings.as_mut().and_then(Iterator::next);
            let siblings = parents.map_or(1, |record| occupied(rho, record.halves()));
            for (index, record) in records.by_ref().take(siblings as usize) {
                let subcells = occupied(rho, record.halves());
                let is_empty = subcells == 0 && shape.shell == Shell::Fat;
                if is_empty || has_stray_bits(rho, record.halves()) {
                    return Err(AssetError::Node {
                        depth,
                        index: index as u32,
                    });
                }
                cells += u64::from(subcells);
            }
        }
        if cells == self.level.cells() as u64 {
            Ok(())
        } else {
            Err(size_error)
        }
    }

    /// Only children that are there are drawn, and flags are the nodes'.
    fn check_drawn(&self, rho: u8, depth: u8) -> Result<(), AssetError> {
        let bad = self
            .node_records(rho)
            .zip(self.drawn_records(rho))
            .position(|(node, drawn)| !is_part(rho, drawn.halves(), node.halves()));
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
            .level
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

/// Takes `count` 16-bit words and the zero that pads them to four bytes.
pub(super) fn split_halves(bytes: &[u8], count: usize) -> Option<(&[u16], &[u8])> {
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
