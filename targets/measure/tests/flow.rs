//! The flow on a board made of host memory: which lines it prints, and what
//! it refuses.

use std::fmt;

use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::Quality;
use rhogrid_core::numbers::{FocalPx, Length, Turns, Unit, Weight};
use rhogrid_core::scene::Lamp;
use rhogrid_core::shadow::Shadows;
use rhogrid_frame::{Content, Placed, Settings, View};
use rhogrid_measure::{Board, Buffers, Failure, run};

/// Counts a tick for each reading.
struct Bench {
    file: &'static [u8],
    printed: String,
    ticks: u32,
    stack: Option<u32>,
    shown: Option<(usize, u16, u16)>,
}

impl fmt::Write for Bench {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.printed.push_str(text);
        Ok(())
    }
}

impl Board for Bench {
    fn frame_file(&self) -> &'static [u8] {
        self.file
    }

    fn restart_timer(&mut self) {
        self.ticks = 0;
    }

    fn ticks(&mut self) -> u32 {
        self.ticks += 1;
        self.ticks
    }

    fn spin(&mut self, loops: u32) {
        self.ticks += 2 * loops;
    }

    fn paint_stack(&mut self) {}

    fn painted_over(&mut self) -> Option<u32> {
        self.stack
    }

    fn show(&mut self, colour: &'static [u16], width: u16, height: u16) -> bool {
        self.shown = Some((colour.len(), width, height));
        true
    }
}

fn bench(file: Vec<u8>) -> Bench {
    Bench {
        file: file.leak(),
        printed: String::new(),
        ticks: 0,
        stack: Some(123),
        shown: None,
    }
}

fn file(height: u16, asset: &[u8]) -> Vec<u8> {
    let orbit = Orbit {
        yaw: Turns::ZERO,
        pitch: Turns::ZERO,
        distance: Length::from_num(9),
    };
    let camera = Camera::orbit(&orbit, FocalPx::from_num(320), 240, height);
    let settings = Settings {
        width: 240,
        height,
        ambient: Weight::ZERO,
        quality: Quality::default(),
        shadows: Shadows::default(),
    };
    let lamp = Lamp {
        towards: [Unit::ONE, Unit::ZERO, Unit::ZERO],
        colour: [255; 3],
        diffuse: Weight::ONE,
        casts: true,
    };
    let view = View {
        warm_up: camera,
        measured: camera,
    };
    let mut bytes = Vec::new();
    let content = Content {
        settings,
        views: &[view; 2],
        assets: &[asset],
        instances: &[Placed::ALONE],
        lamps: &[lamp],
        matcap: None,
    };
    rhogrid_frame::write(&content, |piece| bytes.extend(piece));
    bytes
}

fn buffers() -> &'static mut Buffers {
    Box::leak(Box::new(Buffers::new()))
}

#[test]
fn no_frame_file_is_an_error_that_is_printed() {
    let mut board = bench(vec![0; 1000]);
    let failure = run(&mut board, buffers()).expect_err("zeros");
    assert!(matches!(failure, Failure::Frame(_)), "{failure:?}");
    assert_eq!(board.printed, "ERROR Frame(Magic)\n");
}

#[test]
fn a_broken_asset_is_an_error_that_is_printed() {
    let mut board = bench(file(320, b"abc"));
    let failure = run(&mut board, buffers()).expect_err("no asset");
    assert!(matches!(failure, Failure::Asset(_)), "{failure:?}");
    assert!(board.printed.starts_with("ERROR Asset("));
}
