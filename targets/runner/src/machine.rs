//! The machines: how QEMU and cargo call them, and what they have.

use rhogrid_frame::Window;

use crate::clock::Clock;

/// The Rust release that firmware is built with, by name: later ones bring
/// hand-written BX into ARMv4 images.
pub const TOOLCHAIN: &str = "1.95.0";

/// What cargo calls a machine's instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A target that rustup installs.
    Installed(&'static str),
    /// A target file in `targets/`, for which `core` is built along.
    File(&'static str),
}

impl Target {
    /// Flags of `cargo build` inside `targets/`.
    pub fn flags(self) -> Vec<&'static str> {
        match self {
            Self::Installed(name) => vec!["--target", name],
            Self::File(file) => vec![
                "--target",
                file,
                "-Zbuild-std=core,compiler_builtins",
                "-Zbuild-std-features=compiler-builtins-mem",
                "-Zjson-target-spec",
            ],
        }
    }
}

/// A machine that frames run on.
#[derive(Debug)]
pub struct Machine {
    /// Name on the command line and in results.
    pub name: &'static str,
    /// QEMU's name.
    pub qemu: &'static str,
    /// More of QEMU's arguments: core and memory.
    pub qemu_arguments: &'static [&'static str],
    /// Package of the firmware.
    pub package: &'static str,
    /// What the firmware is built for.
    pub target: Target,
    /// Where the frame file goes.
    pub window: Window,
    /// How its timer counts instructions.
    pub clock: Clock,
    /// Whether the last picture can be seen.
    pub has_screen: bool,
    /// Whether [`crate::cycles`] is a model of it.
    pub has_cycle_model: bool,
}

/// All machines.
pub static MACHINES: [Machine; 2] = [
    Machine {
        name: "sa1110",
        qemu: "versatilepb",
        qemu_arguments: &["-cpu", "sa1110", "-m", "256M"],
        package: "firmware-sa1110",
        target: Target::File("armv4-strongarm-none-eabi.json"),
        window: Window::SA1110,
        clock: Clock {
            icount_shift: 10,
            tick_ns: 1000,
        },
        has_screen: true,
        has_cycle_model: true,
    },
    Machine {
        name: "m3",
        qemu: "mps2-an385",
        qemu_arguments: &[],
        package: "firmware-cortex-m3",
        target: Target::Installed("thumbv7m-none-eabi"),
        window: Window::CORTEX_M3,
        clock: Clock {
            icount_shift: 6,
            tick_ns: 40,
        },
        has_screen: false,
        has_cycle_model: false,
    },
];

/// The machine of a name.
///
/// # Errors
/// When there is none; says which there are.
pub fn find(name: &str) -> Result<&'static Machine, String> {
    MACHINES
        .iter()
        .find(|machine| machine.name == name)
        .ok_or_else(|| {
            let names: Vec<&str> = MACHINES.iter().map(|machine| machine.name).collect();
            format!("no such machine; there are {}", names.join(", "))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_to_machines() {
        for machine in &MACHINES {
            assert_eq!(find(machine.name).map(|found| found.name), Ok(machine.name));
        }
        let error = find("pdp11").expect_err("no such machine");
        assert_eq!(error, "no such machine; there are sa1110, m3");
    }

    #[test]
    fn a_tick_is_no_longer_than_an_instruction() {
        for machine in &MACHINES {
            let clock = machine.clock;
            assert!(clock.tick_ns <= 1 << clock.icount_shift, "{}", machine.name);
            assert_eq!(machine.window.address % 4, 0, "{}", machine.name);
        }
    }
}
