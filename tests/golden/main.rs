//! Frames of built-in geometry, exact to the bit: the same integers give the
//! same pixels everywhere, so there is no tolerance. All shells are fat.
//!
//! `frames/<case>.png` shows what a case draws and `frames/hashes.txt` pins
//! the frame hashes. On failure the actual picture and the difference, four
//! times amplified, are written and their paths printed. After looking at
//! them, accept with `RHOGRID_ACCEPT=1 cargo test --test golden`; nothing else
//! changes the goldens.

mod cases;
mod store;

use std::collections::HashMap;
use std::sync::LazyLock;

use rhogrid::asset_file::AssetFile;
use rhogrid::bake::{self, GridOptions, writer};
use rhogrid::cli::{Frame, draw_frame, draw_shadowed};
use rhogrid_core::asset::Shell;
use rhogrid_core::draw::{draw, shades_len};
use rhogrid_core::shadow::{Method, Shadows};
use rhogrid_core::stats::Stats;
use rhogrid_core::target::{Rect, Target, canvas_len};

use cases::{CASES, Case, INSIDE, Model, light, quality};

/// What tells two assets apart.
type Recipe = (Model, u8, u8, bool);

fn recipe(case: &Case) -> Recipe {
    (case.model, case.rho, case.level, case.two_sided)
}

/// Every asset that some case draws, baked once for all tests.
static ASSETS: LazyLock<HashMap<Recipe, AssetFile>> = LazyLock::new(|| {
    let mut assets = HashMap::new();
    for case in CASES.iter().chain([&INSIDE]) {
        assets
            .entry(recipe(case))
            .or_insert_with(|| bake_case(case));
    }
    assets
});

fn bake_case(case: &Case) -> AssetFile {
    let options = GridOptions {
        rho: case.rho,
        level: case.level,
        shell: Shell::Fat,
        two_sided: case.two_sided,
        ..GridOptions::default()
    };
    let grid = bake::grid(&case.model.geometry(), &options, &|_| {}).unwrap();
    AssetFile::new(&writer::to_bytes(&grid).unwrap()).unwrap()
}

/// Draws a case: the whole picture, or its band alone.
fn draw_case(case: &Case) -> Frame {
    let grid = ASSETS[&recipe(case)].grid();
    let camera = case.view.camera(&grid);
    match case.band {
        None if case.shadows != Method::Off => {
            let shadows = Shadows {
                method: case.shadows,
                ..Shadows::default()
            };
            draw_shadowed(&grid, &camera, &light(), &quality(case), &shadows, 1)
        }
        None => draw_frame(&grid, &camera, &light(), &quality(case), 1),
        Some(band) => {
            let (mut colour, mut depth) = (vec![0; band.pixels()], vec![0; band.pixels()]);
            let mut shades = vec![0; shades_len(grid.materials().len())];
            let mut canvas = vec![0; canvas_len(10)];
            let mut target = Target::band(band, &mut colour, &mut canvas)
                .and_then(|target| target.with_depth(&mut depth))
                .unwrap();
            let stats = draw(
                &grid,
                &camera,
                &light(),
                &quality(case),
                &mut shades,
                &mut target,
            );
            Frame {
                width: band.width() as u16,
                height: band.height() as u16,
                colour,
                depth,
                stats,
                time_ns: 0,
            }
        }
    }
}

#[test]
fn frames_are_the_accepted_ones() {
    let frames: Vec<(&Case, Frame)> = CASES.iter().map(|case| (case, draw_case(case))).collect();
    let names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
    if std::env::var_os("RHOGRID_ACCEPT").is_some_and(|value| value == "1") {
        store::accept(&frames);
    }
    let failures = store::failures(&frames);
    assert!(
        failures.is_empty(),
        "{} of {} frames differ:\n{}",
        failures.len(),
        names.len(),
        failures.join("\n")
    );
}

#[test]
fn bands_tile_the_whole_picture() {
    let case = CASES
        .iter()
        .find(|case| case.band.is_some())
        .expect("a band");
    let whole = draw_case(&Case {
        band: None,
        ..*case
    });
    let mut seen = 0;
    for top in (0..whole.height).step_by(24) {
        for left in (0..whole.width).step_by(40) {
            let band = Rect {
                left,
                top,
                right: (left + 40).min(whole.width),
                bottom: (top + 24).min(whole.height),
            };
            let part = draw_case(&Case {
                band: Some(band),
                ..*case
            });
            let pitch = band.width();
            for (index, (colour, depth)) in part.colour.iter().zip(&part.depth).enumerate() {
                let (x, y) = (index % pitch, index / pitch);
                let at = (usize::from(top) + y) * usize::from(whole.width) + usize::from(left) + x;
                assert_eq!(
                    (*colour, *depth),
                    (whole.colour[at], whole.depth[at]),
                    "column {x}, row {y} of {band:?}"
                );
                seen += 1;
            }
        }
    }
    assert_eq!(seen, whole.colour.len());
}

#[test]
fn one_sided_surfaces_are_not_seen_from_behind() {
    for case in CASES.iter().filter(|case| case.is_empty) {
        let frame = draw_case(case);
        assert!(frame.depth.iter().all(|&depth| depth == 0), "{}", case.name);
    }
    for case in CASES.iter().filter(|case| !case.is_empty) {
        let frame = draw_case(case);
        assert_ne!(frame.stats, Stats::default(), "{}", case.name);
        assert!(frame.depth.iter().any(|&depth| depth != 0), "{}", case.name);
    }
}

/// The inside of a sphere is bright towards the light and dark away from it.
#[test]

fn the_inside_of_a_sphere_has_many_shades() {
    let frame = draw_case(&INSIDE);
    assert!(frame.depth.iter().all(|&depth| depth != 0), "a hole");
    let mut shades = frame.colour.clone();
    shades.sort_unstable();
    shades.dedup();
    assert!(shades.len() > 20, "{} shades", shades.len());
}
