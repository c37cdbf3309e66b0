//! What the line search weighs: infeasibility against the barrier cost.

use super::interior_point::InteriorPoint;
use super::iterate::Layout;
use super::model::LinkValues;

/// Slacks, none below 1e-38, whose product is taken to one logarithm.
const LOGARITHM_BATCH: usize = 8;

/// Infeasibility and barrier cost of a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Merit {
    /// Sum of absolute gaps, equalities and slack errors.
    pub(super) theta: f64,
    /// Cost minus the logarithmic barrier.
    pub(super) phi: f64,
}

impl InteriorPoint {
    /// Infeasibility and barrier cost of the trial values with given slacks.
    pub(super) fn merit_of_values(&self, slack: &[f64]) -> Merit {
        merit(&self.layout, self.mu, slack, self.trial_values.iter())
    }

    /// Infeasibility and barrier cost of the current models with given slacks.
    pub(super) fn merit_of_models(&self, slack: &[f64]) -> Merit {
        let values = self.models.iter().map(|model| &model.values);
        merit(&self.layout, self.mu, slack, values)
    }
}

fn merit<'a>(
    layout: &Layout,
    mu: f64,
    slack: &[f64],
    values: impl Iterator<Item = &'a LinkValues>,
) -> Merit {
    let mut total = Merit {
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
