//! Lights from their tables.

use std::path::{Path, PathBuf};

use glam::DVec3;
use rhogrid_core::scene::{MAX_LAMPS, Matcap as CoreMatcap};
use toml::Spanned;

use super::build::Wrong;
use super::file::{LightTable, SceneFile, Source};
use crate::error::Error;
use crate::picture::{Picture, rgb565};
use crate::view::{Lamp, Lighting, Matcap};

/// Ambient weight without a matcap, unless a file says otherwise.
const AMBIENT: f64 = 0.2;

/// The lights of a scene file.
///
/// # Errors
/// When one cannot be, there are too many, or the matcap cannot be read.
pub fn lighting(file: &Path, content: &SceneFile, source: &Source<'_>) -> Result<Lighting, Error> {
    let mut lamps = Vec::new();
    for table in &content.light {
        let lamp = lamp(table.get_ref()).map_err(|wrong| wrong.at(source, table.span()))?;
        lamps.push(lamp);
    }
    let matcap = match &content.matcap {
        None => None,
        Some(name) => Some(read_matcap(file, name, source)?),
    };
    if lamps.is_empty() && matcap.is_none() {
        lamps.push(default_lamp());
    }
    if lamps.len() > MAX_LAMPS {
        let span = content.light[MAX_LAMPS].span();
        return Err(source.error(span, "there are more than three lights", "leave some out"));
    }
    let unless_said = if matcap.is_some() { 1.0 } else { AMBIENT };
    let ambient = content.ambient.unwrap_or(unless_said);
    if !(0.0..=1.0).contains(&ambient) {
        return Err(source.error(0..0, "ambient is not between 0 and 1", "give a weight"));
    }
    Ok(Lighting {
        ambient,
        matcap,
        lamps,
    })
}

/// Reads a picture of a lit sphere, relative to the scene's file.
fn read_matcap(file: &Path, name: &Spanned<PathBuf>, source: &Source<'_>) -> Result<Matcap, Error> {
    let path = file.parent().unwrap_or(Path::new("")).join(name.get_ref());
    let picture = Picture::load(&path)?;
    let colours = picture
        .rgb
        .iter()
        .map(|colour| rgb565(colour.map(f64::from)));
    let matcap = Matcap {
        texels: colours.collect(),
    };
    let is_square = picture.width == picture.height;
    match CoreMatcap::new(&matcap.texels) {
        Some(_) if is_square => Ok(matcap),
        _ => {
            let what = format!("a matcap of {} by {} pixels", picture.width, picture.height);
            let remedy = "give a square of at most 1024 pixels a side";
            Err(source.error(name.span(), what, remedy))
        }
    }
}

fn lamp(table: &LightTable) -> Result<Lamp, Wrong> {
    let towards = DVec3::from(table.towards).try_normalize();
    let Some(towards) = towards.filter(|towards| towards.is_finite()) else {
        let what = "the light has no direction".into();
        return Err(Wrong::Here(what, "give towards other than 0, 0, 0"));
    };
    if !(0.0..=1.0).contains(&table.intensity) {
        let what = "intensity is not between 0 and 1".into();
        return Err(Wrong::Here(what, "give a weight"));
    }
    Ok(Lamp {
        towards,
        colour: table.colour,
        diffuse: table.intensity,
        casts: table.shadows,
    })
}

fn default_lamp() -> Lamp {
    Lamp {
        towards: DVec3::new(1.0, 2.0, 1.5).normalize(),
        colour: [255; 3],
        diffuse: 0.8,
        casts: true,
    }
}
