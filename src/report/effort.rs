//! How much a report measures.

/// Sizes of a report's sweeps.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Picture width in pixels.
    pub width: u16,
    /// Picture height in pixels.
    pub height: u16,
    /// Cells on an axis at which assets of different rho are compared, as near
    /// as their levels come.
    pub cells: u32,
    /// Levels of the tri-grids whose quality is measured.
    pub levels: &'static [u8],
    /// Splat sizes that each of them is drawn with, pixels.
    pub splats: &'static [f64],
    /// How often each draw call is timed.
    pub rounds: u32,
}

impl Effort {
    /// The standard picture and all that is swept. 3^6 cells are 1.4 times
    /// fewer than 2^10 and 4^5 and 1.2 times more than 5^4: no size that can be
    /// drawn on a small screen brings all four nearer.
    pub const FULL: Self = Self {
        width: 240,
        height: 320,
        cells: 729,
        levels: &[3, 4, 5, 6],
        splats: &[0.4, 0.63, 0.9, 1.25, 1.7, 2.5],
        rounds: 11,
    };
    /// The same with coarser grids and fewer rounds.
    pub const QUICK: Self = Self {
        cells: 243,
        levels: &[3, 4, 5],
        splats: &[0.4, 0.9, 1.25, 2.5],
        rounds: 7,
        ..Self::FULL
    };
}
