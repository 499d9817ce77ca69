//! From a timer's ticks to instructions.
//!
//! Under `-icount shift=N` every instruction takes 2^N ns of QEMU's virtual
//! time, and QEMU's down-counters round towards zero: k instructions after
//! its start a timer has counted ceil(k * 2^N / tick) ticks. As long as an
//! instruction is at least as long as a tick, that can be undone without
//! loss: k = floor(ticks * tick / 2^N). So the resolution is one instruction,
//! and the runner checks it in every run (see [`crate::session`]).

/// How long instructions and ticks are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// An instruction takes 2 to this power nanoseconds.
    pub icount_shift: u32,
    /// A tick of the timer, in nanoseconds; at most an instruction.
    pub tick_ns: u32,
}

impl Clock {
    /// Instructions between two readings of the timer, reading included.
    /// `None` if the second is the smaller one.
    pub fn instructions(&self, start: u32, end: u32) -> Option<u64> {
        self.since_start(end).checked_sub(self.since_start(start))
    }

    fn since_start(&self, ticks: u32) -> u64 {
        (u64::from(ticks) * u64::from(self.tick_ns)) >> self.icount_shift
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOCKS: [Clock; 2] = [
        Clock {
            icount_shift: 10,
            tick_ns: 1000,
        },
        Clock {
            icount_shift: 6,
            tick_ns: 40,
        },
    ];

    #[test]
    fn every_count_comes_back_exactly() {
        for clock in CLOCKS {
            let ticks = |count: u64| {
                let elapsed_ns = count << clock.icount_shift;
                u32::try_from(elapsed_ns.div_ceil(u64::from(clock.tick_ns))).expect("32 bits")
            };
            for count in (0..10_000).chain(2_600_000_000..2_600_010_000) {
                let got = clock.instructions(ticks(17), ticks(17 + count));
                assert_eq!(got, Some(count), "{clock:?}");
            }
        }
    }

    #[test]
    fn readings_of_two_machines() {
        // A million loops of two instructions and 11 and 16 around them.
        assert_eq!(CLOCKS[0].instructions(4, 2_048_013), Some(2_000_009));
        assert_eq!(CLOCKS[1].instructions(9, 3_200_031), Some(2_000_014));
    }

    #[test]
    fn backwards_is_nothing() {
        assert_eq!(CLOCKS[0].instructions(100, 50), None);
    }
}
