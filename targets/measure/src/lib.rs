//! The measuring flow that every machine's firmware runs: open the frame
//! file, check the timer, then for each view draw a warm-up picture, draw the
//! measured one, and print one line. A machine contributes a [`Board`] and
//! the memory for [`Buffers`].
//!
//! What is printed, one line each, in this order (`..` are the timer's ticks
//! when it was read first and last; see [`Board::ticks`]):
//!
//! ```text
//! RHOGRID 1 views                       protocol version, number of views
//! READ  ..                              the timer, read twice in a row
//! SPIN  loops ..                        that many two-instruction loops
//! VIEW  index .. frame_hash stack_bytes
//! SHOWN width height                    the last picture stays on the screen
//! DONE                                  or the machine has none
//! ERROR what                            nothing follows
//! ```
//!
//! The difference of two readings includes the cost of reading, which is what
//! `READ` measures. `stack_bytes` is how far below its caller's frame the draw
//! call reached: the free stack is painted before and searched after it.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod board;
mod content;
mod flow;

pub use board::{Board, Buffers, PIXELS, SHADES, SHADOWS};
pub use content::{Content, Memories};
pub use flow::{Failure, run};

/// Version of the printed lines.
pub const PROTOCOL: u32 = 1;
