//! Options that several commands share.

use std::path::Path;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use glam::DVec3;
use rhogrid_core::asset::{Shell, max_depth};
use rhogrid_core::draw::Quality;

use super::Failure;
use crate::bake::{GridOptions, Masks, Normals};
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

/// Which normals intermediate samples have.
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
    /// Normals of intermediate samples [default: filtered]
    #[arg(long, value_enum)]
    pub normals: Option<NormalChoice>,
    /// How masks are written [default: plain]
    #[arg(long, value_enum)]
    pub masks: Option<MasksChoice>,
    /// Which source axis points up [default: y]
    #[arg(long, value_enum)]
    pub up: Option<Up>,
    /// Bits of a sample's attribute
    #[arg(long, value_enum, value_name = "BITS", default_value = "16")]
    pub attributes: AttributeChoice,
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
        }
    }
}

/// Three numbers, `X,Y,Z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple(pub DVec3);

impl FromStr for Triple {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .filter_map(|part| part.trim().parse().ok())
            .collect();
        match numbers[..] {
            [x, y, z] if text.split(',').count() == 3 && DVec3::new(x, y, z).is_finite() => {
                Ok(Self(DVec3::new(x, y, z)))
            }
            _ => Err("give three numbers, X,Y,Z".into()),
        }
    }
}

/// Width and height in pixels, `WxH`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns, 1 to 4096.
    pub width: u16,
    /// Rows, 1 to 4096.
    pub height: u16,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |part: &str| {
            part.parse::<u16>()
                .ok()
                .filter(|side| (1..=4096).contains(side))
        };
        let parts = text.split_once('x').map(|(w, h)| (side(w), side(h)));
        match parts {
            Some((Some(width), Some(height))) => Ok(Self { width, height }),
            _ => Err("give WxH, each 1 to 4096, as in 240x320".into()),
        }
    }
}

/// Where the camera stands.
#[derive(Clone, Debug, Args)]
pub struct ViewArgs {
    /// Picture size in pixels
    #[arg(long, value_name = "WxH", default_value = "240x320")]
    pub size: Size,
    /// Angle around the y axis, degrees
    #[arg(long, value_name = "D", default_value_t = 0.0, allow_negative_numbers = true, conflicts_with_all = ["eye", "look_at"])]
    pub yaw: f64,
    /// Angle above the horizon, degrees
    #[arg(long, value_name = "D", default_value_t = 15.0, allow_negative_numbers = true, conflicts_with_all = ["eye", "look_at"])]
    pub pitch: f64,
    /// Distance from the centre, in radii of the model
    #[arg(long, value_name = "R", default_value_t = 2.6, allow_negative_numbers = true, conflicts_with_all = ["eye", "look_at"])]
    pub distance: f64,
    /// Eye position in the source's units, y up
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub eye: Option<Triple>,
    /// Point to look at; default the model's centre
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        requires = "eye"
    )]
    pub look_at: Option<Triple>,
    /// Vertical field of view, degrees
    #[arg(
        long,
        value_name = "D",
        default_value_t = 53.13,
        allow_negative_numbers = true
    )]
    pub fov: f64,
}

impl ViewArgs {
    /// Checks what clap cannot.
    ///
    /// # Errors
    /// When an angle or distance is out of range.
    pub fn check(&self) -> Result<(), Failure> {
        let usage = |what: &str| Err(Failure::Usage(what.into()));
        if !(0.1..=179.5).contains(&self.fov) {
            return usage("--fov must be 0.1 to 179.5 degrees");
        }
        if !(self.yaw.is_finite() && self.pitch.is_finite()) {
            return usage("--yaw and --pitch must be finite numbers of degrees");
        }
        if !(0.0..=1e8).contains(&self.distance) {
            return usage("--distance must be 0 to 100000000 radii");
        }
        Ok(())
    }
}

/// Whether and how a light casts shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShadowChoice {
    /// No shadows
    Off,
    /// A shadow map of its own
    TwoPass,
    /// A shadow map in the same pass
    OnePass,
}

/// How cells reach the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PathChoice {
    /// Additions where they err by a quarter of a pixel at most
    Auto,
    /// A reciprocal and a covering splat for each
    Exact,
    /// Additions wherever a subtree fits its window
    Affine,
}

/// Whether pixels that points have missed are closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RepairChoice {
    /// From their neighbours
    On,
    /// They stay holes
    Off,
}

/// What becomes of what faces away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CullingChoice {
    /// It is left out
    On,
    /// It is drawn like everything else, to measure what samples cost
    Off,
}

/// Light and knobs of a frame.
#[derive(Clone, Debug, Args)]
pub struct QualityArgs {
    /// World direction towards the light
    #[arg(
        long,
        value_name = "X,Y,Z",
        default_value = "1,2,1.5",
        allow_hyphen_values = true
    )]
    pub light: Triple,
    /// Cells with edges of at most this many pixels are one sample each
    #[arg(
        long,
        value_name = "PX",
        default_value_t = Quality::SPLAT.to_num(),
        allow_negative_numbers = true
    )]
    pub splat: f64,
    /// How cells are projected
    #[arg(long, value_enum, default_value = "auto")]
    pub path: PathChoice,
    /// What becomes of pixels that points have missed
    #[arg(long, value_enum, default_value = "on")]
    pub repair: RepairChoice,
    /// What becomes of what faces away
    #[arg(long, value_enum, default_value = "on")]
    pub culling: CullingChoice,
    /// Shadows; for --reference alone, which traces rays
    #[arg(long, value_enum, default_value = "off")]
    pub shadows: ShadowChoice,
}

impl QualityArgs {
    /// Checks what clap cannot.
    ///
    /// # Errors
    /// When the light has no direction or the splat size is out of range.
    pub fn check(&self) -> Result<(), Failure> {
        if self.light.0.try_normalize().is_none() {
            return Err(Failure::Usage(
                "--light needs a direction other than 0,0,0".into(),
            ));
        }
        if !(0.0..=4096.0).contains(&self.splat) {
            return Err(Failure::Usage("--splat must be 0 to 4096 pixels".into()));
        }
        Ok(())
    }
}
