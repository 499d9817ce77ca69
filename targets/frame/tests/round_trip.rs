//! What is written is read back; anything less is refused.

use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};
use rhogrid_core::placement::Placement;
use rhogrid_core::scene::{Lamp, Matcap};
use rhogrid_core::shadow::{Method, Shadows};
use rhogrid_frame::{
    Content, Frame, FrameError, MAX_ASSETS, MAX_INSTANCES, Materials, Placed, Settings, View, write,
};

/// An odd number, so that what follows needs padding.
const TEXELS: [u16; 9] = [1, 2, 3, 4, 5, 0xfffe, 7, 8, 9];

const ASSETS: [&[u8]; 3] = [b"an asset of 23 bytes...", b"", b"four"];

fn settings() -> Settings {
    Settings {
        width: 240,
        height: 320,
        ambient: Weight::from_num(0.2),
        quality: Quality {
            splat: SplatPx::from_bits(0x8001_0002),
            distortion: SplatPx::from_bits(0x2345),
            repair: false,
            culling: true,
        },
        shadows: Shadows {
            method: Method::OnePass,
            size: 1024,
            splat: SplatPx::from_bits(0x1_2345),
            bias: SplatPx::from_bits(0x6789),
        },
    }
}

fn placed() -> [Placed; 2] {
    let length =
        |index: usize| Length::from_bits(0x1234_5678_9abc - (index as i64) * 0x0013_579b_df02);
    let vector = |first: usize| [length(first), length(first + 1), length(first + 2)];
    let materials = Materials {
        count: 2,
        colours: [
            [1, 2, 3],
            [253, 254, 255],
            [0; 3],
            [0; 3],
            [0; 3],
            [0; 3],
            [0; 3],
            [0; 3],
        ],
    };
    let turned = Placed {
        asset: 2,
        placement: Placement {
            axes: [vector(0), vector(3), vector(6)],
            origin: vector(9),
        },
        materials: Some(materials),
    };
    [Placed::ALONE, turned]
}

fn lamps() -> [Lamp; 2] {
    let lamp = Lamp {
        towards: [Unit::from_num(-0.5), Unit::ONE, Unit::MIN],
        colour: [255; 3],
        diffuse: Weight::ONE,
        casts: true,
    };
    let other = Lamp {
        colour: [1, 2, 3],
        casts: false,
        ..lamp
    };
    [lamp, other]
}

fn views() -> Vec<View> {
    let camera = |yaw: f64| {
        let orbit = Orbit {
            yaw: Turns::from_num(yaw),
            pitch: Turns::from_num(0.9),
            distance: Length::from_num(2.6),
        };
        Camera::orbit(&orbit, FocalPx::from_num(319.75), 240, 320)
    };
    [0.0, 0.3, 0.6]
        .map(|yaw| View {
            warm_up: camera(yaw + 0.25),
            measured: camera(yaw),
        })
        .to_vec()
}

fn content<'a>(views: &'a [View], assets: &'a [&'a [u8]]) -> Content<'a> {
    Content {
        settings: settings(),
        views,
        assets,
        instances: &[],
        lamps: &[],
        matcap: None,
    }
}

fn written(content: &Content<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let length = write(content, |piece| bytes.extend(piece));
    assert_eq!(length, Some(bytes.len() as u32));
    bytes
}

fn file() -> Vec<u8> {
    written(&Content {
        instances: &placed(),
        lamps: &lamps(),
        matcap: Matcap::new(&TEXELS),
        ..content(&views(), &ASSETS)
    })
}

#[test]
fn everything_comes_back() {
    let mut bytes = file();
    bytes.extend([0xff; 100]);
    let frame = Frame::open(&bytes).expect("opens, with more behind it");
    assert_eq!(frame.settings(), settings());
    assert_eq!(frame.views().collect::<Vec<_>>(), views());
    assert_eq!(frame.instances().collect::<Vec<_>>(), placed());
    assert_eq!(frame.lamps().collect::<Vec<_>>(), lamps());
    assert_eq!(frame.matcap(), Matcap::new(&TEXELS));
    assert_eq!(frame.assets().collect::<Vec<_>>(), ASSETS);
    for asset in frame.assets() {
        assert_eq!((asset.as_ptr() as usize - bytes.as_ptr() as usize) % 4, 0);
    }
    assert_eq!(frame.lone_light(), None);
}

#[test]
fn one_asset_in_one_white_light_stands_alone() {
    let light = |instances: &[Placed], lamps: &[Lamp], method: Method| {
        let mut content = Content {
            instances,
            lamps,
            ..content(&[], &ASSETS)
        };
        content.settings.shadows.method = method;
        let bytes = written(&content);
        Frame::open(&bytes).expect("opens").lone_light()
    };
    let ([alone, placed], [white, tinted]) = (placed(), lamps());
    let lone = light(&[alone], &[white], Method::Off).expect("stands alone");
    assert_eq!(lone.towards, white.towards);
    assert_eq!(
        (lone.ambient, lone.diffuse),
        (settings().ambient, white.diffuse)
    );
    assert_eq!(light(&[alone], &[white], Method::TwoPass), None);
    assert_eq!(light(&[alone], &[tinted], Method::Off), None);
    assert_eq!(light(&[placed], &[white], Method::Off), None);
    assert_eq!(light(&[alone, placed], &[white], Method::Off), None);
    assert_eq!(light(&[alone], &[white, white], Method::Off), None);
    let bytes = written(&Content {
        instances: &[alone],
        lamps: &[white],
        matcap: Matcap::new(&TEXELS),
        ..content(&[], &ASSETS)
    });
    assert_eq!(Frame::open(&bytes).expect("opens").lone_light(), None);
}

#[test]
fn empty_parts_are_parts() {
    let bytes = written(&content(&[], &[]));
    let frame = Frame::open(&bytes).expect("opens");
    assert_eq!(frame.views().count(), 0);
    assert_eq!(frame.assets().count(), 0);
}

#[test]
fn too_much_is_not_written() {
    let many = [ASSETS[0]; MAX_ASSETS + 1];
    assert_eq!(write(&content(&[], &many), |_| panic!("put")), None);
    let instances = &[Placed::ALONE; MAX_INSTANCES + 1];
    let crowd = Content {
        instances,
        ..content(&[], &ASSETS)
    };
    assert_eq!(write(&crowd, |_| panic!("put")), None);
}

#[test]
fn every_truncation_is_refused() {
    let bytes = file();
    for length in 0..bytes.len() {
        let error = Frame::open(&bytes[..length]).expect_err("too short");
        assert_eq!(error, FrameError::Truncated, "at {length}");
    }
}

#[test]
fn wrong_words_are_refused() {
    let with = |offset: usize, value: u32| {
        let mut bytes = file();
        bytes[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
        Frame::open(&bytes).expect_err("wrong")
    };
    assert_eq!(with(0, 0), FrameError::Magic);
    assert_eq!(with(4, 1), FrameError::Version);
    assert_eq!(with(8, u32::MAX), FrameError::Truncated);
    assert_eq!(with(8, 64), FrameError::Layout);
    for part in [16, 24, 32, 40] {
        assert_eq!(with(part, u32::MAX), FrameError::Layout);
        assert_eq!(with(part + 4, 60), FrameError::Layout);
        assert_eq!(with(part + 4, u32::MAX), FrameError::Layout);
    }
    let word = |offset: usize| {
        let bytes = file();
        u32::from_le_bytes(bytes[offset..offset + 4].try_into().expect("a word")) as usize
    };
    let (assets, instances) = (word(28), word(36));
    assert_eq!(with(76, 8), FrameError::Matcap);
    assert_eq!(with(76, u32::MAX), FrameError::Layout);
    assert_eq!(with(80, word(80) as u32 + 1), FrameError::Alignment);
    assert_eq!(with(assets, 78), FrameError::Alignment);
    assert_eq!(with(assets, 0), FrameError::Layout);
    assert_eq!(with(assets + 4, u32::MAX), FrameError::Layout);
    assert_eq!(with(instances, 3), FrameError::Layout);
}

#[test]
fn any_single_bit_flip_in_the_header_is_survived() {
    let bytes = file();
    for bit in 0..21 * 32 {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        if let Ok(frame) = Frame::open(&flipped) {
            assert!(frame.views().count() <= 3, "bit {bit}");
        }
    }
}
