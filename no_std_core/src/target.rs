//! The caller's frame: colours, or a band of them, and the canvas.
//!
//! Drawing is infallible: what lies outside the band is discarded. Sizes are
//! checked once, here.

pub use crate::canvas::canvas_len;
use crate::canvas::{Pixel, STRIP_COLUMNS, canvas_rows, clear};
use core::ops::Range;

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

    /// What two rectangles share; without pixels, and within this one, if that
    /// is nothing.
    pub(crate) fn intersection(&self, other: Self) -> Self {
        let [left, right] = [other.left, other.right].map(|at| at.max(self.left).min(self.right));
        let [top, bottom] = [other.top, other.bottom].map(|at| at.max(self.top).min(self.bottom));
        Self {
            left,
            top,
            right,
            bottom,
        }
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
    /// The canvas is shorter than [`canvas_len`] of one row.
    CanvasLength,
    /// The rectangle is empty or reaches beyond column or row 4096.
    Size,
}

/// Largest picture width and height.
pub const MAX_SIZE: u16 = 4096;

/// The band of a picture that is drawn: RGB565 colours, row-major without
/// padding, and the canvas that samples are drawn on.
///
/// The canvas takes strips of up to 240 columns and as many rows as its
/// length allows; see [`canvas_len`]. A picture that is larger is drawn strip
/// by strip: a canvas for a few rows serves any picture, one for all rows
/// serves it at once.
pub struct Target<'a> {
    pub(crate) picture: Picture<'a>,
    pub(crate) canvas: &'a mut [u32],
}

/// A target with depths, into which one instance comes after the other.
pub struct Layers<'a> {
    target: Target<'a>,
}

impl<'a> Layers<'a> {
    /// Of a target that was given depths.
    ///
    /// # Errors
    /// Without depths.
    pub fn new(target: Target<'a>) -> Result<Self, TargetError> {
        match target.picture.depth {
            Some(_) => Ok(Self { target }),
            None => Err(TargetError::DepthLength),
        }
    }

    pub(crate) fn clear(&mut self) {
        let picture = &mut self.target.picture;
        blank(picture.colour);
        if let Some(depth) = &mut picture.depth {
            blank(depth);
        }
    }

    pub(crate) fn strips<P: Pixel>(&self) -> impl Iterator<Item = Rect> + use<P> {
        self.target.strips::<P>()
    }

    /// Words of the canvas.
    pub(crate) fn canvas_len(&self) -> usize {
        self.target.canvas.len()
    }

    /// The canvas, and what is drawn.
    pub(crate) fn parts(&mut self) -> (&mut [u32], &mut Picture<'a>) {
        (self.target.canvas, &mut self.target.picture)
    }
}

/// What a frame leaves behind.
pub(crate) struct Picture<'a> {
    band: Rect,
    colour: &'a mut [u16],
    depth: Option<&'a mut [u16]>,
}

impl<'a> Target<'a> {
    /// A target for the whole picture. The colours are `width * height`
    /// words, the canvas at least [`canvas_len`] of one row.
    ///
    /// # Errors
    /// When a length or the size does not fit.
    pub fn new(
        width: u16,
        height: u16,
        colour: &'a mut [u16],
        canvas: &'a mut [u32],
    ) -> Result<Self, TargetError> {
        let band = Rect {
            left: 0,
            top: 0,
            right: width,
            bottom: height,
        };
        Self::band(band, colour, canvas)
    }

    /// A target for a part of the picture: the same pixels that the whole
    /// picture would have there. The colours are `band.pixels()` words.
    ///
    /// # Errors
    /// When a length or the size does not fit.
    pub fn band(
        band: Rect,
        colour: &'a mut [u16],
        canvas: &'a mut [u32],
    ) -> Result<Self, TargetError> {
        if band.pixels() == 0 || band.right > MAX_SIZE || band.bottom > MAX_SIZE {
            return Err(TargetError::Size);
        }
        if colour.len() != band.pixels() {
            return Err(TargetError::ColourLength);
        }
        if canvas_rows(canvas.len()) == 0 {
            return Err(TargetError::CanvasLength);
        }
        Ok(Self {
            picture: Picture {
                band,
                colour,
                depth: None,
            },
            canvas,
        })
    }

    /// Asks for depths, too, as many as colours: larger is nearer, zero where
    /// nothing is drawn; see [`crate::projection`] for the scale.
    ///
    /// # Errors
    /// When the length does not fit.
    pub fn with_depth(self, depth: &'a mut [u16]) -> Result<Self, TargetError> {
        let Self { picture, canvas } = self;
        if depth.len() != picture.band.pixels() {
            return Err(TargetError::DepthLength);
        }
        Ok(Self {
            picture: Picture {
                depth: Some(depth),
                ..picture
            },
            canvas,
        })
    }

    /// The strips that the band is drawn in with pixels of a kind.
    pub(crate) fn strips<P: Pixel>(&self) -> impl Iterator<Item = Rect> + use<P> {
        let band = self.picture.band;
        let rows = canvas_rows(self.canvas.len() / P::WORDS).clamp(1, usize::from(MAX_SIZE)) as u16;
        let tops = (band.top..band.bottom).step_by(usize::from(rows));
        tops.flat_map(move |top| {
            let lefts = (band.left..band.right).step_by(usize::from(STRIP_COLUMNS));
            lefts.map(move |left| Rect {
                left,
                top,
                right: band.right.min(left + STRIP_COLUMNS),
                bottom: band.bottom.min(top.saturating_add(rows)),
            })
        })
    }
}

/// Zeroes pixels.
#[inline(always)]
pub(crate) fn blank(pixels: &mut [u16]) {
    if pixels.is_empty() {
        return;
    }
    let (first, words, last) = bytemuck::pod_align_to_mut::<u16, u32>(pixels);
    // At most one on either side.
    for pixel in first.iter_mut().chain(last).take(2) {
        *pixel = 0;
    }
    clear(words);
}

impl Picture<'_> {
    /// Colours of a row of the picture.
    pub(crate) fn colours(&mut self, columns: Range<u16>, row: u16) -> Option<&mut [u16]> {
        let range = self.range(columns, row);
        self.colour.get_mut(range)
    }

    /// Depths of a row of the picture, if they are asked for.
    pub(crate) fn depths(&mut self, columns: Range<u16>, row: u16) -> Option<&mut [u16]> {
        let range = self.range(columns, row);
        self.depth.as_mut()?.get_mut(range)
    }

    /// Both of a row of the picture, if depths are asked for.
    pub(crate) fn layer(
        &mut self,
        columns: Range<u16>,
        row: u16,
    ) -> Option<(&mut [u16], &mut [u16])> {
        let range = self.range(columns, row);
        let depths = self.depth.as_mut()?.get_mut(range.clone())?;
        Some((self.colour.get_mut(range)?, depths))
    }

    /// Zeroes colours, and depths if they are asked for, of rows.
    pub(crate) fn blank(&mut self, columns: Range<u16>, rows: Range<u16>) {
        let first = self.range(columns.clone(), rows.start);
        let width = self.band.width();
        let rows = rows.len();
        let (length, count) = match first.len() == width {
            // One row after the other.
            true => (rows * width, rows.min(1)),
            false => (first.len(), rows),
        };
        for start in (first.start..).step_by(width.max(1)).take(count) {
            if let Some(colours) = self.colour.get_mut(start..start + length) {
                blank(colours);
            }
            let depths = self.depth.as_mut();
            if let Some(depths) = depths.and_then(|depths| depths.get_mut(start..start + length)) {
                blank(depths);
            }
        }
    }

    fn range(&self, columns: Range<u16>, row: u16) -> Range<usize> {
        let start = usize::from(row - self.band.top) * self.band.width();
        let column = |column: u16| start + usize::from(column - self.band.left);
        column(columns.start)..column(columns.end)
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
