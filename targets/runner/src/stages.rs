//! The stages of a frame, told apart by the functions that begin them.
//!
//! A stage's function and all that it calls is that stage; what is in none of
//! them is set-up. So the stages of a frame add up to the whole of it.

use std::ops::Index;

/// A part of a draw call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Projection, plan, displacement tables, clip planes: what no other stage
    /// has.
    SetUp,
    /// The frame's colours of all normals.
    ShadeTable,
    /// Zeroing the canvas.
    Clear,
    /// From the root to samples on the canvas.
    Traversal,
    /// From the canvas to colours, with holes closed.
    Resolve,
}

impl Stage {
    /// All stages in the order of a frame; [`Stage::SetUp`] is first.
    pub const ALL: [Self; 5] = [
        Self::SetUp,
        Self::ShadeTable,
        Self::Clear,
        Self::Traversal,
        Self::Resolve,
    ];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::SetUp => "set-up",
            Self::ShadeTable => "shade table",
            Self::Clear => "clear",
            Self::Traversal => "traversal",
            Self::Resolve => "resolve",
        }
    }

    /// The stage that a function begins, by its name without hashes.
    pub fn begun_by(function: &str) -> Option<Self> {
        match without_arguments(function) {
            "rhogrid_core::draw::stages::shade" => Some(Self::ShadeTable),
            "rhogrid_core::draw::stages::clear" => Some(Self::Clear),
            "rhogrid_core::draw::stages::resolve" => Some(Self::Resolve),
            _ => {
                // `<type>::node::<3>` or `type::node`, as the symbol tells.
                let path = function.trim_start_matches('<');
                let method = path.strip_prefix("rhogrid_core::grid::traverse::Frame<")?;
                let (_, name) = method.split_once(">::")?;
                ["start", "node"]
                    .contains(&without_arguments(name))
                    .then_some(Self::Traversal)
            }
        }
    }
}

/// A function's name without its last generic arguments: `clear` of
/// `clear::<u32>`.
fn without_arguments(name: &str) -> &str {
    match name
        .strip_suffix('>')
        .and_then(|name| name.rsplit_once("::<"))
    {
        Some((plain, _)) => plain,
        None => name,
    }
}

/// Instructions of each stage of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageInstructions(pub [u64; Stage::ALL.len()]);

impl StageInstructions {
    /// Those of the whole frame.
    pub fn sum(&self) -> u64 {
        self.0.iter().sum()
    }
}

impl Index<Stage> for StageInstructions {
    type Output = u64;

    fn index(&self, stage: Stage) -> &u64 {
        &self.0[stage as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_begin_stages() {
        let traverse = "<rhogrid_core::grid::traverse::Frame<27, 9, u32>>::";
        for (function, stage) in [
            ("rhogrid_core::draw::stages::shade", Some(Stage::ShadeTable)),
            ("rhogrid_core::draw::stages::clear", Some(Stage::Clear)),
            (
                "rhogrid_core::draw::stages::clear::<u32>",
                Some(Stage::Clear),
            ),
            (
                "rhogrid_core::draw::stages::resolve::<[u32; 2]>",
                Some(Stage::Resolve),
            ),
            (
                "rhogrid_core::draw::stages::resolve::<u32>::{closure#0}",
                None,
            ),
            ("rhogrid_core::draw::stages::resolve", Some(Stage::Resolve)),
            ("rhogrid_core::canvas::clear", None),
            ("rhogrid_core::grid::traverse::run::<3, 27, 9>", None),
            ("main", None),
            (&format!("{traverse}node::<3>"), Some(Stage::Traversal)),
            (&format!("{traverse}start::<3>"), Some(Stage::Traversal)),
            (
                "rhogrid_core::grid::traverse::Frame<_,_>::node",
                Some(Stage::Traversal),
            ),
            (
                "rhogrid_core::grid::traverse::Frame<_,_>::node::{{closure}}",
                None,
            ),
            (&format!("{traverse}steps"), None),
            (&format!("{traverse}node::<3>::{{closure#0}}"), None),
        ] {
            assert_eq!(Stage::begun_by(function), stage, "{function}");
        }
    }

    #[test]
    fn stages_index_their_instructions() {
        let instructions = StageInstructions([1, 20, 300, 4000, 50_000]);
        assert_eq!(instructions.sum(), 54_321);
        let each = Stage::ALL.map(|stage| instructions[stage]);
        assert_eq!(each, instructions.0);
    }
}
