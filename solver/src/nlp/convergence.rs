//! How far an iterate is from the optimality conditions.

use super::barrier::BarrierProblem;
use super::dense::{add_transpose_mul, axpy};
use super::iterate::Iterate;
use super::riccati::{MAX_CONTROLS, MAX_STATES};
use super::settings::Settings;

/// Multipliers above this average scale the optimality error down.
const MULTIPLIER_SCALE: f64 = 100.0;

/// Scaled maximum norms of the optimality conditions.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Residuals {
    stationarity: f64,
    /// Largest gap, equality or slack error.
    feasibility: f64,
    /// Least and greatest product of slack and multiplier.
    products: (f64, f64),
    z_scale: f64,
}

impl Residuals {
    /// Measures the conditions at the iterate of which the problem holds the models.
    pub(super) fn of(problem: &BarrierProblem, iterate: &Iterate) -> Self {
        let layout = &problem.layout;
        let n = layout.states;
        let mut found = Self::default();
        let mut products = (f64::INFINITY, f64::NEG_INFINITY);
        let mut stationarity = [0.0; MAX_STATES + MAX_CONTROLS];
        for (node, model) in problem.models.iter().enumerate() {
            let residual = &mut stationarity[..model.vars];
            residual.fill(0.0);
            let duals = iterate.multipliers(layout, node);
            add_transpose_mul(&model.inequality_jacobian, duals.inequality, residual);
            for (out, gradient) in residual.iter_mut().zip(&model.gradient) {
                *out = gradient - *out;
            }
            add_transpose_mul(&model.link_jacobian, duals.gap, residual);
            add_transpose_mul(&model.equality_jacobian, duals.equality, &mut residual[..n]);
            if node > 0 {
                let arriving = &iterate.lambda[layout.link(node - 1)];
                axpy(-1.0, arriving, &mut residual[..n]);
            }
            let slack = &iterate.slack[layout.inequality(node)];
            let values = model.values.inequality.iter();
            for ((&z, &s), g) in duals.inequality.iter().zip(slack).zip(values) {
                found.feasibility = greater(found.feasibility, (g - s).abs());
                products = (-greater(-products.0, -(s * z)), greater(products.1, s * z));
            }
            found.stationarity = max_abs(residual, found.stationarity);
            found.feasibility = greater(found.feasibility, model.values.defect_max());
        }
        found.scale_by_multipliers(iterate);
        if iterate.z.is_empty() {
            products = (0.0, 0.0);
        }
        found.products = products;
        found
    }

    /// Divides the errors by the average size of the multipliers, where that is large.
    fn scale_by_multipliers(&mut self, iterate: &Iterate) {
        let mean = |sum: f64, count: usize| sum / count.max(1) as f64;
        let z_sum: f64 = iterate.z.iter().sum();
        let others = iterate.lambda.iter().chain(&iterate.nu);
        let all = others.map(|v| v.abs()).sum::<f64>() + z_sum;
        let count = iterate.lambda.len() + iterate.nu.len() + iterate.z.len();
        self.stationarity /= (mean(all, count) / MULTIPLIER_SCALE).max(1.0);
        self.z_scale = (mean(z_sum, iterate.z.len()) / MULTIPLIER_SCALE).max(1.0);
    }

    /// Whether the conditions hold within the tolerances.
    pub(super) fn are_within(&self, settings: &Settings) -> bool {
        self.complementarity(0.0) <= settings.tolerance
            && self.stationarity <= settings.stationarity * settings.tolerance
            && self.feasibility <= settings.feasibility
    }

    /// The error of the barrier problem with parameter `mu`.
    pub(super) fn of_barrier(&self, mu: f64) -> f64 {
        let optimality = self.stationarity.max(self.complementarity(mu));
        optimality.max(self.feasibility)
    }

    /// The error of complementarity.
    fn complementarity(&self, mu: f64) -> f64 {
        let (least, greatest) = self.products;
        (greatest - mu).max(mu - least).max(0.0) / self.z_scale
    }
}

fn max_abs(values: &[f64], least: f64) -> f64 {
    values
        .iter()
        .fold(least, |worst, v| greater(worst, v.abs()))
}

/// The greater of two numbers, the first one where the second is none: one instruction, where the
/// maximum of the standard library takes several.
fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_slack_and_multiplier_are_compared_with_the_barrier_parameter() {
        let residuals = Residuals {
            stationarity: 1e-6,
            feasibility: 1e-3,
            products: (1e-4, 3e-4),
            z_scale: 2.0,
        };
        let close = |a: f64, b: f64| (a - b).abs() < 1e-15;
        assert!(close(residuals.complementarity(0.0), 1.5e-4));
        assert!(close(residuals.complementarity(2e-4), 0.5e-4));
        assert!(close(residuals.of_barrier(2e-4), 1e-3));
        let settings = |feasibility| Settings {
            tolerance: 1.6e-4,
            feasibility,
            ..Settings::COLD
        };
        assert!(residuals.are_within(&settings(1e-3)));
        assert!(!residuals.are_within(&settings(1e-4)));
        let far = Residuals {
            stationarity: 1e-3,
            ..residuals
        };
        assert!(!far.are_within(&settings(1e-3)));
        let looser = Settings {
            stationarity: 10.0,
            ..settings(1e-3)
        };
        assert!(far.are_within(&looser));
    }
}
