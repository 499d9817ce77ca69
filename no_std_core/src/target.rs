//! The caller's frame: colour and depth words, or a band of them.
//!
//! Drawing is infallible: what lies outside the band is discarded. Sizes are
//! checked once, here.

use crc::{CRC_32_ISO_HDLC, Crc, Table};

/// A rectangle of pixels, right and bottom exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// First column.
    pub left: u16,
    /// First row.
    pub top: u16,
    /// Column behind the last.
    pub right: u16,
    /// Row behind the last.
    pub bottom: u16,
}

impl Rect {
    /// Columns.
    pub const fn width(&self) -> usize {
        self.right.saturating_sub(self.left) as usize
    }

    /// Rows.
    pub const fn height(&self) -> usize {
        self.bottom.saturating_sub(self.top) as usize
    }

    /// Pixels, which is also the length of the colour and depth buffers.
    pub const fn pixels(&self) -> usize {
        self.width() * self.height()
    }
}

/// Why buffers do not make a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetError {
    /// The colour buffer's length is not the rectangle's pixel count.
    ColourLength,
    /// The depth buffer's length is not the rectangle's pixel count.
    DepthLength,
    /// The rectangle is empty or reaches beyond column or row 4096.
    Size,
}

/// Largest picture width and height.
pub const MAX_SIZE: u16 = 4096;

/// The band of a picture that is drawn: RGB565 colours and 16-bit depths,
/// row-major without padding.
///
/// Depth is larger where nearer, zero where nothing is drawn; see
/// [`crate::projection`] for its scale.
pub struct Target<'a> {
    pub(crate) band: Rect,
    pub(crate) colour: &'a mut [u16],
    pub(crate) depth: &'a mut [u16],
}

impl<'a> Target<'a> {
    /// A target for the whole picture. Both buffers hold `width * height`
    /// words.
    ///
    /// # Errors
    /// When a length or the size does not fit.
    pub fn new(
        width: u16,
        height: u16,
        colour: &'a mut [u16],
        depth: &'a mut [u16],
    ) -> Result<Self, TargetError> {
        let band = Rect {
            left: 0,
            top: 0,
            right: width,
            bottom: height,
        };
        Self::band(band, colour, depth)
    }

    /// A target for a part of the picture: the same pixels that the whole
    /// picture would have there. Both buffers hold `band.pixels()` words.
    ///
    /// # Errors
    /// When a length or the size does not fit.
    pub fn band(
        band: Rect,
        colour: &'a mut [u16],
        depth: &'a mut [u16],
    ) -> Result<Self, TargetError> {
        if band.pixels() == 0 || band.right > MAX_SIZE || band.bottom > MAX_SIZE {
            return Err(TargetError::Size);
        }
        if colour.len() != band.pixels() {
            return Err(TargetError::ColourLength);
        }
        if depth.len() != band.pixels() {
            return Err(TargetError::DepthLength);
        }
        Ok(Self {
            band,
            colour,
            depth,
        })
    }

    /// Black, and nothing drawn.
    pub(crate) fn clear(&mut self) {
        self.colour.fill(0);
        self.depth.fill(0);
    }
}

/// CRC-32/ISO-HDLC of pixels as little-endian bytes, row-major: how equal
/// pictures are recognised across machines. Shown as eight lower-case hex
/// digits.
pub fn frame_hash(colour: &[u16]) -> u32 {
    let crc = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);
    let mut digest = crc.digest();
    for pixel in colour {
        digest.update(&pixel.to_le_bytes());
    }
    digest.finalize()
}
