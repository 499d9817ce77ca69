//! Standard views and views of one's own, as cameras of the core.

use clap::Parser;
use rhogrid::bake::Cube;
use rhogrid::cli::{Failure, ViewArgs, core_camera};
use rhogrid_core::camera::Camera;
use rhogrid_core::numbers::Length;

/// Pitch of the standard views in degrees.
const PITCH: f64 = 15.0;
/// Yaws of the standard views in degrees.
const YAWS: [u16; 4] = [0, 90, 180, 270];
/// Names and distances, in radii, of the standard views.
const STANDARD: [(&str, f64); 3] = [("full", 2.6), ("far", 9.0), ("close", 1.4)];
/// Degrees from a measured picture to the one drawn before it.
const WARM_UP_YAW: f64 = 90.0;

/// An eye around the model, looking at its centre.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// What results call it: `full/90`, or the numbers as they were given.
    pub name: String,
    /// Degrees around the y axis.
    pub yaw: f64,
    /// Degrees above the horizon.
    pub pitch: f64,
    /// Distance from the centre in radii of the model.
    pub distance: f64,
}

/// All twelve standard views.
pub fn standard() -> Vec<View> {
    STANDARD
        .iter()
        .flat_map(|(name, distance)| four_yaws(name, *distance))
        .collect()
}

fn four_yaws(name: &str, distance: f64) -> Vec<View> {
    let view = |yaw: u16| View {
        name: format!("{name}/{yaw}"),
        yaw: f64::from(yaw),
        pitch: PITCH,
        distance,
    };
    YAWS.map(view).to_vec()
}

/// Views that an argument means: `full`, `far` and `close` are four each.
///
/// # Errors
/// When it is neither a standard view nor three numbers that `rhogrid render`
/// takes.
pub fn parse(argument: &str) -> Result<Vec<View>, String> {
    if let Some((name, distance)) = STANDARD.iter().find(|(name, _)| *name == argument) {
        return Ok(four_yaws(name, *distance));
    }
    let numbers: Result<Vec<f64>, _> = argument
        .split(',')
        .map(|part| part.trim().parse())
        .collect();
    let Ok([yaw, pitch, distance]) = numbers.as_deref() else {
        return Err(
            "a view is full, far, close, or YAW,PITCH,DISTANCE in degrees and radii".to_owned(),
        );
    };
    let view = View {
        name: argument.to_owned(),
        yaw: *yaw,
        pitch: *pitch,
        distance: *distance,
    };
    match view.options(view.yaw).check() {
        Ok(()) => Ok(vec![view]),
        Err(Failure::Usage(what)) => Err(what),
        Err(Failure::Failed(error)) => Err(error.to_string()),
    }
}

/// The options of `rhogrid render` that say where the camera is.
#[derive(Parser)]
struct RenderView {
    #[command(flatten)]
    view: ViewArgs,
}

impl View {
    /// The camera of this view: the one that `rhogrid render` has.
    pub fn camera(&self, radius: Length, cube: &Cube) -> Camera {
        core_camera(&self.options(self.yaw), radius, cube)
    }

    /// The camera of the picture that is drawn before this one.
    pub fn warm_up(&self, radius: Length, cube: &Cube) -> Camera {
        let options = self.options(self.yaw + WARM_UP_YAW);
        core_camera(&options, radius, cube)
    }

    /// Size and field of view are the defaults, which are the standard.
    fn options(&self, yaw: f64) -> ViewArgs {
        ViewArgs {
            yaw,
            pitch: self.pitch,
            distance: self.distance,
            ..RenderView::parse_from([""]).view
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_standard_views_in_order() {
        let names: Vec<String> = standard().into_iter().map(|view| view.name).collect();
        assert_eq!(names.len(), 12);
        assert_eq!(
            names[..5],
            ["full/0", "full/90", "full/180", "full/270", "far/0"]
        );
        assert_eq!(names[11], "close/270");
    }

    #[test]
    fn arguments_become_views() {
        assert_eq!(parse("close"), Ok(standard()[8..].to_vec()));
        let own = View {
            name: "-30, 10.5,2".to_owned(),
            yaw: -30.0,
            pitch: 10.5,
            distance: 2.0,
        };
        assert_eq!(parse("-30, 10.5,2"), Ok(vec![own]));
    }

    #[test]
    fn nonsense_is_refused() {
        for argument in ["", "near", "full/0", "1,2", "1,2,3,4", "1,x,2"] {
            let error = parse(argument).expect_err(argument);
            assert!(error.contains("YAW,PITCH,DISTANCE"), "{argument}");
        }
        for argument in ["1,2,-3", "nan,1,1", "1,2,inf"] {
            assert!(parse(argument).is_err(), "{argument}");
        }
    }

    #[test]
    fn the_first_view_is_the_default_of_render() {
        let first = &standard()[0];
        let default = RenderView::parse_from([""]).view;
        assert_eq!(
            (first.yaw, first.pitch, first.distance),
            (default.yaw, default.pitch, default.distance)
        );
        assert_eq!((default.size.width, default.size.height), (240, 320));
    }
}
