//! Intervals of real numbers with outward rounding.
//!
//! Sums, products, quotients and square roots are correctly rounded (IEEE 754), so the two
//! neighbours of a result enclose the exact one. Sine, cosine and the arc functions are not
//! specified: the common mathematical libraries state errors of one or two units in the last place
//! (glibc: 1 ulp for `sin` and `cos`, 1 to 2 for `atan2`); [`LIBRARY`] allows nine units of a
//! number near one and more than four of an arc near `pi`.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Absolute error allowed for sines, cosines and arcs: 9 ulp of a number just above one (2.2e-16
/// each), and 4.5 ulp of an arc between 2 and `pi` (4.4e-16 each).
const LIBRARY: f64 = 2e-15;

/// All numbers from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::bounds) struct Interval {
    pub(in crate::bounds) low: f64,
    pub(in crate::bounds) high: f64,
}

impl Interval {
    pub(in crate::bounds) const ZERO: Self = Self {
        low: 0.0,
        high: 0.0,
    };
    pub(in crate::bounds) const ONE: Self = Self {
        low: 1.0,
        high: 1.0,
    };
    /// `pi` lies between its nearest double, which is less, and the successor of that.
    pub(in crate::bounds) const PI: Self = Self {
        low: PI,
        high: 3.141_592_653_589_793_6,
    };

    /// One number.
    pub(in crate::bounds) fn exactly(x: f64) -> Self {
        Self { low: x, high: x }
    }

    /// All numbers within a distance of a number.
    pub(in crate::bounds) fn around(x: f64, radius: f64) -> Self {
        Self {
            low: (x - radius).next_down(),
            high: (x + radius).next_up(),
        }
    }

    pub(in crate::bounds) fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Half the width, rounded up, about [`Self::middle`].
    fn radius(self) -> f64 {
        let middle = self.middle();
        (self.high - middle).max(middle - self.low).next_up()
    }

    pub(in crate::bounds) fn contains_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// The largest absolute value.
    pub(in crate::bounds) fn size(self) -> f64 {
        self.high.max(-self.low)
    }

    /// The smaller one of two numbers.
    pub(in crate::bounds) fn least(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.min(other.high),
        }
    }

    /// The numbers that are in both intervals; `None` where there are none.
    pub(in crate::bounds) fn common(self, other: Self) -> Option<Self> {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        (low <= high).then_some(Self { low, high })
    }

    /// `|x|`.
    pub(in crate::bounds) fn abs(self) -> Self {
        Self {
            low: self.low.max(-self.high).max(0.0),
            high: self.size(),
        }
    }

    /// `x^2`.
    pub(in crate::bounds) fn squared(self) -> Self {
        let size = self.abs();
        Self {
            low: (size.low * size.low).next_down().max(0.0),
            high: (size.high * size.high).next_up(),
        }
    }

    /// The square root of the part that is not negative.
    pub(in crate::bounds) fn sqrt(self) -> Self {
        Self {
            low: self.low.max(0.0).sqrt().next_down().max(0.0),
            high: self.high.max(0.0).sqrt().next_up(),
        }
    }

    /// The length of a vector of two components.
    pub(in crate::bounds) fn length(self, other: Self) -> Self {
        (self.squared() + other.squared()).sqrt()
    }

    /// Sine and cosine, whose derivatives are at most one.
    pub(in crate::bounds) fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.middle().sin_cos();
        let radius = (self.radius() + LIBRARY).next_up();
        (Self::around(sin, radius), Self::around(cos, radius))
    }

    /// The angle of the vector `(x, y)`, around `atan2` of the middles; the whole circle, a radius
    /// of `pi`, when the vector may be zero. The result is not reduced to a range.
    pub(in crate::bounds) fn angle(y: Self, x: Self) -> Self {
        let angle = f64::atan2(y.middle(), x.middle());
        // The sine of the angle between the middle and any point of the box, seen from the origin,
        // is at most the ratio of the box's radius to the distance of its middle.
        let radius = Self::exactly(x.radius())
            .length(Self::exactly(y.radius()))
            .high;
        let distance = Self::exactly(x.middle())
            .length(Self::exactly(y.middle()))
            .low;
        let sine = (radius / distance).next_up();
        if sine.is_nan() || sine >= 0.5 {
            return Self::around(angle, Self::PI.high);
        }
        // asin s <= s / sqrt(1 - s^2) <= 1.2 s for s <= 1/2.
        Self::around(angle, (1.2 * sine + LIBRARY).next_up())
    }

    /// The arc cosine of the part within `[-1, 1]`.
    pub(in crate::bounds) fn acos(self) -> Self {
        Self {
            low: (self.high.clamp(-1.0, 1.0).acos() - LIBRARY).max(0.0),
            high: (self.low.clamp(-1.0, 1.0).acos() + LIBRARY).next_up(),
        }
    }

    /// `2 x`.
    pub(in crate::bounds) fn twice(self) -> Self {
        Self {
            low: 2.0 * self.low,
            high: 2.0 * self.high,
        }
    }

    /// `x / 2`.
    pub(in crate::bounds) fn half(self) -> Self {
        Self {
            low: 0.5 * self.low,
            high: 0.5 * self.high,
        }
    }
}

/// An upper bound on `2 asin(sqrt(x))`: half a turn for `x >= 1/2`, else from the tangent.
pub(in crate::bounds) fn twice_asin_of_root(x: f64) -> f64 {
    if x >= 0.5 {
        return Interval::PI.high;
    }
    // asin s <= s / sqrt(1 - s^2), the tangent.
    let x = Interval::exactly(x.max(0.0));
    let bound = (x / (Interval::ONE - x)).sqrt().high * 2.0;
    bound.min(2.0 * FRAC_PI_2.next_up())
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            low: (self.low + other.low).next_down(),
            high: (self.high + other.high).next_up(),
        }
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let products = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        let [a, b, c, d] = products;
        Self {
            low: a.min(b).min(c.min(d)).next_down(),
            high: a.max(b).max(c.max(d)).next_up(),
        }
    }
}

impl Div for Interval {
    type Output = Self;

    /// All numbers when the divisor may be zero.
    fn div(self, other: Self) -> Self {
        if other.contains_zero() {
            return Self {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            };
        }
        let quotients = [
            self.low / other.low,
            self.low / other.high,
            self.high / other.low,
            self.high / other.high,
        ];
        let [a, b, c, d] = quotients;
        Self {
            low: a.min(b).min(c.min(d)).next_down(),
            high: a.max(b).max(c.max(d)).next_up(),
        }
    }
}
