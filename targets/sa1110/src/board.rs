//! The `versatilepb` board: SP804 timer, PL110 screen, stack, start-up. All
//! unsafe code of this firmware.
//!
//! Its timer functions carry the marks by which `../plugin/sa1110.c` knows
//! what to count: instructions without effect that no compiler emits.

use core::arch::{asm, global_asm};
use core::fmt;

use rhogrid_frame::Window;
use rhogrid_measure::{Board, Buffers};
use semihosting::io::{self, Write as _};

global_asm!(include_str!("start.s"));

/// SP804 dual timer, first half: counts down at 1 MHz.
const TIMER_LOAD: usize = 0x101e_2000;
const TIMER_VALUE: usize = 0x101e_2004;
const TIMER_CONTROL: usize = 0x101e_2008;
/// Enabled, 32 bits, free-running.
const TIMER_RUN: u32 = 1 << 7 | 1 << 1;

/// System registers: unlock, and how the screen's bits are routed.
const SYSTEM_LOCK: usize = 0x1000_0020;
const SYSTEM_UNLOCK: u32 = 0xa05f;
const SYSTEM_CLCD: usize = 0x1000_0050;
/// CLCD mode field: 5:6:5.
const CLCD_MODE_MASK: u32 = 3;
const CLCD_RGB565: u32 = 2;

/// PL110 screen controller.
const LCD_TIMING_0: usize = 0x1012_0000;
const LCD_TIMING_1: usize = 0x1012_0004;
const LCD_UPPER_BASE: usize = 0x1012_0010;
const LCD_CONTROL: usize = 0x1012_0018;
/// Enabled, 16 bits a pixel, TFT, red in the upper bits, powered.
const LCD_RUN: u32 = 1 | 4 << 1 | 1 << 5 | 1 << 8 | 1 << 11;

/// What free stack is filled with.
const PAINT: u32 = 0xc5c5_5c5c;

/// Loops of [`Versatile::linger`]: about a minute of QEMU's time.
const LINGER_LOOPS: u64 = 1 << 33;

static mut BUFFERS: Buffers = Buffers::new();

unsafe extern "C" {
    /// Lowest word of the stack; from the link script.
    static mut __stack_limit: u32;
}

/// The board; printing goes to the semihosting console.
pub struct Versatile {
    console: Option<io::Stdout>,
}

impl Versatile {
    /// The board with its console open, if the host offers one.
    pub fn new() -> Self {
        Self {
            console: io::stdout().ok(),
        }
    }

    /// Keeps the screen on until the host stops the machine, but not for ever:
    /// a host that died leaves no machine behind.
    pub fn linger(&mut self) {
        for _ in 0..LINGER_LOOPS {
            // SAFETY: no instruction at all; it only keeps the loop.
            unsafe { asm!("", options(nomem, nostack, preserves_flags)) }
        }
    }
}

impl fmt::Write for Versatile {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let console = self.console.as_mut().ok_or(fmt::Error)?;
        console.write_all(text.as_bytes()).map_err(|_| fmt::Error)
    }
}

impl Board for Versatile {
    fn frame_file(&self) -> &'static [u8] {
        let Window { address, length } = Window::SA1110;
        // SAFETY: the machine has 256 MB of RAM, the link script keeps the
        // image out of this part of it, and nothing ever writes there.
        unsafe { core::slice::from_raw_parts(address as *const u8, length as usize) }
    }

    fn restart_timer(&mut self) {
        write_register(TIMER_CONTROL, 0);
        write_register(TIMER_LOAD, u32::MAX);
        write_register(TIMER_CONTROL, TIMER_RUN);
        // SAFETY: no effect; the mark "the next reading begins an interval".
        unsafe { asm!("orr r0, r0, #0", options(nostack, preserves_flags)) }
    }

    #[inline(never)]
    fn ticks(&mut self) -> u32 {
        let left: u32;
        // SAFETY: reads a device register; the second instruction has no
        // effect but is the mark "a reading". Not `nomem`, which makes it the
        // barrier that the trait asks for.
        unsafe {
            asm!(
                "ldr {left}, [{address}]",
                "bic {left}, {left}, #0",
                address = in(reg) TIMER_VALUE,
                left = out(reg) left,
                options(nostack, preserves_flags)
            );
        }
        u32::MAX - left
    }

    #[inline(never)]
    fn spin(&mut self, loops: u32) {
        // SAFETY: changes nothing but its own register and the flags.
        unsafe {
            asm!(
                "2: subs {loops}, {loops}, #1",
                "bne 2b",
                loops = inout(reg) loops => _,
                options(nomem, nostack)
            );
        }
    }

    fn paint_stack(&mut self) {
        // SAFETY: writes only between the stack's limit and the stack pointer,
        // where nothing is alive; no exception handler returns.
        unsafe {
            asm!(
                "2: cmp {word}, sp",
                "strlo {paint}, [{word}], #4",
                "blo 2b",
                word = inout(reg) &raw mut __stack_limit => _,
                paint = in(reg) PAINT,
                options(nostack)
            );
        }
    }

    fn painted_over(&mut self) -> Option<u32> {
        let limit = (&raw mut __stack_limit).addr();
        let (deepest, caller): (usize, usize);
        // SAFETY: reads only between the stack's limit and the stack pointer.
        unsafe {
            asm!(
                "2: cmp {word}, sp",
                "bhs 3f",
                "ldr {found}, [{word}]",
                "cmp {found}, {paint}",
                "addeq {word}, {word}, #4",
                "beq 2b",
                "3: mov {found}, sp",
                word = inout(reg) limit => deepest,
                paint = in(reg) PAINT,
                found = out(reg) caller,
                options(nostack, readonly)
            );
        }
        (deepest > limit).then_some((caller - deepest) as u32)
    }

    fn show(&mut self, colour: &'static [u16], width: u16, height: u16) -> bool {
        write_register(SYSTEM_LOCK, SYSTEM_UNLOCK);
        let routing = read_register(SYSTEM_CLCD) & !CLCD_MODE_MASK;
        write_register(SYSTEM_CLCD, routing | CLCD_RGB565);
        write_register(LCD_TIMING_0, (u32::from(width) / 16 - 1) << 2);
        write_register(LCD_TIMING_1, u32::from(height) - 1);
        write_register(LCD_UPPER_BASE, colour.as_ptr().addr() as u32);
        write_register(LCD_CONTROL, LCD_RUN);
        true
    }
}

fn write_register(address: usize, value: u32) {
    // SAFETY: every caller passes one of the device registers above.
    unsafe { (address as *mut u32).write_volatile(value) }
}

fn read_register(address: usize) -> u32 {
    // SAFETY: every caller passes one of the device registers above.
    unsafe { (address as *const u32).read_volatile() }
}

// SAFETY: no other item of this image has this name; start-up jumps here.
#[unsafe(no_mangle)]
extern "C" fn start() -> ! {
    let buffers = &raw mut BUFFERS;
    // SAFETY: start-up calls this function once, and nothing else names the
    // buffers.
    let buffers = unsafe { &mut *buffers };
    crate::main(Versatile::new(), buffers)
}

// SAFETY: no other item of this image has this name; the vectors jump here.
#[unsafe(no_mangle)]
extern "C" fn fault(kind: u32, return_address: u32) -> ! {
    crate::fault(kind, return_address)
}
