use super::*;
use crate::asset::Rgb;
use crate::canvas::canvas_len;
use crate::draw::Light;
use crate::numbers::{Unit, Weight};
use crate::shade::Paint;
use crate::splat::{Extent, Splat, draw};
use crate::target::{Rect, Target};
use crate::testing::Rng;
use std::vec::Vec;

const MATERIALS: [Rgb; 8] = [[255; 3]; 8];

/// Every pixel by the definition: what it shows, as a word or two.
fn shown(words: &[Vec<u32>], x: usize, y: usize, gap: Gap) -> Vec<u32> {
    let at = |x: usize, y: usize| u64::from(words[y][x]);
    let own = at(x, y);
    let needed = |word: u64| match word {
        0 => 0,
        _ => (word + u64::from(gap.base) + (word >> gap.shift)).min(u64::from(u32::MAX)),
    };
    let mut best: Option<[u64; 2]> = None;
    for [dx, dy] in [[1, 0], [0, 1], [1, 1], [-1, 1]] {
        let beside = |sign: i32| {
            let along = |from: usize, step: i32| (from as i32 + sign * step) as usize;
            at(along(x, dx), along(y, dy))
        };
        let pair = [beside(-1), beside(1)];
        let deeper = |[a, b]: [u64; 2]| a.min(b);
        if deeper(pair) > needed(own) && best.is_none_or(|best| deeper(pair) > deeper(best)) {
            best = Some(pair);
        }
    }
    let beside = [-1i32, 0, 1].map(|dy| [-1i32, 0, 1].map(|dx| [dx, dy]));
    let nearer = beside.into_iter().flatten().filter(|&[dx, dy]| {
        let word = at((x as i32 + dx) as usize, (y as i32 + dy) as usize);
        [dx, dy] != [0, 0] && word > needed(own)
    });
    let nearer: Vec<[i32; 2]> = nearer.collect();
    let is_before = |&[dx, dy]: &[i32; 2]| dy < 0 || dy == 0 && dx < 0;
    if best.is_none()
        && nearer.len() >= 4
        && nearer.iter().any(is_before)
        && !nearer.iter().all(is_before)
    {
        let pairs = [[at(x, y - 1), at(x, y + 2)], [at(x, y - 2), at(x, y + 1)]];
        let closes = |pair: &[u64; 2]| pair.iter().all(|&word| word > needed(own));
        best = pairs.into_iter().find(closes);
    }
    match best {
        Some(pair) => pair.map(|word| word as u32).to_vec(),
        None => std::vec![own as u32],
    }
}

/// A strip of random points, some of them sparse, against the definition.
#[test]
fn pixels_are_those_of_the_definition() {
    let mut rng = Rng::with_seed(81);
    let light = Light {
        towards: [Unit::ZERO, Unit::ONE, Unit::ZERO],
        ambient: Weight::lit("0.2"),
        diffuse: Weight::lit("0.8"),
    };
    let mut shades = std::vec![0; crate::draw::shades_len(8)];
    let shader = Shader::new(&light, Paint::Materials(&MATERIALS), &mut shades);
    let colour_of = |word: u32| match word {
        0 => 0,
        _ => shader.colour(word as u16),
    };
    let mut closed = 0;
    for case in 0..600 {
        let (width, height) = (rng.u16(1..40), rng.u16(1..24));
        let gap = Gap {
            base: rng.u32(..1 << 14) << 16 >> rng.u32(..14),
            shift: rng.u32(2..20),
        };
        let share = rng.f64();
        let strip = Rect {
            left: 0,
            top: 0,
            right: width,
            bottom: height,
        };
        let mut memory = std::vec![0; canvas_len(height)];
        let mut canvas = Canvas::<u32>::new(&mut memory, strip);
        // What counts around the strip, too.
        let mut words = std::vec![std::vec![0; usize::from(width) + 2]; usize::from(height) + 4];
        for (y, row) in words.iter_mut().enumerate() {
            for (x, word) in row.iter_mut().enumerate() {
                if rng.f64() >= share {
                    continue;
                }
                let most = if rng.bool() { 20 } else { 65535 };
                let depth = 1 + rng.u16(..most);
                let attribute = rng.u16(..);
                *word = u32::from(depth) << 16 | u32::from(attribute);
                let pixel = |at: usize, around: i32| ((at as i32 - around) << 12) + (1 << 11);
                let splat = Splat {
                    x: pixel(x, 1),
                    y: pixel(y, 2),
                    depth,
                    attribute,
                    sample: (),
                };
                let extent = Extent {
                    half: [0; 2],
                    rim_drop: 1,
                };
                draw(&mut canvas, &splat, &extent);
            }
        }
        let pixels = usize::from(width) * usize::from(height);
        let (mut colour, mut depth) = (std::vec![7; pixels], std::vec![7; pixels]);
        let mut unused = std::vec![0; canvas_len(1)];
        let mut target = Target::new(width, height, &mut colour, &mut unused)
            .and_then(|target| target.with_depth(&mut depth))
            .expect("buffers fit");
        resolve(&canvas, strip, Some(gap), &shader, &mut target.picture);
        for index in 0..pixels {
            let (x, y) = (index % usize::from(width), index / usize::from(width));
            let want = shown(&words, x + 1, y + 2, gap);
            closed += usize::from(want.len() == 2);
            let colours: Vec<u16> = want.iter().map(|&word| colour_of(word)).collect();
            let channel = |shift: u32, bits: u16| {
                let sum: u16 = colours.iter().map(|colour| colour >> shift & bits).sum();
                sum / want.len() as u16
            };
            let mean = channel(11, 31) << 11 | channel(5, 63) << 5 | channel(0, 31);
            assert_eq!(colour[index], mean, "case {case}: {x}, {y}: {want:?}");
            let deepest = want.iter().map(|word| word >> 16).min();
            assert_eq!(
                u32::from(depth[index]),
                deepest.unwrap(),
                "case {case}: {x}, {y}"
            );
        }
    }
    assert!(closed > 1000, "{closed} holes closed");
}
