//! One case: baked, drawn without measuring, then counted on host and machine.
//! No count is accepted of a picture whose hash is not the unmeasured one's.

use std::fs;
use std::path::{Path, PathBuf};

use rhogrid::asset_file::AssetFile;
use rhogrid::cli::{
    Model, ShadowChoice, core_light, core_quality, core_shadows, draw_frame, float_light,
};
use rhogrid::error::Error;
use rhogrid_core::asset::node::occupied;
use rhogrid_core::draw::{Light, Quality};
use rhogrid_targets::failure;
use rhogrid_targets::job::{self, Job};
use rhogrid_targets::machine::Machine;
use rhogrid_targets::measurement::Measurement;
use rhogrid_targets::stages::StageInstructions;
use rhogrid_targets::views::View;

use crate::callgrind::{self, HostCount};
use crate::cases::Case;

/// What cases are counted with.
#[derive(Debug)]
pub struct Bench {
    /// The host's program.
    pub program: PathBuf,
    /// The machine beside the host.
    pub machine: &'static Machine,
    /// Where models are, if they are anywhere.
    pub models: Option<PathBuf>,
    /// The views of every case.
    pub views: Vec<View>,
}

/// A picture without measuring.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Drawn {
    hash: u32,
    samples: u64,
    pixels: u64,
}

/// A counted picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Name of the view.
    pub view: String,
    /// Its hash, everywhere.
    pub frame_hash: u32,
    /// Samples that reached the depth test.
    pub samples_drawn: u64,
    /// Pixels that show something.
    pub pixels_shown: u64,
    /// Instructions on the host.
    pub host: StageInstructions,
    /// Instructions on the machine.
    pub machine: StageInstructions,
}

/// A counted case.
#[derive(Debug)]
pub struct Counted {
    /// The case.
    pub case: &'static Case,
    /// Leaf samples of its asset.
    pub leaf_samples: u64,
    /// Its pictures.
    pub frames: Vec<Frame>,
}

/// Where a case's input is.
pub fn input(case: &Case, models: Option<&Path>) -> PathBuf {
    match models {
        Some(models) if !case.is_built_in() => models.join(case.input),
        _ => case.input.into(),
    }
}

impl Bench {
    /// Counts a case.
    ///
    /// # Errors
    /// When something is missing or broken, or pictures differ.
    pub fn count(&self, case: &'static Case) -> Result<Counted, Error> {
        let folder = tempfile::Builder::new().prefix("rhogrid-").tempdir();
        let folder = folder
            .map_err(|error| failure(format!("no temporary folder: {error}"), "make room there"))?;
        let (asset, job) = self.bake(case, folder.path())?;
        let frame_path = folder.path().join("frame");
        job.frame_file()?.save(&frame_path)?;
        let view_count = self.views.len();
        let hosts = callgrind::count(&self.program, &frame_path, view_count, folder.path())?;
        let mut machines = Vec::new();
        job::measure(&job, &mut |measurement| {
            machines.push(measurement.clone());
            Ok(())
        })?;
        let frames = self.views.iter().zip(hosts).zip(&machines);
        let frames = frames
            .map(|((view, host), machine)| {
                let drawn = draw(&asset, view, &job.light, &job.quality);
                frame(view, &drawn, &host, machine).map_err(|error| Error {
                    what: format!("{}, {}: {}", case.name, view.name, error.what),
                    ..error
                })
            })
            .collect::<Result<_, _>>()?;
        Ok(Counted {
            case,
            leaf_samples: leaf_samples(&asset),
            frames,
        })
    }

    fn bake(&self, case: &Case, folder: &Path) -> Result<(AssetFile, Job), Error> {
        let (source, quality) = case.options()?;
        let input = input(case, self.models.as_deref());
        let asset = Model::open(&input, &source).map_err(|failed| match failed {
            rhogrid::cli::Failure::Usage(what) => failure(what, ""),
            rhogrid::cli::Failure::Failed(error) => error,
        })?;
        let asset = asset.asset;
        if float_light(&quality).casts {
            return Err(failure("shadows cannot be counted yet", ""));
        }
        let file = folder.join("asset.rho");
        fs::write(&file, asset.bytes())
            .map_err(|error| Error::file(&file, error.to_string(), "make room there"))?;
        let job = Job {
            machine: self.machine,
            file,
            models: None,
            views: self.views.clone(),
            light: core_light(&quality),
            quality: core_quality(&quality),
            shadows: core_shadows(&quality, ShadowChoice::Off),
            by_stage: true,
        };
        Ok((asset, job))
    }
}

fn draw(asset: &AssetFile, view: &View, light: &Light, quality: &Quality) -> Drawn {
    let grid = asset.grid();
    let camera = view.camera(grid.radius(), &asset.cube());
    let frame = draw_frame(&grid, &camera, light, quality, 1);
    Drawn {
        hash: frame.hash(),
        samples: u64::from(frame.stats.samples_drawn),
        pixels: frame.depth.iter().filter(|&&depth| depth != 0).count() as u64,
    }
}

/// Puts together what belongs to a view, if all pictures are the same.
fn frame(
    view: &View,
    drawn: &Drawn,
    host: &HostCount,
    machine: &Measurement,
) -> Result<Frame, Error> {
    for (name, hash) in [
        ("host", host.frame_hash),
        (&machine.machine, machine.frame_hash),
    ] {
        if hash != drawn.hash {
            let what = format!(
                "the picture counted on {name} has the hash {hash:08x}, \
                 drawn without counting it has {:08x}",
                drawn.hash
            );
            return Err(failure(
                what,
                "its instructions mean nothing; run tests/run",
            ));
        }
    }
    let stages = machine
        .stages
        .filter(|stages| stages.sum() == machine.instructions);
    let machine = stages.ok_or_else(|| {
        let what = format!(
            "the stages on {} do not add up to {}",
            machine.machine, machine.instructions
        );
        failure(what, "")
    })?;
    Ok(Frame {
        view: view.name.clone(),
        frame_hash: drawn.hash,
        samples_drawn: drawn.samples,
        pixels_shown: drawn.pixels,
        host: host.stages,
        machine,
    })
}

/// Cells of the deepest level that are drawn.
fn leaf_samples(asset: &AssetFile) -> u64 {
    let grid = asset.grid();
    let records = grid.drawn_records(usize::from(grid.depth()));
    let leaves: u64 = records
        .map(|record| u64::from(occupied(grid.rho(), record.halves())))
        .sum();
    // A root alone is one.
    leaves.max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STAGES: StageInstructions = StageInstructions([1, 2, 3, 4, 5]);

    fn view() -> View {
        rhogrid_targets::views::standard().swap_remove(0)
    }

    fn machine() -> Measurement {
        Measurement {
            machine: "sa1110".to_owned(),
            view: "full/0".to_owned(),
            instructions: 15,
            cycles_estimate: None,
            frame_hash: 7,
            host_frame_hash: 7,
            stack_bytes: 0,
            stages: Some(STAGES),
        }
    }

    fn put_together(hash: u32, host_hash: u32, machine: &Measurement) -> Result<Frame, Error> {
        let drawn = Drawn {
            hash,
            samples: 100,
            pixels: 50,
        };
        let host = HostCount {
            frame_hash: host_hash,
            stages: STAGES,
        };
        frame(&view(), &drawn, &host, machine)
    }

    #[test]
    fn equal_pictures_are_counted() {
        let frame = put_together(7, 7, &machine()).expect("all are 7");
        assert_eq!((frame.host, frame.machine), (STAGES, STAGES));
        assert_eq!(frame.frame_hash, 7);
    }

    #[test]
    fn another_picture_is_not_counted_wherever_it_was_drawn() {
        for (hash, host_hash, who) in [(7, 8, "host"), (8, 8, "sa1110"), (8, 7, "host")] {
            let error = put_together(hash, host_hash, &machine()).expect_err(who);
            assert!(
                error.what.contains(&format!("counted on {who} has")),
                "{error}"
            );
        }
    }

    #[test]
    fn stages_that_are_not_the_whole_are_not_counted() {
        for (stages, instructions) in [(Some(STAGES), 16), (None, 15)] {
            let machine = Measurement {
                stages,
                instructions,
                ..machine()
            };
            let error = put_together(7, 7, &machine).expect_err("no sum");
            assert!(error.what.contains("do not add up"), "{error}");
        }
    }
}
