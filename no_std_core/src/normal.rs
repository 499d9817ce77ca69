//! 13-bit normal codes: a recursively subdivided octahedron, level 5.
//!
//! Source: Duguet and Drettakis 2003, 5.5 and table 3 (after Botsch et al.
//! 2002). Bits 10, 11, 12 are the signs of x, y, z (set: negative); bits 0 to
//! 9 name one of 4^5 triangles of the octant's face, two bits a level,
//! coarsest first. A triangle (a, b, c) splits into 0: (a, ab, ca),
//! 1: (ab, b, bc), 2: (ca, bc, c), 3: (bc, ca, ab). The code stands for the
//! direction of its triangle's centroid, whose barycentric coordinates are
//! multiples of 1/96.
//!
//! Over all directions, 1 - cosine of the angle between a direction and its
//! code's is at most 9.6e-4, in the mean 1.6e-4.

/// Number of normal codes.
pub const CODES: usize = 1 << 13;
/// Bits of an attribute that hold the normal code.
pub const CODE_MASK: u16 = CODES as u16 - 1;
/// Flips every sign: the opposite direction's code.
pub const OPPOSITE: u16 = 7 << 10;
/// Subdivisions of an octant's face.
const LEVEL: u32 = 5;
/// Triangles of an octant's face.
pub(crate) const OCTANT_CODES: usize = 1 << (2 * LEVEL);
/// Fraction bits of decoded components.
pub const COMPONENT_BITS: u32 = 14;

/// Unit normals of the positive octant's codes, Q2.14, each component within
/// one unit of the last place.
pub(crate) static OCTANT: [[i16; 3]; OCTANT_CODES] = octant();

const fn octant() -> [[i16; 3]; OCTANT_CODES] {
    let mut table = [[0; 3]; OCTANT_CODES];
    let mut code = 0;
    while code < OCTANT_CODES {
        table[code] = unit(centroid(code, LEVEL));
        code += 1;
    }
    table
}

/// Codes without their last subdivision: what [`Coarse`] tells apart.
const COARSE_CODES: usize = CODES / 4;

/// Unit normals of the triangles one level up, for tests that can spare three
/// degrees: x, y, z in the bits from 22, 11 and 0 on, signed, 511 to one.
static COARSE: [u32; COARSE_CODES] = {
    let mut table = [0; COARSE_CODES];
    let mut code = 0;
    while code < COARSE_CODES {
        // The middle child's centroid is its parent's.
        let v = OCTANT[(code * 4 + 3) % OCTANT_CODES];
        let mut packed = 0u32;
        let mut axis = 0;
        while axis < 3 {
            let length = (v[axis] as i32 * 511 + (1 << 13)) >> 14;
            let signed = if code >> (8 + axis) & 1 != 0 {
                -length
            } else {
                length
            };
            packed = packed.wrapping_add((signed << (22 - 11 * axis)) as u32);
            axis += 1;
        }
        table[code] = packed;
        code += 1;
    }
    table
};

/// Fraction bits, nearly, of [`coarse`]'s components: 511 to one.
pub(crate) const COARSE_ONE: i32 = 511;

/// A code's normal without its last subdivision, at most 3.4 degrees off.
#[inline(always)]
pub(crate) fn coarse(code: u16) -> [i32; 3] {
    let packed = COARSE[usize::from(code & CODE_MASK) / 4] as i32;
    // Lower fields of either sign borrow one from those above.
    [packed >> 22, packed << 10 >> 21, packed << 21 >> 21]
}

/// Fills a table by code with what stands for the products of normals, Q2.14,
/// and a vector: `facing` of those above zero, else `away`.
///
/// Two octants at once: of the products with a direction and its opposite, one
/// is at most zero.
pub(crate) fn fill_facing<T: Copy>(
    table: &mut [T],
    towards: [i32; 3],
    away: T,
    facing: impl Fn(i32) -> T,
) {
    let (octants, _) = table.as_chunks_mut::<OCTANT_CODES>();
    let [o0, o1, o2, o3, o4, o5, o6, o7] = octants else {
        return;
    };
    // By the signs' bits: x, y, z from bit 0 on.
    let pairs = [(0, o0, o7), (1, o1, o6), (2, o2, o5), (3, o3, o4)];
    for (octant, own, opposite) in pairs {
        let [mut x_axis, mut y_axis, z_axis] = towards;
        if octant & 1 != 0 {
            x_axis = -x_axis;
        }
        if octant & 2 != 0 {
            y_axis = -y_axis;
        }
        for ((normal, own), opposite) in OCTANT.iter().zip(own).zip(opposite) {
            let [x, y, z] = normal.map(i32::from);
            let product = x * x_axis + y * y_axis + z * z_axis;
            let value = facing(product.abs());
            (*own, *opposite) = match product > 0 {
                true => (value, away),
                false => (away, value),
            };
        }
    }
}

/// Centroid of a triangle of an octant's face that was subdivided `level` times,
/// at most 15: barycentric, in parts of 3 * 2^level.
pub const fn centroid(code: usize, level: u32) -> [i64; 3] {
    // Corners in parts of 2^level.
    let one = 1i64 << level;
    let mut corners = [[one, 0, 0], [0, one, 0], [0, 0, one]];
    let mut level = level;
    while level > 0 {
        level -= 1;
        let [a, b, c] = corners;
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        corners = match (code >> (2 * level)) & 3 {
            0 => [a, ab, ca],
            1 => [ab, b, bc],
            2 => [ca, bc, c],
            _ => [bc, ca, ab],
        };
    }
    let [a, b, c] = corners;
    [a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]]
}

const fn middle(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2]
}

/// Scales to unit length in Q2.14, rounding to nearest.
const fn unit(v: [i64; 3]) -> [i16; 3] {
    // 1 << 24 keeps 24 fraction bits of the length.
    let length = ((v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) << 24).isqrt();
    let scale = 1 << (12 + COMPONENT_BITS);
    [
        ((v[0] * scale + length / 2) / length) as i16,
        ((v[1] * scale + length / 2) / length) as i16,
        ((v[2] * scale + length / 2) / length) as i16,
    ]
}

/// The unit normal of a code (upper bits are ignored), Q2.14.
#[inline(always)]
pub fn decode(code: u16) -> [i32; 3] {
    let index = usize::from(code) % OCTANT_CODES;
    let [x, y, z] = OCTANT.get(index).copied().unwrap_or([0; 3]);
    let signed = |component: i16, bit: u16| {
        let component = i32::from(component);
        if code & bit == 0 {
            component
        } else {
            -component
        }
    };
    [signed(x, 1 << 10), signed(y, 1 << 11), signed(z, 1 << 12)]
}

/// The code whose triangle contains a direction. Any length below 2^28 will
/// do, the longer the more exact; the zero vector counts as +x.
pub fn encode(direction: [i32; 3]) -> u16 {
    let [x, y, z] = direction;
    let signs = u16::from(x < 0) | u16::from(y < 0) << 1 | u16::from(z < 0) << 2;
    triangle(direction, LEVEL) as u16 | signs << 10
}

/// The triangle that contains a direction, of its octant's face, subdivided
/// `level` times, at most 15: two bits a level, coarsest first. Lengths are those
/// of [`encode`].
#[inline]
pub fn triangle(direction: [i32; 3], level: u32) -> usize {
    let mut weights = direction.map(|component| i64::from(component.unsigned_abs()));
    if weights == [0; 3] {
        weights = [1, 0, 0];
    }
    let [x, y, z] = weights;
    let sum = x + y + z;
    let mut code = 0;
    for _ in 0..level {
        let [x, y, z] = weights.map(|weight| 2 * weight);
        let (child, next) = if x > sum {
            (0, [x - sum, y, z])
        } else if y > sum {
            (1, [x, y - sum, z])
        } else if z > sum {
            (2, [x, y, z - sum])
        } else {
            (3, [sum - x, sum - y, sum - z])
        };
        weights = next;
        code = code << 2 | child;
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    fn float(code: u16) -> [f64; 3] {
        decode(code).map(|component| f64::from(component) / f64::from(1 << COMPONENT_BITS))
    }

    #[test]
    fn every_code_is_a_unit_vector_that_encodes_to_itself() {
        for code in 0..CODES as u16 {
            let [x, y, z] = float(code);
            let length = (x * x + y * y + z * z).sqrt();
            assert!((length - 1.0).abs() < 1e-4, "code {code}: length {length}");
            assert_eq!(encode(decode(code)), code);
            let opposite = float(code ^ OPPOSITE);
            assert_eq!(opposite, [-x, -y, -z], "opposite of code {code}");
        }
    }

    #[test]
    fn dot_product_error_is_that_of_table_3() {
        let (mut worst, mut sum) = (0f64, 0f64);
        let mut state = 1u64;
        let mut random = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64 / f64::from(1u32 << 30) - 1.0
        };
        let mut count = 0;
        while count < 300_000 {
            let v = [random(), random(), random()];
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
            if !(0.01..1.0).contains(&length) {
                continue;
            }
            count += 1;
            let v = v.map(|component| component / length);
            let code = encode(v.map(|component| (component * f64::from(1 << 24)) as i32));
            let decoded = float(code);
            let length = decoded.iter().map(|c| c * c).sum::<f64>().sqrt();
            let dot = v[0] * decoded[0] + v[1] * decoded[1] + v[2] * decoded[2];
            let error = 1.0 - dot / length;
            worst = worst.max(error);
            sum += error;
        }
        let mean = sum / f64::from(count);
        assert!((9.0e-4..9.7e-4).contains(&worst), "largest {worst}");
        assert!((1.5e-4..1.7e-4).contains(&mean), "mean {mean}");
    }
}
