//! The first stage: a model file becomes [`Geometry`], or an [`Error`] that
//! names file, place and remedy.
//!
//! ```text
//! OBJ text  -> obj::scan -> tobj -+
//!                                 +-> Polygons -> polygon, normals, materials -> Mesh
//! PLY bytes -> ply::header, body -+
//!                                 +-> Cloud, normals estimated where absent
//! ```
//!
//! No input makes a reader panic, and no input loads silently empty. Equal
//! bytes give equal geometry on every machine: only correctly rounded
//! operations are used.

mod estimate;
mod materials;
mod normals;
mod obj;
mod ply;
mod polygon;
pub mod procedural;
mod surface;

pub use materials::MAX_MATERIALS;
pub use normals::CREASE_COSINE;

use std::path::Path;

use glam::DVec3;

use crate::error::Error;
use crate::geometry::Geometry;

/// What the readers understand, for messages.
const READABLE: &str = "Wavefront OBJ (.obj) and PLY (.ply, ascii or binary) can be read";

/// A loaded model and what deserves a warning about it.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The model; finite, of non-zero extent, with unit normals.
    pub geometry: Geometry,
    /// Warnings, each one line without its file name: what was missing,
    /// merged or left unused.
    pub notes: Vec<String>,
}

/// Loads a model file, and the MTL files it names.
///
/// Positions are `f64`; a mesh's of equal bits become one, and those that no
/// face uses are dropped. Polygons are cut into triangles. Normals come from
/// the file, or else from the faces around a position within
/// [`CREASE_COSINE`]. A file without faces is a cloud; where it has no normals
/// they are estimated, and it is two-sided if they tell no outside. Colours come from the diffuse colour of materials
/// ([`MAX_MATERIALS`] at most); textures and vertex colours are not used.
///
/// # Errors
///
/// Everything that cannot be drawn, with its line (text) or byte (binary).
///
/// ```no_run
/// let imported = rhogrid::import::load("bunny.ply".as_ref())?;
/// for note in &imported.notes {
///     eprintln!("bunny.ply: {note}");
/// }
/// # Ok::<(), rhogrid::error::Error>(())
/// ```
pub fn load(path: &Path) -> Result<Imported, Error> {
    let bytes = std::fs::read(path).map_err(|error| {
        Error::file(
            path,
            format!("cannot be read: {error}"),
            "check the path and its permissions",
        )
    })?;
    parse(path, &bytes)
}

/// Reads a model from memory, as [`load`] does. `path` gives the file's name
/// in messages, its extension, and the folder of its MTL files.
///
/// # Errors
///
/// As [`load`].
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Imported, Error> {
    if bytes.is_empty() {
        return Err(Error::file(path, "the file is empty", READABLE));
    }
    let extension = path
        .extension()
        .map(|extension| extension.to_ascii_lowercase());
    match extension.as_ref().and_then(|extension| extension.to_str()) {
        _ if ply::has_magic(bytes) => ply::read(path, bytes),
        Some("ply") => ply::read(path, bytes),
        Some("obj") => obj::read(path, bytes),
        _ => Err(Error::file(path, "is of an unknown kind", READABLE)),
    }
}

/// A word of a file as messages show it: short, on one line.
fn shown(word: &str) -> String {
    word.chars().take(40).flat_map(char::escape_debug).collect()
}

/// Finite and within the range of `f32`, so that products of four
/// coordinates stay finite in `f64`.
fn in_range(value: f64) -> bool {
    value.abs() <= f64::from(f32::MAX)
}

/// The unit vector along `vector`; `None` where that has no meaning.
fn unit(vector: DVec3) -> Option<DVec3> {
    // Scaled by the largest component first: neither tiny nor huge vectors
    // leave the range when squared.
    let largest = vector.abs().max_element();
    if largest > 0.0 && largest.is_finite() {
        Some((vector / largest).normalize()).filter(|unit| unit.is_finite())
    } else {
        None
    }
}
