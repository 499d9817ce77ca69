use super::*;
use crate::numbers::Length;
use crate::placement::{Inverse, Placement};
use crate::projection::DepthRange;
use crate::reciprocal::reciprocal;
use crate::shadow::Sphere;
use crate::testing::view::{looking, magnitude};
use crate::testing::{Exact, Rng, direction, dot};

fn floats(v: [Unit; 3]) -> [f64; 3] {
    v.map(|c| c.to_num())
}

/// A light space around the cube or a little more.
fn space(rng: &mut Rng) -> LightSpace {
    let sphere = Sphere {
        centre: [0; 3].map(|_| Length::from_num(rng.f64() - 0.5)),
        radius: Length::from_num(2.0 + 4.0 * rng.f64()),
    };
    let towards = direction(rng).map(Unit::from_num);
    LightSpace::new(
        towards,
        sphere,
        *rng.choice(&[16u16, 255, 256, 1024]).expect("some"),
    )
}

/// u, v and depth of a world point, exactly.
fn exact(space: &LightSpace, point: [f64; 3]) -> [f64; 3] {
    let origin = space.relative_to_middle([Length::ZERO; 3]);
    let radius = space.radius() as f64 / 2f64.powi(32);
    let from = [0, 1, 2].map(|at| point[at] + origin[at] as f64 / 2f64.powi(32));
    let size = f64::from(space.size) / 2.0;
    let middles = [size, size, 32768.0];
    [0, 1, 2].map(|at| {
        let along = dot(floats(space.axes[at]), from) / radius;
        middles[at] + along * space.reaches()[at] as f64
    })
}

/// How far tabulated w are off, relative to it.
fn chord(near: f64, far: f64) -> f64 {
    let offset = 65534.0 * near / (far - near);
    match offset < 8000.0 {
        true => 0.0,
        false => (256.0 / offset).powi(2) / 8.0 + 2f64.powi(-22),
    }
}

#[test]
fn axes_are_orthonormal() {
    let mut rng = Rng::with_seed(51);
    for _ in 0..1000 {
        let axes = space(&mut rng).axes.map(floats);
        for a in 0..3 {
            for b in 0..3 {
                let want = f64::from(u8::from(a == b));
                assert!((dot(axes[a], axes[b]) - want).abs() < 1e-8, "{axes:?}");
            }
        }
    }
}

#[test]
fn forms_are_those_of_light_space() {
    let mut rng = Rng::with_seed(52);
    for case in 0..1000 {
        let space = space(&mut rng);
        let size = magnitude(&mut rng, 1e-3, 0.5);
        let mut vector = |scale: f64| [0; 3].map(|_| Length::from_num((rng.f64() - 0.5) * scale));
        let placement = Placement {
            axes: [vector(size), vector(size), vector(size)],
            origin: vector(1.0),
        };
        let forms = space.forms(&placement);
        let model = [0; 3].map(|_| rng.f64() * 2.0 - 1.0);
        let world = [0, 1, 2].map(|at| {
            let parts = placement.axes.iter().zip(model);
            let sum: f64 = parts.map(|(axis, m)| axis[at].to_num::<f64>() * m).sum();
            sum + placement.origin[at].to_num::<f64>()
        });
        let want = exact(&space, world);
        for ((form, want), bits) in forms.iter().zip(want).zip([16, 16, 14]) {
            let sum: f64 = form
                .axes
                .iter()
                .zip(model)
                .map(|(&a, m)| a as f64 * m)
                .sum();
            let got = (form.centre as f64 + sum) / 2f64.powi(32 + bits);
            // Axes keep 2^-32 of a unit, and the scale is up to 32,000 a radius.
            assert!((got - want).abs() < 1e-4, "case {case}: {got}, not {want}");
        }
    }
}

#[test]
fn pixels_find_their_place() {
    let mut rng = Rng::with_seed(53);
    let mut checked = 0;
    for case in 0..20_000 {
        let space = space(&mut rng);
        let point = [0; 3].map(|_| rng.f64() * 2.0 - 1.0);
        let eye = direction(&mut rng).map(|c| c * magnitude(&mut rng, 1.8, 40.0));
        let focal = magnitude(&mut rng, 50.0, 2000.0);
        let away = [0, 1, 2].map(|at| point[at] - eye[at]);
        let length = dot(away, away).sqrt();
        let forward = away.map(|c| c / length);
        let camera = looking(eye, forward, direction(&mut rng), focal, 320, 240);
        let projection = Projection::new(&camera);
        let forms = Exact::new(&camera).forms(point);
        let w = (forms[2] * 2f64.powi(-projection.w_scale)) as u32;
        let depth = projection.depth(reciprocal(w));
        let slopes = &mut std::vec![0; 4096];
        let identity = Inverse::of(&Placement::IDENTITY).expect("has volume");
        let normals = NormalMap::new(&Placement::IDENTITY, identity);
        let to_w = DepthToW::new(&projection);
        let picture = PictureForms::new(&space, &camera);
        let view = (&picture, &projection, &to_w);
        let receiver = Receiver::new(&space, (&[], slopes), &normals, view, [0; 2]);
        let receiver = receiver.expect("all slopes");
        // The pixel that looks at the point, and what its own ray meets there.
        let (column, row) = (rng.u16(..320), rng.u16(..240));
        let (x, y) = (f64::from(column) - 159.5, f64::from(row) - 119.5);
        let axis = |v: [Unit; 3]| floats(v);
        let seen = [0, 1, 2].map(|at| {
            let along = axis(camera.right)[at] * x / focal - axis(camera.up)[at] * y / focal;
            eye[at] + forms[2] * (along + axis(camera.forward)[at])
        });
        let first = rng.u16(..=column);
        let line = receiver.row(first, row);
        let got = receiver.place(&line, usize::from(column - first), u32::from(depth) << 16);
        let want = exact(&space, seen);
        let radius = space.radius() as f64 / 2f64.powi(32);
        // Depth resolves half a step and errs as it says; the reciprocal by 2^-18.9.
        let range = DepthRange::of(&camera);
        let (near, far) = (range.near.to_num::<f64>(), range.far.to_num::<f64>());
        let w = forms[2];
        let steps = 2.5 + 65534.0 * (near / w + near / far) * far / (far - near) * 2f64.powf(-18.8);
        let w_error = w
            * (w * steps * (1.0 / near - 1.0 / far) / 65534.0
                + 2f64.powf(-18.9)
                + chord(near, far));
        let oblique = (1.0 + (x * x + y * y) / (focal * focal)).sqrt();
        for (axis, bits) in [(0, TEXEL_BITS), (1, TEXEL_BITS), (2, DEPTH_BITS)] {
            let got = f64::from(got[axis]) / 2f64.powi(bits);
            let scale = space.reaches()[axis] as f64 / radius;
            let bound = w_error * oblique * scale + 2.0 / 2f64.powi(bits);
            assert!(
                (got - want[axis]).abs() < bound,
                "case {case}, axis {axis}: {got}, not {} within {bound}",
                want[axis]
            );
            checked += 1;
        }
    }
    assert!(checked > 50_000);
}
