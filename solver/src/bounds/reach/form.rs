//! Affine forms: numbers that depend on the place in a cell.
//!
//! A form is `c + a . d + r`, where the three deviations `d` of a place from the middle of its cell are within
//! `[-1, 1]` and shared by all forms of the cell, and `r` is any number within the rest. Every operation adds to the
//! rest what it leaves out, rounding included, so a form encloses its number at every place.

use crate::bounds::interval::Interval;

/// Twice the relative error of an operation.
const ROUNDING: f64 = f64::EPSILON;

/// Deviations of a place in its cell, and three more.
pub(super) const SYMBOLS: usize = 6;

/// A number at the places of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Form {
    /// At the middle.
    pub(super) middle: f64,
    /// Change with each deviation.
    pub(super) slopes: [f64; SYMBOLS],
    /// Largest distance from `middle + slopes . d`.
    pub(super) rest: f64,
}

/// A vector of forms.
pub(super) type VectorForm = [Form; 3];

/// A sum of numbers that are not negative, and what its rounding may have lost.
fn above(sum: f64) -> f64 {
    sum * (1.0 + 16.0 * ROUNDING) + f64::MIN_POSITIVE
}

impl Form {
    pub(super) const ZERO: Self = Self::exactly(0.0);

    /// One number everywhere.
    pub(super) const fn exactly(middle: f64) -> Self {
        Self {
            middle,
            slopes: [0.0; SYMBOLS],
            rest: 0.0,
        }
    }

    /// Any number within a distance.
    pub(super) const fn within(middle: f64, rest: f64) -> Self {
        Self {
            middle,
            slopes: [0.0; SYMBOLS],
            rest,
        }
    }

    /// The sum of the sizes of the slopes and the rest.
    pub(super) fn radius(&self) -> f64 {
        above(self.inclined() + self.rest)
    }

    /// The sum of the sizes of the slopes.
    fn inclined(&self) -> f64 {
        self.slopes.iter().fold(0.0, |sum, slope| sum + slope.abs())
    }

    /// The same with all but the first three symbols in the rest.
    pub(super) fn of_places(mut self) -> Self {
        for slope in &mut self.slopes[3..] {
            self.rest = above(self.rest + slope.abs());
            *slope = 0.0;
        }
        self
    }

    /// An upper bound on the size.
    pub(super) fn size(&self) -> f64 {
        above(self.middle.abs() + self.radius())
    }

    /// All its numbers.
    pub(super) fn hull(&self) -> Interval {
        Interval::around(self.middle, self.radius())
    }

    /// The same with a larger rest.
    pub(super) fn inflated(mut self, by: f64) -> Self {
        self.rest = above(self.rest + by);
        self
    }

    fn rounded(mut self, factor: f64) -> Self {
        self.rest = above(self.rest + factor * ROUNDING * (self.middle.abs() + self.inclined()));
        self
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            middle: self.middle + other.middle,
            slopes: std::array::from_fn(|k| self.slopes[k] + other.slopes[k]),
            rest: self.rest + other.rest,
        }
        .rounded(1.0)
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        Self {
            middle: self.middle - other.middle,
            slopes: std::array::from_fn(|k| self.slopes[k] - other.slopes[k]),
            rest: self.rest + other.rest,
        }
        .rounded(1.0)
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            middle: self.middle * factor,
            slopes: self.slopes.map(|slope| slope * factor),
            rest: self.rest * factor.abs(),
        }
        .rounded(1.0)
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        let (wide, broad) = (a.radius(), b.radius());
        let mut slopes = [0.0; SYMBOLS];
        let mut sizes = (a.middle * b.middle).abs();
        for k in 0..SYMBOLS {
            let parts = [a.middle * b.slopes[k], b.middle * a.slopes[k]];
            slopes[k] = parts[0] + parts[1];
            sizes += parts[0].abs() + parts[1].abs();
        }
        let rest = a.middle.abs() * b.rest
            + b.middle.abs() * a.rest
            + wide * broad
            + 2.0 * ROUNDING * sizes;
        Self {
            middle: a.middle * b.middle,
            slopes,
            rest: above(rest),
        }
    }

    /// `factor self + middle` up to a rest: an enclosure of a function whose graph is that close to a line.
    pub(super) fn along_line(&self, factor: f64, residual: Interval) -> Self {
        let middle = residual.middle();
        let rest = (residual.high - middle).max(middle - residual.low);
        self.scaled(factor)
            .plus(&Self::within(middle, rest.next_up()))
    }
}

/// Three values. The map of an array is not inlined by itself.
#[expect(
    clippy::inline_always,
    reason = "measured: half of the time of a covering"
)]
#[inline(always)]
pub(super) fn each<T>(mut of: impl FnMut(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// Sum of the products with three numbers.
pub(super) fn combined(factors: [f64; 3], of: &VectorForm) -> Form {
    let mut sum = Form::ZERO;
    let mut sizes = 0.0;
    for (factor, form) in factors.iter().zip(of) {
        sum.middle += factor * form.middle;
        sizes += (factor * form.middle).abs();
        for k in 0..SYMBOLS {
            sum.slopes[k] += factor * form.slopes[k];
            sizes += (factor * form.slopes[k]).abs();
        }
        sum.rest += factor.abs() * form.rest;
    }
    sum.rest = above(sum.rest + 4.0 * ROUNDING * sizes);
    sum
}

/// Vector product.
pub(super) fn cross(a: &VectorForm, b: &VectorForm) -> VectorForm {
    each(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j].times(&b[k]).minus(&a[k].times(&b[j]))
    })
}

/// Sum of two vectors.
pub(super) fn sum(a: &VectorForm, b: &VectorForm) -> VectorForm {
    each(|i| a[i].plus(&b[i]))
}

/// Difference of two vectors.
pub(super) fn difference(a: &VectorForm, b: &VectorForm) -> VectorForm {
    each(|i| a[i].minus(&b[i]))
}

/// An upper bound on the length of a vector.
pub(super) fn length(v: &VectorForm) -> f64 {
    long(v.map(|x| x.size()))
}

/// An upper bound on the length of a vector with components of such sizes.
pub(super) fn long(sizes: [f64; 3]) -> f64 {
    let [x, y, z] = sizes;
    above((x * x + y * y + z * z).sqrt())
}
