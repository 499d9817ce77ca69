//! What the tests share: seeded random views with their exact twins, and
//! small assets built by hand. Float and heap live here only.

#[cfg(feature = "rho-3")]
pub(crate) mod coded;
pub(crate) mod model;
pub(crate) mod view;

#[cfg(feature = "rho-3")]
pub(crate) use coded::Coder;
pub(crate) use fastrand::Rng;
pub(crate) use model::{File, Model, aligned};
pub(crate) use view::{Exact, camera, direction, dot};
