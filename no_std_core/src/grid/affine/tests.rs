use super::*;
use crate::canvas::WINDOW_CENTRE;
use crate::grid::mask;
use crate::testing::Rng;
use crate::testing::view::signed;

/// Where a packed word says that a cell lies: sixteenths from the window's
/// corner, and depth.
fn unpacked(word: u32) -> [f64; 3] {
    [
        f64::from(word >> 16 & 0xff) / 16.0,
        f64::from(word >> 24) / 16.0,
        f64::from(word & 0xffff),
    ]
}

/// Random steps, made as long as still fit, from places at the ends of their
/// pixels: every cell of two levels lies within its bound of the exact sum,
/// and so in its window.
fn two_levels<const RHO: u8>(seed: u64) {
    let mut rng = Rng::with_seed(seed);
    let rho = i32::from(RHO);
    let mut tried = 0;
    while tried < 300 {
        let one = f64::from(1 << SCREEN_BITS);
        let unit = [0; 9].map(|_| signed(&mut rng));
        let size = 15.0 / f64::from(rho * rho - 1) * one;
        let along = |axis: usize| Step {
            x: (unit[axis] * size) as i32,
            y: (unit[axis + 3] * size) as i32,
            depth: (unit[axis + 6] * 40.0) as i32,
        };
        let steps = Steps([along(0), along(1), along(2)]);
        let fraction = |rng: &mut Rng| match rng.u8(..3) {
            0 => 0,
            1 => 4095,
            _ => rng.i32(0..4096),
        };
        let place = Place {
            x: (100 << SCREEN_BITS) + fraction(&mut rng),
            y: (90 << SCREEN_BITS) + fraction(&mut rng),
            depth: rng.i32(1..65536),
        };
        let brush = [Brush::Point, Brush::Wide, Brush::Square][rng.usize(..3)];
        let reach = steps.reach(rho * rho);
        if !reach.fits_window(brush) || !reach.fits_depth(&place) {
            continue;
        }
        tried += 1;
        let start = place.step().packed_in_window();
        let start = start.wrapping_add(brush.offset());
        let mut affine = Affine::blank();
        affine.blocks.fill::<RHO>(&steps.times(rho).0);
        affine.leaves.fill::<RHO>(&steps.0);
        let cells = 0..RHO.pow(3);
        for (block, leaf) in cells
            .clone()
            .flat_map(|block| cells.clone().map(move |leaf| (block, leaf)))
        {
            let word = start
                .wrapping_add(displacement::<RHO>(&affine.blocks, block))
                .wrapping_add(displacement::<RHO>(&affine.leaves, leaf));
            let offset = [0, 1, 2].map(|axis| {
                let at = |cell: u8| {
                    f64::from(i32::from(cell) / rho.pow(axis) % rho) - f64::from(rho - 1) / 2.0
                };
                at(block) * f64::from(rho) + at(leaf)
            });
            let sum = |of: fn(&Step) -> i32| {
                let parts = steps.0.iter().zip(offset);
                parts
                    .map(|(step, times)| f64::from(of(step)) * times)
                    .sum::<f64>()
            };
            let corner = |pixel: i32| f64::from(pixel - WINDOW_CENTRE);
            let (is_wide, is_square) = (brush != Brush::Point, brush == Brush::Square);
            let [half_left, half_up] = [is_wide, is_square].map(|is| if is { 0.5 } else { 0.0 });
            let want = [
                (f64::from(place.x) + sum(|step| step.x)) / one - corner(100) - half_left,
                (f64::from(place.y) + sum(|step| step.y)) / one - corner(90) - half_up,
                f64::from(place.depth) + sum(|step| step.depth),
            ];
            let bounds = [11.0 / 32.0, 11.0 / 32.0, f64::from(DEPTH_ROUNDING)];
            for ((got, want), bound) in unpacked(word).into_iter().zip(want).zip(bounds) {
                assert!(
                    (got - want).abs() <= bound,
                    "{got}, not {want}: {place:?} {:?}",
                    steps.0
                );
            }
            // A square's second row lies in the window's spare one.
            let last = [want[0] + 2.0 * half_left, want[1]];
            assert!(want[0] >= 0.0 && last[0] < 16.0, "{want:?}");
            assert!(want[1] >= 0.0 && last[1] < 16.0, "{want:?}");
        }
    }
}

/// A subcell's displacement, by its word and its place in it.
fn displacement<const RHO: u8>(subcells: &Subcells, cell: u8) -> u32 {
    let cells = mask::cells(RHO);
    let (word, bit) = (usize::from(cell) / cells, usize::from(cell) % cells);
    subcells.words[word].wrapping_add(subcells.cells[mask::slot(bit)])
}

#[test]
fn cells_of_two_levels_lie_where_their_steps_lead() {
    two_levels::<2>(91);
    two_levels::<3>(92);
    two_levels::<4>(93);
    two_levels::<5>(94);
}
