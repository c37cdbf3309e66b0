//! How far an iterate is from the optimality conditions.

use super::dense::{add_transpose_mul, axpy};
use super::interior_point::InteriorPoint;
use super::iterate::Iterate;

/// Multipliers above this average scale the optimality error down.
const MULTIPLIER_SCALE: f64 = 100.0;

impl InteriorPoint {
    /// Scaled maximum norm of the optimality conditions for a barrier parameter.
    pub(super) fn error(&self, iterate: &Iterate, mu: f64) -> f64 {
        let n = self.layout.states;
        let mut stationarity = 0.0_f64;
        let mut feasibility = 0.0_f64;
        let mut complementarity = 0.0_f64;
        let mut residual = [0.0; 64];
        for (node, model) in self.models.iter().enumerate() {
            let residual = &mut residual[..model.vars];
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
                feasibility = feasibility.max((model.values.inequality[i] - s).abs());
                complementarity = complementarity.max((s * z - mu).abs());
            }
            stationarity = residual
                .iter()
                .fold(stationarity, |worst, r| worst.max(r.abs()));
            feasibility = feasibility.max(model.values.defect_max());
        }
        let mean = |sum: f64, count: usize| sum / count.max(1) as f64;
        let z_sum: f64 = iterate.z.iter().sum();
        let all: f64 = iterate
            .lambda
            .iter()
            .chain(&iterate.nu)
            .map(|v| v.abs())
            .sum::<f64>()
            + z_sum;
        let count = iterate.lambda.len() + iterate.nu.len() + iterate.z.len();
        let dual_scale = (mean(all, count) / MULTIPLIER_SCALE).max(1.0);
        let z_scale = (mean(z_sum, iterate.z.len()) / MULTIPLIER_SCALE).max(1.0);
        (stationarity / dual_scale)
            .max(feasibility)
            .max(complementarity / z_scale)
    }
}
