//! Light and knobs of a frame.

use clap::{Args, ValueEnum};
use glam::DVec3;
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::SplatPx;
use rhogrid_core::shadow::Shadows;

use super::super::Failure;
use super::Triple;

/// Towards the light unless somebody says otherwise.
const DEFAULT_LIGHT: DVec3 = DVec3::new(1.0, 2.0, 1.5);

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
    /// Additions where they err by no more than --distortion
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

/// What becomes of what faces away or is hidden.
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
    /// World direction towards the light; scenes have their own [default:
    /// 1,2,1.5]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub light: Option<Triple>,
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
    /// How far additions may be off, pixels, in the worst corner of the worst
    /// view; with --path auto [default: 1]
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub distortion: Option<f64>,
    /// What becomes of pixels that points have missed
    #[arg(long, value_enum, default_value = "on")]
    pub repair: RepairChoice,
    /// What becomes of what faces away or is hidden
    #[arg(long, value_enum, default_value = "on")]
    pub culling: CullingChoice,
    /// How lights cast shadows; --reference traces rays for either way
    /// [default: off; for scenes one-pass]
    #[arg(long, value_enum)]
    pub shadows: Option<ShadowChoice>,
    /// Texels along a side of the shadow map
    #[arg(long, value_name = "TEXELS", default_value_t = Shadows::default().size,
        value_parser = clap::value_parser!(u16).range(i64::from(Shadows::MIN_SIZE)..=i64::from(Shadows::MAX_SIZE)))]
    pub shadow_size: u16,
    /// Cells with edges of at most this many texels cast as one square each
    #[arg(long, value_name = "TEXELS", default_value_t = Shadows::default().splat.to_num(),
        allow_negative_numbers = true)]
    pub shadow_splat: f64,
    /// Times what a surface may differ from its own squares in the map, so that
    /// it does not shadow itself
    #[arg(long, value_name = "FACTOR", default_value_t = Shadows::default().bias.to_num(),
        allow_negative_numbers = true)]
    pub shadow_bias: f64,
}

impl QualityArgs {
    /// Checks what clap cannot.
    ///
    /// # Errors
    /// When the light has no direction, a size is out of range or a bound has
    /// no use.
    pub fn check(&self) -> Result<(), Failure> {
        if self.towards().try_normalize().is_none() {
            return Err(Failure::Usage(
                "--light needs a direction other than 0,0,0".into(),
            ));
        }
        if !(0.0..=4096.0).contains(&self.splat) {
            return Err(Failure::Usage("--splat must be 0 to 4096 pixels".into()));
        }
        if !(0.0..=4096.0).contains(&self.shadow_splat) {
            return Err(Failure::Usage(
                "--shadow-splat must be 0 to 4096 texels".into(),
            ));
        }
        if !(0.0..=256.0).contains(&self.shadow_bias) {
            return Err(Failure::Usage("--shadow-bias must be 0 to 256".into()));
        }
        match self.distortion {
            Some(_) if self.path != PathChoice::Auto => Err(Failure::Usage(
                "--distortion bounds --path auto: leave one of the two out".into(),
            )),
            Some(bound) if !(0.0..=4096.0).contains(&bound) => Err(Failure::Usage(
                "--distortion must be 0 to 4096 pixels".into(),
            )),
            _ => Ok(()),
        }
    }

    /// The direction towards the light, of any length.
    pub fn towards(&self) -> DVec3 {
        self.light.map_or(DEFAULT_LIGHT, |light| light.0)
    }

    /// How far additions may be off.
    pub fn distortion(&self) -> SplatPx {
        match (self.path, self.distortion) {
            (PathChoice::Auto, None) => Quality::DISTORTION,
            (PathChoice::Auto, Some(bound)) => SplatPx::saturating_from_num(bound),
            (PathChoice::Exact, _) => SplatPx::ZERO,
            (PathChoice::Affine, _) => SplatPx::MAX,
        }
    }
}
