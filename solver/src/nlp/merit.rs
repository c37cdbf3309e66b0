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
