//! What can be wrong with an asset, and where.

use core::fmt;

/// Why bytes are not an asset. Offsets count bytes from the file's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AssetError {
    /// The bytes do not start at a multiple of four.
    Misaligned,
    /// The file ends inside its header, or not at the end of a level.
    Truncated {
        /// Length of the file.
        length: u32,
    },
    /// The first four bytes are not `RHOG`.
    Magic,
    /// A format version that this core does not read.
    Version {
        /// The version found.
        version: u16,
    },
    /// The header's checksum differs.
    HeaderChecksum,
    /// Not a kind of asset that this core draws.
    Kind {
        /// The kind found.
        kind: u8,
    },
    /// Rho is not 2, 3, 4 or 5.
    Rho {
        /// The value found.
        rho: u8,
    },
    /// This build of the core leaves out what the asset needs.
    LeftOut {
        /// Offset of the header's field or of the section.
        offset: u32,
        /// The feature of the core that has it.
        feature: &'static str,
    },
    /// More subdivisions than rho allows.
    Depth {
        /// The value found.
        depth: u8,
    },
    /// A header field has no meaning.
    Field {
        /// Where it stands.
        offset: u32,
    },
    /// Sections overlap, leave gaps or have odd sizes.
    SectionTable {
        /// Offset of the entry.
        offset: u32,
    },
    /// A section's checksum differs.
    SectionChecksum {
        /// Offset of the section.
        offset: u32,
    },
    /// The materials are malformed, repeated or behind the levels.
    Materials {
        /// Offset of the section.
        offset: u32,
    },
    /// The dictionary of masks is malformed, repeated, not a tri-grid's, or
    /// absent before a level with coded records.
    Dictionary {
        /// Offset of the section, or of the level's.
        offset: u32,
    },
    /// There are not as many levels as the header says.
    LevelCount {
        /// Offset of the section, or of the header's field.
        offset: u32,
    },
    /// A level's size does not follow from its cell counts.
    LevelSize {
        /// Offset of the section.
        offset: u32,
    },
    /// A node has bits outside its mask, or none in a fat shell.
    Node {
        /// Depth of the cell that it subdivides.
        depth: u8,
        /// Index of that cell in its level.
        index: u32,
    },
    /// A drawn record has children that its node has not, or other flags.
    Drawn {
        /// Depth of the cell that it subdivides.
        depth: u8,
        /// Index of that cell in its level.
        index: u32,
    },
    /// Flags of coded records have bits outside their place.
    Flags {
        /// Offset of the level's section.
        offset: u32,
    },
    /// A coded record names no mask of the dictionary, or not the next record
    /// of those that are stored whole.
    Code {
        /// Depth of the cell that it subdivides.
        depth: u8,
        /// Index of that cell in its level.
        index: u32,
    },
    /// A link differs from the number of cells before it.
    Link {
        /// Depth of the cell whose first grandchild it names.
        depth: u8,
        /// Index of that cell in its level.
        index: u32,
    },
    /// An attribute names a material that is not there.
    Attribute {
        /// Depth of the cell.
        depth: u8,
        /// Index of the cell in its level.
        index: u32,
    },
    /// A colour has bits without meaning.
    Colour {
        /// Depth of the cell.
        depth: u8,
        /// Index of the cell in its level.
        index: u32,
    },
}

impl fmt::Display for AssetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Misaligned => {
                f.write_str("the asset does not start at a multiple of four bytes; align it")
            }
            Self::Truncated { length } => write!(
                f,
                "byte {length}: the file ends inside its header or a level; copy it again"
            ),
            Self::Magic => f.write_str("byte 0: not a .rho asset; make one with `rhogrid bake`"),
            Self::Version { version } => write!(
                f,
                "byte 4: format version {version} is not readable here; bake the asset again"
            ),
            Self::HeaderChecksum => {
                f.write_str("byte 60: the header's checksum differs; copy the file again")
            }
            Self::Kind { kind } => write!(
                f,
                "byte 8: assets of kind {kind} are not drawn here; update the reader"
            ),
            Self::Rho { rho } => {
                write!(f, "byte 9: rho is {rho}, not 2 to 5; bake the asset again")
            }
            Self::LeftOut { offset, feature } => write!(
                f,
                "byte {offset}: not drawn by this build; enable rhogrid-core's feature {feature}"
            ),
            Self::Depth { depth } => write!(
                f,
                "byte 10: {depth} subdivisions are too many for this rho; bake the asset again"
            ),
            Self::Field { offset } => write!(
                f,
                "byte {offset}: a value without meaning; bake the asset again"
            ),
            Self::SectionTable { offset } => write!(
                f,
                "byte {offset}: sections overlap or leave gaps; bake the asset again"
            ),
            Self::SectionChecksum { offset } => write!(
                f,
                "byte {offset}: the section's checksum differs; copy the file again"
            ),
            Self::Materials { offset } => write!(
                f,
                "byte {offset}: malformed materials; bake the asset again"
            ),
            Self::Dictionary { offset } => write!(
                f,
                "byte {offset}: malformed or misplaced dictionary of masks; bake the asset again"
            ),
            Self::LevelCount { offset } => write!(
                f,
                "byte {offset}: levels do not match the header's depth; bake the asset again"
            ),
            Self::LevelSize { offset } => write!(
                f,
                "byte {offset}: the level's size contradicts its cell counts; bake the asset again"
            ),
            Self::Node { depth, index } => write!(
                f,
                "depth {depth}, cell {index}: empty or malformed mask; bake the asset again"
            ),
            Self::Drawn { depth, index } => write!(
                f,
                "depth {depth}, cell {index}: the drawn record contradicts its node; bake the asset again"
            ),
            Self::Flags { offset } => write!(
                f,
                "byte {offset}: malformed flags of coded masks; bake the asset again"
            ),
            Self::Code { depth, index } => write!(
                f,
                "depth {depth}, cell {index}: a code without a mask; bake the asset again"
            ),
            Self::Link { depth, index } => write!(
                f,
                "depth {depth}, cell {index}: wrong grandchild link; bake the asset again"
            ),
            Self::Attribute { depth, index } => write!(
                f,
                "depth {depth}, cell {index}: no such material; bake the asset again"
            ),
            Self::Colour { depth, index } => write!(
                f,
                "depth {depth}, cell {index}: no such colour; bake the asset again"
            ),
        }
    }
}

impl core::error::Error for AssetError {}
