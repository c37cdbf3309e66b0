//! The barrier problem at the current iterate.

use super::chain::{Chain, LinkModel, LinkValues, models_of};
use super::iterate::{Iterate, Layout};
use super::merit::Merit;

/// The models of all links at the current iterate, and the barrier parameter.
pub(super) struct BarrierProblem {
    pub(super) layout: Layout,
    pub(super) models: Vec<LinkModel>,
    /// The barrier parameter.
    pub(super) mu: f64,
}

impl BarrierProblem {
    /// Storage for the problem of a chain.
    pub(super) fn of<C: Chain>(chain: &C, mu: f64) -> Self {
        Self {
            layout: Layout::of(chain),
            models: models_of(chain),
            mu,
        }
    }

    /// Evaluates the derivatives at an iterate whose values are known.
    pub(super) fn linearise<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &Iterate,
        values: &[LinkValues],
    ) {
        let known = self.models.iter_mut().zip(values);
        for (node, (model, values)) in known.enumerate() {
            model.values.copy_from(values);
            model.clear();
            let duals = iterate.multipliers(&self.layout, node);
            chain.derivatives(&iterate.link(&self.layout, node), &duals, model);
        }
    }

    /// Infeasibility and barrier cost of the models with given slacks.
    pub(super) fn merit(&self, slack: &[f64]) -> Merit {
        let values = self.models.iter().map(|model| &model.values);
        Merit::of(&self.layout, self.mu, slack, values)
    }

    /// Infeasibility and barrier cost of the values at another point, with its slacks.
    pub(super) fn merit_of(&self, values: &[LinkValues], slack: &[f64]) -> Merit {
        Merit::of(&self.layout, self.mu, slack, values.iter())
    }

    /// Largest gap, equality or inequality violation.
    pub(super) fn infeasibility(&self) -> f64 {
        let values = || self.models.iter().map(|model| &model.values);
        let below_zero = values()
            .flat_map(|v| &v.inequality)
            .fold(0.0_f64, |worst, g| worst.max(-g));
        values().fold(below_zero, |worst, v| worst.max(v.defect_max()))
    }
}
