//! Numbers that carry their two partial derivatives (forward-mode automatic
//! differentiation). A surface written once as a function of `u` and `v` in
//! these numbers yields positions and exact normals together, relief included.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

use super::elementary;

/// A value with its derivatives along the surface parameters u and v.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    pub value: f64,
    pub du: f64,
    pub dv: f64,
}

impl Jet {
    /// The parameter u itself.
    pub fn u(value: f64) -> Self {
        Self {
            value,
            du: 1.0,
            dv: 0.0,
        }
    }

    /// The parameter v itself.
    pub fn v(value: f64) -> Self {
        Self {
            value,
            du: 0.0,
            dv: 1.0,
        }
    }

    /// A function of this number, from its value and slope here (chain rule).
    fn map(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            du: self.du * slope,
            dv: self.dv * slope,
        }
    }

    pub fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = elementary::sin_cos(self.value);
        (self.map(sine, cosine), self.map(cosine, -sine))
    }

    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    pub fn exp(self) -> Self {
        let power = elementary::exp(self.value);
        self.map(power, power)
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.map(root, 0.5 / root)
    }

    pub fn square(self) -> Self {
        self * self
    }

    /// 0 up to `from`, 1 above `to`, in between 3x^2 - 2x^3.
    pub fn smoothstep(self, from: f64, to: f64) -> Self {
        let x = (self.value - from) / (to - from);
        if x <= 0.0 {
            self.map(0.0, 0.0)
        } else if x >= 1.0 {
            self.map(1.0, 0.0)
        } else {
            self.map(x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x) / (to - from))
        }
    }
}

impl From<f64> for Jet {
    fn from(value: f64) -> Self {
        Self {
            value,
            du: 0.0,
            dv: 0.0,
        }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            du: self.du + other.du,
            dv: self.dv + other.dv,
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            du: self.du * other.value + self.value * other.du,
            dv: self.dv * other.value + self.value * other.dv,
        }
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        self * other.map(inverse, -inverse * inverse)
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(-self.value, -1.0)
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        self.map(self.value + other, 1.0)
    }
}

impl Sub<f64> for Jet {
    type Output = Self;
    fn sub(self, other: f64) -> Self {
        self.map(self.value - other, 1.0)
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self.map(self.value * other, other)
    }
}

/// A surface point in jets.
#[derive(Clone, Copy, Debug)]
pub struct JetPoint {
    pub x: Jet,
    pub y: Jet,
    pub z: Jet,
}

impl JetPoint {
    pub fn position(self) -> DVec3 {
        DVec3::new(self.x.value, self.y.value, self.z.value)
    }

    /// Unit normal: derivative along u, cross derivative along v.
    pub fn normal(self) -> DVec3 {
        let du = DVec3::new(self.x.du, self.y.du, self.z.du);
        let dv = DVec3::new(self.x.dv, self.y.dv, self.z.dv);
        du.cross(dv).normalize()
    }

    pub fn dot(self, other: Self) -> Jet {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    pub fn scaled(self, factor: Jet) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }

    pub fn normalized(self) -> Self {
        self.scaled(Jet::from(1.0) / self.dot(self).sqrt())
    }
}

impl Add for JetPoint {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation at once, against central differences.
    #[test]
    fn derivatives_agree_with_differences() {
        let function = |u: Jet, v: Jet| {
            let (sine, cosine) = (u * v + 0.3).sin_cos();
            (sine.exp() / (cosine.square() + 1.0)).sqrt() - (u - 0.1).smoothstep(0.0, 2.0) * v
        };
        let at = |u: f64, v: f64| function(u.into(), v.into()).value;
        let step = 1e-5;
        for (u, v) in [(0.4, 0.7), (1.3, -0.2), (-0.8, 2.1)] {
            let jet = function(Jet::u(u), Jet::v(v));
            let du = (at(u + step, v) - at(u - step, v)) / (2.0 * step);
            let dv = (at(u, v + step) - at(u, v - step)) / (2.0 * step);
            assert!((jet.du - du).abs() < 1e-8, "{} {du}", jet.du);
            assert!((jet.dv - dv).abs() < 1e-8, "{} {dv}", jet.dv);
        }
    }
}
