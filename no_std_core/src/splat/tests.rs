use super::*;
use crate::canvas::{PITCH, canvas_len};
use crate::target::Rect;
use crate::testing::Rng;
use std::string::String;
use std::vec::Vec;

const CORE: u16 = 1000;
const DROP: u16 = 10;

/// A strip with the memory it needs.
struct Board {
    words: Vec<u32>,
    strip: Rect,
    splats: Vec<(Splat<()>, Extent)>,
}

impl Board {
    fn new(left: u16, top: u16, right: u16, bottom: u16) -> Self {
        Self {
            words: std::vec![0; canvas_len(bottom - top)],
            strip: Rect {
                left,
                top,
                right,
                bottom,
            },
            splats: Vec::new(),
        }
    }

    fn draw(&mut self, splat: &Splat<()>, extent: &Extent) {
        self.splats.push((*splat, *extent));
    }

    /// The words of the strip, row after row.
    fn pixels(&mut self) -> Vec<u32> {
        let strip = self.strip;
        let mut canvas = Canvas::new(&mut self.words, strip);
        for (splat, extent) in &self.splats {
            draw(&mut canvas, splat, extent);
        }
        let rows = strip.top..strip.bottom;
        let row = |row| {
            let words = canvas.neighbourhoods(&(strip.left..strip.right), row);
            let line = words.expect("the canvas holds the strip").iter();
            let line = line.skip(2 * PITCH + 1).take(strip.width());
            line.copied().collect::<Vec<u32>>()
        };
        rows.flat_map(row).collect()
    }

    fn depths(&mut self) -> Vec<u16> {
        let pixels = self.pixels();
        pixels.iter().map(|pixel| (pixel >> 16) as u16).collect()
    }

    /// `#` core, `+` rim, `.` nothing, as drawn by [`at`].
    fn map(&mut self) -> Vec<String> {
        let letter = |depth: &u16| match *depth {
            0 => '.',
            CORE => '#',
            depth if depth == CORE - DROP => '+',
            depth => panic!("depth {depth}"),
        };
        let depths = self.depths();
        let rows = depths.chunks(self.strip.width());
        rows.map(|row| row.iter().map(letter).collect()).collect()
    }
}

/// A splat at a place in pixels.
fn at(x: f64, y: f64) -> Splat<()> {
    let bits = |v: f64| (v * f64::from(SCREEN_ONE)) as i32;
    Splat {
        x: bits(x),
        y: bits(y),
        depth: CORE,
        attribute: 7,
        sample: (),
    }
}

/// An extent by its half sides in pixels.
fn half(x: f64, y: f64) -> Extent {
    let bits = |v: f64| (v * f64::from(SCREEN_ONE)) as i32;
    Extent {
        half: [bits(x), bits(y)],
        rim_drop: DROP,
    }
}

#[test]
fn coverage_is_that_of_pixel_centres() {
    let cases: [(Splat<()>, Extent, [&str; 5]); 9] = [
        // Nearly nothing: the home pixel, wherever in it the centre lies.
        (
            at(3.0, 2.0),
            half(0.0, 0.0),
            [".......", ".......", "...#...", ".......", "......."],
        ),
        (
            at(3.99, 2.99),
            half(0.1, 0.1),
            [".......", ".......", "...#...", ".......", "......."],
        ),
        // One pixel wide, a quarter off: still one column.
        (
            at(3.25, 2.5),
            half(0.5, 0.5),
            [".......", ".......", "...#...", ".......", "......."],
        ),
        // Three pixels: a core of the middle one, half its size around it.
        (
            at(3.5, 2.5),
            half(1.5, 1.5),
            [".......", "..+++..", "..+#+..", "..+++..", "......."],
        ),
        // Five by three.
        (
            at(3.5, 2.5),
            half(2.5, 1.5),
            [".......", ".+++++.", ".+###+.", ".+++++.", "......."],
        ),
        // On a corner: low ends belong, high ends do not.
        (
            at(3.0, 2.0),
            half(1.5, 0.5),
            [".......", ".+++...", ".+##...", ".......", "......."],
        ),
        // A row of the home pixel only, four columns.
        (
            at(3.0, 2.5),
            half(2.0, 0.0),
            [".......", ".......", ".+##+..", ".......", "......."],
        ),
        // Over the left and top edge, over the right and bottom edge.
        (
            at(0.5, 0.5),
            half(1.5, 1.5),
            ["#+.....", "++.....", ".......", ".......", "......."],
        ),
        (
            at(6.5, 4.5),
            half(1.5, 1.5),
            [".......", ".......", ".......", ".....++", ".....+#"],
        ),
    ];
    for (splat, extent, want) in cases {
        let mut canvas = Board::new(0, 0, 7, 5);
        canvas.draw(&splat, &extent);
        let map = canvas.map();
        assert_eq!(map, want, "{splat:?} {extent:?}\n{}", map.join("\n"));
    }
}

#[test]
fn a_band_has_the_pixels_of_the_whole() {
    let mut rng = Rng::with_seed(31);
    for case in 0..2000 {
        let (left, top) = (rng.u16(..16), rng.u16(..16));
        let (right, bottom) = (rng.u16(left + 1..=16), rng.u16(top + 1..=16));
        let mut whole = Board::new(0, 0, 16, 16);
        let mut band = Board::new(left, top, right, bottom);
        for _ in 0..rng.u32(1..8) {
            let mut place = || 24.0 * rng.f64() - 4.0;
            let mut splat = at(place(), place());
            splat.attribute = rng.u16(..);
            splat.depth = rng.u16(1..40);
            let extent = half(6.0 * rng.f64(), 6.0 * rng.f64());
            whole.draw(&splat, &extent);
            band.draw(&splat, &extent);
        }
        let mut inside = band.pixels().into_iter();
        let all = whole.pixels();
        for y in top..bottom {
            for x in left..right {
                let pixel = usize::from(y) * 16 + usize::from(x);
                let own = inside.next().expect("as many as the band has");
                assert_eq!(
                    own, all[pixel],
                    "case {case}: pixel {x}, {y} of {:?}",
                    band.strip
                );
            }
        }
    }
}

#[test]
fn splats_that_tile_leave_no_gap() {
    let mut rng = Rng::with_seed(32);
    for case in 0..4000 {
        let half_side = [0, 1].map(|_| rng.i32(1..2 * SCREEN_ONE));
        let first = [0, 1].map(|_| rng.i32(-SCREEN_ONE..4 * SCREEN_ONE));
        let extent = Extent {
            half: half_side,
            rim_drop: DROP,
        };
        let mut canvas = Board::new(0, 0, 24, 24);
        let count = 6;
        for row in 0..count {
            for column in 0..count {
                let splat = Splat {
                    x: first[0] + 2 * half_side[0] * column,
                    y: first[1] + 2 * half_side[1] * row,
                    depth: CORE,
                    attribute: 7,
                    sample: (),
                };
                canvas.draw(&splat, &extent);
            }
        }
        let covers = |axis: usize, pixel: i32| {
            let centre = pixel * SCREEN_ONE + SCREEN_ONE / 2;
            let low = first[axis] - half_side[axis];
            (low..low + 2 * half_side[axis] * count).contains(&centre)
        };
        for (index, depth) in canvas.depths().into_iter().enumerate() {
            let (x, y) = (index as i32 % 24, index as i32 / 24);
            assert!(
                depth > 0 || !(covers(0, x) && covers(1, y)),
                "case {case}: hole at {x}, {y}; first {first:?}, half {half_side:?}"
            );
        }
    }
}

#[test]
fn rims_never_cover_cores_of_equal_depth() {
    for drop in [1, DROP, u16::MAX] {
        for depth in [1, 2, CORE, u16::MAX] {
            let extent = Extent {
                rim_drop: drop,
                ..half(2.5, 2.5)
            };
            let mut canvas = Board::new(0, 0, 9, 9);
            let mut splat = at(3.5, 4.5);
            (splat.depth, splat.attribute) = (depth, 1);
            canvas.draw(&splat, &extent);
            let word = |attribute: u32| u32::from(depth) << 16 | attribute;
            assert_eq!(canvas.pixels()[4 * 9 + 3], word(1));
            splat.x += 2 * SCREEN_ONE;
            splat.attribute = 2;
            canvas.draw(&splat, &extent);
            assert_eq!(canvas.pixels()[4 * 9 + 3], word(1), "drop {drop}");
            // The neighbour's core wins over the first's rim, if it is nearer.
            let want = if depth == 1 { 1 } else { 2 };
            assert_eq!(canvas.pixels()[4 * 9 + 5], word(want), "drop {drop}");
        }
    }
}

#[test]
fn of_equal_depths_the_first_stays() {
    let mut canvas = Board::new(0, 0, 1, 1);
    for (depth, attribute) in [(5, 1), (5, 2), (4, 3), (6, 4), (6, 5)] {
        let splat = Splat {
            depth,
            attribute,
            ..at(0.5, 0.5)
        };
        canvas.draw(&splat, &half(0.5, 0.5));
    }
    assert_eq!(canvas.pixels()[0], 6 << 16 | 4);
}

#[test]
fn saturated_places_and_extents_do_not_overflow() {
    // What projection may give: +-2^30 and the middle, half sides to 2^29.
    let far = (1 << 30) + (2048 << SCREEN_BITS);
    for x in [-far, 0, far] {
        for y in [-far, 0, far] {
            for side in [0, 1 << 29] {
                let splat = Splat {
                    x,
                    y,
                    depth: CORE,
                    attribute: 7,
                    sample: (),
                };
                let extent = Extent {
                    half: [side, side],
                    rim_drop: DROP,
                };
                let mut canvas = Board::new(0, 0, 2, 2);
                canvas.draw(&splat, &extent);
                let holds = x == 0 && y == 0;
                assert_eq!(canvas.depths()[0] > 0, holds, "{splat:?} {extent:?}");
            }
        }
    }
}
