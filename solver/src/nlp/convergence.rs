//! How far an iterate is from the optimality conditions.

use super::dense::{add_transpose_mul, axpy};
use super::interior_point::InteriorPoint;
use super::iterate::Iterate;

/// Multipliers above this average scale the optimality error down.
const MULTIPLIER_SCALE: f64 = 100.0;

/// Scaled maximum norms of the optimality conditions.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Residuals {
    stationarity: f64,
    /// Largest gap, equality or slack error.
    pub(super) feasibility: f64,
    /// Least and greatest product of slack and multiplier.
    products: (f64, f64),
    z_scale: f64,
}

impl Residuals {
    /// The error of the barrier problem with parameter `mu`.
    pub(super) fn of_barrier(&self, mu: f64) -> f64 {
        self.optimality(mu).max(self.feasibility)
    }

    /// The error of stationarity and complementarity.
    pub(super) fn optimality(&self, mu: f64) -> f64 {
        let (least, greatest) = self.products;
        let complementarity = (greatest - mu).max(mu - least).max(0.0);
        self.stationarity.max(complementarity / self.z_scale)
    }
}

impl InteriorPoint {
    /// Measures the optimality conditions where the models have been evaluated.
    pub(super) fn residuals(&mut self, iterate: &Iterate) -> Residuals {
        let n = self.layout.states;
        let mut found = Residuals::default();
        let mut products = (f64::INFINITY, f64::NEG_INFINITY);
        for (node, model) in self.models.iter().enumerate() {
            let residual = &mut self.residual[..model.vars];
            let duals = iterate.multipliers(&self.layout, node);
            residual.copy_from_slice(&model.gradient);
            add_transpose_mul(&model.link_jacobian, model.vars, duals.gap, residual);
            add_transpose_mul(&model.equality_jacobian, n, duals.equality, residual);
            if node > 0 {
                let arriving = &iterate.lambda[self.layout.link(node - 1)];
                axpy(-1.0, arriving, &mut residual[..n]);
            }
            let slack = &iterate.slack[self.layout.inequality(node)];
            for (i, (&z, &s)) in duals.inequality.iter().zip(slack).enumerate() {
                axpy(-z, model.inequality_row(i), residual);
                found.feasibility = found
                    .feasibility
                    .max((model.values.inequality[i] - s).abs());
                products = (products.0.min(s * z), products.1.max(s * z));
            }
            found.stationarity = max_abs(residual, found.stationarity);
            found.feasibility = found.feasibility.max(model.values.defect_max());
        }
        let mean = |sum: f64, count: usize| sum / count.max(1) as f64;
        let z_sum: f64 = iterate.z.iter().sum();
        let others = iterate.lambda.iter().chain(&iterate.nu);
        let all = others.map(|v| v.abs()).sum::<f64>() + z_sum;
        let count = iterate.lambda.len() + iterate.nu.len() + iterate.z.len();
        found.stationarity /= (mean(all, count) / MULTIPLIER_SCALE).max(1.0);
        found.z_scale = (mean(z_sum, iterate.z.len()) / MULTIPLIER_SCALE).max(1.0);
        if iterate.z.is_empty() {
            products = (0.0, 0.0);
        }
        found.products = products;
        found
    }
}

fn max_abs(values: &[f64], least: f64) -> f64 {
    values.iter().fold(least, |worst, v| worst.max(v.abs()))
}
