//! Colours by brightness.

use crate::asset::Rgb;

/// Brightness steps between black and a material's full colour. A step is an
/// eighth of a level of 6-bit green: rounding to it adds 1/16 to the half level
/// that rounding to 5:6:5 costs.
pub const STEPS: usize = 512;

/// Every brightness as it is.
pub static BRIGHTNESS: [u16; STEPS + 1] = {
    let mut ramp = [0; STEPS + 1];
    let mut step = 0;
    while step <= STEPS {
        ramp[step] = step as u16;
        step += 1;
    }
    ramp
};
/// A material's colours by brightness, RGB565, each channel rounded to
/// nearest.
#[derive(Clone, Copy)]
pub struct Ramp {
    /// A step of each channel, Q22; 512 steps stay below 2^29.
    steps: [u32; 3],
}

impl Ramp {
    pub const BLACK: Self = Self { steps: [0; 3] };

    pub fn new(material: Rgb) -> Self {
        let [red, green, blue] = material;
        let step = |value: u8, levels: u32| {
            // 1 / 255 = 0x808081 / 2^31, within 2^-32.
            ((u64::from(value) * u64::from(levels) * 0x80_8081) >> (9 + 9)) as u32
        };
        Self {
            steps: [step(red, 31), step(green, 63), step(blue, 31)],
        }
    }

    #[inline(always)]
    fn packed(channels: [u32; 3]) -> u16 {
        let [red, green, blue] = channels.map(|channel| (channel + (1 << 21)) >> 22);
        (red << 11 | green << 5 | blue) as u16
    }

    /// The colour for each channel's brightness.
    pub fn colour(&self, brightness: [usize; 3]) -> u16 {
        let mut channels = self.steps;
        for (channel, brightness) in channels.iter_mut().zip(brightness) {
            *channel *= brightness as u32;
        }
        Self::packed(channels)
    }

    /// The colours of all brightnesses.
    pub fn all(&self) -> [u16; STEPS + 1] {
        let mut colours = [0; STEPS + 1];
        let mut channels = [0; 3];
        for colour in &mut colours {
            *colour = Self::packed(channels);
            for (channel, step) in channels.iter_mut().zip(self.steps) {
                *channel += step;
            }
        }
        colours
    }
}

/// Steps of brightness in a weight, Q1.15. At most four lights' worth: below
/// 2^19.
#[inline(always)]
pub fn steps(weight: i32) -> usize {
    (weight as usize >> 6).min(STEPS)
}
