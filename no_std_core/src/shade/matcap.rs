//! Ambient light by where a normal points on the screen.
//!
//! Source: Sloan, Martin, Gooch and Gooch, The Lit Sphere, 2001: the picture of
//! a lit sphere holds the light for every normal that the eye sees.

use crate::asset::Rgb;
use crate::camera::Camera;
use crate::placement::NormalMap;

/// The picture of a sphere, RGB565, row-major, as many rows as columns; the
/// sphere touches its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Matcap<'a> {
    texels: &'a [u16],
    side: u16,
}

impl<'a> Matcap<'a> {
    /// Most texels along a side.
    pub const MAX_SIDE: u16 = 1024;

    /// A square of texels; `None` if they make none, or a larger one than
    /// [`Self::MAX_SIDE`].
    pub fn new(texels: &'a [u16]) -> Option<Self> {
        let side = texels.len().isqrt();
        let is_square =
            side > 0 && side <= usize::from(Self::MAX_SIDE) && side * side == texels.len();
        is_square.then_some(Self {
            texels,
            side: side as u16,
        })
    }

    /// The texels, row after row.
    pub fn texels(&self) -> &'a [u16] {
        self.texels
    }

    /// The texel of a place on the sphere, x to the right and y up, one being
    /// its rim: Q4.28.
    fn texel(&self, [x, y]: [i32; 2]) -> u16 {
        let side = i32::from(self.side);
        // Two units to a side: of 15 bits and the side's 10.
        let at = |along: i32| {
            ((((along >> 14) + (1 << 14)) * side) >> 15)
                .min(side - 1)
                .max(0)
        };
        let (column, row) = (at(x) as usize, at(-y) as usize);
        let index = row * usize::from(self.side) + column;
        self.texels.get(index).copied().unwrap_or(0)
    }
}

/// A matcap as normals meet the eye.
#[derive(Clone, Copy)]
pub(crate) struct LitSphere<'a> {
    matcap: Matcap<'a>,
    /// To the right and up, Q2.14.
    axes: [[i32; 3]; 2],
}

impl<'a> LitSphere<'a> {
    pub fn new(matcap: Matcap<'a>, camera: &Camera, normals: &NormalMap) -> Self {
        Self {
            matcap,
            axes: [camera.right, camera.up].map(|axis| normals.light(axis)),
        }
    }

    /// The light on a normal, Q2.14: a share of each channel, 0 to 255.
    pub fn light(&self, [x, y, z]: [i32; 3]) -> Rgb {
        // A unit vector and another one: at most 2^28, rounding aside.
        let along = self
            .axes
            .map(|axis| x * axis[0] + y * axis[1] + z * axis[2]);
        crate::asset::expanded(self.matcap.texel(along))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::{Inverse, Placement};
    use crate::testing::{Rng, camera, direction, dot};
    use std::vec::Vec;

    #[test]
    fn only_squares_are_matcaps() {
        let texels = [0; 17];
        assert_eq!(
            Matcap::new(&texels[..16]).map(|matcap| matcap.side),
            Some(4)
        );
        assert!(Matcap::new(&texels).is_none() && Matcap::new(&[]).is_none());
        let large = std::vec![0; 1025 * 1025];
        assert!(Matcap::new(&large).is_none());
    }

    /// Every texel has a colour of its own: the texel that is found is the one
    /// where the normal is, or its neighbour where rounding decides.
    #[test]
    fn normals_find_their_place_on_the_sphere() {
        let mut rng = Rng::with_seed(44);
        let side = 64;
        let texels: Vec<u16> = (0..side * side).collect();
        let matcap = Matcap::new(&texels).expect("a square");
        let identity = Inverse::of(&Placement::IDENTITY).expect("has volume");
        let normals = NormalMap::new(&Placement::IDENTITY, identity);
        for _ in 0..2000 {
            let camera = camera(&mut rng, 4.0, 64.0);
            let sphere = LitSphere::new(matcap, &camera, &normals);
            let normal = direction(&mut rng);
            let fixed = normal.map(|c| (c * 16384.0).round() as i32);
            let texel = sphere.matcap.texel(
                sphere
                    .axes
                    .map(|axis| (0..3).map(|at| fixed[at] * axis[at]).sum()),
            );
            let along = |axis: [crate::numbers::Unit; 3]| {
                (dot(normal, axis.map(|c| c.to_num())) + 1.0) / 2.0 * f64::from(side)
            };
            let (x, y) = (along(camera.right), f64::from(side) - along(camera.up));
            let got = [texel % side, texel / side];
            for (got, want) in got.into_iter().zip([x, y]) {
                let off = (f64::from(got) + 0.5 - want).abs();
                assert!(off < 0.52, "{got}, not {want}");
            }
        }
    }
}
