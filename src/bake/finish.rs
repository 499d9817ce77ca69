//! From touched cells to stored levels: which of them stay, and their order.
//!
//! A fat shell stores all. Of a thin one the finest level stores its thin
//! subset, and every level above the thin subset of its own and what leads to
//! a stored cell. Drawn children come first.

use std::ops::Range;

use rhogrid_core::asset::Shell;
use rhogrid_core::asset::node::halves;

use super::shell::BakedLevel;
use super::touched::TouchedLevel;

/// Chooses, orders and records the cells of levels of depth 0 to depth.
pub(super) fn finish(rho: u8, shell: Shell, levels: &[TouchedLevel]) -> Vec<BakedLevel> {
    let children: Vec<Vec<Range<usize>>> = levels.iter().map(TouchedLevel::children).collect();
    let stored = stored(shell, levels, &children);
    let mut baked = Vec::new();
    // Indices of the stored cells of the level above, in file order.
    let mut order: Vec<usize> = Vec::new();
    for (depth, level) in levels.iter().enumerate() {
        let mut own = Vec::new();
        let mut out = BakedLevel::default();
        if depth == 0 {
            own.extend(0..level.cells.len());
        }
        let stores_drawn = shell == Shell::Thin && depth + 1 < levels.len();
        for &parent in &order {
            let first = own.len();
            let present = || {
                let all = children[depth][parent].clone();
                all.filter(|&index| stored[depth][index])
            };
            own.extend(present().filter(|&index| level.cells[index].is_thin));
            let drawn = own.len();
            own.extend(present().filter(|&index| !level.cells[index].is_thin));
            let record = |records: &mut Vec<u16>, of: &[usize]| {
                let start = records.len();
                records.resize(start + halves(rho), 0);
                for &index in of {
                    let bit = usize::from(level.cells[index].bit);
                    records[start + bit / 16] |= 1 << (bit % 16);
                }
                if let Some(last) = records.last_mut() {
                    *last |= level.above[parent].flags.to_last(rho);
                }
            };
            record(&mut out.nodes, &own[first..]);
            if stores_drawn {
                record(&mut out.drawn, &own[first..drawn]);
            }
        }
        out.attributes = own
            .iter()
            .map(|&index| level.cells[index].attribute)
            .collect();
        out.colours = own.iter().map(|&index| level.cells[index].colour).collect();
        baked.push(out);
        order = own;
    }
    baked
}

/// Which cells of each level stay, from the finest up.
fn stored(shell: Shell, levels: &[TouchedLevel], children: &[Vec<Range<usize>>]) -> Vec<Vec<bool>> {
    let mut stored: Vec<Vec<bool>> = levels
        .iter()
        .map(|level| {
            let thin = level.cells.iter().map(|cell| cell.is_thin);
            thin.map(|is_thin| is_thin || shell == Shell::Fat).collect()
        })
        .collect();
    for depth in (1..levels.len()).rev() {
        let (above, below) = stored.split_at_mut(depth);
        for (parent, range) in above[depth - 1].iter_mut().zip(&children[depth]) {
            *parent |= below[0][range.clone()].contains(&true);
        }
    }
    stored
}
