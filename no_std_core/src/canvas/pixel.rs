//! What a pixel of the canvas holds.

use crate::shade::Shader;

/// A pixel: one word, or two where samples have colours of their own.
pub(crate) trait Pixel: Copy {
    /// Words of a pixel.
    const WORDS: usize;

    /// Tells a sample of the asset from all others, as far as a pixel holds
    /// that.
    type Sample: Copy;

    /// The sample of a level with an index in it, which is below 2^28.
    fn sample(depth: u8, index: usize) -> Self::Sample;

    /// The sample so many behind another one in its level.
    fn ahead(sample: Self::Sample, count: usize) -> Self::Sample;

    /// A pixel of depth << 16 | attribute.
    fn new(word: u32, sample: Self::Sample) -> Self;

    /// Depth << 16 | attribute: what is compared.
    fn word(self) -> u32;

    /// As many pixels as words make.
    fn of(words: &mut [u32]) -> &mut [Self];

    /// All their words.
    fn words(pixels: &mut [Self]) -> &mut [u32];

    /// What is shown of a pixel that is not empty, under the lamps whose bits
    /// are not set.
    fn colour(self, shader: &Shader<'_>, unlit: u32) -> u16;
}

impl Pixel for u32 {
    const WORDS: usize = 1;

    type Sample = ();

    #[inline(always)]
    fn sample(_: u8, _: usize) {}

    #[inline(always)]
    fn ahead((): (), _: usize) {}

    #[inline(always)]
    fn new(word: u32, (): ()) -> Self {
        word
    }

    #[inline(always)]
    fn word(self) -> u32 {
        self
    }

    #[inline(always)]
    fn of(words: &mut [u32]) -> &mut [Self] {
        words
    }

    #[inline(always)]
    fn words(pixels: &mut [Self]) -> &mut [u32] {
        pixels
    }

    #[inline(always)]
    fn colour(self, shader: &Shader<'_>, unlit: u32) -> u16 {
        shader.colour_without(self as u16, unlit)
    }
}

/// The second word is the sample's depth << 28 | its index.
impl Pixel for [u32; 2] {
    const WORDS: usize = 2;

    type Sample = u32;

    #[inline(always)]
    fn sample(depth: u8, index: usize) -> u32 {
        u32::from(depth) << INDEX_BITS | index as u32
    }

    #[inline(always)]
    fn ahead(sample: u32, count: usize) -> u32 {
        sample.wrapping_add(count as u32)
    }

    #[inline(always)]
    fn new(word: u32, sample: u32) -> Self {
        [word, sample]
    }

    #[inline(always)]
    fn word(self) -> u32 {
        self[0]
    }

    #[inline(always)]
    fn of(words: &mut [u32]) -> &mut [Self] {
        words.as_chunks_mut().0
    }

    #[inline(always)]
    fn words(pixels: &mut [Self]) -> &mut [u32] {
        pixels.as_flattened_mut()
    }

    #[inline(always)]
    fn colour(self, shader: &Shader<'_>, unlit: u32) -> u16 {
        let [word, sample] = self;
        let (depth, index) = (sample >> INDEX_BITS, sample % (1 << INDEX_BITS));
        shader.coloured(word as u16, (depth as usize, index as usize), unlit)
    }
}

/// Bits of an index in a level: four are left for the depth.
const INDEX_BITS: u32 = 28;
