//! Displacement tables: from a cell's centre to its subcells' centres.
//!
//! Source: Duguet and Drettakis 2003, eq. (1). The cube's half side is one,
//! so a subcell (i, j, k) of a cell at depth n lies at (2i - rho + 1, 2j -
//! rho + 1, 2k - rho + 1) / rho^(n + 1) times the basis.
//!
//! # Error
//!
//! A table entry is the exact displacement rounded to the nearest block unit:
//! the 32 guard bits of the basis divided by rho^(n + 1) with truncation err
//! by less than 3 rho 2^-32 units, which is inside the slack below. A centre
//! at depth n is the sum of the rounded centre of the root and n rounded
//! displacements, so it lies within E = (n + 1) / 2 + 2^-24 units of the exact
//! one.
//!
//! In pixels: a point (X, Y, w) in block units lies x = s X / w pixels from
//! the picture's middle, s = 2^screen_scale. The traversal has X + e and w + f
//! with |e|, |f| <= E, and
//!
//! ```text
//! s (X + e) / (w + f) - s X / w = (s e - x f) / (w + f).
//! ```
//!
//! Multiplying by the reciprocal adds a relative 2^-18.9 and rounds down to
//! 2^-12 px, the forms add less than 2^-9 units to E and 2^-31 |x|. With W =
//! w + f, the w that the traversal has, a position errs by less than
//!
//! ```text
//! (E + 2^-9) (s + |x|) (1 + 2^-18) / W + |x| 2^-18.9 + 2^-12 px
//! ```
//!
//! as long as it stays inside +-2^18 px, where it saturates. At the standard
//! full view (240x320, focal length 320 px, 2.6 radii) that is below 0.001 px
//! for every cell in the picture; only next to an eye inside the cube does the
//! first term count. The tests below assert all of it.

use crate::projection::Form;

/// A point in homogeneous screen space, block units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Point {
    pub x: i32,
    pub y: i32,
    pub w: i32,
}

impl Point {
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            w: self.w + other.w,
        }
    }
}

/// One depth's displacements and extents.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LevelTable<const CELLS: usize> {
    /// To each subcell's centre, in mask order.
    pub displacements: [Point; CELLS],
    /// The same in eye space: see [`super::facing`].
    pub eye_displacements: [[i32; 3]; CELLS],
    /// Half the edges of a cell of this depth, along x, y and z.
    pub half_edges: [Point; 3],
    /// Half the extent of a cell in w.
    pub half_w: i32,
    /// Radius of a cell's bounding sphere in eye-space units, rounded up, with
    /// what rounding may put its centre off.
    pub eye_radius: i32,
}

/// How large the cells of a depth are.
#[derive(Clone, Copy)]
pub(crate) struct Extents<'a> {
    /// See [`LevelTable::half_edges`].
    pub half_edges: &'a [Point; 3],
    /// See [`LevelTable::half_w`].
    pub half_w: i32,
    /// See [`LevelTable::eye_radius`].
    pub eye_radius: i32,
}

/// The tables of every depth that a frame may reach, and the root's centre.
pub(crate) struct Tables<const CELLS: usize, const LEVELS: usize> {
    /// Entry n holds displacements to cells of depth n + 1 and extents of
    /// cells of depth n + 1.
    pub levels: [LevelTable<CELLS>; LEVELS],
    /// Extents of the root.
    pub root: LevelTable<1>,
    /// The root's centre.
    pub centre: Point,
}

impl<const CELLS: usize, const LEVELS: usize> Tables<CELLS, LEVELS> {
    /// To be filled where it lies: a table that moves is on the stack twice.
    pub const EMPTY: Self = Self {
        levels: [LevelTable::EMPTY; LEVELS],
        root: LevelTable::<1>::EMPTY,
        centre: Point { x: 0, y: 0, w: 0 },
    };

    /// Fills the tables of `depth` levels.
    pub fn fill(&mut self, rho: u8, depth: u8, forms: &[Form; 3], eye_unit: i32) {
        let rho = i64::from(rho);
        self.centre = point(forms, |form| form.centre);
        let mut cells_per_axis = 1i64;
        self.root.set_extents(&edges(forms, 1), 1, eye_unit, 0);
        for (level, depth) in self.levels.iter_mut().zip(1..=i32::from(depth)) {
            cells_per_axis *= rho;
            let edges = edges(forms, cells_per_axis);
            level.set_extents(&edges, cells_per_axis, eye_unit, depth);
            level.set_displacements(rho, &edges, cells_per_axis, eye_unit);
        }
    }

    /// The table of displacements from cells of a depth to their subcells; its
    /// extents are the subcells'.
    #[inline(always)]
    pub fn below(&self, depth: u8) -> &LevelTable<CELLS> {
        let last = LEVELS - 1;
        &self.levels[usize::from(depth).min(last)]
    }

    /// Extents of cells of a depth.
    #[inline(always)]
    pub fn extents(&self, depth: u8) -> Extents<'_> {
        match depth.checked_sub(1) {
            None => self.root.extents(),
            Some(above) => self.below(above).extents(),
        }
    }
}

impl<const CELLS: usize> LevelTable<CELLS> {
    const EMPTY: Self = Self {
        displacements: [Point { x: 0, y: 0, w: 0 }; CELLS],
        eye_displacements: [[0; 3]; CELLS],
        half_edges: [Point { x: 0, y: 0, w: 0 }; 3],
        half_w: 0,
        eye_radius: 0,
    };

    fn extents(&self) -> Extents<'_> {
        Extents {
            half_edges: &self.half_edges,
            half_w: self.half_w,
            eye_radius: self.eye_radius,
        }
    }

    /// Extents of cells of a depth, of which `cells_per_axis` span the cube,
    /// with their half edges.
    fn set_extents(
        &mut self,
        [x, y, w]: &HalfEdges,
        cells_per_axis: i64,
        eye_unit: i32,
        depth: i32,
    ) {
        for (edge, ((&x, &y), &w)) in self.half_edges.iter_mut().zip(x.iter().zip(y).zip(w)) {
            *edge = Point {
                x: round_guard(x),
                y: round_guard(y),
                w: round_guard(w),
            };
        }
        // One unit more for each rounded edge.
        self.half_w = self.half_edges.iter().map(|edge| edge.w.abs() + 1).sum();
        // sqrt(3) < 7/4; the centre is a sum of depth + 1 rounded vectors,
        // each within sqrt(3) / 2 units.
        self.eye_radius = (eye_unit * 7 / 4) / (cells_per_axis as i32).max(1) + 2 + depth;
    }

    fn set_displacements(
        &mut self,
        rho: i64,
        edges: &HalfEdges,
        cells_per_axis: i64,
        eye_unit: i32,
    ) {
        let cells_per_axis = cells_per_axis.max(1);
        // By the subcell's number along an axis.
        let mut steps = [0; MAX_RHO];
        for (step, number) in steps.iter_mut().zip(0..rho) {
            let at = 2 * number + 1 - rho;
            *step = round_ratio(at * i64::from(eye_unit), cells_per_axis);
        }
        let entries = self
            .displacements
            .iter_mut()
            .zip(&mut self.eye_displacements);
        let mut place = [1 - rho; 3];
        for (displacement, eye_displacement) in entries {
            let [x, y, w] = edges.map(|edges| {
                let sum: i64 = place.iter().zip(edges).map(|(at, edge)| at * edge).sum();
                round_guard(sum)
            });
            *displacement = Point { x, y, w };
            *eye_displacement = place.map(|at| steps[(at + rho) as usize / 2 % MAX_RHO]);
            next_place(&mut place, rho);
        }
    }
}

/// Largest number of subcells along an axis.
const MAX_RHO: usize = 5;

/// What X, Y and w change along half of each edge, block units with guard bits.
type HalfEdges = [[i64; 3]; 3];

/// The half edges of cells of which so many span the cube.
fn edges(forms: &[Form; 3], cells_per_axis: i64) -> HalfEdges {
    let count = cells_per_axis.max(1);
    forms.map(|form| form.axes.map(|axis| axis / count))
}

/// Advances (x, y, z), x fastest, in steps of two from 1 - rho to rho - 1.
fn next_place(place: &mut [i64; 3], rho: i64) {
    for at in place {
        *at += 2;
        if *at < rho {
            return;
        }
        *at = 1 - rho;
    }
}

/// Rounds one value of each form to block units.
fn point([x, y, w]: &[Form; 3], value: impl Fn(&Form) -> i64) -> Point {
    Point {
        x: round_guard(value(x)),
        y: round_guard(value(y)),
        w: round_guard(value(w)),
    }
}

/// Takes the 32 guard bits off, rounding to nearest.
fn round_guard(value: i64) -> i32 {
    ((value + (1 << 31)) >> 32) as i32
}

/// a / b for b > 0, rounded to nearest.
fn round_ratio(a: i64, b: i64) -> i32 {
    (2 * a + b).div_euclid(2 * b) as i32
}

#[cfg(test)]
mod tests;
