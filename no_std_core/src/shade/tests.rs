use super::*;
use crate::normal::decode;
use crate::numbers::{Unit, Weight};
use crate::placement::{Inverse, Placement};
use crate::scene::{Lamp, Matcap};
use crate::testing::{Rng, camera, direction, dot};

const WHITE: u16 = 0xffff;

fn light(towards: [f64; 3], ambient: f64, diffuse: f64) -> Light {
    Light {
        towards: towards.map(Unit::from_num),
        ambient: Weight::from_num(ambient),
        diffuse: Weight::from_num(diffuse),
    }
}

fn channels(colour: u16) -> [u16; 3] {
    [colour >> 11, colour >> 5 & 63, colour & 31]
}

#[test]
fn table_holds_what_direct_shading_gives_within_one_of_float() {
    let mut rng = Rng::with_seed(41);
    for _ in 0..12 {
        let materials = [0; 8].map(|_| [rng.u8(..), rng.u8(..), rng.u8(..)]);
        let (ambient, diffuse) = (rng.f64(), rng.f64());
        let towards = direction(&mut rng);
        let light = light(towards, ambient, diffuse);
        let mut memory = std::vec![0; CODES * 8];
        let table = Shader::new(&light, Paint::Materials(&materials), &mut memory);
        let direct = Shader::new(&light, Paint::Materials(&materials), &mut []);
        for attribute in 0..=u16::MAX {
            let got = table.colour(attribute);
            assert_eq!(got, direct.colour(attribute), "{attribute:#x} in {light:?}");
            let normal = decode(attribute).map(|c| f64::from(c) / 16384.0);
            let weight = (ambient + diffuse * dot(normal, towards).max(0.0)).min(1.0);
            let material = materials[usize::from(attribute >> 13)];
            for ((got, value), levels) in channels(got)
                .into_iter()
                .zip(material)
                .zip([31.0, 63.0, 31.0])
            {
                let want = f64::from(value) / 255.0 * levels * weight;
                // Half a level by rounding to the nearest, 1/16 by brightness
                // steps, little by weights.
                let error = (f64::from(got) - want).abs();
                assert!(
                    error < 0.58,
                    "{attribute:#x} in {light:?}: {got}, not {want}"
                );
            }
        }
    }
}

#[test]
fn memory_that_is_too_short_is_not_used() {
    let light = light([0.0, 1.0, 0.0], 0.2, 0.8);
    let mut memory = std::vec![0xabcd; CODES * 2 - 1];
    let materials = [[255; 3]; 2];
    let shader = Shader::new(&light, Paint::Materials(&materials), &mut memory);
    assert!(shader.table.is_empty());
    assert!(memory.iter().all(|&word| word == 0xabcd));
}

#[test]
fn brightness_grows_with_the_cosine() {
    let mut rng = Rng::with_seed(42);
    for _ in 0..20 {
        let light = light(direction(&mut rng), rng.f64() / 2.0, rng.f64());
        let materials = [[255, 200, 90]];
        let shader = Shader::new(&light, Paint::Materials(&materials), &mut []);
        let mut all: std::vec::Vec<_> = (0..CODES as u16)
            .map(|code| {
                let cosine = shader.model.lamps[0].cosine(decode(code));
                let brightness = shader.model.brightness(cosine);
                (brightness, shader.colour(code))
            })
            .collect();
        all.sort_unstable();
        for pair in all.windows(2) {
            let [(below, dark), (above, bright)] = [pair[0], pair[1]];
            let grows = channels(dark)
                .iter()
                .zip(channels(bright))
                .all(|(d, b)| *d <= b);
            assert!(grows, "{below} {dark:#x}, {above} {bright:#x}: {light:?}");
        }
    }
}

#[test]
fn extremes_saturate() {
    let up = crate::normal::encode([0, 1 << 20, 0]);
    let down = up ^ crate::normal::OPPOSITE;
    let colour = |light: &Light, code| {
        Shader::new(light, Paint::Materials(&[[255; 3]]), &mut []).colour(code)
    };
    let full = light([0.0, 1.0, 0.0], 0.2, 0.8);
    assert_eq!(colour(&full, up), WHITE);
    assert_eq!(channels(colour(&full, down)), [6, 13, 6]);
    let twice = light([0.0, 1.0, 0.0], 1.0, 1.0);
    assert_eq!(colour(&twice, up), WHITE);
    assert_eq!(colour(&twice, down), WHITE);
    let none = light([0.0, 1.0, 0.0], 0.0, 0.0);
    assert_eq!(colour(&none, up), 0);
    let black = Shader::new(&twice, Paint::Materials(&[[0; 3]]), &mut []).colour(up);
    assert_eq!(black, 0);
    // A material that is not there is black, not a fault.
    assert_eq!(colour(&full, up | 7 << 13), 0);
}

#[test]
fn senseless_lights_do_no_harm() {
    for component in [Unit::MIN, Unit::MAX, Unit::ONE, -Unit::ONE, Unit::ZERO] {
        for weight in [Weight::MAX, Weight::ONE, Weight::ZERO] {
            let light = Light {
                towards: [component; 3],
                ambient: weight,
                diffuse: weight,
            };
            let shader = Shader::new(&light, Paint::Materials(&[[255; 3]]), &mut []);
            for code in 0..CODES as u16 {
                let lit = dot(
                    decode(code).map(f64::from),
                    light.towards.map(|c| c.to_num::<f64>()),
                ) > 0.0;
                let colour = shader.colour(code);
                assert!(weight != 0 || colour == 0, "{light:?}");
                assert!(weight == 0 || !lit || colour > 0, "{light:?}");
            }
        }
    }
}

/// With one lamp or none, in a table or without: ambient is the texel's share.
#[test]
fn matcaps_are_ambient_light() {
    let mut rng = Rng::with_seed(45);
    let identity = || Inverse::of(&Placement::IDENTITY).expect("has volume");
    for case in 0..40 {
        // Of one colour: where a normal is found is another test's.
        let texel = rng.u16(..);
        let texels = [texel; 16];
        let lamp = Lamp {
            towards: direction(&mut rng).map(Unit::from_num),
            colour: [255; 3],
            diffuse: Weight::from_num(rng.f64()),
            casts: true,
        };
        let lamps = [lamp];
        let lighting = Lighting {
            ambient: Weight::from_num(rng.f64()),
            matcap: Matcap::new(&texels),
            lamps: &lamps[..rng.usize(..2)],
        };
        let camera = camera(&mut rng, 4.0, 64.0);
        let normals = NormalMap::new(&Placement::IDENTITY, identity());
        let paint = Paint::Materials(&[[255, 128, 64]]);
        let mut memory = std::vec![0; CODES];
        let table = Shader::placed(&lighting, &camera, &normals, paint, &mut memory);
        let direct = Shader::placed(&lighting, &camera, &normals, paint, &mut []);
        let share = channels(texel).map(f64::from);
        let share = [share[0] / 31.0, share[1] / 63.0, share[2] / 31.0];
        for attribute in 0..CODES as u16 {
            let normal = decode(attribute).map(|c| f64::from(c) / 16384.0);
            let towards = lamp.towards.map(|c| c.to_num());
            for (unlit, lit) in [(0, lighting.lamps.len()), (1, 0)] {
                let got = direct.colour_without(attribute, unlit);
                assert_eq!(got, table.colour_without(attribute, unlit));
                let weight = lamp.diffuse.to_num::<f64>() * dot(normal, towards).max(0.0);
                let weight = if lit > 0 { weight } else { 0.0 };
                let full = [(255.0, 31.0), (128.0, 63.0), (64.0, 31.0)];
                for (channel, (value, levels)) in full.into_iter().enumerate() {
                    let light = lighting.ambient.to_num::<f64>() * share[channel] + weight;
                    let want = value / 255.0 * levels * light.min(1.0);
                    let error = (f64::from(channels(got)[channel]) - want).abs();
                    assert!(
                        error < 0.75,
                        "case {case}, {attribute:#x}: {got:#x}, {want}"
                    );
                }
            }
        }
    }
}
