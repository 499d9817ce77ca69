//! Colours of samples: of the nearest points, or the mean of what is below.

use glam::DVec3;
use rhogrid::bake::{Attributes, GridOptions, Masks, Normals};
use rhogrid::geometry::{Cloud, Geometry, Mesh, OrientedPoint};
use rhogrid::import::procedural::shapes;
use rhogrid_core::asset::{Colours, Rgb};

use super::cells::{Cell, cells};
use super::{Random, baked, options, sphere_of_points, thin};
use rhogrid::asset_file::AssetFile;
use rhogrid::bake::{self, writer};

/// 0 to 255 for -1 to 1.
fn ramp(place: DVec3) -> Rgb {
    let channels = ((place + 1.0) * 127.5).round();
    channels.to_array().map(|channel| channel as u8)
}

fn with(options: GridOptions, attributes: Attributes) -> GridOptions {
    GridOptions {
        attributes: Some(attributes),
        ..options
    }
}

fn painted(mesh: Mesh, mut colour: impl FnMut(DVec3) -> Rgb) -> Mesh {
    let mut corners = |positions: [u32; 3]| positions.map(|i| colour(mesh.positions[i as usize]));
    let colours = mesh.triangles.iter().map(|t| corners(t.positions));
    Mesh {
        colours: colours.collect(),
        ..mesh.clone()
    }
}

/// Of cells with colours.
fn colour(cell: &Cell) -> Rgb {
    cell.colour.expect("a colour")
}

fn leaves<'c>(depths: &'c [Vec<Cell>], depth: usize, cell: &'c Cell) -> Vec<&'c Cell> {
    if depth + 1 == depths.len() {
        return if cell.is_drawn {
            vec![cell]
        } else {
            Vec::new()
        };
    }
    let children = &depths[depth + 1][cell.children.clone()];
    children
        .iter()
        .flat_map(|child| leaves(depths, depth + 1, child))
        .collect()
}

/// The mean of the drawn leaves, halves up.
fn check_means(file: &AssetFile) {
    let depths = cells(&file.grid());
    let mut checked = 0;
    for (depth, cells) in depths.iter().enumerate().take(depths.len() - 1) {
        for cell in cells {
            let below = leaves(&depths, depth, cell);
            let count = below.len() as u64;
            for channel in (0..3).filter(|_| count > 0) {
                let sum: u64 = below
                    .iter()
                    .map(|leaf| u64::from(colour(leaf)[channel]))
                    .sum();
                let mean = (sum + count / 2) / count;
                assert_eq!(u64::from(colour(cell)[channel]), mean, "depth {depth}");
                checked += 1;
            }
        }
    }
    assert!(checked > 100, "{checked}");
}

#[test]
fn leaves_have_the_colour_of_the_nearest_point() {
    let mesh = painted(shapes::quad(), ramp);
    for (rho, level) in [(2, 4), (3, 3), (4, 2), (5, 2)] {
        for normals in [Normals::Filtered, Normals::Nearest] {
            let options = GridOptions {
                normals,
                ..with(options(rho, level), Attributes::Bits48)
            };
            let depths = cells(&baked(&mesh, &options).grid());
            for (depth, cells) in depths.iter().enumerate() {
                let axis = f64::from(u32::from(rho).pow(depth as u32));
                let is_leaf = depth + 1 == depths.len();
                for cell in cells
                    .iter()
                    .filter(|_| is_leaf || normals == Normals::Nearest)
                {
                    let [x, y, _] = cell
                        .place
                        .map(|at| (2.0 * f64::from(at) + 1.0) / axis - 1.0);
                    let want = ramp(DVec3::new(x, y, 0.0));
                    let off = [0, 1].map(|i| colour(cell)[i].abs_diff(want[i]));
                    // Corners' colours are rounded, too.
                    assert!(
                        off.into_iter().all(|off| off <= 1),
                        "{cell:?}, not {want:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn intermediate_colours_are_the_mean_of_drawn_leaves() {
    let mut random = Random(77);
    let mut any = |_| [(); 3].map(|()| (random.next() * 127.5 + 127.5) as u8);
    for shape in [shapes::sphere(8), shapes::torus(20, 9), shapes::cube()] {
        let mesh = painted(shape, &mut any);
        for options in [thin(3, 3), options(2, 4), thin(5, 1)] {
            check_means(&baked(&mesh, &with(options, Attributes::Bits48)));
        }
    }
}

#[test]
fn narrow_colours_are_the_nearest_ones() {
    let mesh = painted(shapes::sphere(8), ramp);
    let of = |attributes, masks| {
        let options = GridOptions {
            masks,
            ..with(thin(3, 3), attributes)
        };
        baked(&mesh, &options)
    };
    let wide = of(Attributes::Bits48, Masks::Plain);
    for masks in [Masks::Plain, Masks::Dictionary] {
        let narrow = of(Attributes::Bits32, masks);
        let (wide, narrow) = (wide.grid(), narrow.grid());
        for (wide, narrow) in wide.levels().iter().zip(narrow.levels()) {
            let Colours::Rgb565(words) = narrow.colours else {
                panic!("16 bits");
            };
            for (index, &word) in words.iter().enumerate() {
                let want = wide.colours.get(index).expect("as many").map(f64::from);
                let got = [word >> 11, word >> 5 & 63, word & 31].map(f64::from);
                for ((got, want), full) in got.into_iter().zip(want).zip([31.0, 63.0, 31.0]) {
                    assert!((got / full - want / 255.0).abs() <= 0.5 / full + 1e-9);
                }
            }
        }
    }
    assert_eq!(
        of(Attributes::Bits16, Masks::Plain).grid().attribute_bits(),
        16
    );
}

/// Without being asked: 32 bits where there are colours. Asked for, colours are
/// materials'.
#[test]
fn geometry_decides_how_wide_attributes_are() {
    let plain = shapes::sphere(8);
    let coloured = painted(plain.clone(), ramp);
    assert_eq!(baked(&plain, &thin(3, 2)).grid().attribute_bits(), 16);
    assert_eq!(baked(&coloured, &thin(3, 2)).grid().attribute_bits(), 32);
    let asked = baked(&plain, &with(thin(3, 2), Attributes::Bits48));
    let own = asked.grid().materials()[0];
    let grid = asked.grid();
    let last = grid.levels().last().expect("levels");
    assert!((0..last.cells()).all(|index| last.colours.get(index) == Some(own)));
}

#[test]
fn clouds_have_the_colours_of_their_points() {
    let cloud = sphere_of_points();
    let colour_of = |point: &OrientedPoint| ramp(point.position);
    let cloud = Cloud {
        colours: cloud.points.iter().map(colour_of).collect(),
        ..cloud
    };
    let grid = bake::grid(&Geometry::Cloud(cloud), &thin(3, 3), &|_| {}).unwrap();
    let grid = bake::BakedGrid {
        attributes: Attributes::Bits48,
        ..grid
    };
    let file = AssetFile::new(&writer::to_bytes(&grid).unwrap()).unwrap();
    check_means(&file);
    for cell in cells(&file.grid()).last().expect("levels") {
        let place = cell
            .place
            .map(|at| (2.0 * f64::from(at) + 1.0) / 81.0 - 1.0);
        let want = ramp(DVec3::from_array(place));
        let off = [0, 1, 2].map(|i| colour(cell)[i].abs_diff(want[i]));
        // Half a cell's diagonal, 0.02, and half a tile's, 0.1 of the radius.
        assert!(
            off.into_iter().all(|off| off <= 16),
            "{cell:?}, not {want:?}"
        );
    }
}
