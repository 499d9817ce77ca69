//! Assets in host memory, aligned as the core asks for.

use std::fs;
use std::path::Path;

use rhogrid::error::Error;
use rhogrid_core::asset::Grid;

/// Bytes that start at a multiple of four.
#[derive(Clone, Debug)]
pub struct AlignedBytes {
    words: Vec<u32>,
    length: usize,
}

impl AlignedBytes {
    /// A copy of the bytes.
    pub fn new(bytes: &[u8]) -> Self {
        let mut words = vec![0; bytes.len().div_ceil(4)];
        bytemuck::cast_slice_mut(&mut words)[..bytes.len()].copy_from_slice(bytes);
        Self {
            words,
            length: bytes.len(),
        }
    }

    /// The content of a file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(file: &Path) -> Result<Self, Error> {
        let bytes = fs::read(file)
            .map_err(|error| Error::file(file, error.to_string(), "name an asset file"))?;
        Ok(Self::new(&bytes))
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }
}

/// Opens the asset that `file` holds.
///
/// # Errors
/// When the core refuses it.
pub fn open<'a>(file: &Path, bytes: &'a AlignedBytes) -> Result<Grid<'a>, Error> {
    Grid::open(bytes.bytes()).map_err(|error| {
        Error::file(
            file,
            format!("not a usable asset: {error:?}"),
            "bake it with `rhogrid bake`",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_keeps_its_bytes_and_alignment() {
        let bytes: Vec<u8> = (0..100).collect();
        for length in 0..bytes.len() {
            let aligned = AlignedBytes::new(&bytes[..length]);
            assert_eq!(aligned.bytes(), &bytes[..length]);
            assert_eq!(aligned.bytes().as_ptr().addr() % 4, 0);
        }
    }
}
