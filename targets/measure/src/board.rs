//! What a machine contributes: a timer, a stack, perhaps a screen, memory.

use core::fmt;

use rhogrid_core::asset::Grid;
use rhogrid_core::target::canvas_len;
use rhogrid_frame::MAX_ASSETS;

/// Pixels of the largest picture.
pub const PIXELS: usize = 240 * 320;

/// Words of the canvas.
pub const CANVAS: usize = canvas_len(320);

/// Words of the largest shade table: eight materials of 8192 normals.
pub const SHADES: usize = 8 * 8192;

/// Words for shadow maps: one of 512 texels a side, or three of 256.
pub const SHADOWS: usize = 512 * 512 + 8192 / 2;

/// The memory that drawing needs, as one static of the firmware.
#[repr(C, align(4096))]
pub struct Buffers {
    /// Colours, RGB565; first, so that a screen finds them aligned.
    pub colour: [u16; PIXELS],
    /// The canvas: all rows of the largest picture.
    pub canvas: [u32; CANVAS],
    /// Shade table.
    pub shades: [u16; SHADES],
    /// Depths, for scenes.
    pub depth: [u16; PIXELS],
    /// Shadow maps, for scenes.
    pub shadows: [u16; SHADOWS],
    /// The assets, opened.
    pub grids: [Option<Grid<'static>>; MAX_ASSETS],
}

impl Buffers {
    /// All zero, so that they take no room in the image.
    pub const fn new() -> Self {
        Self {
            colour: [0; PIXELS],
            canvas: [0; CANVAS],
            shades: [0; SHADES],
            depth: [0; PIXELS],
            shadows: [0; SHADOWS],
            grids: [const { None }; MAX_ASSETS],
        }
    }
}

impl Default for Buffers {
    fn default() -> Self {
        Self::new()
    }
}

/// A machine. Writing to it prints to the host.
pub trait Board: fmt::Write {
    /// The memory in which the host puts the frame file; 4-byte aligned.
    fn frame_file(&self) -> &'static [u8];

    /// Sets the timer to zero and lets it run.
    fn restart_timer(&mut self);

    /// Ticks since [`Board::restart_timer`]. Never inlined, so that two
    /// readings differ by the same cost wherever they are taken, and a barrier
    /// over which the compiler moves no memory access.
    fn ticks(&mut self) -> u32;

    /// Executes exactly `2 * loops` instructions, and a constant number more.
    /// `loops` is at least one.
    fn spin(&mut self, loops: u32);

    /// Paints the stack below the caller's frame.
    fn paint_stack(&mut self);

    /// Bytes from the caller's frame down to the deepest one that is no longer
    /// paint. `None` if no paint is left: the stack was too small.
    fn painted_over(&mut self) -> Option<u32>;

    /// Puts the picture on the machine's screen, to stay there. `false` if it
    /// has none.
    fn show(&mut self, colour: &'static [u16], width: u16, height: u16) -> bool;
}
