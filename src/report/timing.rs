//! Draw calls against the clock. Calls take turns, so that whatever else the
//! host does meets all of them alike, and each finds memory as another has
//! left it.

use std::time::Instant;

use rhogrid_core::asset::Grid;
use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{Quality, draw, shades_len};
use rhogrid_core::target::{Target, canvas_len};

use super::model::light;

/// A draw call.
pub struct Call<'a> {
    /// What is drawn.
    pub grid: Grid<'a>,
    /// From where.
    pub camera: Camera,
    /// How.
    pub quality: Quality,
}

/// The median time of each call, nanoseconds, over so many rounds of all.
pub fn medians(calls: &[Call<'_>], rounds: u32) -> Vec<f64> {
    let light = light();
    let most = |of: fn(&Call<'_>) -> usize| calls.iter().map(of).max().unwrap_or(0);
    let mut colour = vec![0; most(|call| pixels(&call.camera))];
    let mut canvas = vec![0; most(|call| canvas_len(call.camera.height))];
    let mut shades = vec![0; most(|call| shades_len(call.grid.materials().len()))];
    let mut times = vec![Vec::new(); calls.len()];
    for _ in 0..rounds.max(1) {
        for (
            Call {
                grid,
                camera,
                quality,
            },
            times,
        ) in calls.iter().zip(&mut times)
        {
            let colour = &mut colour[..pixels(camera)];
            let shades = &mut shades[..shades_len(grid.materials().len())];
            let mut target = Target::new(camera.width, camera.height, colour, &mut canvas)
                .expect("buffers are as long as the picture");
            let start = Instant::now();
            draw(grid, camera, &light, quality, shades, &mut target);
            times.push(start.elapsed().as_nanos() as f64);
        }
    }
    times.into_iter().map(median).collect()
}

fn pixels(camera: &Camera) -> usize {
    usize::from(camera.width) * usize::from(camera.height)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}
