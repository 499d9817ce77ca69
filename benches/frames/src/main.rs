//! `bench-frames FRAME_FILE`: draws every view of a frame file as firmware
//! does, a warm-up picture and then the measured one, and prints the measured
//! one's hash. What callgrind counts is `measured`.

#![forbid(unsafe_code)]

use std::hint::black_box;
use std::process::ExitCode;

use rhogrid_core::asset::Grid;
use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{draw, shades_len};
use rhogrid_core::stats::Stats;
use rhogrid_core::target::{Target, canvas_len, frame_hash};
use rhogrid_frame::{Frame, Settings};

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

    let frame = Frame::open(bytes).map_err(|error| format!("{error:?}"))?;
    let settings = frame.settings();
    let grid = Grid::open(frame.asset()).map_err(|error| error.to_string())?;
    let mut colour = vec![0; usize::from(settings.width) * usize::from(settings.height)];
    let mut canvas = vec![0; canvas_len(settings.height)];
    let mut shades = vec![0; shades_len(grid.materials().len())];
    for view in frame.views() {
        let mut target = Target::new(settings.width, settings.height, &mut colour, &mut canvas)
            .map_err(|error| format!("{error:?}"))?;
        let (light, quality) = (&settings.light, &settings.quality);
        draw(
            &grid,
            &view.warm_up,
            light,
            quality,
            &mut shades,
            &mut target,
        );
        black_box(measured(
            &grid,
            &view.measured,
            &settings,
            &mut shades,
            &mut target,
        ));
        println!("{:08x}", frame_hash(&colour));
    }
    Ok(())
}

/// The draw call that counts.
#[inline(never)]
fn measured(
    grid: &Grid<'_>,
    camera: &Camera,
    settings: &Settings,
    shades: &mut [u16],
    target: &mut Target<'_>,
) -> Stats {
    let (light, quality) = (&settings.light, &settings.quality);
    draw(grid, camera, light, quality, shades, target)
}
