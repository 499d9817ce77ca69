//! The smallest product: opens an asset and draws it, as an orbiting camera
//! sees it, into a whole picture. Only its size counts; it is never run.
#![no_std]
#![no_main]

#[expect(unsafe_code, reason = "an entry for the linker")]
mod board;

use core::hint::black_box;

use rhogrid_core::asset::Grid;
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light, Quality, draw};
use rhogrid_core::numbers::{FocalPx, Length, Turns, Unit, Weight};
use rhogrid_core::target::Target;

const LIGHT: Light = Light {
    towards: [Unit::lit("0.6"), Unit::lit("0.8"), Unit::ZERO],
    ambient: Weight::lit("0.2"),
    diffuse: Weight::lit("0.8"),
};
const FOCAL: FocalPx = FocalPx::lit("320");

fn show() {
    // Of asset, buffers and orbit the compiler knows nothing.
    let asset: &[u8] = black_box(&[]);
    let (colour, shades): (&mut [u16], &mut [u16]) = (black_box(&mut []), black_box(&mut []));
    let canvas: &mut [u32] = black_box(&mut []);
    let orbit = Orbit {
        yaw: black_box(Turns::ZERO),
        pitch: black_box(Turns::ZERO),
        distance: black_box(Length::ZERO),
    };
    let camera = Camera::orbit(&orbit, FOCAL, 240, 320);
    let target = Target::new(240, 320, colour, canvas);
    if let (Ok(grid), Ok(mut target)) = (Grid::open(asset), target) {
        draw(
            &grid,
            &camera,
            &LIGHT,
            &Quality::default(),
            shades,
            &mut target,
        );
    }
}
