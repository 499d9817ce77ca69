//! Reading in place: checked once by [`Frame::open`], infallible after it.

use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Unit, Weight};

use crate::{CAMERA_WORDS, HEADER_WORDS, MAGIC, Settings, VERSION, VIEW_BYTES, View};

/// Why bytes are not a frame file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// The first word is not [`MAGIC`]: nothing was loaded here.
    Magic,
    /// Another version.
    Version,
    /// The bytes end before the file does.
    Truncated,
    /// The views or the asset reach beyond the file, or overlap the header.
    Layout,
    /// The asset's offset is not a multiple of four.
    Alignment,
}

/// A frame file in memory.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    settings: Settings,
    views: &'a [u8],
    asset: &'a [u8],
}

impl<'a> Frame<'a> {
    /// Checks the header and finds the parts. `bytes` may reach beyond the
    /// file's end: the header says how long it is. The asset is 4-byte
    /// aligned if `bytes` is.
    ///
    /// # Errors
    /// When the bytes are no frame file, or only the beginning of one.
    pub fn open(bytes: &'a [u8]) -> Result<Self, FrameError> {
        let mut header = Words(bytes.get(..HEADER_WORDS * 4).ok_or(FrameError::Truncated)?);
        if header.word() != MAGIC {
            return Err(FrameError::Magic);
        }
        if header.word() != VERSION {
            return Err(FrameError::Version);
        }
        let file = bytes
            .get(..header.word() as usize)
            .ok_or(FrameError::Truncated)?;
        let size = header.word();
        let view_count = header.word() as usize;
        let views_offset = header.word() as usize;
        let asset_offset = header.word() as usize;
        let asset_length = header.word() as usize;
        if !asset_offset.is_multiple_of(4) {
            return Err(FrameError::Alignment);
        }
        let part = |offset: usize, length: Option<usize>| {
            let end = offset.checked_add(length?)?;
            file.get(offset..end).filter(|_| offset >= HEADER_WORDS * 4)
        };
        let views_length = view_count.checked_mul(VIEW_BYTES);
        let views = part(views_offset, views_length).ok_or(FrameError::Layout)?;
        let asset = part(asset_offset, Some(asset_length)).ok_or(FrameError::Layout)?;
        let light = Light {
            towards: header.units(),
            ambient: Weight::from_bits(header.word()),
            diffuse: Weight::from_bits(header.word()),
        };
        let [splat, distortion] = [0; 2].map(|_| SplatPx::from_bits(header.word()));
        let switches = header.word();
        let quality = Quality {
            splat,
            distortion,
            repair: switches & 1 != 0,
            culling: switches & 2 != 0,
        };
        let settings = Settings {
            width: (size & 0xffff) as u16,
            height: (size >> 16) as u16,
            light,
            quality,
        };
        Ok(Self {
            settings,
            views,
            asset,
        })
    }

    /// What all views share.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The views, in order.
    pub fn views(&self) -> Views<'a> {
        Views {
            rest: self.views,
            settings: self.settings,
        }
    }

    /// The asset's bytes.
    pub fn asset(&self) -> &'a [u8] {
        self.asset
    }
}

/// Iterator over the views of a [`Frame`].
#[derive(Clone, Debug)]
pub struct Views<'a> {
    rest: &'a [u8],
    settings: Settings,
}

impl Iterator for Views<'_> {
    type Item = View;

    fn next(&mut self) -> Option<View> {
        let (view, rest) = self.rest.split_at_checked(VIEW_BYTES)?;
        self.rest = rest;
        let (warm_up, measured) = view.split_at_checked(CAMERA_WORDS * 4)?;
        Some(View {
            warm_up: camera(warm_up, &self.settings),
            measured: camera(measured, &self.settings),
        })
    }
}

fn camera(bytes: &[u8], settings: &Settings) -> Camera {
    let mut words = Words(bytes);
    Camera {
        eye: [words.double(), words.double(), words.double()].map(Length::from_bits),
        right: words.units(),
        up: words.units(),
        forward: words.units(),
        focal_px: FocalPx::from_bits(words.double()),
        near: Length::from_bits(words.double()),
        width: settings.width,
        height: settings.height,
    }
}

/// Words one after the other; zeros behind the end, which the length checks
/// above keep out of reach.
struct Words<'a>(&'a [u8]);

impl Words<'_> {
    fn word(&mut self) -> u32 {
        let Some((word, rest)) = self.0.split_first_chunk() else {
            return 0;
        };
        self.0 = rest;
        u32::from_le_bytes(*word)
    }

    fn double(&mut self) -> i64 {
        let low = u64::from(self.word());
        let high = u64::from(self.word());
        (high << 32 | low).cast_signed()
    }

    fn units(&mut self) -> [Unit; 3] {
        [self.word(), self.word(), self.word()].map(|word| Unit::from_bits(word.cast_signed()))
    }
}
