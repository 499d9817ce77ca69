//! The host side of Rhogrid: import, bake, reference, measures.
//!
//! ```text
//! file -> import -> Geometry -> bake -> .rho bytes -> rhogrid-core -> frame
//!                      |                                                |
//!                      +-----------> reference ----------> measure <----+
//! ```

pub mod asset_file;
pub mod bake;
pub mod cli;
pub mod error;
pub mod geometry;
pub mod import;
pub mod measure;
mod nearest;
pub mod output;
pub mod picture;
pub mod reference;
pub mod report;
pub mod scene;
pub mod view;
