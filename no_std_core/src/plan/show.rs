//! The plan in words and distances, for people.

use core::fmt::{Display, Formatter, Result};

use super::{NEVER, Plan};
use crate::numbers::{Length, shift_round};
use crate::target::Rect;

/// A distance in half sides, or none.
struct Distance {
    w: i32,
    w_scale: i32,
}

impl Display for Distance {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if self.w == NEVER {
            return f.pad_integral(true, "", "-");
        }
        let bits = shift_round(i128::from(self.w), -self.w_scale - 32);
        let width = f.width().unwrap_or(0);
        write!(f, "{:>width$.3}", Length::from_bits(bits))
    }
}

impl Plan {
    fn at(&self, w: i32) -> Distance {
        Distance {
            w,
            w_scale: self.w_scale,
        }
    }

    /// Depth of the shallowest cells that are drawn.
    fn shallowest(&self) -> u8 {
        let stops = |&depth: &u8| self.range[1] >= self.level(depth).stop;
        (0..self.depth).find(stops).unwrap_or(self.depth)
    }
}

/// What is drawn, what is tested, and a line for each depth that is drawn.
/// Distances are in half sides of the cube.
impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let [nearest, farthest] = self.range.map(|w| self.at(w));
        let (first, last, leaves) = (self.shallowest(), self.depth, self.leaves);
        writeln!(
            f,
            "draws cells of depth {first} to {last} of {leaves}; the cube lies {nearest} to {farthest} away"
        )?;
        let Rect {
            left,
            top,
            right,
            bottom,
        } = self.part;
        writeln!(
            f,
            "part     columns {left} to {right}, rows {top} to {bottom}; beyond it nothing is cleared or drawn"
        )?;
        let sides = match self.culls {
            true => "cells are tested against them until one is inside",
            false => "the picture holds the cube, no cell is tested",
        };
        writeln!(f, "sides    {sides}")?;
        let facing = match (self.faces, self.shows_all) {
            (true, _) => "cones that face away are skipped",
            (false, true) => "culling is off, no cone is tested",
            (false, false) => "two-sided, no cone is tested",
        };
        writeln!(f, "facing   {facing}")?;
        let hidden = match self.hides {
            true => "what lies behind what is drawn is skipped",
            false => "culling is off, nothing is asked for",
        };
        writeln!(f, "hidden   {hidden}")?;
        let materials = self.materials;
        let colours = match (self.tabulates, materials) {
            (false, _) => "few pixels, each is shaded by itself",
            (true, 1) => "one material, none is looked up",
            (true, _) => "by material",
        };
        writeln!(f, "colours  {colours} ({materials})")?;
        let holes = match self.repair {
            Some(_) => "closed between nearer opposite neighbours",
            None => "left",
        };
        writeln!(f, "holes    {holes}")?;
        writeln!(
            f,
            "depth   stops from  packed 1, 2 levels from  siblings 1, 2 from       points, pairs from"
        )?;
        for depth in first..=last {
            let plan = self.level(depth);
            let stop = self.at(if depth == last { 0 } else { plan.stop });
            let [one, two] = plan.packed.map(|w| self.at(w));
            let [first, second] = plan.siblings.map(|w| self.at(w));
            let [point, wide] = [plan.point, plan.wide].map(|w| self.at(w));
            writeln!(
                f,
                "{depth:>5} {stop:>12} {one:>12} {two:>12} {first:>12} {second:>12} {point:>12} {wide:>12}"
            )?;
        }
        Ok(())
    }
}
