//! Writing, piece by piece, into whatever takes bytes.

use rhogrid_core::camera::Camera;

use crate::{HEADER_WORDS, MAGIC, Settings, VERSION, VIEW_BYTES, View};

/// Hands a frame file to `put` in order, in pieces; returns its length in
/// bytes. The cameras' widths and heights are not stored: the settings' count
/// for all of them. `None`, with nothing put, if the file would not fit 32-bit
/// offsets.
pub fn write(
    settings: &Settings,
    views: &[View],
    asset: &[u8],
    mut put: impl FnMut(&[u8]),
) -> Option<u32> {
    let views_offset = HEADER_WORDS * 4;
    let asset_offset = views
        .len()
        .checked_mul(VIEW_BYTES)?
        .checked_add(views_offset)?;
    let length = u32::try_from(asset_offset.checked_add(asset.len())?).ok()?;
    let light = &settings.light;
    let header: [u32; HEADER_WORDS] = [
        MAGIC,
        VERSION,
        length,
        u32::from(settings.width) | u32::from(settings.height) << 16,
        views.len() as u32,
        views_offset as u32,
        asset_offset as u32,
        asset.len() as u32,
        light.towards[0].to_bits().cast_unsigned(),
        light.towards[1].to_bits().cast_unsigned(),
        light.towards[2].to_bits().cast_unsigned(),
        light.ambient.to_bits(),
        light.diffuse.to_bits(),
        settings.quality.splat.to_bits(),
        settings.quality.distortion.to_bits(),
        u32::from(settings.quality.repair) | u32::from(settings.quality.culling) << 1,
    ];
    for word in header {
        put(&word.to_le_bytes());
    }
    for view in views {
        put_camera(&view.warm_up, &mut put);
        put_camera(&view.measured, &mut put);
    }
    put(asset);
    Some(length)
}

fn put_camera(camera: &Camera, put: &mut impl FnMut(&[u8])) {
    for component in camera.eye {
        put(&component.to_bits().to_le_bytes());
    }
    for vector in [camera.right, camera.up, camera.forward] {
        for component in vector {
            put(&component.to_bits().to_le_bytes());
        }
    }
    put(&camera.focal_px.to_bits().to_le_bytes());
    put(&camera.near.to_bits().to_le_bytes());
}
