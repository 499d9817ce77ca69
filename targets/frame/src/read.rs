//! Reading in place: checked once by [`Frame::open`], infallible after it.

use rhogrid_core::asset::{MAX_MATERIALS, Rgb};
use rhogrid_core::camera::Camera;
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{Length, SplatPx, Unit, Weight};
use rhogrid_core::placement::Placement;
use rhogrid_core::scene::{Lamp, Matcap};
use rhogrid_core::shadow::{Method, Shadows};

use crate::{
    ASSET_BYTES, HEADER_WORDS, INSTANCE_BYTES, LAMP_BYTES, MAGIC, MAX_ASSETS, MAX_INSTANCES,
    Materials, Placed, Settings, TEXEL_BYTES, VERSION, VIEW_BYTES, View, lone_light,
};

/// Why bytes are not a frame file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// The first word is not [`MAGIC`]: nothing was loaded here.
    Magic,
    /// Another version.
    Version,
    /// The bytes end before the file does.
    Truncated,
    /// A part reaches beyond the file or overlaps the header, there are too
    /// many, or one names another that is not there.
    Layout,
    /// An asset or the texels do not lie at a multiple of four.
    Alignment,
    /// The texels are no matcap.
    Matcap,
}

/// A frame file in memory.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    settings: Settings,
    file: &'a [u8],
    views: &'a [u8],
    assets: &'a [u8],
    instances: &'a [u8],
    lamps: &'a [u8],
    matcap: Option<Matcap<'a>>,
}

impl<'a> Frame<'a> {
    /// Checks the header and finds the parts. `bytes` may reach beyond the
    /// file's end: the header says how long it is. Assets are 4-byte aligned if
    /// `bytes` is.
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
        let part = |header: &mut Words<'_>, size: usize, most: usize| {
            let (count, offset) = (header.word() as usize, header.word() as usize);
            let end = count.saturating_mul(size).saturating_add(offset);
            let is_sound = offset >= HEADER_WORDS * 4 && count <= most;
            let bytes = file.get(offset..end).filter(|_| is_sound);
            bytes.ok_or(FrameError::Layout)
        };
        let views = part(&mut header, VIEW_BYTES, usize::MAX)?;
        let assets = part(&mut header, ASSET_BYTES, MAX_ASSETS)?;
        let instances = part(&mut header, INSTANCE_BYTES, MAX_INSTANCES)?;
        let lamps = part(&mut header, LAMP_BYTES, usize::MAX)?;
        let settings = settings(size, &mut header);
        let texels = part(&mut header, TEXEL_BYTES, usize::MAX)?;
        let frame = Self {
            settings,
            file,
            views,
            assets,
            instances,
            lamps,
            matcap: matcap(texels)?,
        };
        frame.check().map(|()| frame)
    }

    /// Checks what parts say of others.
    fn check(&self) -> Result<(), FrameError> {
        for entry in self.assets.chunks_exact(ASSET_BYTES) {
            if !Words(entry).word().is_multiple_of(4) {
                return Err(FrameError::Alignment);
            }
            self.asset_of(entry).ok_or(FrameError::Layout)?;
        }
        let count = self.assets.len() / ASSET_BYTES;
        match self
            .instances()
            .all(|placed| (placed.asset as usize) < count)
        {
            true => Ok(()),
            false => Err(FrameError::Layout),
        }
    }

    fn asset_of(&self, entry: &[u8]) -> Option<&'a [u8]> {
        let mut words = Words(entry);
        let (offset, length) = (words.word() as usize, words.word() as usize);
        let bytes = self.file.get(offset..offset.checked_add(length)?);
        bytes.filter(|_| offset >= HEADER_WORDS * 4)
    }

    /// What all views share.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The views, in order.
    pub fn views(&self) -> impl Iterator<Item = View> + use<'a> {
        let settings = self.settings;
        self.views.chunks_exact(VIEW_BYTES).map(move |view| {
            let mut words = Words(view);
            View {
                warm_up: camera(&mut words, &settings),
                measured: camera(&mut words, &settings),
            }
        })
    }

    /// The assets' bytes.
    pub fn assets(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let frame = *self;
        let entries = self.assets.chunks_exact(ASSET_BYTES);
        entries.filter_map(move |entry| frame.asset_of(entry))
    }

    /// Where they stand.
    pub fn instances(&self) -> impl Iterator<Item = Placed> + use<'a> {
        self.instances.chunks_exact(INSTANCE_BYTES).map(placed)
    }

    /// The lights.
    pub fn lamps(&self) -> impl Iterator<Item = Lamp> + use<'a> {
        self.lamps.chunks_exact(LAMP_BYTES).map(lamp)
    }

    /// What ambient light is.
    pub fn matcap(&self) -> Option<Matcap<'a>> {
        self.matcap
    }

    /// The light of one asset that stands alone and casts no shadows: what
    /// [`rhogrid_core::draw::draw`] draws. `None` for scenes.
    pub fn lone_light(&self) -> Option<Light> {
        let (mut instances, mut lamps) = (self.instances(), self.lamps());
        let first = (instances.next(), lamps.next());
        match (instances.next(), lamps.next()) {
            (None, None) if self.matcap.is_none() => lone_light(&self.settings, first.0, first.1),
            _ => None,
        }
    }
}

/// None without texels.
fn matcap(texels: &[u8]) -> Result<Option<Matcap<'_>>, FrameError> {
    if texels.is_empty() {
        return Ok(None);
    }
    let texels = bytemuck::try_cast_slice(texels).map_err(|_| FrameError::Alignment)?;
    Matcap::new(texels).map(Some).ok_or(FrameError::Matcap)
}

fn settings(size: u32, header: &mut Words<'_>) -> Settings {
    let ambient = Weight::from_bits(header.word());
    let [splat, distortion] = [0; 2].map(|_| SplatPx::from_bits(header.word()));
    let switches = header.word();
    Settings {
        width: (size & 0xffff) as u16,
        height: (size >> 16) as u16,
        ambient,
        quality: Quality {
            splat,
            distortion,
            repair: switches & 1 != 0,
            culling: switches & 2 != 0,
        },
        shadows: Shadows {
            method: match switches >> 2 & 3 {
                0 => Method::Off,
                1 => Method::TwoPass,
                _ => Method::OnePass,
            },
            size: header.word() as u16,
            splat: SplatPx::from_bits(header.word()),
            bias: SplatPx::from_bits(header.word()),
        },
    }
}

fn camera(words: &mut Words<'_>, settings: &Settings) -> Camera {
    Camera {
        eye: words.lengths(),
        right: words.units(),
        up: words.units(),
        forward: words.units(),
        focal_px: words.length(),
        near: words.length(),
        width: settings.width,
        height: settings.height,
    }
}

fn placed(bytes: &[u8]) -> Placed {
    let mut words = Words(bytes);
    let (asset, count) = (words.word(), words.word());
    let colours = [0; MAX_MATERIALS].map(|_| words.rgb());
    let materials = Materials {
        count: count.min(MAX_MATERIALS as u32) as u8,
        colours,
    };
    Placed {
        asset,
        materials: (count > 0).then_some(materials),
        placement: Placement {
            origin: words.lengths(),
            axes: [0; 3].map(|_| words.lengths()),
        },
    }
}

fn lamp(bytes: &[u8]) -> Lamp {
    let mut words = Words(bytes);
    Lamp {
        towards: words.units(),
        colour: words.rgb(),
        diffuse: Weight::from_bits(words.word()),
        casts: words.word() != 0,
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

    fn length(&mut self) -> Length {
        let low = u64::from(self.word());
        let high = u64::from(self.word());
        Length::from_bits((high << 32 | low).cast_signed())
    }

    fn lengths(&mut self) -> [Length; 3] {
        [self.length(), self.length(), self.length()]
    }

    fn units(&mut self) -> [Unit; 3] {
        [self.word(), self.word(), self.word()].map(|word| Unit::from_bits(word.cast_signed()))
    }

    fn rgb(&mut self) -> Rgb {
        let [red, green, blue, _] = self.word().to_le_bytes();
        [red, green, blue]
    }
}
