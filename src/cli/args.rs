//! Options that several commands share.

mod quality;
mod source;
mod view;

use std::str::FromStr;

use glam::DVec3;

pub use quality::{CullingChoice, QualityArgs, RepairChoice, ShadowChoice};
pub use source::SourceArgs;
pub use view::ViewArgs;

/// Three numbers, `X,Y,Z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple(pub DVec3);

impl FromStr for Triple {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .filter_map(|part| part.trim().parse().ok())
            .collect();
        match numbers[..] {
            [x, y, z] if text.split(',').count() == 3 && DVec3::new(x, y, z).is_finite() => {
                Ok(Self(DVec3::new(x, y, z)))
            }
            _ => Err("give three numbers, X,Y,Z".into()),
        }
    }
}

/// Width and height in pixels, `WxH`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns, 1 to 4096.
    pub width: u16,
    /// Rows, 1 to 4096.
    pub height: u16,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |part: &str| {
            part.parse::<u16>()
                .ok()
                .filter(|side| (1..=4096).contains(side))
        };
        let parts = text.split_once('x').map(|(w, h)| (side(w), side(h)));
        match parts {
            Some((Some(width), Some(height))) => Ok(Self { width, height }),
            _ => Err("give WxH, each 1 to 4096, as in 240x320".into()),
        }
    }
}
