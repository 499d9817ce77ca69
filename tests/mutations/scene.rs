//! Real assets, and small frames of what becomes of them.

use rhogrid::bake::{self, GridOptions, writer};
use rhogrid::geometry::{Geometry, Material, Mesh};
use rhogrid::import::procedural::shapes;
use rhogrid_core::asset::{Grid, Shell};
use rhogrid_core::camera::{Camera, Orbit};
use rhogrid_core::draw::{Light, Quality, draw, shades_len};
use rhogrid_core::numbers::{FocalPx, Length, SplatPx, Turns, Unit, Weight};
use rhogrid_core::target::{Rect, Target, canvas_len};

use super::layout::Layout;
use super::mutate::Random;

/// Picture width and height.
const SIDE: u16 = 32;
/// Words on either side of a target.
const GUARD: usize = 64;
/// What they hold.
const MARK: u16 = 0xbeef;

pub fn assets() -> Vec<Layout> {
    let mut many = shapes::torus(12, 8);
    many.materials = vec![Material::white(); 8];
    for (index, triangle) in many.triangles.iter_mut().enumerate() {
        triangle.material = (index % 8) as u8;
    }
    let bake = |name, shell, mesh: &Mesh, rho, level, two_sided| {
        let options = GridOptions {
            rho,
            level,
            shell,
            two_sided,
            ..GridOptions::default()
        };
        let grid = bake::grid(&Geometry::Mesh(mesh.clone()), &options, &|_| {}).unwrap();
        Layout::new(name, rho, shell, writer::to_bytes(&grid).unwrap())
    };
    let coded = |name, shell, mesh: &Mesh, level, levels| {
        let options = GridOptions {
            level,
            shell,
            ..GridOptions::default()
        };
        let grid = bake::grid(&Geometry::Mesh(mesh.clone()), &options, &|_| {}).unwrap();
        let bytes = writer::to_coded_bytes(&grid, levels).unwrap();
        Layout::new(name, 3, shell, bytes)
    };
    vec![
        coded("coded torus", Shell::Fat, &shapes::torus(12, 8), 2, 2),
        coded("coded thin torus", Shell::Thin, &shapes::torus(12, 8), 2, 3),
        coded("coded, eight materials", Shell::Fat, &many, 1, 1),
        coded("coded, thin, eight materials", Shell::Thin, &many, 2, 2),
        bake(
            "torus, rho 2",
            Shell::Fat,
            &shapes::torus(12, 8),
            2,
            2,
            false,
        ),
        bake(
            "torus, rho 3",
            Shell::Fat,
            &shapes::torus(12, 8),
            3,
            1,
            false,
        ),
        bake(
            "torus, rho 4",
            Shell::Fat,
            &shapes::torus(12, 8),
            4,
            1,
            false,
        ),
        bake(
            "torus, rho 5",
            Shell::Fat,
            &shapes::torus(12, 8),
            5,
            0,
            false,
        ),
        bake("eight materials, rho 2", Shell::Fat, &many, 2, 3, false),
        bake("eight materials, rho 3", Shell::Fat, &many, 3, 1, true),
        bake("eight materials, rho 5", Shell::Fat, &many, 5, 1, false),
        bake("quad, rho 2", Shell::Fat, &shapes::quad(), 2, 4, true),
        bake("sphere, rho 3", Shell::Fat, &shapes::sphere(8), 3, 0, true),
        bake("cube, rho 4", Shell::Fat, &shapes::cube(), 4, 0, false),
        bake(
            "thin torus, rho 2",
            Shell::Thin,
            &shapes::torus(12, 8),
            2,
            3,
            false,
        ),
        bake(
            "thin torus, rho 3",
            Shell::Thin,
            &shapes::torus(12, 8),
            3,
            2,
            false,
        ),
        bake(
            "thin torus, rho 4",
            Shell::Thin,
            &shapes::torus(12, 8),
            4,
            1,
            false,
        ),
        bake(
            "thin torus, rho 5",
            Shell::Thin,
            &shapes::torus(12, 8),
            5,
            1,
            true,
        ),
        bake(
            "thin, eight materials, rho 2",
            Shell::Thin,
            &many,
            2,
            4,
            false,
        ),
        bake(
            "thin, eight materials, rho 3",
            Shell::Thin,
            &many,
            3,
            1,
            true,
        ),
        bake("thin quad, rho 2", Shell::Thin, &shapes::quad(), 2, 4, true),
    ]
}

/// Memory that a thread uses again and again.
#[derive(Default)]
pub struct Buffers {
    pub words: Vec<u32>,
    colour: Vec<u16>,
    depth: Vec<u16>,
    canvas: Vec<u32>,
    shades: Vec<u16>,
}

/// What came of a frame.
pub struct Drawn {
    pub samples: u32,
    pub pixels: u32,
}

/// The whole picture or a part of it.
fn band(random: &mut Random) -> Rect {
    let (left, top) = (random.below(24) as u16, random.below(24) as u16);
    match random.below(3) {
        0 => Rect {
            left,
            top,
            right: left + 1 + random.below(8) as u16,
            bottom: top + 1 + random.below(8) as u16,
        },
        _ => Rect {
            left: 0,
            top: 0,
            right: SIDE,
            bottom: SIDE,
        },
    }
}

/// Eyes outside of the cube's corners, in half sides.
pub const OUTSIDE: [Length; 4] = [
    Length::lit("2.6"),
    Length::lit("1.8"),
    Length::lit("9"),
    Length::lit("100000"),
];

/// Eyes among the cells.
pub const INSIDE: [Length; 4] = [
    Length::lit("1.2"),
    Length::lit("0.7"),
    Length::lit("0.01"),
    Length::ZERO,
];

const SPLATS: [SplatPx; 5] = [
    SplatPx::ONE,
    SplatPx::ONE,
    SplatPx::ZERO,
    SplatPx::lit("6"),
    SplatPx::MAX,
];

impl Buffers {
    /// Draws a small frame from somewhere and looks at what lies around it.
    pub fn draw(&mut self, grid: &Grid<'_>, distances: &[Length], random: &mut Random) -> Drawn {
        let orbit = Orbit {
            yaw: Turns::from_bits(random.next() as u32),
            pitch: Turns::from_bits(random.next() as u32),
            distance: random.pick(distances),
        };
        let focal = random.pick(&[32, 32, 32, 4, 4000]);
        let camera = Camera::orbit(&orbit, FocalPx::from_num(focal), SIDE, SIDE);
        let light = Light {
            towards: [Unit::lit("0.6"), Unit::lit("0.8"), Unit::ZERO],
            ambient: Weight::lit("0.2"),
            diffuse: Weight::lit("0.8"),
        };
        let quality = Quality {
            splat: random.pick(&SPLATS),
            distortion: random.pick(&[SplatPx::ZERO, Quality::DISTORTION, SplatPx::MAX]),
            repair: random.pick(&[true, false]),
            culling: random.pick(&[true, false]),
        };
        let band = band(random);
        let pixels = band.pixels();
        for buffer in [&mut self.colour, &mut self.depth] {
            buffer.clear();
            buffer.resize(pixels + 2 * GUARD, MARK);
        }
        // The table costs more than the frame: one in sixteen has it.
        let with_table = random.below(16) == 0;
        let words = if with_table {
            shades_len(grid.materials().len())
        } else {
            0
        };
        self.shades.resize(words, 0);
        let middle = GUARD..GUARD + pixels;
        let (colour, depth) = (&mut self.colour[middle.clone()], &mut self.depth[middle]);
        let rows = 1 + random.below(usize::from(SIDE)) as u16;
        self.canvas.clear();
        self.canvas.resize(canvas_len(rows), 0x5a5a_5a5a);
        let mut target = Target::band(band, colour, &mut self.canvas)
            .and_then(|target| target.with_depth(depth))
            .unwrap();
        let stats = draw(
            grid,
            &camera,
            &light,
            &quality,
            &mut self.shades,
            &mut target,
        );
        for buffer in [&self.colour, &self.depth] {
            let (before, rest) = buffer.split_at(GUARD);
            let (_, behind) = rest.split_at(pixels);
            assert!(
                before.iter().chain(behind).all(|&word| word == MARK),
                "drawn out of bounds"
            );
        }
        let drawn = self.depth[GUARD..GUARD + pixels]
            .iter()
            .filter(|&&depth| depth != 0)
            .count();
        assert!(drawn == 0 || stats.samples_drawn > 0);
        Drawn {
            samples: stats.samples_drawn,
            pixels: drawn as u32,
        }
    }
}
