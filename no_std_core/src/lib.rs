//! Rhogrid's core: integers only, no heap, no FPU, no statics.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod asset;
pub mod camera;
pub mod draw;
pub mod numbers;
pub mod stats;
pub mod target;
pub mod trig;
