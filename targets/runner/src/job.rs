//! One run of the command: asset in, measurements out.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use rhogrid::asset_file::AssetFile;
use rhogrid::bake::Cube;
use rhogrid::cli::{ambient, is_scene, lamps, load_scene, placements};
use rhogrid::error::Error;
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{Length, Weight};
use rhogrid_core::scene::Lamp;
use rhogrid_core::shadow::Shadows;
use rhogrid_frame::{Content, Materials, Placed, Settings};

use crate::frame_file::FrameFile;
use crate::host::{self, HostFrame};
use crate::machine::Machine;
use crate::measurement::Measurement;
use crate::plugin::{CountsFile, Interval, Plugin};
use crate::qemu::{self, Guest};
use crate::qmp::Qmp;
use crate::screen::{self, Screen};
use crate::session::{Ending, Event, Session, ViewResult};
use crate::views::View;
use crate::{failure, firmware, symbols, workspace};

/// What to draw, where, and how.
#[derive(Debug)]
pub struct Job {
    /// The machine.
    pub machine: &'static Machine,
    /// The asset, or a scene.
    pub file: PathBuf,
    /// Where a scene's models are, if not beside its file.
    pub models: Option<PathBuf>,
    /// The views, measured in this order.
    pub views: Vec<View>,
    /// The light.
    pub light: Light,
    /// The options.
    pub quality: Quality,
    /// How shadows are drawn.
    pub shadows: Shadows,
    /// Whether instructions are told apart by stage, too.
    pub by_stage: bool,
}

impl Job {
    /// What the machine draws.
    ///
    /// # Errors
    /// When something cannot be read or is too large.
    pub fn frame_file(&self) -> Result<FrameFile, Error> {
        if is_scene(&self.file) {
            return self.scene();
        }
        let asset = AssetFile::load(&self.file)?;
        let views = self.cameras(asset.grid().radius(), &asset.cube());
        FrameFile::new(&Content {
            settings: self.settings(&views, self.light.ambient),
            views: &views,
            assets: &[asset.bytes()],
            instances: &[Placed::ALONE],
            lamps: &[lamp(&self.light)],
            matcap: None,
        })
    }

    fn scene(&self) -> Result<FrameFile, Error> {
        let scene = load_scene(&self.file, self.models.as_deref())?;
        let views = self.cameras(Length::ONE, &scene.cube);
        let assets: Vec<&[u8]> = scene
            .models
            .iter()
            .map(|model| model.asset.bytes())
            .collect();
        let placed = scene.instances.iter().zip(placements(&scene));
        let instances: Vec<Placed> = placed
            .map(|(instance, placement)| Placed {
                asset: instance.model as u32,
                placement,
                materials: instance.materials.as_deref().map(Materials::new),
            })
            .collect();
        FrameFile::new(&Content {
            settings: self.settings(&views, ambient(&scene)),
            views: &views,
            assets: &assets,
            instances: &instances,
            lamps: &lamps(&scene),
            matcap: scene.matcap(),
        })
    }

    fn cameras(&self, radius: Length, cube: &Cube) -> Vec<rhogrid_frame::View> {
        let cameras = |view: &View| rhogrid_frame::View {
            warm_up: view.warm_up(radius, cube),
            measured: view.camera(radius, cube),
        };
        self.views.iter().map(cameras).collect()
    }

    fn settings(&self, views: &[rhogrid_frame::View], ambient: Weight) -> Settings {
        let size = views.first().map(|view| view.measured);
        Settings {
            width: size.map_or(0, |camera| camera.width),
            height: size.map_or(0, |camera| camera.height),
            ambient,
            quality: self.quality,
            shadows: self.shadows,
        }
    }
}

/// A light as a scene's lamp.
fn lamp(light: &Light) -> Lamp {
    Lamp {
        towards: light.towards,
        colour: [255; 3],
        diffuse: light.diffuse,
        casts: true,
    }
}

/// Takes what was measured, view by view.
pub type Take<'a> = dyn FnMut(&Measurement) -> Result<(), Error> + 'a;

/// Draws on host and machine, measures every view, and compares.
///
/// # Errors
/// When something is missing or broken, or a picture is not the host's.
pub fn measure(job: &Job, take: &mut Take<'_>) -> Result<(), Error> {
    let machine = job.machine;
    let frame_file = job.frame_file()?;
    frame_file.check_fits(machine)?;
    qemu::check(machine)?;
    let host_frames = host::render(&frame_file)?;
    let firmware = firmware::build(machine)?;

    let folder = tempfile::Builder::new()
        .prefix("rhogrid-")
        .tempdir()
        .map_err(|error| failure(format!("no temporary folder: {error}"), "make room there"))?;
    let frame_path = folder.path().join("frame");
    let socket = folder.path().join("qmp");
    frame_file.save(&frame_path)?;
    let plugin = plugin(job, &firmware, folder.path())?;
    let plugin_option = plugin.as_ref().map(Plugin::option);
    let mut guest = Guest::start(
        machine,
        &firmware,
        &frame_path,
        &socket,
        plugin_option.as_deref(),
    )?;
    let mut counts_file = plugin.as_ref().map(Plugin::counts_file);
    let (ending, differing) = listen(job, &mut guest, counts_file.as_mut(), &host_frames, take)?;
    let screen_result = if machine.has_screen {
        let dump = folder.path().join("screen.ppm");
        Qmp::connect(&socket)?.screendump(&dump)?;
        let settings = frame_file.open()?.settings();
        let size = [settings.width, settings.height].map(u32::from);
        let screen = Screen::read(&dump)?;
        check_screen(machine, ending, size, &screen, host_frames.last())
    } else {
        Ok(())
    };
    if differing.is_empty() {
        return screen_result;
    }
    Err(failure(
        format!(
            "{} of {} pictures differ from the host's: {}",
            differing.len(),
            job.views.len(),
            differing.join(", ")
        ),
        screen_result.map_or_else(|error| error.to_string(), |()| String::new()),
    ))
}

/// The machine's plugin. A run without it measures all but cycles and stages.
fn plugin(job: &Job, firmware: &Path, folder: &Path) -> Result<Option<Plugin>, Error> {
    if job.by_stage {
        let entries = symbols::stage_entries(firmware)?;
        return Plugin::build(folder, entries).map(Some);
    }
    if !job.machine.has_cycle_model {
        return Ok(None);
    }
    let plugin = Plugin::build(folder, Vec::new());
    Ok(plugin
        .inspect_err(|error| eprintln!("note: cycles are not estimated: {error}"))
        .ok())
}

/// Follows the firmware to its end; returns the names of the views whose
/// pictures differ from the host's.
fn listen<'a>(
    job: &'a Job,
    guest: &mut Guest,
    mut counts_file: Option<&mut CountsFile>,
    host_frames: &[HostFrame],
    take: &mut Take<'_>,
) -> Result<(Ending, Vec<&'a str>), Error> {
    let mut session = Session::new(job.machine.clock, job.views.len());
    let mut differing = Vec::new();
    let mut expected = job.views.iter().zip(host_frames);
    let mut interval = |between_readings| {
        let next = |file: &mut &mut CountsFile| file.next(between_readings);
        counts_file.as_mut().map(next).transpose()
    };
    loop {
        match session.take(&guest.line()?)? {
            Event::Greeting => {}
            Event::Check { between_readings } => {
                // The plugin must count these, too, as the timer does.
                interval(between_readings)?;
            }
            Event::End(ending) => return Ok((ending, differing)),
            Event::View(result) => {
                // The session lets through as many as there are.
                let Some((view, host_frame)) = expected.next() else {
                    continue;
                };
                let interval = interval(result.between_readings)?;
                let measurement = measurement(job, view, &result, interval.as_ref(), host_frame)?;
                take(&measurement)?;
                if !measurement.agrees() {
                    differing.push(view.name.as_str());
                }
            }
        }
    }
}

fn measurement(
    job: &Job,
    view: &View,
    result: &ViewResult,
    interval: Option<&Interval>,
    host_frame: &HostFrame,
) -> Result<Measurement, Error> {
    let reading = result.between_readings - result.instructions;
    let stages = interval
        .filter(|_| job.by_stage)
        .map(|interval| interval.stages(reading))
        .transpose()?;
    Ok(Measurement {
        machine: job.machine.name.to_owned(),
        view: view.name.clone(),
        instructions: result.instructions,
        cycles_estimate: interval.map(|interval| interval.counts.cycles()),
        frame_hash: result.frame_hash,
        host_frame_hash: host_frame.hash,
        stack_bytes: result.stack_bytes,
        stages,
    })
}

/// Prints a line, with `json` as an object.
///
/// # Errors
/// When nobody reads it.
pub fn print(measurement: &Measurement, json: bool) -> Result<(), Error> {
    let line = if json {
        serde_json::to_string(measurement).map_err(|error| failure(error.to_string(), ""))?
    } else {
        measurement.line()
    };
    writeln!(io::stdout(), "{line}").map_err(|error| failure(format!("cannot print: {error}"), ""))
}

/// The screen must show the host's last picture, pixel for pixel.
fn check_screen(
    machine: &Machine,
    ending: Ending,
    [width, height]: [u32; 2],
    screen: &Screen,
    last: Option<&HostFrame>,
) -> Result<(), Error> {
    let Some(last) = last else {
        return Ok(());
    };
    if ending != (Ending::Shown { width, height }) || screen.size() != (width, height) {
        return Err(failure(
            format!(
                "the screen of {} is {:?}, not ({width}, {height})",
                machine.name,
                screen.size()
            ),
            "",
        ));
    }
    let words = screen.rgb565();
    let Err(difference) = screen::compare(&words, &last.colour, width as usize) else {
        return Ok(());
    };
    let folder = workspace().join("target/screens");
    let paths = screen::save_difference(&folder, machine.name, screen, &last.colour)?;
    let paths: Vec<String> = paths
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    Err(failure(
        format!(
            "{} pixels of {}'s screen differ from the host's picture, the first at {:?}; see {}",
            difference.pixels,
            machine.name,
            difference.first,
            paths.join(", ")
        ),
        "",
    ))
}
