//! The plane through a few points: principal components of their positions.
//!
//! Source: the cyclic Jacobi method (G. H. Golub and C. F. Van Loan, Matrix
//! Computations, 1996, 8.4): only `+ - * /` and square roots, which are exact
//! to the bit on every machine.

use glam::DVec3;

/// Sweeps of the Jacobi method. It doubles the correct digits with each; five
/// reach the last bit from any start.
const SWEEPS: usize = 6;

/// Second eigenvalue over the largest below which points are on a line: they
/// stray from it by a hundredth of their spread.
const COLLINEAR: f64 = 1e-4;

/// A plane through points.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Unit normal of either sign.
    pub normal: DVec3,
    /// Variances of the points along their principal axes, ascending; the
    /// first is along the normal.
    pub variances: [f64; 3],
}

impl Plane {
    /// The plane of least squared distances. Its normal is some unit vector
    /// where the points do not span one.
    pub fn through(points: impl Iterator<Item = DVec3> + Clone) -> Self {
        let (count, sum) = points
            .clone()
            .fold((0.0, DVec3::ZERO), |(count, sum), point| {
                (count + 1.0, sum + point)
            });
        let mean = sum / f64::max(count, 1.0);
        let mut matrix = [[0.0; 3]; 3];
        for point in points {
            let offset = (point - mean).to_array();
            for row in 0..3 {
                for column in 0..3 {
                    matrix[row][column] += offset[row] * offset[column] / count;
                }
            }
        }
        Self::of_covariance(matrix)
    }

    fn of_covariance(mut matrix: [[f64; 3]; 3]) -> Self {
        let mut axes = [DVec3::X, DVec3::Y, DVec3::Z];
        for _ in 0..SWEEPS {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                rotate(&mut matrix, &mut axes, p, q);
            }
        }
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| matrix[a][a].total_cmp(&matrix[b][b]));
        Self {
            normal: axes[order[0]].normalize(),
            // Rounding leaves a little below zero.
            variances: order.map(|axis| matrix[axis][axis].max(0.0)),
        }
    }

    /// Whether the points lie on one line, or in one place.
    pub fn is_line(&self) -> bool {
        let [_, middle, largest] = self.variances;
        middle <= COLLINEAR * largest
    }
}

/// Makes the elements (p, q) and (q, p) of a symmetric matrix zero by a
/// rotation, which the axes follow.
fn rotate(matrix: &mut [[f64; 3]; 3], axes: &mut [DVec3; 3], p: usize, q: usize) {
    let off = matrix[p][q];
    if off == 0.0 {
        return;
    }
    let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * off);
    // The smaller root of t^2 + 2 theta t - 1. Where theta is infinite it is 0.
    let sign = if theta < 0.0 { -1.0 } else { 1.0 };
    let tangent = sign / (theta.abs() + (theta * theta + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    let other = 3 - p - q;
    matrix[p][p] -= tangent * off;
    matrix[q][q] += tangent * off;
    matrix[p][q] = 0.0;
    matrix[q][p] = 0.0;
    let (a, b) = (matrix[other][p], matrix[other][q]);
    let (a, b) = (cosine * a - sine * b, sine * a + cosine * b);
    (matrix[other][p], matrix[p][other]) = (a, a);
    (matrix[other][q], matrix[q][other]) = (b, b);
    let (a, b) = (axes[p], axes[q]);
    axes[p] = a * cosine - b * sine;
    axes[q] = a * sine + b * cosine;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::estimate::tests::Random;

    #[test]
    fn principal_axes_solve_the_eigenvalue_equation() {
        let mut random = Random(3);
        for scale in [1.0, 1e-30, 1e30, 1e-3] {
            for _ in 0..200 {
                let stretch = DVec3::new(1.0, random.unit(), random.unit() * 0.01) * scale;
                let points: Vec<DVec3> = (0..12).map(|_| random.vector() * stretch).collect();
                let plane = Plane::through(points.iter().copied());
                let mean = points.iter().sum::<DVec3>() / 12.0;
                let offsets = points.iter().map(|point| (point - mean) / scale);
                let product = offsets
                    .map(|offset| offset * offset.dot(plane.normal) / 12.0)
                    .sum::<DVec3>();
                let least = plane.variances[0] / scale / scale;
                assert!((product - plane.normal * least).length() < 1e-14);
                assert!(plane.variances.is_sorted());
            }
        }
    }

    #[test]
    fn lines_and_places_are_no_planes() {
        let line = [0.0, 1.0, 2.5].map(|x| DVec3::new(x, 3.0 * x, -x));
        assert!(Plane::through(line.into_iter()).is_line());
        for count in [0, 1, 5] {
            let plane = Plane::through(std::iter::repeat_n(DVec3::ONE, count));
            assert!(plane.is_line() && plane.normal.is_normalized());
        }
        let flat = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
        let plane = Plane::through(flat.into_iter());
        assert!(!plane.is_line() && plane.normal.z.abs() == 1.0);
    }
}
