//! What the tests share: seeded random views with their exact twins, and
//! small assets built by hand. Float and heap live here only.

pub(crate) mod model;
pub(crate) mod view;

pub(crate) use fastrand::Rng;
pub(crate) use model::{File, Model, aligned};
pub(crate) use view::{Exact, camera, direction, dot};
