//! Trees: limbs that fork into thinner ones, and leaves that are single sheets.
//!
//! The two stand for the paper's Arbre and Saule (Duguet and Drettakis 2003,
//! table 4), which are not to be had: about as many samples at level 4.

use glam::DVec3;

use super::elementary::sin_cos;
use super::rings::{Builder, End, Ring, Vertex, angle};

const BARK: u8 = 0;
const LEAF: u8 = 1;

/// Names and colours in the order of the constants above.
pub const PALETTE: [(&str, [u8; 3]); 2] = [("bark", [122, 92, 66]), ("leaf", [104, 156, 62])];

/// Vertices around a limb.
const AROUND: u32 = 6;
/// Rings along a limb, its first one left out.
const SEGMENTS: u32 = 4;

/// How a tree grows.
struct Habit {
    /// Forks from the trunk to the twigs.
    forks: u32,
    /// Limbs from each fork.
    branches: u32,
    /// Length of a limb, of the one before it.
    shrink: f64,
    /// Sine of the angle between a limb and the one before it.
    spread: f64,
    /// How much limbs bend upwards, or down, on their way.
    lift: f64,
    /// Leaves of a twig.
    leaves: u32,
    /// Length of a leaf; it is half as wide.
    leaf: f64,
    /// How far strands hang from a twig; zero for none.
    strand: f64,
}

/// A broad crown on a short trunk.
pub fn broad(builder: &mut Builder) {
    let habit = Habit {
        forks: 6,
        branches: 3,
        shrink: 0.74,
        spread: 0.62,
        lift: 0.12,
        leaves: 36,
        leaf: 0.075,
        strand: 0.0,
    };
    grow(builder, &habit, 0x0bad_5eed);
}

/// Arching limbs, from whose twigs long strands hang.
pub fn willow(builder: &mut Builder) {
    let habit = Habit {
        forks: 5,
        branches: 3,
        shrink: 0.76,
        spread: 0.66,
        lift: 0.05,
        leaves: 110,
        leaf: 0.075,
        strand: 1.25,
    };
    grow(builder, &habit, 0x5a11_1ee5);
}

fn grow(builder: &mut Builder, habit: &Habit, seed: u64) {
    let mut tree = Tree {
        builder,
        habit,
        random: seed,
    };
    let trunk = Limb {
        foot: DVec3::ZERO,
        along: DVec3::Y,
        length: 0.9,
        thickness: 0.11,
        forks: habit.forks,
    };
    tree.limb(&trunk);
}

/// A limb before it is drawn.
struct Limb {
    foot: DVec3,
    /// Unit vector.
    along: DVec3,
    length: f64,
    /// Radius at the foot.
    thickness: f64,
    /// Forks above it.
    forks: u32,
}

struct Tree<'b> {
    builder: &'b mut Builder,
    habit: &'b Habit,
    random: u64,
}

/// Two unit vectors at right angles to one and to each other.
fn across(along: DVec3) -> [DVec3; 2] {
    let helper = if along.x.abs() < 0.6 {
        DVec3::X
    } else {
        DVec3::Z
    };
    let u = along.cross(helper).normalize();
    [u, u.cross(along)]
}

impl Tree<'_> {
    /// In [0, 1): the upper bits of SplitMix64, here so that no release of a
    /// library moves a leaf.
    fn next(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.random;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ bits >> 31) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [-1, 1).
    fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    /// A unit vector.
    fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(self.signed(), self.signed(), self.signed());
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// Draws a limb and all above it.
    fn limb(&mut self, limb: &Limb) {
        let tip = limb.thickness * if limb.forks == 0 { 0.3 } else { 0.66 };
        let (mut at, mut along) = (limb.foot, limb.along);
        let step = limb.length / f64::from(SEGMENTS);
        let mut u = across(along)[0];
        let mut ring = self.ring(at, [u, u.cross(along)], limb.thickness);
        let foot = Vertex {
            position: at,
            normal: -along,
        };
        self.builder.lid(ring, End::First, foot, BARK);
        for segment in 1..=SEGMENTS {
            let bend = DVec3::Y * self.habit.lift + self.direction() * 0.1;
            along = (along + bend).normalize();
            at += along * step;
            let share = f64::from(segment) / f64::from(SEGMENTS);
            // Turned no more than the limb, so that its sides do not twist.
            u = u.reject_from_normalized(along).normalize();
            let thickness = limb.thickness + (tip - limb.thickness) * share;
            let next = self.ring(at, [u, u.cross(along)], thickness);
            self.builder.join(ring, next, BARK);
            ring = next;
        }
        let end = Vertex {
            position: at,
            normal: along,
        };
        self.builder.lid(ring, End::Last, end, BARK);
        match limb.forks {
            0 => self.twig(at, along, limb.length),
            _ => self.fork(limb, at, along, tip),
        }
    }

    fn ring(&mut self, at: DVec3, [u, v]: [DVec3; 2], radius: f64) -> Ring {
        self.builder.ring(AROUND, |i| {
            let (sin, cos) = sin_cos(angle(i, AROUND));
            let normal = u * cos + v * sin;
            Vertex {
                position: at + normal * radius,
                normal,
            }
        })
    }

    fn fork(&mut self, limb: &Limb, at: DVec3, along: DVec3, thickness: f64) {
        let [u, v] = across(along);
        let turn = self.next();
        for branch in 0..self.habit.branches {
            let share = f64::from(branch) / f64::from(self.habit.branches);
            let around = std::f64::consts::TAU * (turn + share + 0.08 * self.signed());
            let (sin, cos) = sin_cos(around);
            let spread = self.habit.spread * (0.75 + 0.5 * self.next());
            let aside = (u * cos + v * sin) * spread;
            let length = limb.length * self.habit.shrink * (0.85 + 0.3 * self.next());
            self.limb(&Limb {
                foot: at - along * thickness,
                along: (along * (1.0 - spread * spread).max(0.2).sqrt() + aside).normalize(),
                length,
                thickness: thickness * 0.86,
                forks: limb.forks - 1,
            });
        }
    }

    /// The leaves of a twig, or of the strands that hang from it.
    fn twig(&mut self, at: DVec3, along: DVec3, length: f64) {
        if self.habit.strand == 0.0 {
            for _ in 0..self.habit.leaves {
                let place = at - along * (length * 0.8 * self.next()) + self.direction() * 0.09;
                let towards = (self.direction() + along).normalize_or(along);
                self.leaf(place, towards);
            }
            return;
        }
        let mut place = at;
        let mut down = (along * 0.8 + self.direction() * 0.3).normalize();
        let hang = self.habit.strand * (0.6 + 0.4 * self.next()) * at.y.min(1.6) / 1.6;
        let step = hang / f64::from(self.habit.leaves);
        for _ in 0..self.habit.leaves {
            down = (down + DVec3::NEG_Y * 0.09 + self.direction() * 0.03).normalize();
            place += down * step;
            let towards = (down + self.direction() * 0.7).normalize_or(down);
            self.leaf(place, towards);
        }
    }

    /// A pointed leaf from its stalk on.
    fn leaf(&mut self, stalk: DVec3, towards: DVec3) {
        let length = self.habit.leaf * (0.7 + 0.6 * self.next());
        let side = towards
            .cross(self.direction())
            .normalize_or(across(towards)[0]);
        let normal = towards.cross(side).normalize();
        let normal = self.builder.normal(normal);
        let mut corner = |along: f64, aside: f64| {
            let position = stalk + towards * (along * length) + side * (aside * length);
            (self.builder.position(position), normal)
        };
        let (foot, tip) = (corner(0.0, 0.0), corner(1.0, 0.0));
        let (left, right) = (corner(0.45, -0.25), corner(0.45, 0.25));
        // Counter-clockwise from the side that the normal leads to.
        self.builder.triangle([foot, tip, right], LEAF);
        self.builder.triangle([foot, left, tip], LEAF);
    }
}
