//! Bytes in host memory that start where the core wants them.

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

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }
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
