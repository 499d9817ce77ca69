//! Where the camera stands.

use clap::Args;

use super::super::Failure;
use super::{Size, Triple};

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
