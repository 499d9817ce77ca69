//! Writing, piece by piece, into whatever takes bytes.

use rhogrid_core::asset::Rgb;
use rhogrid_core::camera::Camera;
use rhogrid_core::numbers::{Length, Unit};
use rhogrid_core::scene::Lamp;
use rhogrid_core::shadow::Method;

use crate::{
    ASSET_BYTES, Content, HEADER_WORDS, INSTANCE_BYTES, LAMP_BYTES, MAGIC, MAX_ASSETS,
    MAX_INSTANCES, Placed, TEXEL_BYTES, VERSION, VIEW_BYTES,
};

/// Hands a frame file to `put` in order, in pieces; returns its length in
/// bytes. The cameras' widths and heights are not stored: the settings' count
/// for all of them. `None`, with nothing put, if the file would not fit 32-bit
/// offsets, or there are too many assets or instances.
pub fn write(content: &Content<'_>, mut put: impl FnMut(&[u8])) -> Option<u32> {
    let fits = content.assets.len() <= MAX_ASSETS && content.instances.len() <= MAX_INSTANCES;
    let layout = Layout::of(content).filter(|_| fits)?;
    for word in header(content, &layout) {
        put(&word.to_le_bytes());
    }
    for view in content.views {
        put_camera(&view.warm_up, &mut put);
        put_camera(&view.measured, &mut put);
    }
    let mut offset = layout.bytes;
    for asset in content.assets {
        put(&offset.to_le_bytes());
        put(&(asset.len() as u32).to_le_bytes());
        offset += asset.len().next_multiple_of(4) as u32;
    }
    for placed in content.instances {
        put_placed(placed, &mut put);
    }
    for lamp in content.lamps {
        put_lamp(lamp, &mut put);
    }
    let texels = texels(content);
    for texel in texels {
        put(&texel.to_le_bytes());
    }
    if !texels.len().is_multiple_of(2) {
        put(&[0; TEXEL_BYTES]);
    }
    for asset in content.assets {
        put(asset);
        let padding = asset.len().next_multiple_of(4) - asset.len();
        put([0; 3].get(..padding).unwrap_or(&[]));
    }
    Some(layout.length)
}

fn texels<'a>(content: &Content<'a>) -> &'a [u16] {
    content.matcap.map_or(&[], |matcap| matcap.texels())
}

/// Byte offsets.
struct Layout {
    views: u32,
    assets: u32,
    instances: u32,
    lamps: u32,
    texels: u32,
    /// The first asset's bytes.
    bytes: u32,
    length: u32,
}

impl Layout {
    fn of(content: &Content<'_>) -> Option<Self> {
        let mut end = (HEADER_WORDS * 4) as u32;
        let mut part = |count: usize, size: usize| {
            let start = end;
            let length = u32::try_from(count.checked_mul(size)?).ok()?;
            end = end.checked_add(length)?;
            Some(start)
        };
        let views = part(content.views.len(), VIEW_BYTES)?;
        let assets = part(content.assets.len(), ASSET_BYTES)?;
        let instances = part(content.instances.len(), INSTANCE_BYTES)?;
        let lamps = part(content.lamps.len(), LAMP_BYTES)?;
        let texels = part(texels(content).len().next_multiple_of(2), TEXEL_BYTES)?;
        let bytes = part(0, 0)?;
        for asset in content.assets {
            part(asset.len().checked_next_multiple_of(4)?, 1)?;
        }
        Some(Self {
            views,
            assets,
            instances,
            lamps,
            texels,
            bytes,
            length: part(0, 0)?,
        })
    }
}

fn header(content: &Content<'_>, layout: &Layout) -> [u32; HEADER_WORDS] {
    let Content {
        settings, lamps, ..
    } = content;
    let method = match settings.shadows.method {
        Method::Off => 0,
        Method::TwoPass => 1,
        Method::OnePass => 2,
    };
    let switches = u32::from(settings.quality.repair) | u32::from(settings.quality.culling) << 1;
    [
        MAGIC,
        VERSION,
        layout.length,
        u32::from(settings.width) | u32::from(settings.height) << 16,
        content.views.len() as u32,
        layout.views,
        content.assets.len() as u32,
        layout.assets,
        content.instances.len() as u32,
        layout.instances,
        lamps.len() as u32,
        layout.lamps,
        settings.ambient.to_bits(),
        settings.quality.splat.to_bits(),
        settings.quality.distortion.to_bits(),
        switches | method << 2,
        u32::from(settings.shadows.size),
        settings.shadows.splat.to_bits(),
        settings.shadows.bias.to_bits(),
        texels(content).len() as u32,
        layout.texels,
    ]
}

fn put_camera(camera: &Camera, put: &mut impl FnMut(&[u8])) {
    put_lengths(camera.eye, put);
    for vector in [camera.right, camera.up, camera.forward] {
        put_units(vector, put);
    }
    put_lengths([camera.focal_px, camera.near], put);
}

fn put_placed(placed: &Placed, put: &mut impl FnMut(&[u8])) {
    put(&placed.asset.to_le_bytes());
    let count = placed.materials.map_or(0, |materials| materials.count);
    put(&u32::from(count).to_le_bytes());
    let colours = placed.materials.map(|materials| materials.colours);
    for colour in colours.unwrap_or_default() {
        put(&rgb_bits(colour).to_le_bytes());
    }
    put_lengths(placed.placement.origin, put);
    for axis in placed.placement.axes {
        put_lengths(axis, put);
    }
}

fn put_lamp(lamp: &Lamp, put: &mut impl FnMut(&[u8])) {
    put_units(lamp.towards, put);
    put(&rgb_bits(lamp.colour).to_le_bytes());
    put(&lamp.diffuse.to_bits().to_le_bytes());
    put(&u32::from(lamp.casts).to_le_bytes());
}

fn put_lengths<const COUNT: usize>(lengths: [Length; COUNT], put: &mut impl FnMut(&[u8])) {
    for length in lengths {
        put(&length.to_bits().to_le_bytes());
    }
}

fn put_units(units: [Unit; 3], put: &mut impl FnMut(&[u8])) {
    for unit in units {
        put(&unit.to_bits().to_le_bytes());
    }
}

fn rgb_bits([red, green, blue]: Rgb) -> u32 {
    u32::from(red) | u32::from(green) << 8 | u32::from(blue) << 16
}
