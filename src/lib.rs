//! The host side of Rhogrid: import, bake, reference, measures.
//!
//! ```text
//! file -> import -> Geometry -> bake -> .rho bytes -> rhogrid-core -> frame
//!                      |                                                |
//!                      +-----------> reference ----------> measure <----+
//! ```

pub mod bake;
pub mod error;
pub mod geometry;
pub mod measure;
pub mod output;
pub mod picture;
#[path = "import/procedural/mod.rs"]
pub mod procedural;
pub mod reference;
pub mod view;
