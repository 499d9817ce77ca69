//! A figure of a report and what it is a figure of: one line of `data.csv`.

use std::io;

use rhogrid_core::asset::Shell;
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::SplatPx;

use crate::bake::{GridOptions, Normals};

/// What a figure tells about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// An asset's bytes.
    File,
    /// Frames of the core.
    Core,
    /// The samples of the core's frames in float, at their cells' centres.
    Centres,
    /// The same at the surface's points nearest to the centres.
    Points,
    /// The mesh, drawn by the reference with one sample a pixel, RGB565.
    Mesh,
    /// The same with eight bits a channel.
    MeshTrueColour,
    /// The supersampled reference itself, in RGB565.
    Rgb565,
}

impl Subject {
    /// Its name in `data.csv`.
    pub fn name(self) -> &'static str {
        match self {
            Self::File => "file",
            Self::Core => "core",
            Self::Centres => "float, cell centres",
            Self::Points => "float, surface points",
            Self::Mesh => "mesh, 1 sample a pixel, RGB565",
            Self::MeshTrueColour => "mesh, 1 sample a pixel",
            Self::Rgb565 => "reference in RGB565",
        }
    }
}

/// How an asset was baked and drawn, as far as it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// What the figure tells about.
    pub subject: Subject,
    /// How it was baked.
    pub bake: Option<GridOptions>,
    /// Bits of a sample's attribute, where they are no longer the file's.
    pub attribute_bits: Option<u8>,
    /// How it was drawn.
    pub quality: Option<Quality>,
}

impl Setting {
    /// A subject without any options.
    pub fn of(subject: Subject) -> Self {
        Self {
            subject,
            bake: None,
            attribute_bits: None,
            quality: None,
        }
    }

    /// An asset's file.
    pub fn file(bake: GridOptions) -> Self {
        Self {
            bake: Some(bake),
            ..Self::of(Subject::File)
        }
    }

    /// Frames of an asset.
    pub fn drawn(subject: Subject, bake: GridOptions, quality: Quality) -> Self {
        Self {
            bake: Some(bake),
            quality: Some(quality),
            ..Self::of(subject)
        }
    }

    fn path(&self) -> &'static str {
        self.quality.map_or("", |quality| path_name(&quality))
    }
}

/// One figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Which chapter asks for it.
    pub chapter: &'static str,
    /// The model's name.
    pub model: String,
    /// Standard view, the mean of whose four yaws it is; empty where nothing is
    /// drawn.
    pub view: &'static str,
    /// What it is a figure of.
    pub setting: Setting,
    /// What is measured.
    pub measure: &'static str,
    /// The figure.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What the paper has for it.
    pub paper: Option<f64>,
}

/// The first line of `data.csv`.
const COLUMNS: [&str; 15] = [
    "chapter",
    "model",
    "view",
    "subject",
    "rho",
    "level",
    "shell",
    "normals",
    "attribute_bits",
    "path",
    "splat",
    "measure",
    "value",
    "unit",
    "paper",
];

impl Row {
    fn fields(&self) -> [String; COLUMNS.len()] {
        let Setting {
            subject,
            bake,
            attribute_bits,
            quality,
        } = self.setting;
        [
            self.chapter.into(),
            self.model.clone(),
            self.view.into(),
            subject.name().into(),
            or_empty(bake.map(|bake| bake.rho)),
            or_empty(bake.map(|bake| bake.level)),
            or_empty(bake.map(|bake| shell_name(bake.shell))),
            or_empty(bake.map(|bake| normals_name(bake.normals))),
            or_empty(attribute_bits),
            self.setting.path().into(),
            or_empty(quality.map(|quality| splat_of(&quality))),
            self.measure.into(),
            self.value.to_string(),
            self.unit.into(),
            or_empty(self.paper),
        ]
    }
}

fn or_empty(value: Option<impl ToString>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

/// A shell's name on the command line.
pub fn shell_name(shell: Shell) -> &'static str {
    match shell {
        Shell::Fat => "fat",
        Shell::Thin => "thin",
    }
}

/// A choice of normals' name on the command line.
pub fn normals_name(normals: Normals) -> &'static str {
    match normals {
        Normals::Filtered => "filtered",
        Normals::Nearest => "nearest",
    }
}

/// How a quality projects, as the command line calls it.
pub fn path_name(quality: &Quality) -> &'static str {
    match quality.distortion == SplatPx::ZERO {
        true => "exact",
        false => "auto",
    }
}

/// The splat size in pixels, as it was asked for: four decimals tell apart
/// what Q16 does.
pub fn splat_of(quality: &Quality) -> f64 {
    (quality.splat.to_num::<f64>() * 1e4).round() / 1e4
}

/// Writes rows as CSV.
///
/// # Errors
/// Whatever `out` returns.
pub fn write_csv(rows: &[Row], out: &mut dyn io::Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(COLUMNS)?;
    for row in rows {
        writer.write_record(row.fields())?;
    }
    writer.flush()
}
