//! `bench-frames FRAME_FILE`: draws every view of a frame file as firmware
//! does, a warm-up picture and then the measured one, and prints the measured
//! one's hash. What callgrind counts is `measured`.

#![forbid(unsafe_code)]

use std::fmt::Debug;
use std::hint::black_box;
use std::process::ExitCode;

use rhogrid_core::asset::Grid;
use rhogrid_core::camera::Camera;
use rhogrid_core::draw::shades_len;
use rhogrid_core::scene::Instance;
use rhogrid_core::stats::Stats;
use rhogrid_core::target::{TargetError, canvas_len, frame_hash};
use rhogrid_frame::Frame;
use rhogrid_measure::{Content, Memories, SHADOWS};

fn main() -> ExitCode {
    let Some(file) = std::env::args_os().nth(1) else {
        eprintln!("usage: bench-frames FRAME_FILE");
        return ExitCode::from(2);
    };
    let drawn = std::fs::read(&file)
        .map_err(|error| error.to_string())
        .and_then(|bytes| draw_all(&bytes));
    match drawn {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("{}: {what}", file.display());
            ExitCode::FAILURE
        }
    }
}

fn draw_all(bytes: &[u8]) -> Result<(), String> {
    // At a multiple of four.
    let mut words = vec![0u32; bytes.len().div_ceil(4)];
    bytemuck::cast_slice_mut(&mut words)[..bytes.len()].copy_from_slice(bytes);
    let bytes = &bytemuck::cast_slice(&words)[..bytes.len()];

    let frame = Frame::open(bytes).map_err(shown)?;
    let settings = frame.settings();
    let grids = frame.assets().map(|asset| Grid::open(asset).map(Some));
    let grids = grids.collect::<Result<Vec<_>, _>>().map_err(shown)?;
    let content = Content::new(&frame, &grids).map_err(shown)?;
    let (instances, count) = content.instances().map_err(shown)?;
    let instances = &instances[..count];

    let pixels = usize::from(settings.width) * usize::from(settings.height);
    let (mut colour, mut depth) = (vec![0; pixels], vec![0; pixels]);
    let mut shadows = vec![0; SHADOWS];
    let mut memory = Memories {
        shades: &mut vec![0; shades_len(content.materials())],
        shadows: content.shadows(&mut shadows).map_err(shown)?,
        canvas: &mut vec![0; canvas_len(settings.height)],
    };
    for view in frame.views() {
        let (colour, depth) = (&mut colour, &mut depth);
        let warm_up = content.draw(instances, &view.warm_up, colour, depth, &mut memory);
        black_box(warm_up.map_err(shown)?);
        let camera = &view.measured;
        let stats = measured(&content, instances, camera, colour, depth, &mut memory);
        black_box(stats.map_err(shown)?);
        println!("{:08x}", frame_hash(colour));
    }
    Ok(())
}

fn shown(error: impl Debug) -> String {
    format!("{error:?}")
}

/// The draw call that counts.
#[inline(never)]
fn measured(
    content: &Content<'_>,
    instances: &[Instance<'_>],
    camera: &Camera,
    colour: &mut [u16],
    depth: &mut [u16],
    memory: &mut Memories<'_>,
) -> Result<Stats, TargetError> {
    content.draw(instances, camera, colour, depth, memory)
}
