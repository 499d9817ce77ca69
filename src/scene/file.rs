//! SCENE.toml as it is written.

use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use crate::error::{Error, Place};
use crate::geometry::Up;

/// A scene file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Weight of the ambient light; without one 0.2, or 1 with a matcap.
    pub ambient: Option<f64>,
    /// A picture of a lit sphere, which ambient light is taken from.
    pub matcap: Option<Spanned<PathBuf>>,
    /// What stands where.
    #[serde(default)]
    pub instance: Vec<Spanned<InstanceTable>>,
    /// The lights; none given is one from (1, 2, 1.5), or none with a matcap.
    #[serde(default)]
    pub light: Vec<Spanned<LightTable>>,
    /// A plane that everything stands on.
    pub ground: Option<Spanned<GroundTable>>,
}

/// A placed model.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct InstanceTable {
    /// Asset, mesh or cloud, or a built-in model.
    pub model: String,
    /// How it is baked; as the options of the same names.
    pub level: Option<u8>,
    /// See `level`.
    pub rho: Option<u8>,
    /// See `level`.
    pub shell: Option<ShellName>,
    /// See `level`.
    pub up: Option<UpName>,
    /// See `level`.
    #[serde(default)]
    pub two_sided: bool,
    /// Where the middle of its box comes to lie, or of its box's bottom.
    #[serde(default)]
    pub position: [f64; 3],
    /// Whether `position` is of its bottom.
    #[serde(default)]
    pub stand: bool,
    /// Yaw, pitch and roll in degrees: first around z, then x, then y.
    #[serde(default)]
    pub rotation: [f64; 3],
    /// World units in a source unit, for all axes or for each.
    pub scale: Option<Scale>,
    /// Its radius in world units, instead of `scale`.
    pub size: Option<f64>,
    /// Colours that take the place of its materials'.
    #[serde(default)]
    pub materials: Vec<[u8; 3]>,
}

/// One factor, or one for each axis.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub enum Scale {
    /// For all axes.
    Even(f64),
    /// For x, y and z of the source, y up.
    Uneven([f64; 3]),
}

/// See [`rhogrid_core::asset::Shell`].
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShellName {
    /// Every cell that the surface touches.
    Fat,
    /// A separating subset.
    Thin,
}

/// See [`Up`].
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpName {
    /// +x is up.
    X,
    /// +y is up.
    Y,
    /// +z is up.
    Z,
}

impl From<UpName> for Up {
    fn from(name: UpName) -> Self {
        match name {
            UpName::X => Self::X,
            UpName::Y => Self::Y,
            UpName::Z => Self::Z,
        }
    }
}

/// A directional light.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightTable {
    /// World direction towards it.
    pub towards: [f64; 3],
    /// Its colour.
    #[serde(default = "white")]
    pub colour: [u8; 3],
    /// Diffuse weight.
    #[serde(default = "intensity")]
    pub intensity: f64,
    /// Whether it casts shadows.
    #[serde(default = "casts")]
    pub shadows: bool,
}

/// A square of the plane y = const around the y axis.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroundTable {
    /// Height.
    #[serde(default)]
    pub y: f64,
    /// Half its side.
    pub size: f64,
    /// Its colour.
    #[serde(default = "white")]
    pub colour: [u8; 3],
    /// How finely it is sampled.
    pub level: Option<u8>,
}

fn white() -> [u8; 3] {
    [255; 3]
}

fn intensity() -> f64 {
    0.8
}

fn casts() -> bool {
    true
}

/// A scene file's text, for errors.
pub struct Source<'a> {
    file: &'a Path,
    text: &'a str,
}

impl<'a> Source<'a> {
    /// Of a file's text.
    pub fn new(file: &'a Path, text: &'a str) -> Self {
        Self { file, text }
    }

    /// Reads it.
    ///
    /// # Errors
    /// When it is no TOML, or holds what no scene has.
    pub fn parse(&self) -> Result<SceneFile, Error> {
        toml::from_str(self.text).map_err(|error| {
            let what = error.message().replace('\n', ", ");
            let span = error.span().unwrap_or(0..0);
            self.error(span, what, "README says what a scene file holds")
        })
    }

    /// An error at a span of the text.
    pub fn error(&self, span: Range<usize>, what: impl Into<String>, remedy: &str) -> Error {
        let before = self.text.get(..span.start).unwrap_or("");
        let line = before.matches('\n').count() + 1;
        Error::at(self.file, Place::Line(line), what, remedy)
    }
}
