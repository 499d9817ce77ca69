//! Where in each machine's memory the frame file lies.

/// A range of a machine's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First byte; 4-byte aligned.
    pub address: u32,
    /// Bytes.
    pub length: u32,
}

impl Window {
    /// `versatilepb` with 256 MB: all memory above the firmware's 64 MB.
    pub const SA1110: Self = Self {
        address: 64 << 20,
        length: 192 << 20,
    };

    /// `mps2-an385`: its 16 MB of PSRAM.
    pub const CORTEX_M3: Self = Self {
        address: 0x2100_0000,
        length: 16 << 20,
    };
}
