//! Rhogrid's core: recursive point grids drawn straight from flash into the
//! caller's framebuffer, with integers only.
//!
//! No heap, no float, no statics but constant tables, no panic: buffers are
//! the caller's, everything that can be wrong is found when an asset is
//! opened or a target is made, and drawing cannot fail.
//!
//! # Conventions
//!
//! * **Model space** is right-handed, y up. The grid's cube spans [-1, 1] on
//!   every axis; lengths are in half sides of that cube.
//! * **Pictures** are row-major, x to the right, y down; pixel centres lie at
//!   half-integers, the principal point in the middle.
//! * **w** is the distance along the viewing direction; **depth** is 16 bits,
//!   larger is nearer, zero is empty.
//! * **Coverage**: a point owns the pixel that holds its centre; a splat also
//!   those whose centres lie in [low, high) of its rectangle. Of two equal
//!   depths the larger attribute stays among points, else the first drawn.
//! * **Faces** are counter-clockwise from their front; normals point outward
//!   and surfaces are one-sided unless the asset says otherwise.
//! * **Colours** are RGB565, native words, no gamma: a sample's own, where
//!   it has one, else its material's. **Angles** are turns.
//! * **Cells** are ordered x fastest, then y, then z; *level* k has rho^(k +
//!   1) cells on an axis and consists of the cells of *depth* k + 1.
//!
//! # A frame
//!
//! ```text
//! asset       bytes in flash -> checked, zero-copy views
//! camera      eye, directions, focal length
//! projection  block fixed point: X, Y, w as linear forms; reciprocal
//! plan        from which distance on which cells are small enough; what is left out
//! grid        tables, culling, traversal; packed subtrees  -> samples
//! splat       cells larger than a pixel -> pixels
//! canvas      depth << 16 | attribute, a strip at a time; depth test
//! shade       normal codes x materials -> colours, once a frame
//! resolve     canvas -> colours; holes are closed
//! target      the caller's colours, or a band of them, and the canvas
//! stats       what was visited, drawn, skipped
//! ```
//!
//! # Example
//!
//! ```
//! use rhogrid_core::asset::{AssetError, Grid};
//! use rhogrid_core::camera::{Camera, Orbit};
//! use rhogrid_core::draw::{Light, Quality, draw, shades_len};
//! use rhogrid_core::numbers::{FocalPx, Length, Turns, Unit, Weight};
//! use rhogrid_core::target::Target;
//!
//! // Constants: at run time, a decimal's parser would be linked, too.
//! const LIGHT: Light = Light {
//!     towards: [Unit::lit("0.6"), Unit::lit("0.8"), Unit::ZERO],
//!     ambient: Weight::lit("0.2"),
//!     diffuse: Weight::lit("0.8"),
//! };
//! const FOCAL: FocalPx = FocalPx::lit("320");
//! const DISTANCE: Length = Length::lit("2.6");
//!
//! fn show(asset: &[u8], colour: &mut [u16], canvas: &mut [u32]) -> Result<(), AssetError> {
//!     let grid = Grid::open(asset)?;
//!     let orbit = Orbit {
//!         yaw: Turns::from_bits(1 << 29),
//!         pitch: Turns::from_bits(1 << 27),
//!         distance: grid.radius() * DISTANCE,
//!     };
//!     let camera = Camera::orbit(&orbit, FOCAL, 240, 320);
//!     let mut shades = [0; shades_len(1)];
//!     if let Ok(mut target) = Target::new(240, 320, colour, canvas) {
//!         draw(&grid, &camera, &LIGHT, &Quality::default(), &mut shades, &mut target);
//!     }
//!     Ok(())
//! }
//! assert_eq!(show(b"RHOX", &mut [], &mut []), Err(AssetError::Magic));
//! ```
#![no_std]

#[cfg(test)]
extern crate std;

pub mod asset;
pub mod camera;
mod canvas;
mod divisor;
pub mod draw;
mod grid;
pub mod normal;
pub mod numbers;
pub mod placement;
pub mod plan;
pub mod projection;
pub mod reciprocal;
mod resolve;
pub mod scene;
mod shade;
pub mod shadow;
mod splat;
pub mod stats;
pub mod target;
#[cfg(test)]
mod testing;
pub mod trig;
