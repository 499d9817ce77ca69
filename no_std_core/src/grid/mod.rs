//! Drawing a rho-grid: displacement tables and traversal.
//!
//! Source: Duguet and Drettakis 2003, 5.1 and 5.2. Changes here: centres are
//! integers in block fixed point; every level's table is rounded from the
//! exact basis (the paper divides the table above); nodes whose surfaces all
//! face away, or that are hidden by what is drawn, are skipped with their
//! subtrees.

mod affine;
mod blocks;
mod both;
mod cast;
mod children;
mod clip;
mod facing;
mod footprint;
mod hidden;
mod leaves;
mod mask;
mod normals;
mod octave;
mod packed;
mod record;
mod samples;
mod siblings;
mod subtree;
mod tables;
mod traverse;

pub(crate) use both::traverse_and_cast;
pub(crate) use cast::cast;
pub(crate) use traverse::traverse;
