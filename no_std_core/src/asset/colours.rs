//! Colours that samples have of their own.

use super::level::split_halves;
use super::{AssetError, Rgb};

/// The colours of a level's samples.
#[derive(Clone, Copy, Debug)]
pub enum Colours<'a> {
    /// None: their materials' are theirs.
    None,
    /// Of 32-bit attributes: red << 11 | green << 5 | blue.
    Rgb565(&'a [u16]),
    /// Of 48-bit attributes: red | green << 8 | blue << 16.
    Rgb888(&'a [u32]),
}

impl<'a> Colours<'a> {
    /// Takes the colours of so many samples with attributes of 16, 32 or 48
    /// bits.
    pub(super) fn split(
        bytes: &'a [u8],
        attribute_bits: u8,
        samples: usize,
    ) -> Option<(Self, &'a [u8])> {
        match attribute_bits {
            32 => {
                let (words, rest) = split_halves(bytes, samples)?;
                Some((Self::Rgb565(words), rest))
            }
            48 => {
                let (words, rest) = bytes.split_at_checked(samples.checked_mul(4)?)?;
                Some((Self::Rgb888(bytemuck::try_cast_slice(words).ok()?), rest))
            }
            _ => Some((Self::None, bytes)),
        }
    }

    /// The uppermost byte of a word is zero.
    pub(super) fn check(&self, depth: u8) -> Result<(), AssetError> {
        let Self::Rgb888(words) = self else {
            return Ok(());
        };
        match words.iter().position(|word| word >> 24 != 0) {
            None => Ok(()),
            Some(index) => Err(AssetError::Colour {
                depth,
                index: index as u32,
            }),
        }
    }

    /// A sample's colour, if it has one.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Option<Rgb> {
        match self {
            Self::None => None,
            Self::Rgb565(words) => words.get(index).map(|&word| expanded(word)),
            Self::Rgb888(words) => {
                let [red, green, blue, _] = words.get(index)?.to_le_bytes();
                Some([red, green, blue])
            }
        }
    }
}

/// The nearest of eight bits, which full five or six bits make full.
pub(crate) fn expanded(colour: u16) -> Rgb {
    let [red, green, blue] = [colour >> 11, colour >> 5 & 63, colour & 31];
    [
        (red << 3 | red >> 2) as u8,
        (green << 2 | green >> 4) as u8,
        (blue << 3 | blue >> 2) as u8,
    ]
}
