//! Standard views and views of one's own, as cameras of the core.

use rhogrid_core::asset::Grid;
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::numbers::{FocalPx, Length, Turns};

/// Picture width of all views in pixels.
pub const WIDTH: u16 = 240;
/// Picture height of all views in pixels.
pub const HEIGHT: u16 = 320;
/// Focal length in pixels: a vertical field of view of 53.13 degrees.
const FOCAL_PX: u16 = 320;
/// Pitch of the standard views in degrees.
const PITCH: f64 = 15.0;
/// Yaws of the standard views in degrees.
const YAWS: [u16; 4] = [0, 90, 180, 270];
/// Names and distances, in radii, of the standard views.
const STANDARD: [(&str, f64); 3] = [("full", 2.6), ("far", 9.0), ("close", 1.4)];
/// Farthest distance in radii.
const MAX_DISTANCE: f64 = 1e6;
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
/// When it is neither a standard view nor three sensible numbers.
pub fn parse(argument: &str) -> Result<Vec<View>, String> {
    if let Some((name, distance)) = STANDARD.iter().find(|(name, _)| *name == argument) {
        return Ok(four_yaws(name, *distance));
    }
    let numbers: Option<Vec<f64>> = argument
        .split(',')
        .map(|part| {
            part.trim()
                .parse()
                .ok()
                .filter(|number: &f64| number.is_finite())
        })
        .collect();
    match numbers.as_deref() {
        Some([yaw, pitch, distance]) if *distance > 0.0 && *distance <= MAX_DISTANCE => {
            Ok(vec![View {
                name: argument.to_owned(),
                yaw: *yaw,
                pitch: *pitch,
                distance: *distance,
            }])
        }
        _ => Err(format!(
            "a view is full, far, close, or YAW,PITCH,DISTANCE in degrees and radii (up to {MAX_DISTANCE})"
        )),
    }
}

/// Radius of the model in model space.
pub fn radius(_: &Grid<'_>) -> Length {
    Length::ONE
}

impl View {
    /// The camera of this view.
    pub fn camera(&self, radius: Length) -> Camera {
        self.camera_at_yaw(self.yaw, radius)
    }

    /// The camera of the picture that is drawn before this one.
    pub fn warm_up(&self, radius: Length) -> Camera {
        self.camera_at_yaw(self.yaw + WARM_UP_YAW, radius)
    }

    fn camera_at_yaw(&self, yaw: f64, radius: Length) -> Camera {
        let orbit = Orbit {
            yaw: turns(yaw),
            pitch: turns(self.pitch),
            distance: Length::from_num(self.distance).saturating_mul(radius),
        };
        Camera::orbit(&orbit, FocalPx::from(FOCAL_PX), WIDTH, HEIGHT)
    }
}

/// Degrees, any number of times around, as turns; rounded to nearest.
fn turns(degrees: f64) -> Turns {
    let fraction = (degrees / 360.0).rem_euclid(1.0);
    // At most 2^32, which is 0 again.
    let steps = (fraction * 4_294_967_296.0).round() as u64;
    Turns::from_bits((steps & u64::from(u32::MAX)) as u32)
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
        for argument in [
            "", "near", "full/0", "1,2", "1,2,3,4", "1,2,0", "1,2,-3", "nan,1,1", "1,2,inf",
            "1,2,1e7",
        ] {
            let error = parse(argument).expect_err(argument);
            assert!(error.contains("YAW,PITCH,DISTANCE"), "{argument}");
        }
    }

    #[test]
    fn degrees_wrap() {
        let quarter = 1 << 30;
        for (degrees, bits) in [
            (0.0, 0),
            (90.0, quarter),
            (-90.0, 3 * quarter),
            (450.0, quarter),
            (360.0, 0),
            (-1e-30, 0),
        ] {
            assert_eq!(turns(degrees).to_bits(), bits, "{degrees}");
        }
    }

    #[test]
    fn the_warm_up_is_a_quarter_away() {
        let views = standard();
        let radius = Length::from_num(1.25);
        for pair in views[..4].windows(2) {
            assert_eq!(pair[0].warm_up(radius), pair[1].camera(radius));
        }
        let eye = views[0].camera(radius).eye.map(|c| c.to_num::<f64>());
        let distance = eye.iter().map(|c| c * c).sum::<f64>().sqrt();
        assert!((distance - 2.6 * 1.25).abs() < 1e-6);
    }
}
