//! The header's own fields and the materials, checked.

use super::coded::Codings;
use super::section::{u8_at, u32_at};
use super::{
    AssetError, Grid, KIND_GRID, Level, MAX_LEVELS, MAX_MATERIALS, Shell, is_built, max_depth,
};
use crate::numbers::Length;

impl Grid<'_> {
    /// The header's own fields, checked.
    pub(super) fn header(bytes: &[u8]) -> Result<Self, AssetError> {
        let field = |offset: usize| {
            u8_at(bytes, offset).ok_or(AssetError::Truncated {
                length: bytes.len() as u32,
            })
        };
        let kind = field(8)?;
        if kind != KIND_GRID {
            return Err(AssetError::Kind { kind });
        }
        let (rho, depth) = (field(9)?, field(10)?);
        if !(2..=5).contains(&rho) {
            return Err(AssetError::Rho { rho });
        }
        if !is_built(rho) {
            let feature = ["rho-2", "rho-3", "rho-4", "rho-5"];
            return Err(AssetError::LeftOut {
                offset: 9,
                feature: feature[usize::from(rho - 2) % feature.len()],
            });
        }
        if depth > max_depth(rho) {
            return Err(AssetError::Depth { depth });
        }
        let attribute_bits = field(11)?;
        match attribute_bits {
            16 => {}
            32 | 48 if cfg!(feature = "colour") => {}
            32 | 48 => {
                return Err(AssetError::LeftOut {
                    offset: 11,
                    feature: "colour",
                });
            }
            _ => return Err(AssetError::Field { offset: 11 }),
        }
        let shell = match field(12)? {
            0 => Shell::Fat,
            1 => Shell::Thin,
            _ => return Err(AssetError::Field { offset: 12 }),
        };
        if field(13)? > 2 {
            return Err(AssetError::Field { offset: 13 });
        }
        let flags = field(14)?;
        if flags > 1 {
            return Err(AssetError::Field { offset: 14 });
        }
        let extents = u32_at(bytes, 20).unwrap_or(0);
        if extents >> 30 != 0 {
            return Err(AssetError::Field { offset: 20 });
        }
        if u32_at(bytes, 56) != Some(0) {
            return Err(AssetError::Field { offset: 56 });
        }
        let radius = u32_at(bytes, 16).unwrap_or(0);
        // Between a touching sphere and the cube's corner, rounding included.
        if !(1..=2 << 28).contains(&radius) {
            return Err(AssetError::Field { offset: 16 });
        }
        Ok(Self {
            rho,
            depth: 0,
            stored_depth: depth,
            shell,
            two_sided: flags & 1 != 0,
            attribute_bits,
            radius: Length::from_bits(i64::from(radius) << 4),
            extents: match extents {
                0 => [Length::ONE; 3],
                _ => [0, 10, 20].map(|shift| extent(extents >> shift & 1023)),
            },
            materials: [[255; 3]; MAX_MATERIALS],
            material_count: 1,
            dictionary: None,
            levels: [Level::EMPTY; MAX_LEVELS],
            codings: Codings::EMPTY,
        })
    }

    /// A count, and as many colours.
    pub(super) fn read_materials(&mut self, bytes: &[u8], offset: u32) -> Result<(), AssetError> {
        let error = AssetError::Materials { offset };
        let count = u32_at(bytes, 0).ok_or(error)?;
        if !(1..=MAX_MATERIALS as u32).contains(&count) || bytes.len() != 4 + 4 * count as usize {
            return Err(error);
        }
        for (material, word) in self.materials.iter_mut().zip(bytes.chunks_exact(4).skip(1)) {
            match *word {
                [red, green, blue, 0] => *material = [red, green, blue],
                _ => return Err(error),
            }
        }
        self.material_count = count as u8;
        Ok(())
    }
}

/// A 1023rd part of the half side so many times, rounded up.
fn extent(parts: u32) -> Length {
    // 1 / 1023 = 2^-10 + 2^-20 + 2^-30 + ...
    let parts = i64::from(parts);
    Length::from_bits((parts << 22) + (parts << 12) + (parts << 2) + 4)
}
