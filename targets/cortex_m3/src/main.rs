//! Firmware for QEMU's `mps2-an385`, a Cortex-M3 (ARMv7-M). It runs the
//! measuring flow on the frame file in memory. The machine has no screen.
#![no_std]
#![no_main]

#[expect(unsafe_code, reason = "the machine itself: registers, stack, statics")]
mod board;

use core::fmt::Write;
use core::panic::PanicInfo;

use board::Mps2;
use rhogrid_measure::{Buffers, run};
use semihosting::process::exit;

/// What the runtime calls, once.
fn main(mut board: Mps2, buffers: &'static mut Buffers) -> ! {
    exit(i32::from(run(&mut board, buffers).is_err()))
}

/// What the hard fault vector calls.
fn fault(return_address: u32) -> ! {
    let _ = writeln!(
        Mps2::new(),
        "ERROR hard fault, return address {return_address:#010x}"
    );
    exit(1)
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let _ = writeln!(Mps2::new(), "ERROR {info}");
    exit(1)
}
