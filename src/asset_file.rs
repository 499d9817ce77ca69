//! A `.rho` file in memory, aligned for the core, with what only tools read
//! of its header.

use std::path::Path;

use glam::DVec3;
use rhogrid_core::asset::{AssetError, Grid};

use crate::bake::Cube;
use crate::error::{Error, Place};
use crate::geometry::Up;

/// Bytes of an asset that the core accepts.
#[derive(Clone, Debug)]
pub struct AssetFile {
    /// Keeps the bytes at a multiple of four.
    words: Vec<u32>,
    length: usize,
    cube: Cube,
    up: Up,
}

impl AssetFile {
    /// Takes bytes and checks them.
    ///
    /// # Errors
    /// What [`Grid::open`] finds.
    pub fn new(bytes: &[u8]) -> Result<Self, AssetError> {
        let mut words = vec![0u32; bytes.len().div_ceil(4)];
        bytemuck::cast_slice_mut(&mut words)[..bytes.len()].copy_from_slice(bytes);
        let mut file = Self {
            words,
            length: bytes.len(),
            cube: Cube {
                centre: DVec3::ZERO,
                extents: DVec3::ONE,
                half_side: 1.0,
                radius: 1.0,
            },
            up: Up::Y,
        };
        let grid = Grid::open(file.bytes())?;
        let radius = grid.radius().to_num::<f64>();
        let extents = grid.extents().map(|extent| extent.to_num::<f64>());
        let [x, y, z, half_side] = [24, 32, 40, 48].map(|offset| double(bytes, offset));
        file.cube = Cube {
            centre: DVec3::new(x, y, z),
            extents: DVec3::from(extents) * half_side,
            half_side,
            radius: radius * half_side,
        };
        file.up = match bytes.get(13) {
            Some(0) => Up::X,
            Some(2) => Up::Z,
            _ => Up::Y,
        };
        let is_usable = file.cube.centre.is_finite() && half_side.is_normal() && half_side > 0.0;
        if is_usable {
            Ok(file)
        } else {
            Err(AssetError::Field { offset: 24 })
        }
    }

    /// Reads and checks a file.
    ///
    /// # Errors
    /// When it cannot be read or is not an asset.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let bytes = std::fs::read(path).map_err(|error| {
            Error::file(path, format!("cannot be read: {error}"), "check the name")
        })?;
        Self::new(&bytes).map_err(|error| Error::at(path, Place::Whole, error.to_string(), ""))
    }

    /// The file's bytes, at a multiple of four.
    pub fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }

    /// The asset.
    pub fn grid(&self) -> Grid<'_> {
        Grid::open(self.bytes()).expect("checked when made")
    }

    /// Where the asset lies in its source.
    pub fn cube(&self) -> Cube {
        self.cube
    }

    /// Which source axis points up.
    pub fn up(&self) -> Up {
        self.up
    }
}

fn double(bytes: &[u8], offset: usize) -> f64 {
    let word = bytes
        .get(offset..offset + 8)
        .and_then(|word| word.try_into().ok());
    word.map_or(f64::NAN, f64::from_le_bytes)
}
