//! Numbers that carry their first and second derivatives by a few features.
//!
//! A term of the program, for example the energy of a wheel over an interval, depends on at most
//! [`FEATURES`] quantities that are linear in the program's variables. Evaluated in jets, its formula
//! gives the first and second derivatives too, exact to rounding.

use std::ops::{Add, Mul, Sub};

/// Number of features of a term.
pub(super) const FEATURES: usize = 6;

/// A value with gradient and Hessian by the features.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) gradient: [f64; FEATURES],
    /// Both triangles.
    pub(super) hessian: [[f64; FEATURES]; FEATURES],
}

impl Jet {
    /// A number that depends on nothing.
    pub(super) fn constant(value: f64) -> Self {
        Self {
            value,
            gradient: [0.0; FEATURES],
            hessian: [[0.0; FEATURES]; FEATURES],
        }
    }

    /// The feature itself.
    pub(super) fn feature(index: usize, value: f64) -> Self {
        let mut jet = Self::constant(value);
        jet.gradient[index] = 1.0;
        jet
    }

    /// A function of the number, given its value and first two derivatives there.
    pub(super) fn through(&self, [value, slope, bend]: [f64; 3]) -> Self {
        let mut jet = Self::constant(value);
        for i in 0..FEATURES {
            jet.gradient[i] = slope * self.gradient[i];
            for j in 0..FEATURES {
                jet.hessian[i][j] =
                    slope * self.hessian[i][j] + bend * self.gradient[i] * self.gradient[j];
            }
        }
        jet
    }

    /// One over the number.
    pub(super) fn recip(&self) -> Self {
        let inverse = self.value.recip();
        self.through([inverse, -inverse * inverse, 2.0 * inverse.powi(3)])
    }
}

impl Add for Jet {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        for i in 0..FEATURES {
            self.gradient[i] += other.gradient[i];
            for j in 0..FEATURES {
                self.hessian[i][j] += other.hessian[i][j];
            }
        }
        self
    }
}

impl Sub for Jet {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul<f64> for Jet {
    type Output = Self;

    fn mul(mut self, scale: f64) -> Self {
        self.value *= scale;
        self.gradient.iter_mut().for_each(|g| *g *= scale);
        self.hessian.iter_mut().flatten().for_each(|h| *h *= scale);
        self
    }
}

impl Mul for Jet {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let mut jet = Self::constant(self.value * other.value);
        for i in 0..FEATURES {
            jet.gradient[i] = self.value * other.gradient[i] + other.value * self.gradient[i];
            for j in 0..FEATURES {
                jet.hessian[i][j] = self.value * other.hessian[i][j]
                    + other.value * self.hessian[i][j]
                    + self.gradient[i] * other.gradient[j]
                    + self.gradient[j] * other.gradient[i];
            }
        }
        jet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quotient_has_the_derivatives_of_its_formula() {
        let (x, y) = (3.0, 2.0);
        let jet = Jet::feature(0, x) * Jet::feature(0, x) * Jet::feature(1, y).recip();
        assert!((jet.value - 4.5).abs() < 1e-15);
        assert!((jet.gradient[0] - 2.0 * x / y).abs() < 1e-15);
        assert!((jet.gradient[1] + x * x / (y * y)).abs() < 1e-15);
        assert!((jet.hessian[0][0] - 2.0 / y).abs() < 1e-15);
        assert!((jet.hessian[0][1] + 2.0 * x / (y * y)).abs() < 1e-15);
        assert!((jet.hessian[1][1] - 2.0 * x * x / y.powi(3)).abs() < 1e-15);
    }
}
