//! What the line search weighs: infeasibility against the barrier cost.

use super::chain::LinkValues;
use super::iterate::Layout;

/// Number of slacks whose product goes into one logarithm: the product of eight does not underflow
/// while none is below 1e-38.
const LOGARITHM_BATCH: usize = 8;

/// Infeasibility and barrier cost of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Merit {
    /// Sum of absolute gaps, equalities and slack errors.
    pub(super) theta: f64,
    /// Cost minus the logarithmic barrier.
    pub(super) phi: f64,
}

impl Merit {
    /// Of the values of all links with all slacks, at the barrier parameter `mu`.
    pub(super) fn of<'a>(
        layout: &Layout,
        mu: f64,
        slack: &[f64],
        values: impl Iterator<Item = &'a LinkValues>,
    ) -> Self {
        let mut total = Self {
            theta: 0.0,
            phi: 0.0,
        };
        for (node, values) in values.enumerate() {
            total.theta += values.defect_norm();
            total.phi += values.cost;
            let slack = &slack[layout.inequality(node)];
            for (g, s) in values.inequality.iter().zip(slack) {
                total.theta += (g - s).abs();
            }
            for slacks in slack.chunks(LOGARITHM_BATCH) {
                total.phi -= mu * slacks.iter().product::<f64>().ln();
            }
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nlp::tests::carts::{Period, Sampled};
    use crate::nlp::values_of;

    #[test]
    fn merit_is_the_sum_of_violations_and_cost_minus_all_logarithms() {
        let chain = Sampled {
            period: Period::Free,
            intervals: 3,
            repeats: 1,
        };
        let (layout, mut values) = (Layout::of(&chain), values_of(&chain));
        values[0].cost = 2.0;
        values[1].gap[1] = -0.5;
        values[3].equality[0] = 0.25;
        let slack: Vec<f64> = (1..=9).map(f64::from).collect();
        let merit = Merit::of(&layout, 0.1, &slack, values.iter());
        // Inequalities are zero, so every slack is an error.
        assert!((merit.theta - (0.75 + 45.0)).abs() < 1e-12);
        let logarithms: f64 = slack.iter().map(|s| s.ln()).sum();
        assert!((merit.phi - (2.0 - 0.1 * logarithms)).abs() < 1e-12);
    }
}
