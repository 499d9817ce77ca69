//! Several lamps, and matcaps.

use super::*;
use crate::view::Matcap;

/// Red from the right and blue from above, on a square that faces both at 60
/// degrees and the eye; one of them in a shadow or not.
#[test]
fn lamps_add_up() {
    let lamp = |towards: DVec3, colour, casts| Lamp {
        towards: towards.normalize(),
        colour,
        diffuse: 0.5,
        casts,
    };
    let slant = 3f64.sqrt();
    let lamps = |casts| {
        vec![
            lamp(DVec3::new(slant, 0.0, 1.0), [255, 0, 0], casts),
            lamp(DVec3::new(0.0, slant, 1.0), [0, 0, 255], false),
        ]
    };
    let lighting = |casts| Lighting {
        ambient: 0.25,
        matcap: None,
        lamps: lamps(casts),
    };
    // What stands on the right shades the middle from the red one.
    let mut wall = square(DVec3::new(slant, 0.0, 1.0), 0.3);
    wall.positions.iter_mut().for_each(|position| {
        let offset = *position - DVec3::new(slant, 0.0, 1.0);
        *position = DVec3::new(slant, offset.y, 1.0 + offset.x);
    });
    let mesh = joined(square(DVec3::ZERO, 1.0), wall);
    let scene = Scene::new(&Geometry::Mesh(mesh), false);
    let view = view(DVec3::Z * 5.0, DVec3::ZERO, 1, 1);
    let ray = Ray::new((view.eye - scene.centre) / scene.radius, view.forward);
    for (casts, red) in [(false, 0.5), (true, 0.25)] {
        let lighting = lighting(casts);
        let sight = scene.look(&ray, &view, &lighting).expect("a hit");
        let want = DVec3::new(red, 0.25, 0.5) * 255.0;
        assert!((sight.colour - want).length() < 1e-4, "{}", sight.colour);
        assert_eq!((sight.shadowed, sight.lambert > 0.4), (casts, casts));
    }
}

/// Each texel of the lit sphere has its colour where the sphere's picture has it.
#[test]
fn a_sphere_shows_its_matcap() {
    let texels: Vec<u16> = (0..16).map(|texel| texel * 2113).collect();
    let lighting = Lighting {
        ambient: 1.0,
        matcap: Some(Matcap {
            texels: texels.clone(),
        }),
        lamps: Vec::new(),
    };
    let scene = Scene::new(&Geometry::Mesh(sphere(DVec3::ZERO, 1.0, 200)), false);
    // From far away the picture is the sphere's.
    let view = View {
        focal_px: 32.0 * 1000.0,
        ..view(DVec3::Z * 1000.0, DVec3::ZERO, 64, 64)
    };
    let drawn = render(&scene, &view, &lighting, 1, &|_| ());
    let mut seen = 0;
    for (index, (colour, coverage)) in drawn.colour.iter().zip(&drawn.coverage).enumerate() {
        let place = [index % 64, index / 64];
        let is_inside = |at: usize| (2..14).contains(&(at % 16));
        if *coverage > 0.0 && place.into_iter().all(is_inside) {
            let texel = texels[place[1] / 16 * 4 + place[0] / 16];
            assert_eq!(*colour, crate::picture::widen_rgb565(texel), "{place:?}");
            seen += 1;
        }
    }
    assert!(seen > 1000, "{seen}");
}
