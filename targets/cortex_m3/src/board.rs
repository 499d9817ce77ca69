//! The `mps2-an385` board: CMSDK timer, stack, start-up. All unsafe code of
//! this firmware.

use core::arch::asm;
use core::fmt;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use rhogrid_frame::Window;
use rhogrid_measure::{Board, Buffers};
use semihosting::io::{self, Write as _};

/// CMSDK APB timer 0: counts down at 25 MHz.
const TIMER_CONTROL: usize = 0x4000_0000;
const TIMER_VALUE: usize = 0x4000_0004;
const TIMER_RELOAD: usize = 0x4000_0008;
const TIMER_RUN: u32 = 1;

/// What free stack is filled with.
const PAINT: u32 = 0xc5c5_5c5c;

unsafe extern "C" {
    /// Lowest word of the stack; from memory.x.
    static mut __stack_limit: u32;
}

/// The board; printing goes to the semihosting console.
pub struct Mps2 {
    console: Option<io::Stdout>,
}

impl Mps2 {
    /// The board with its console open, if the host offers one.
    pub fn new() -> Self {
        Self {
            console: io::stdout().ok(),
        }
    }
}

impl fmt::Write for Mps2 {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let console = self.console.as_mut().ok_or(fmt::Error)?;
        console.write_all(text.as_bytes()).map_err(|_| fmt::Error)
    }
}

impl Board for Mps2 {
    fn frame_file(&self) -> &'static [u8] {
        let Window { address, length } = Window::CORTEX_M3;
        // SAFETY: the board has 16 MB of PSRAM there; memory.x does not name
        // it, and nothing ever writes there.
        unsafe { core::slice::from_raw_parts(address as *const u8, length as usize) }
    }

    fn restart_timer(&mut self) {
        write_register(TIMER_CONTROL, 0);
        write_register(TIMER_RELOAD, u32::MAX);
        write_register(TIMER_VALUE, u32::MAX);
        write_register(TIMER_CONTROL, TIMER_RUN);
    }

    #[inline(never)]
    fn ticks(&mut self) -> u32 {
        let left: u32;
        // SAFETY: reads a device register. Not `nomem`, which makes it the
        // barrier that the trait asks for.
        unsafe {
            asm!(
                "ldr {left}, [{address}]",
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
        // where nothing is alive; no interrupt is enabled.
        unsafe {
            asm!(
                "mov {top}, sp",
                "2: cmp {word}, {top}",
                "bhs 3f",
                "str {paint}, [{word}], #4",
                "b 2b",
                "3:",
                word = inout(reg) &raw mut __stack_limit => _,
                top = out(reg) _,
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
                "mov {top}, sp",
                "2: cmp {word}, {top}",
                "bhs 3f",
                "ldr {found}, [{word}]",
                "cmp {found}, {paint}",
                "bne 3f",
                "adds {word}, {word}, #4",
                "b 2b",
                "3:",
                word = inout(reg) limit => deepest,
                top = out(reg) caller,
                paint = in(reg) PAINT,
                found = out(reg) _,
                options(nostack, readonly)
            );
        }
        (deepest > limit).then_some((caller - deepest) as u32)
    }

    fn show(&mut self, _: &'static [u16], _: u16, _: u16) -> bool {
        false
    }
}

fn write_register(address: usize, value: u32) {
    // SAFETY: every caller passes one of the device registers above.
    unsafe { (address as *mut u32).write_volatile(value) }
}

#[entry]
fn start() -> ! {
    static mut BUFFERS: Buffers = Buffers::new();
    crate::main(Mps2::new(), BUFFERS)
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    crate::fault(frame.pc())
}
