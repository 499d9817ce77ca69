//! The canvas: what samples are drawn into before they become colours.
//!
//! A [`Pixel`] begins with one word, depth << 16 | attribute, zero where nothing
//! is drawn; comparing words compares depths. Rows are 256 pixels apart and
//! [`GUARD`] rows lie above and below, so that the neighbourhood of any
//! sample near the strip is a [`Window`]: 16 rows of 16 columns in one slice
//! of constant length, which needs no test for each sample. Columns beyond
//! the strip's are guards, too. Samples keep within [`REACH`] pixels and seven
//! more of the strip: what runs over on the right side of a row ends at column
//! 254 and what runs over on the left side of the next one begins at column
//! 241, so that the pixels right next to the strip, 240 and 255, are their own.
//! [`AROUND`] the strip pixels are as in any other strip that holds them.

mod pixel;

use core::hint::black_box;
use core::ops::Range;

pub(crate) use pixel::Pixel;

use crate::target::Rect;

/// Pixels from row to row.
pub(crate) const PITCH: usize = 256;
/// Rows above and below the strip.
const GUARD: usize = 17;
/// Columns of the widest strip.
pub(crate) const STRIP_COLUMNS: u16 = 240;
/// Columns and rows on either side of a strip that count: repair looks at them.
pub(crate) const AROUND: [i32; 2] = [1, 2];
/// How far from the strip the centre of a window may lie, columns and rows.
pub(crate) const REACH: [i32; 2] = [8, 9];
/// Columns on either side of a strip that samples near it reach.
const SIDE: usize = REACH[0] as usize + 9;
/// Pixels of a window: 16 rows, and what squares at any of them reach.
pub(crate) const WINDOW: usize = 17 * PITCH + 1;
/// The window's pixel that its centre falls on, both ways.
pub(crate) const WINDOW_CENTRE: i32 = 8;

/// Sixteen rows of the canvas.
pub(crate) type Window<P> = [P; WINDOW];

/// Words of a canvas that takes strips of so many rows.
pub const fn canvas_len(rows: u16) -> usize {
    (rows as usize + 2 * GUARD + 1) * PITCH
}

/// Rows of the tallest strip that a canvas of so many pixels takes.
pub(crate) const fn canvas_rows(pixels: usize) -> usize {
    (pixels / PITCH).saturating_sub(2 * GUARD + 1)
}

/// Zeroes words.
#[inline(never)]
pub(crate) fn clear(words: &mut [u32]) {
    // Zeros that the compiler does not know are stored eight at a time, and the
    // last ones without a call.
    let zeros = black_box([0; 8]);
    let (blocks, rest) = words.as_chunks_mut::<64>();
    for block in blocks {
        for eight in block.as_chunks_mut::<8>().0 {
            *eight = zeros;
        }
    }
    let (eights, rest) = rest.as_chunks_mut::<8>();
    for eight in eights {
        *eight = zeros;
    }
    for word in rest {
        *word = zeros[0];
    }
}

/// Clears rows in which so many columns are a strip's, and what samples near
/// them reach on either side.
fn clear_columns<P: Pixel>(rows: &mut [P], columns: usize) {
    let beside = [columns + SIDE, PITCH - SIDE];
    if beside[0] >= beside[1] {
        return clear(P::words(rows));
    }
    for row in rows.as_chunks_mut::<PITCH>().0 {
        let (own, rest) = row.split_at_mut(beside[0]);
        clear(P::words(own));
        // The left side of the next row.
        clear(P::words(rest.split_at_mut(beside[1] - beside[0]).1));
    }
}

/// A strip of the picture on the canvas.
pub(crate) struct Canvas<'a, P> {
    pixels: &'a mut [P],
    /// The pixels that will be seen.
    pub strip: Rect,
    /// Pixels on which something may have been drawn, relative to the strip.
    touched: Touched,
}

/// First and last row and column, in this order, of what was drawn on.
#[derive(Clone, Copy, Debug)]
struct Touched {
    rows: [i32; 2],
    columns: [i32; 2],
}

impl Touched {
    const NOTHING: Self = Self {
        rows: [i32::MAX, i32::MIN],
        columns: [i32::MAX, i32::MIN],
    };

    #[inline(always)]
    fn add(&mut self, [left, right]: [i32; 2], [top, bottom]: [i32; 2]) {
        self.rows = [self.rows[0].min(top), self.rows[1].max(bottom)];
        self.columns = [self.columns[0].min(left), self.columns[1].max(right)];
    }

    /// Adds a window: most lie within what was drawn on, and nothing is stored.
    #[inline(always)]
    fn add_window(&mut self, column: i32, row: i32) {
        let widen = |[first, last]: &mut [i32; 2], at: i32| {
            if at < *first {
                *first = at;
            }
            if at + 15 > *last {
                *last = at + 15;
            }
        };
        widen(&mut self.rows, row);
        widen(&mut self.columns, column);
    }
}

impl<'a, P: Pixel> Canvas<'a, P> {
    /// A canvas for a strip, cleared.
    pub fn new(words: &'a mut [u32], strip: Rect) -> Self {
        let rows = strip.height() + 2 * GUARD + 1;
        let pixels = P::of(words);
        let used = pixels.len().min(rows * PITCH);
        clear_columns(pixels.split_at_mut(used).0, strip.width());
        Self {
            pixels,
            strip,
            touched: Touched::NOTHING,
        }
    }

    /// The strip's rows and columns that were drawn on, with one more around
    /// them, as far as they lie in the strip: [first, end).
    pub fn touched(&self) -> (Range<u16>, Range<u16>) {
        let within = |[first, last]: [i32; 2], low: u16, size: usize| {
            let first = (first - 1).max(0).min(size as i32);
            let end = last.saturating_add(2).min(size as i32).max(first);
            low + first as u16..low + end as u16
        };
        let strip = &self.strip;
        (
            within(self.touched.columns, strip.left, strip.width()),
            within(self.touched.rows, strip.top, strip.height()),
        )
    }

    /// The window around a pixel of the picture, at most [`REACH`] from the
    /// strip.
    #[inline(always)]
    pub fn window(&mut self, column: i32, row: i32) -> Option<&mut Window<P>> {
        let row = row - i32::from(self.strip.top) - WINDOW_CENTRE;
        let column = column - i32::from(self.strip.left) - WINDOW_CENTRE;
        self.touched.add_window(column, row);
        let start = ((row + GUARD as i32) * PITCH as i32 + column) as usize;
        self.pixels.get_mut(start..)?.first_chunk_mut()
    }

    /// The rows of a rectangle, [first, end) columns and rows, not empty.
    #[inline(always)]
    pub fn rows(
        &mut self,
        [left, right]: [i32; 2],
        [top, bottom]: [i32; 2],
    ) -> impl Iterator<Item = &mut [P]> {
        let strip = &self.strip;
        let [left, right] = [left, right].map(|column| column - i32::from(strip.left));
        let [top, bottom] = [top, bottom].map(|row| row - i32::from(strip.top));
        self.touched.add([left, right - 1], [top, bottom - 1]);
        let start = ((top + GUARD as i32) * PITCH as i32 + left) as usize;
        let columns = (right - left) as usize;
        let length = (bottom - top - 1) as usize * PITCH + columns;
        let pixels = self
            .pixels
            .get_mut(start..start + length)
            .unwrap_or(&mut []);
        let rows = pixels.chunks_mut(PITCH);
        rows.filter_map(move |row| row.get_mut(..columns))
    }

    /// Whether a pixel on the canvas shows more than a word.
    #[inline(always)]
    pub fn exceeds_at(&self, column: i32, row: i32, word: u32) -> bool {
        let own = self.pixels.get(self.index(column, row));
        own.is_some_and(|own| own.word() > word)
    }

    /// Whether all pixels of a rectangle, first to last column and row, show
    /// more than a word, as far as they count. The corners are asked first.
    #[inline(never)]
    pub fn exceeds(&self, columns: [i32; 2], rows: [i32; 2], word: u32) -> bool {
        let within = |[first, last]: [i32; 2], low: u16, high: u16, around: i32| {
            let (low, high) = (i32::from(low) - around, i32::from(high) - 1 + around);
            [first.max(low), last.min(high)]
        };
        let strip = &self.strip;
        let [left, right] = within(columns, strip.left, strip.right, AROUND[0]);
        let [top, bottom] = within(rows, strip.top, strip.bottom, AROUND[1]);
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        let mut corners = corners.into_iter();
        if !corners.all(|(column, row)| self.exceeds_at(column, row, word)) {
            return false;
        }
        let length = (right - left + 1).max(0) as usize;
        (top..=bottom).all(|row| {
            let start = self.index(left, row);
            let row = self.pixels.get(start..start + length);
            row.is_some_and(|row| row.iter().all(|own| own.word() > word))
        })
    }

    /// Where a pixel of the picture is, as far as it is on the canvas.
    #[inline(always)]
    fn index(&self, column: i32, row: i32) -> usize {
        let row = row - i32::from(self.strip.top) + GUARD as i32;
        (row * PITCH as i32 + column - i32::from(self.strip.left)) as usize
    }

    /// The neighbourhoods of pixels of a row of the strip: five rows, from the
    /// second above the first one's left neighbour to the second below the
    /// last one's right neighbour.
    pub fn neighbourhoods(&self, columns: &Range<u16>, row: u16) -> Option<&[P]> {
        let first = usize::from(row - self.strip.top) + GUARD - 2;
        let start = first * PITCH + usize::from(columns.start - self.strip.left) - 1;
        self.pixels
            .get(start..start + 4 * PITCH + columns.len() + 2)
    }
}
