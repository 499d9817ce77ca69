//! The cycle model: how long a SA-1110 would take, estimated from what
//! `../plugin/sa1110.c` counts between two readings of the timer.
//!
//! ```text
//! cycles = instructions                              one issues each cycle
//!        + long_multiplies * LONG_MULTIPLY_EXTRA
//!        + multiple_words - multiples                a word a cycle, the first included
//!        + load_stalls + multiply_stalls             waits for *_DELAY cycles
//!        + taken_branches * TAKEN_BRANCH_EXTRA
//!        + (fetch_misses + load_misses) * MISS_CYCLES
//! ```
//!
//! Stalls are not averages: within a block without branches the plugin knows
//! which instruction uses which register how soon after a load or a multiply
//! has named it as its result. The caches are the SA-1110's: 16 KB for
//! instructions and 8 KB for data, 32-way, 32-byte lines, round robin, no
//! allocation on writes, write-back; empty when a draw call begins. The counts
//! hold one reading of the timer, which is some hundred cycles with its misses.
//!
//! Sources: (timing) Intel, SA-110 Microprocessor Instruction Timing,
//! 278194-001, 1998, and the timing table of the SA-1110 Developer's Manual;
//! (paper) Montanaro et al., A 160-MHz, 32-b, 0.5-W CMOS RISC Microprocessor,
//! 1996. What no source is named for is assumed. So are:
//!
//! 1. The write buffer is never full: stores, write-backs and stores that miss
//!    cost nothing but their instructions. Clearing a 240x320 picture (colour
//!    and depth) alone may cost 0.3 million cycles more.
//! 2. A miss stalls until its whole line is there.
//! 3. No TLB misses, no mini-cache, no refresh, no screen that takes its share
//!    of the memory.
//! 4. Branches by other instructions than B and BL cost what B costs, shifts by
//!    a register cost nothing, multiplies wait for none before them.
//! 5. An instruction whose condition fails waits for its registers, and counts
//!    as a multiply, all the same. Only loads and stores are counted as done.

use serde::Deserialize;

/// Clock of the SA-1110 of 2000's handhelds (206.4 MHz).
pub const CLOCK_MHZ: u64 = 206;

/// Cycles for which a loaded register is not there yet (timing).
pub const LOAD_DELAY: u64 = 1;

/// The same where the load extends a sign, too (timing).
pub const SIGNED_LOAD_DELAY: u64 = 2;

/// Cycles for which a product is not there yet. 1 to 3, as the multiplier takes
/// 12 bits a cycle (timing, paper); operands of 13 to 24 bits are assumed.
pub const MULTIPLY_DELAY: u64 = 2;

/// A product of 64 bits takes a second cycle to issue (timing).
const LONG_MULTIPLY_EXTRA: u64 = 1;

/// Nothing predicts branches; their targets are known a cycle late (paper).
const TAKEN_BRANCH_EXTRA: u64 = 1;

/// A line from SDRAM on 32 wires at half the core's clock: six memory cycles to
/// the first of eight words, one for each (assumed).
const MISS_CYCLES: u64 = 2 * (6 + 8);

/// What the plugin counts in an interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counts {
    /// All instructions.
    pub instructions: u64,
    /// Multiplies with a 32-bit result.
    pub multiplies: u64,
    /// Multiplies with a 64-bit result.
    pub long_multiplies: u64,
    /// Cycles of waiting for a loaded register.
    pub load_stalls: u64,
    /// Cycles of waiting for a product.
    pub multiply_stalls: u64,
    /// Loads, of whatever size; each word of a load multiple is one.
    pub loads: u64,
    /// Stores, likewise.
    pub stores: u64,
    /// Load and store multiple instructions.
    pub multiples: u64,
    /// Words that those moved.
    pub multiple_words: u64,
    /// Times that execution did not go on with the next instruction.
    pub taken_branches: u64,
    /// Lines that the instruction cache did not hold.
    pub fetch_misses: u64,
    /// Loads whose line the data cache did not hold.
    pub load_misses: u64,
    /// Stores whose line the data cache did not hold.
    pub store_misses: u64,
    /// Changed lines that load misses drove out.
    pub write_backs: u64,
}

impl Counts {
    /// The estimate.
    pub fn cycles(&self) -> u64 {
        self.instructions
            + self.long_multiplies * LONG_MULTIPLY_EXTRA
            + self.multiple_words.saturating_sub(self.multiples)
            + self.load_stalls
            + self.multiply_stalls
            + self.taken_branches * TAKEN_BRANCH_EXTRA
            + (self.fetch_misses + self.load_misses) * MISS_CYCLES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_count_costs_what_the_model_says() {
        let cycles = |counts: Counts| counts.cycles();
        let none = Counts::default();
        assert_eq!(cycles(none), 0);
        #[rustfmt::skip]
        let table = [
            (1, Counts { instructions: 1, ..none }),
            (0, Counts { multiplies: 1, ..none }),
            (1, Counts { long_multiplies: 1, ..none }),
            (1, Counts { load_stalls: 1, ..none }),
            (1, Counts { multiply_stalls: 1, ..none }),
            (0, Counts { loads: 1, stores: 1, ..none }),
            // Two instructions move five and eight words.
            (11, Counts { multiples: 2, multiple_words: 13, ..none }),
            (1, Counts { taken_branches: 1, ..none }),
            (28, Counts { fetch_misses: 1, ..none }),
            (28, Counts { load_misses: 1, ..none }),
            (0, Counts { store_misses: 1, write_backs: 1, ..none }),
        ];
        for (expected, counts) in table {
            assert_eq!(cycles(counts), expected, "{counts:?}");
        }
    }

    #[test]
    fn costs_add_up() {
        let counts = Counts {
            instructions: 1_000_000,
            multiplies: 20_000,
            long_multiplies: 15_000,
            load_stalls: 70_000,
            multiply_stalls: 35_000,
            loads: 250_000,
            stores: 170_000,
            multiples: 12_000,
            multiple_words: 82_000,
            taken_branches: 40_000,
            fetch_misses: 700,
            load_misses: 1_300,
            store_misses: 14_000,
            write_backs: 350,
        };
        let expected = 1_000_000 + 15_000 + 70_000 + 35_000 + 70_000 + 40_000 + 2_000 * 28;
        assert_eq!(counts.cycles(), expected);
    }
}
