//! What is read, and how it is baked.

use std::path::Path;

use clap::{Args, ValueEnum};
use rhogrid_core::asset::{Shell, max_depth};

use super::super::Failure;
use crate::bake::{Attributes, GridOptions, Masks, Normals};
use crate::geometry::Up;

/// What a mesh or cloud is baked into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Representation {
    /// A recursive point grid
    Grid,
}

/// Which cells a grid holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShellChoice {
    /// Every cell that the surface touches
    Fat,
    /// A subset through which nothing slips, about half of them
    Thin,
}

impl From<ShellChoice> for Shell {
    fn from(choice: ShellChoice) -> Self {
        match choice {
            ShellChoice::Fat => Self::Fat,
            ShellChoice::Thin => Self::Thin,
        }
    }
}

/// Which normals and colours intermediate samples have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum NormalChoice {
    /// The mean of what a cell holds, where that tells something
    Filtered,
    /// The surface's at the point nearest to the cell's centre
    Nearest,
}

impl From<NormalChoice> for Normals {
    fn from(choice: NormalChoice) -> Self {
        match choice {
            NormalChoice::Filtered => Self::Filtered,
            NormalChoice::Nearest => Self::Nearest,
        }
    }
}

/// How masks are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MasksChoice {
    /// As they are
    Plain,
    /// The finest levels' as indices into a dictionary, for less memory (rho 3)
    Dictionary,
}

impl From<MasksChoice> for Masks {
    fn from(choice: MasksChoice) -> Self {
        match choice {
            MasksChoice::Plain => Self::Plain,
            MasksChoice::Dictionary => Self::Dictionary,
        }
    }
}

/// How wide a sample's attribute is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AttributeChoice {
    /// 13-bit normal and 3-bit material
    #[value(name = "16")]
    Bits16,
    /// With a 16-bit colour
    #[value(name = "32")]
    Bits32,
    /// With a 24-bit colour
    #[value(name = "48")]
    Bits48,
}

impl From<AttributeChoice> for Attributes {
    fn from(choice: AttributeChoice) -> Self {
        match choice {
            AttributeChoice::Bits16 => Self::Bits16,
            AttributeChoice::Bits32 => Self::Bits32,
            AttributeChoice::Bits48 => Self::Bits48,
        }
    }
}

/// How a source becomes an asset.
#[derive(Clone, Debug, Args)]
pub struct SourceArgs {
    /// What to bake
    #[arg(long = "as", value_enum, default_value = "grid")]
    pub representation: Representation,
    /// Subdivisions of each axis of a cell [default: 3]
    #[arg(long, value_parser = clap::value_parser!(u8).range(2..=5))]
    pub rho: Option<u8>,
    /// Level K has rho^(K + 1) cells on an axis [default: 4]
    #[arg(long, value_name = "K", allow_negative_numbers = true)]
    pub level: Option<u8>,
    /// Which cells to keep [default: thin]
    #[arg(long, value_enum)]
    pub shell: Option<ShellChoice>,
    /// Normals and colours of intermediate samples [default: filtered]
    #[arg(long, value_enum)]
    pub normals: Option<NormalChoice>,
    /// How masks are written [default: plain]
    #[arg(long, value_enum)]
    pub masks: Option<MasksChoice>,
    /// Which source axis points up [default: y]
    #[arg(long, value_enum)]
    pub up: Option<Up>,
    /// Bits of a sample's attribute [default: 16, or 32 for a source with
    /// colours]
    #[arg(long, value_enum, value_name = "BITS")]
    pub attributes: Option<AttributeChoice>,
    /// Draw every surface from both sides
    #[arg(long)]
    pub two_sided: bool,
}

impl SourceArgs {
    /// Checks what clap cannot.
    ///
    /// # Errors
    /// When the level is too deep for rho, or the masks are not rho's.
    pub fn check(&self) -> Result<(), Failure> {
        let GridOptions {
            rho, level, masks, ..
        } = self.grid_options();
        if masks == Masks::Dictionary && rho != 3 {
            return Err(Failure::Usage(format!(
                "--masks dictionary is not possible with --rho {rho}; give --rho 3"
            )));
        }
        let deepest = max_depth(rho) - 1;
        if level > deepest {
            return Err(Failure::Usage(format!(
                "--level {level} is too deep for --rho {rho}; give at most {deepest}"
            )));
        }
        Ok(())
    }

    /// Refuses options of baking where nothing is baked.
    ///
    /// # Errors
    /// When one of them is given.
    pub fn check_unused(&self, asset: &Path) -> Result<(), Failure> {
        let given = [
            ("--rho", self.rho.is_some()),
            ("--level", self.level.is_some()),
            ("--shell", self.shell.is_some()),
            ("--normals", self.normals.is_some()),
            ("--masks", self.masks.is_some()),
            ("--up", self.up.is_some()),
            ("--attributes", self.attributes.is_some()),
            ("--two-sided", self.two_sided),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            None => Ok(()),
            Some((option, _)) => Err(Failure::Usage(format!(
                "{option} is for baking, and {} is an asset already; give the mesh it was baked from",
                asset.display()
            ))),
        }
    }

    /// The grid baker's options.
    pub fn grid_options(&self) -> GridOptions {
        let defaults = GridOptions::default();
        GridOptions {
            rho: self.rho.unwrap_or(defaults.rho),
            level: self.level.unwrap_or(defaults.level),
            shell: self.shell.map_or(defaults.shell, Shell::from),
            normals: self.normals.map_or(defaults.normals, Normals::from),
            two_sided: self.two_sided,
            up: self.up.unwrap_or(defaults.up),
            masks: self.masks.map_or(defaults.masks, Masks::from),
            attributes: self.attributes.map(Attributes::from),
        }
    }
}
