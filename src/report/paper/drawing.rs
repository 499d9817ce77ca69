//! Ways to draw that the paper compares, and how fast each is.

use std::path::Path;

use rhogrid_core::camera::Camera;
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::SplatPx;
use rhogrid_core::shadow::{Method, Shadows};

use super::Comparison;
use crate::asset_file::AssetFile;
use crate::cli::{Frame, draw_frame, draw_placed, draw_shadowed, with_core};
use crate::error::Error;
use crate::report::machine::{Machine, asset_file};
use crate::report::model::light;
use crate::scene::Scene;

/// Clock of the paper's machine, Hz.
const CLOCK: f64 = 200e6;

/// A way to draw.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// As the paper calls it.
    pub name: &'static str,
    /// Every leaf is a point: no coarser cells, nothing that faces away or is
    /// hidden is left out.
    points: bool,
    method: Method,
}

const fn way(name: &'static str, points: bool, method: Method) -> Way {
    Way {
        name,
        points,
        method,
    }
}

/// Points with shadows, in parentheses in table 5.
pub const SHADOWED_POINTS: Way = way("points with shadows", true, Method::TwoPass);
/// Cells as large as a splat, with shadows of the same pass.
pub const ONE_PASS: Way = way("one-pass shadows", false, Method::OnePass);
/// In the order of table 5.
pub const WAYS: [Way; 5] = [
    way("points", true, Method::Off),
    SHADOWED_POINTS,
    way("splats", false, Method::Off),
    way("two-pass shadows", false, Method::TwoPass),
    ONE_PASS,
];

impl Way {
    /// The same without shadows.
    pub fn lit(self) -> Self {
        Self {
            method: Method::Off,
            ..self
        }
    }

    /// As `targets/run` is told.
    fn options(&self) -> Vec<&'static str> {
        let mut options = match self.points {
            true => vec!["--splat", "0", "--culling", "off"],
            false => Vec::new(),
        };
        let method = match self.method {
            Method::Off => "off",
            Method::TwoPass => "two-pass",
            Method::OnePass => "one-pass",
        };
        options.extend(["--shadows", method]);
        options
    }

    fn quality(&self) -> Quality {
        match self.points {
            true => Quality {
                splat: SplatPx::ZERO,
                culling: false,
                ..Quality::default()
            },
            false => Quality::default(),
        }
    }

    /// Draws on the host, so many times.
    pub fn draw(&self, content: &Content<'_>, camera: &Camera, rounds: u32) -> Frame {
        let quality = self.quality();
        let shadows = Shadows {
            method: self.method,
            ..Shadows::default()
        };
        match content {
            Content::Asset(asset) if self.method == Method::Off => {
                draw_frame(&asset.grid(), camera, &light(), &quality, rounds)
            }
            Content::Asset(asset) => {
                let grid = asset.grid();
                draw_shadowed(&grid, camera, &light(), &quality, &shadows, rounds)
            }
            Content::Scene(scene, _) => with_core(scene, shadows, |scene| {
                draw_placed(scene, camera, &quality, rounds)
            }),
        }
    }
}

/// What is drawn.
pub enum Content<'a> {
    /// A model.
    Asset(&'a AssetFile),
    /// A scene, and its file.
    Scene(&'a Scene, &'a Path),
}

/// Something seen from some places.
pub struct Sight<'a> {
    /// What progress calls it.
    pub name: &'a str,
    /// What is seen.
    pub content: Content<'a>,
    /// From where, as `targets/run` is told.
    pub view: &'a str,
    /// The same, for the host.
    pub cameras: Vec<Camera>,
}

impl Comparison<'_> {
    /// How fast something is drawn, the mean over its cameras: frames a second of
    /// the paper's machine, or without a machine milliseconds of the host. `None`
    /// where the machine has no estimate of its cycles.
    ///
    /// # Errors
    /// When the machine cannot be run.
    pub fn speed(&self, sight: &Sight<'_>, way: &Way) -> Result<Option<f64>, Error> {
        let Sight { name, view, .. } = sight;
        (self.progress)(&format!("{name}: draws {}, {view}", way.name));
        match self.machine {
            Some(machine) => self.frames_a_second(machine, sight, way),
            None => Ok(Some(self.milliseconds(sight, way))),
        }
    }

    fn frames_a_second(
        &self,
        machine: &Machine,
        sight: &Sight<'_>,
        way: &Way,
    ) -> Result<Option<f64>, Error> {
        let mut options = vec!["--view", sight.view];
        options.extend(way.options());
        let cycles = match sight.content {
            Content::Asset(asset) => {
                let file = asset_file(asset.bytes())?;
                machine.cycles(file.path(), &options)?
            }
            Content::Scene(_, file) => {
                let models = self.models.and_then(Path::to_str);
                options.extend(models.iter().flat_map(|models| ["--models", models]));
                machine.cycles(file, &options)?
            }
        };
        Ok(cycles.map(|cycles| CLOCK / cycles))
    }

    fn milliseconds(&self, sight: &Sight<'_>, way: &Way) -> f64 {
        let cameras = sight.cameras.iter();
        let times = cameras.map(|camera| {
            let frame = way.draw(&sight.content, camera, self.rounds());
            frame.time_ns as f64 / 1e6
        });
        times.sum::<f64>() / sight.cameras.len().max(1) as f64
    }

    /// How often the host draws what it times.
    pub fn rounds(&self) -> u32 {
        if self.quick { 1 } else { 5 }
    }

    /// What [`Comparison::speed`] is in.
    pub fn unit(&self) -> &'static str {
        match self.machine {
            Some(_) => "frames/s",
            None => "host ms",
        }
    }

    /// What the page says of speeds.
    pub fn about_speed(&self) -> String {
        match self.machine {
            Some(machine) => format!(
                "Ours are frames a second at {} MHz: the clock over the cycles that `targets/run {} \
                 FILE --json` estimates. QEMU counts instructions, which are exact; cycles are an \
                 estimate (`targets/runner/src/cycles.rs`), of the SA-1110 alone: others leave \
                 cells empty.",
                CLOCK / 1e6,
                machine.name
            ),
            None => format!(
                "Ours are milliseconds a frame on this host ({}), medians of {}: no rate of the \
                 paper's machine, which needs --machine sa1110.",
                std::env::consts::ARCH,
                self.rounds()
            ),
        }
    }
}
