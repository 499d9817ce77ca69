//! The reference against closed forms and against its own naive twin.

mod lights;

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::hierarchy::tests::Random;
use super::*;
use crate::geometry::{Cloud, Material, Mesh, OrientedPoint, Triangle};
use crate::view::Light;

const LIGHT: Light = Light {
    towards: DVec3::new(0.0, 0.0, 1.0),
    ambient: 0.2,
    diffuse: 0.8,
    casts: false,
};

/// Looks from `eye` to `target`, 45 degrees across the height.
fn view(eye: DVec3, target: DVec3, width: u32, height: u32) -> View {
    let forward = (target - eye).normalize();
    let aside = if forward.y.abs() > 0.9 {
        DVec3::Z
    } else {
        DVec3::Y
    };
    let right = forward.cross(aside).normalize();
    View {
        eye,
        right,
        up: right.cross(forward),
        forward,
        focal_px: View::focal_px(45.0, height),
        width,
        height,
    }
}

/// A sphere as a closed mesh of `rings` by `2 * rings` quads around shared
/// vertices, with the sphere's normals.
fn sphere(centre: DVec3, radius: f64, rings: u32) -> Mesh {
    let columns = 2 * rings;
    let mut directions = vec![DVec3::Y, DVec3::NEG_Y];
    for ring in 1..rings {
        let (sin, cos) = (TAU / 2.0 * f64::from(ring) / f64::from(rings)).sin_cos();
        for column in 0..columns {
            let turn = TAU * f64::from(column) / f64::from(columns);
            directions.push(DVec3::new(sin * turn.sin(), cos, sin * turn.cos()));
        }
    }
    let vertex = |ring: u32, column: u32| match ring {
        0 => 0,
        _ if ring == rings => 1,
        _ => 2 + (ring - 1) * columns + column % columns,
    };
    let mut corners = Vec::new();
    for ring in 0..rings {
        for column in 0..columns {
            let [a, b] = [vertex(ring, column), vertex(ring, column + 1)];
            let [c, d] = [vertex(ring + 1, column), vertex(ring + 1, column + 1)];
            corners.extend([[a, c, d], [a, d, b]]);
        }
    }
    corners.retain(|[a, b, c]| a != b && b != c && c != a);
    Mesh {
        positions: directions
            .iter()
            .map(|&direction| centre + direction * radius)
            .collect(),
        normals: directions
            .iter()
            .map(|direction| direction.as_vec3())
            .collect(),
        triangles: corners.into_iter().map(white).collect(),
        materials: vec![Material::white()],
        colours: Vec::new(),
        two_sided: false,
    }
}

fn white(corners: [u32; 3]) -> Triangle {
    Triangle {
        positions: corners,
        normals: corners,
        material: 0,
    }
}

/// A square in the xy plane, its front towards +z.
fn square(centre: DVec3, half_side: f64) -> Mesh {
    let corner = |x: f64, y: f64| centre + DVec3::new(x, y, 0.0) * half_side;
    Mesh {
        positions: vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ],
        normals: vec![Vec3::Z; 4],
        triangles: vec![white([0, 1, 2]), white([0, 2, 3])],
        materials: vec![Material::white()],
        colours: Vec::new(),
        two_sided: false,
    }
}

fn joined(mut first: Mesh, second: Mesh) -> Mesh {
    let (positions, normals) = (first.positions.len() as u32, first.normals.len() as u32);
    first
        .triangles
        .extend(second.triangles.iter().map(|triangle| Triangle {
            positions: triangle.positions.map(|corner| corner + positions),
            normals: triangle.normals.map(|normal| normal + normals),
            ..*triangle
        }));
    first.positions.extend(second.positions);
    first.normals.extend(second.normals);
    first
}

fn draw(mesh: Mesh, two_sided: bool, view: &View, light: &Light) -> Reference {
    let scene = Scene::new(&Geometry::Mesh(mesh), two_sided);
    render(
        &scene,
        view,
        &(*light).into(),
        DEFAULT_SAMPLES_PER_AXIS,
        &|_| (),
    )
}

/// Where a ray first meets a sphere, in multiples of its direction.
fn first_hit(eye: DVec3, direction: DVec3, centre: DVec3, radius: f64) -> Option<f64> {
    let to_eye = eye - centre;
    let (a, half_b) = (direction.length_squared(), to_eye.dot(direction));
    let c = to_eye.length_squared() - radius * radius;
    let discriminant = half_b * half_b - a * c;
    (discriminant >= 0.0).then(|| (-half_b - discriminant.sqrt()) / a)
}

/// Colour, depth and coverage of a finely tessellated sphere, at many sizes and
/// places, against the sphere.
#[test]
fn sphere_agrees_with_the_closed_form() {
    let light = Light {
        towards: DVec3::new(1.0, 2.0, 1.5).normalize(),
        ..LIGHT
    };
    let cases = [
        (1.0, DVec3::ZERO),
        (1e-6, DVec3::new(1e-6, 2e-6, -5e-6)),
        (1e6, DVec3::new(-3e6, 1e6, 2e6)),
        (1.0, DVec3::new(1e6, -2e6, 3e6)),
    ];
    for (radius, centre) in cases {
        let eye = centre + DVec3::new(1.2, 0.9, 2.4) * radius;
        let view = view(eye, centre, 61, 67);
        let drawn = draw(sphere(centre, radius, 128), false, &view, &light);
        let mut inside = 0;
        for y in 0..view.height {
            for x in 0..view.width {
                let pixel = (y * view.width + x) as usize;
                let at = format!("radius {radius}, centre {centre}, pixel {x},{y}");
                let look = |x_px: f64, y_px: f64, grow: f64| {
                    let direction = view.direction(f64::from(x) + x_px, f64::from(y) + y_px);
                    let distance = first_hit(eye, direction, centre, radius * grow)?;
                    Some((distance, eye + direction * distance))
                };
                let touches = |grow: f64| {
                    let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.5)];
                    corners.map(|(x_px, y_px)| look(x_px, y_px, grow).is_some())
                };
                if touches(1.03) == [false; 5] {
                    assert_eq!(drawn.coverage[pixel], 0.0, "{at}");
                    assert_eq!(drawn.colour[pixel], [0; 3], "{at}");
                    assert_eq!(
                        (drawn.nearest[pixel], drawn.farthest[pixel]),
                        (f32::INFINITY, 0.0)
                    );
                }
                if touches(0.97) != [true; 5] {
                    continue;
                }
                inside += 1;
                assert_eq!(drawn.coverage[pixel], 1.0, "{at}");
                let Some((depth, point)) = look(0.5, 0.5, 1.0) else {
                    panic!("{at}: no hit")
                };
                let (nearest, farthest) = (drawn.nearest[pixel], drawn.farthest[pixel]);
                let middle = f64::from(nearest.midpoint(farthest));
                assert!(
                    nearest <= farthest && (middle - depth).abs() < 4e-3 * radius,
                    "{at}"
                );
                let lambert = (point - centre).normalize().dot(light.towards).max(0.0);
                let expected = 255.0 * (0.2 + 0.8 * lambert);
                for channel in drawn.colour[pixel] {
                    assert!(
                        (f64::from(channel) - expected).abs() < 2.0,
                        "{at}: {expected}"
                    );
                }
            }
        }
        assert!(inside > 1000, "only {inside} pixels inside");
    }
}

/// Rays exactly at the shared vertices and edges of a lattice, along an axis,
/// where every edge function is exactly zero.
#[test]
fn shared_edges_do_not_leak() {
    let scene = Scene::new(&Geometry::Mesh(sphere(DVec3::ZERO, 1.0, 24)), false);
    let Surface::Mesh { facets, .. } = &scene.surface else {
        panic!("a mesh")
    };
    let eye = DVec3::new(0.3, 0.2, 4.0);
    for facet in facets.shapes() {
        let [a, b, c] = facet.corners.map(Vec3::as_dvec3);
        for target in [
            a,
            b,
            c,
            a.midpoint(b),
            b.midpoint(c),
            c.midpoint(a),
            a.lerp(b, 0.3),
        ] {
            if target.dot(eye - target) < 0.5 {
                continue; // behind, or where a silhouette may run
            }
            let ray = Ray::new(eye, target - eye);
            let hit = facets
                .nearest(&ray, Sides::Front)
                .map(|(_, hit)| hit.distance);
            assert!(
                hit.is_some_and(|distance| (distance - 1.0).abs() < 1e-3),
                "ray to {target}: {hit:?}"
            );
        }
    }
    // Parallel to two axes, through a lattice of right angles.
    let mut plate = square(DVec3::ZERO, 1.0);
    plate.positions.push(DVec3::ZERO);
    plate.normals.push(Vec3::Z);
    plate.triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
        .map(white)
        .to_vec();
    let scene = Scene::new(&Geometry::Mesh(plate), false);
    for (x, y) in [
        (0.0, 0.0),
        (0.25, 0.25),
        (0.0, 0.5),
        (-0.25, 0.25),
        (0.1, -0.1),
    ] {
        let ray = Ray::new(DVec3::new(x, y, 3.0), DVec3::NEG_Z);
        let view = view(DVec3::Z * 3.0, DVec3::ZERO, 1, 1);
        let sight = scene.look(&ray, &view, &LIGHT.into()).expect("a hit");
        assert_eq!(
            (sight.distance, sight.colour),
            (3.0, DVec3::splat(255.0)),
            "{x}, {y}"
        );
    }
}

/// The colour of the middle pixel of a square seen from +z or -z.
fn seen_from(side: f64, normal: Vec3, two_sided: bool, light_side: f64) -> Option<u8> {
    let mut mesh = square(DVec3::ZERO, 1.0);
    mesh.normals.fill(normal);
    let view = view(DVec3::Z * 3.0 * side, DVec3::ZERO, 5, 5);
    let light = Light {
        towards: DVec3::Z * light_side,
        ..LIGHT
    };
    let drawn = draw(mesh, two_sided, &view, &light);
    (drawn.coverage[12] == 1.0).then_some(drawn.colour[12][0])
}

#[test]
fn sides() {
    let (lit, unlit) = (Some(255), Some(51));
    // One-sided: only the front is there, shaded with its normal as it is.
    assert_eq!(seen_from(1.0, Vec3::Z, false, 1.0), lit);
    assert_eq!(seen_from(1.0, Vec3::Z, false, -1.0), unlit);
    assert_eq!(seen_from(-1.0, Vec3::Z, false, -1.0), None);
    assert_eq!(seen_from(1.0, Vec3::NEG_Z, false, 1.0), unlit);
    assert_eq!(seen_from(1.0, Vec3::NEG_Z, false, -1.0), lit);
    // Two-sided: lit where the side that is seen faces the light.
    for normal in [Vec3::Z, Vec3::NEG_Z] {
        for side in [1.0, -1.0] {
            assert_eq!(seen_from(side, normal, true, side), lit, "{normal} {side}");
            assert_eq!(
                seen_from(side, normal, true, -side),
                unlit,
                "{normal} {side}"
            );
        }
    }
}

/// What lies behind an absent back face is seen, and gives the depth.
#[test]
fn rays_pass_through_back_faces() {
    let mut near = square(DVec3::Z, 1.0);
    near.triangles
        .iter_mut()
        .for_each(|triangle| triangle.positions.reverse());
    let both = joined(near, square(DVec3::ZERO, 1.0));
    let view = view(DVec3::Z * 4.0, DVec3::ZERO, 5, 5);
    let depth = |two_sided| draw(both.clone(), two_sided, &view, &LIGHT).nearest[12];
    assert!((depth(false) - 4.0).abs() < 1e-6 && (depth(true) - 3.0).abs() < 1e-6);
}

/// A front face stays, whatever its interpolated normal says.
#[test]
fn normals_that_face_away_are_kept() {
    let mut mesh = square(DVec3::ZERO, 1.0);
    mesh.normals = [-1.0, 1.0, 1.0, -1.0]
        .map(|x| Vec3::new(x, 0.0, -0.2).normalize())
        .to_vec();
    let view = view(DVec3::Z * 3.0, DVec3::ZERO, 9, 9);
    let light = Light {
        towards: DVec3::X,
        ..LIGHT
    };
    let row = |two_sided| -> Vec<u8> {
        let drawn = draw(mesh.clone(), two_sided, &view, &light);
        assert!(
            drawn.coverage[4 * 9 + 2..4 * 9 + 7]
                .iter()
                .all(|&share| share == 1.0)
        );
        drawn.colour[4 * 9 + 2..4 * 9 + 7]
            .iter()
            .map(|rgb| rgb[0])
            .collect()
    };
    // The light comes from the right, and so do the normals of the right half.
    let one_sided = row(false);
    assert!(one_sided[0] == 51 && one_sided[4] > 200, "{one_sided:?}");
    // Turned over, the left half is lit.
    let two_sided = row(true);
    assert!(two_sided[0] > 200 && two_sided[4] == 51, "{two_sided:?}");
}

/// A plate of half side 0.5 at height 1 above a floor of half side 2, lit at 45
/// degrees: its shadow is the same square, shifted by 1 in x.
#[test]
fn plate_casts_its_shadow() {
    for turned_over in [false, true] {
        let mut plate = square(DVec3::Z, 0.5);
        if turned_over {
            plate
                .triangles
                .iter_mut()
                .for_each(|triangle| triangle.positions.reverse());
        }
        let scene = joined(square(DVec3::ZERO, 2.0), plate);
        let view = view(DVec3::new(3.0, 0.0, 6.0), DVec3::ZERO, 64, 64);
        let light = Light {
            towards: DVec3::new(-1.0, 0.0, 1.0).normalize(),
            casts: true,
            ..LIGHT
        };
        let drawn = draw(scene, false, &view, &light);
        let level = (255.0 * (0.2 + 0.8 * 0.5_f64.sqrt())).round() as u8;
        let (mut lit, mut dark) = (0, 0);
        for pixel in 0..drawn.colour.len() {
            let (x, y) = (pixel as u32 % 64, pixel as u32 / 64);
            let direction = view.direction(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let floor = view.eye - direction * (view.eye.z / direction.z);
            let plate = view.eye - direction * ((view.eye.z - 1.0) / direction.z);
            let around = |point: DVec3| point.x.abs().max(point.y.abs());
            let shadow = around(floor - DVec3::X);
            let margin = 0.15;
            if around(floor) > 2.0 - margin || (around(plate) < 0.5 + margin && !turned_over) {
                continue; // a rim or the plate
            }
            if shadow < 0.5 - margin {
                assert_eq!(drawn.colour[pixel], [51; 3], "{x},{y} at {floor}");
                dark += 1;
            } else if shadow > 0.5 + margin {
                assert_eq!(drawn.colour[pixel], [level; 3], "{x},{y} at {floor}");
                lit += 1;
            }
        }
        assert!(lit > 500 && dark > 20, "{lit} lit, {dark} dark");
    }
}

/// A convex body never shadows its own lit side: no speckle from rounding, at
/// any size. Facets that face away from the light, at the terminator, are the
/// exception.
#[test]
fn shadows_do_not_speckle() {
    for radius in [1e-6, 1.0, 1e6] {
        let centre = DVec3::new(5.0, -3.0, 1.0) * radius;
        let view = view(centre + DVec3::Z * 3.0 * radius, centre, 60, 60);
        let light = |casts| Light {
            towards: DVec3::new(1.0, 2.0, 1.5).normalize(),
            casts,
            ..LIGHT
        };
        let plain = draw(sphere(centre, radius, 100), false, &view, &light(false));
        let cast = draw(sphere(centre, radius, 100), false, &view, &light(true));
        let mut lit = 0;
        for pixel in 0..plain.colour.len() {
            if plain.coverage[pixel] == 1.0 && plain.colour[pixel][0] > 51 + 12 {
                assert_eq!(
                    plain.colour[pixel], cast.colour[pixel],
                    "{radius}, pixel {pixel}"
                );
                lit += 1;
            }
        }
        assert!(lit > 1000, "{lit} lit");
    }
}

#[test]
fn materials_and_coverage_mix_into_the_mean() {
    let mut mesh = square(DVec3::ZERO, 1.0);
    mesh.materials.push(Material {
        name: String::new(),
        diffuse: [200, 100, 10],
    });
    mesh.triangles
        .iter_mut()
        .for_each(|triangle| triangle.material = 1);
    // One pixel a unit wide at the square's depth, its middle on the rim: the
    // square covers its left half.
    let view = View {
        eye: DVec3::new(1.0, 0.0, 4.0),
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        focal_px: 4.0,
        width: 1,
        height: 1,
    };
    let drawn = draw(mesh, false, &view, &LIGHT);
    assert_eq!((drawn.colour[0], drawn.coverage[0]), ([100, 50, 5], 0.5));
    assert_eq!((drawn.nearest[0], drawn.farthest[0]), (4.0, 4.0));
    assert_eq!(drawn.picture().drawn, [true]);
}

#[test]
fn progress_counts_rows() {
    let rows = AtomicU32::new(0);
    let scene = Scene::new(&Geometry::Mesh(square(DVec3::ZERO, 1.0)), false);
    let view = view(DVec3::Z * 4.0, DVec3::ZERO, 3, 17);
    render(&scene, &view, &LIGHT.into(), 1, &|done| {
        rows.fetch_max(done, Ordering::Relaxed);
    });
    assert_eq!(rows.into_inner(), 17);
}

/// Points scattered over a unit sphere.
fn sphere_cloud(count: usize) -> Cloud {
    let mut random = Random(4);
    let directions = std::iter::repeat_with(|| random.vector())
        .filter(|vector| (0.1..1.0).contains(&vector.length()))
        .map(DVec3::normalize);
    let points = directions.take(count).map(|direction| OrientedPoint {
        position: direction,
        normal: direction.as_vec3(),
    });
    Cloud {
        points: points.collect(),
        colours: Vec::new(),
        two_sided: false,
    }
}

/// A cloud's discs close its surface and look like it, shadows included.
#[test]
fn cloud_closes_its_surface() {
    let scene = Scene::new(&Geometry::Cloud(sphere_cloud(20_000)), false);
    let view = view(DVec3::Z * 3.0, DVec3::ZERO, 60, 60);
    let light = Light {
        casts: true,
        ..LIGHT
    };
    let drawn = render(&scene, &view, &light.into(), 4, &|_| ());
    let (mut inside, mut open) = (0, 0);
    for pixel in 0..drawn.colour.len() {
        let (x, y) = ((pixel % 60) as f64 + 0.5, (pixel / 60) as f64 + 0.5);
        let direction = view.direction(x, y);
        if first_hit(view.eye, direction, DVec3::ZERO, 0.93).is_none() {
            continue;
        }
        inside += 1;
        // A scatter leaves a gap now and then, of a sample, never of a pixel.
        open += usize::from(drawn.coverage[pixel] < 1.0);
        assert!(drawn.coverage[pixel] > 0.6, "{x},{y}");
        let distance = first_hit(view.eye, direction, DVec3::ZERO, 1.0).expect("inside");
        let lambert = (view.eye + direction * distance).z.max(0.0);
        let expected = 255.0 * (0.2 + 0.8 * lambert) * f64::from(drawn.coverage[pixel]);
        assert!(
            (f64::from(drawn.colour[pixel][0]) - expected).abs() < 16.0,
            "{x},{y}"
        );
        assert!(
            (f64::from(drawn.nearest[pixel]) - distance).abs() < 0.08,
            "{x},{y}"
        );
    }
    assert!(
        inside > 1000 && open * 100 < inside,
        "{open} of {inside} open"
    );
}

#[test]
fn geometry_without_extent_is_invisible() {
    let view = view(DVec3::Z * 4.0, DVec3::ZERO, 4, 4);
    let mut point = square(DVec3::ZERO, 0.0);
    point.triangles.truncate(1);
    let empty = Mesh::default();
    for mesh in [point, empty] {
        let drawn = draw(mesh, true, &view, &LIGHT);
        assert_eq!(drawn.coverage, [0.0; 16]);
    }
    let lone = Geometry::Cloud(sphere_cloud(1));
    let drawn = render(&Scene::new(&lone, true), &view, &LIGHT.into(), 2, &|_| ());
    assert_eq!(drawn.coverage, [0.0; 16]);
}
