//! The dual ascent of the Lagrangian bounds, in a long search over few targets.

use super::OrderSearch;
use super::coupled::CoupledBounds;
use crate::tour::order::lagrangian::{LagrangianLegs, LagrangianPaths, MAX_LAGRANGIAN_TARGETS};

/// Largest number of rounds.
const MAX_ROUNDS: usize = 24;
/// Orders evaluated in each round.
const ORDERS: usize = 4;
/// The ascent ends when the bound has gained less than [`MIN_RELATIVE_GAIN`] in so many rounds.
const MAX_STALE_ROUNDS: usize = 4;
/// Gain of the bound in [`MAX_STALE_ROUNDS`] rounds, relative, below which the ascent ends.
const MIN_RELATIVE_GAIN: f64 = 2e-4;

impl OrderSearch<'_> {
    /// Raises the Lagrangian bounds and evaluates the orders of smallest Lagrangian bound. The
    /// bounds are not used when the search is stopped meanwhile or the model has no costates.
    pub(super) fn raise_lagrangian_bound(&mut self) {
        let targets = self.tree.table().targets();
        if targets > MAX_LAGRANGIAN_TARGETS || !self.model.has_couplings() {
            return;
        }
        let rules = self.tree.rules().clone();
        let mut legs = LagrangianLegs::new(self.model, self.tree.table());
        let mut paths = LagrangianPaths::new(&legs, &rules);
        let mut best = legs.clone();
        // The best bound after each round.
        let mut bounds = vec![f64::NEG_INFINITY];
        let mut is_best = true;
        for round in 1..=MAX_ROUNDS {
            if !paths.fill(&legs, self.pool, self.stop) {
                return;
            }
            let before = bounds[round - 1];
            is_best = paths.root_bound() > before;
            if is_best {
                best.clone_from(&legs);
            }
            bounds.push(paths.root_bound().max(before));
            if self.ascent_is_done(&bounds) {
                break;
            }
            let orders = paths.orders(ORDERS);
            self.evaluate_new(&orders);
            self.tree.tidy();
            self.reporter.announce(&self.tree);
            self.reporter.report(&self.tree);
            if !legs.update_costates(&orders, self.model, self.pool, self.stop) {
                return;
            }
        }
        if (is_best || paths.fill(&best, self.pool, self.stop))
            && let Some(CoupledBounds::Paths(subsets)) = self.tree.take_coupled_bounds()
        {
            let lagrangian = CoupledBounds::Lagrangian(subsets, Box::new(paths));
            self.tree.set_coupled_bounds(lagrangian);
        }
    }

    /// Whether the bounds no longer rise, or the best order is proved optimal.
    fn ascent_is_done(&self, bounds: &[f64]) -> bool {
        let rounds = bounds.len() - 1;
        let last = bounds[rounds];
        let proved = self.tree.best_s().is_some_and(|best_s| last >= best_s);
        let earlier = rounds.checked_sub(MAX_STALE_ROUNDS);
        proved || earlier.is_some_and(|round| last <= bounds[round] * (1.0 + MIN_RELATIVE_GAIN))
    }
}
