//! Firmware for QEMU's `versatilepb -cpu sa1110`: a StrongARM SA-1110 (ARMv4:
//! no BX, CLZ, divide or FPU) with a PL110 screen. It runs the measuring flow
//! on the frame file in memory and leaves the last picture on the screen.
#![no_std]
#![no_main]

#[expect(unsafe_code, reason = "the machine itself: registers, stack, statics")]
mod board;

use core::fmt::Write;
use core::panic::PanicInfo;

use board::Versatile;
use rhogrid_measure::{Buffers, run};
use semihosting::process::exit;

/// What start-up calls, once.
fn main(mut board: Versatile, buffers: &'static mut Buffers) -> ! {
    if run(&mut board, buffers).is_err() {
        exit(1);
    }
    board.linger();
    exit(0)
}

/// What the exception vectors call: 1 undefined instruction, 2 software
/// interrupt, 3 prefetch abort, 4 data abort.
fn fault(kind: u32, return_address: u32) -> ! {
    let _ = writeln!(
        Versatile::new(),
        "ERROR exception {kind}, return address {return_address:#010x}"
    );
    exit(1)
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let _ = writeln!(Versatile::new(), "ERROR {info}");
    exit(1)
}
