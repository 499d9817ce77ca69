//! What is written is read back; anything less is refused.

use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light, Quality};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};
use rhogrid_frame::{Frame, FrameError, Settings, View, write};

const ASSET: &[u8] = b"an asset of 23 bytes...";

fn settings() -> Settings {
    Settings {
        width: 240,
        height: 320,
        light: Light {
            towards: [Unit::from_num(-0.5), Unit::ONE, Unit::MIN],
            ambient: Weight::from_num(0.2),
            diffuse: Weight::ONE,
        },
        quality: Quality {
            splat: SplatPx::from_bits(0x8001_0002),
            distortion: SplatPx::from_bits(0x2345),
            repair: false,
            culling: true,
        },
    }
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

fn file(views: &[View], asset: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let length = write(&settings(), views, asset, |piece| bytes.extend(piece));
    assert_eq!(length, Some(bytes.len() as u32));
    bytes
}

#[test]
fn everything_comes_back() {
    let mut bytes = file(&views(), ASSET);
    bytes.extend([0xff; 100]);
    let frame = Frame::open(&bytes).expect("opens, with more behind it");
    assert_eq!(frame.settings(), settings());
    assert_eq!(frame.views().collect::<Vec<_>>(), views());
    assert_eq!(frame.asset(), ASSET);
    let offset = frame.asset().as_ptr() as usize - bytes.as_ptr() as usize;
    assert_eq!(offset % 4, 0);
}

#[test]
fn empty_parts_are_parts() {
    let bytes = file(&[], &[]);
    let frame = Frame::open(&bytes).expect("opens");
    assert_eq!(frame.views().count(), 0);
    assert_eq!(frame.asset(), b"");
}

#[test]
fn every_truncation_is_refused() {
    let bytes = file(&views(), ASSET);
    for length in 0..bytes.len() {
        let error = Frame::open(&bytes[..length]).expect_err("too short");
        assert_eq!(error, FrameError::Truncated, "at {length}");
    }
}

#[test]
fn wrong_words_are_refused() {
    let with = |word: usize, value: u32| {
        let mut bytes = file(&views(), ASSET);
        bytes[word * 4..word * 4 + 4].copy_from_slice(&value.to_le_bytes());
        Frame::open(&bytes).expect_err("wrong")
    };
    assert_eq!(with(0, 0), FrameError::Magic);
    assert_eq!(with(1, 1), FrameError::Version);
    assert_eq!(with(2, u32::MAX), FrameError::Truncated);
    assert_eq!(with(2, 64), FrameError::Layout);
    assert_eq!(with(4, u32::MAX), FrameError::Layout);
    assert_eq!(with(5, 60), FrameError::Layout);
    assert_eq!(with(5, u32::MAX), FrameError::Layout);
    assert_eq!(with(6, 66), FrameError::Alignment);
    assert_eq!(with(6, 0), FrameError::Layout);
    assert_eq!(with(7, u32::MAX), FrameError::Layout);
}

#[test]
fn any_single_bit_flip_in_the_header_is_survived() {
    let bytes = file(&views(), ASSET);
    for bit in 0..16 * 32 {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        if let Ok(frame) = Frame::open(&flipped) {
            assert!(frame.views().count() <= 3, "bit {bit}");
        }
    }
}
