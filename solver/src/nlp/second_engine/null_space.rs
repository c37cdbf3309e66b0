//! The linear equations of a step: a particular solution and the null space.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Pivots below this share of the first count as zero: their equations depend on others.
const DEPENDENT: f64 = 1e-10;

/// The solutions `d = particular + basis y` of `E d = -c`.
pub(super) struct NullSpace {
    /// Orthonormal columns that span the null space of `E`.
    pub(super) basis: DMatrix<f64>,
    /// Orthonormal columns that span the range of `E^T`.
    range: DMatrix<f64>,
    /// `M = E range` and the factor of `M^T M`.
    image: DMatrix<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl NullSpace {
    /// Of a matrix with fewer rows than columns, some of which may depend on each other; `None`
    /// when it is not finite.
    pub(super) fn of(equal: &DMatrix<f64>) -> Option<Self> {
        let unknowns = equal.ncols();
        let square = equal.transpose().resize_horizontally(unknowns, 0.0);
        let decomposed = square.col_piv_qr();
        let triangle = decomposed.r();
        let least = DEPENDENT * triangle.get((0, 0)).copied().unwrap_or(0.0).abs();
        let rank = (0..unknowns)
            .take_while(|&i| triangle[(i, i)].abs() > least)
            .count();
        let q = decomposed.q();
        let range = q.columns(0, rank).into_owned();
        let image = equal * &range;
        Some(Self {
            basis: q.columns(rank, unknowns - rank).into_owned(),
            factor: image.tr_mul(&image).cholesky()?,
            range,
            image,
        })
    }

    /// The smallest `d` with `E d = target`, as nearly as the equations allow.
    pub(super) fn particular(&self, target: &DVector<f64>) -> DVector<f64> {
        let mut weights = self.factor.solve(&self.image.tr_mul(target));
        // Once more with the residual: the normal equations lose half the digits.
        let residual = target - &self.image * &weights;
        weights += self.factor.solve(&self.image.tr_mul(&residual));
        &self.range * weights
    }

    /// The smallest `y` with `E^T y = target`, as nearly as possible.
    pub(super) fn multipliers(&self, target: &DVector<f64>) -> DVector<f64> {
        let mut residual = self.range.tr_mul(target);
        let mut found = DVector::zeros(self.image.nrows());
        for _ in 0..2 {
            found += &self.image * self.factor.solve(&residual);
            residual = self.range.tr_mul(target) - self.image.tr_mul(&found);
        }
        found
    }
}
