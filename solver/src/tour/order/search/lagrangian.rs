//! Learning the prices that legs pay each other, in a search over few targets that has turned out to be
//! hard.

use super::OrderSearch;
use super::coupled::CoupledBounds;
use crate::tour::order::lagrangian::{LagrangianLegs, LagrangianPaths, MAX_LAGRANGIAN_TARGETS};

/// Rounds at most, and orders flown in each.
const ROUNDS: usize = 24;
const ORDERS: usize = 4;
/// The learning ends when in so many rounds the bound has not gained this share of itself.
const MAX_STALE_ROUNDS: usize = 4;
const MIN_RELATIVE_GAIN: f64 = 2e-4;

impl OrderSearch<'_> {
    /// Prices the legs, and flies the orders that are shortest by the prices. Nothing comes of it
    /// when the search is stopped meanwhile, or the model knows no prices.
    pub(super) fn raise_lagrangian_bound(&mut self) {
        let targets = self.tree.table().targets();
        let couple = (0..targets).any(|via| self.model.couples(via));
        if targets > MAX_LAGRANGIAN_TARGETS || !couple {
            return;
        }
        let rules = self.tree.rules().clone();
        let mut legs = LagrangianLegs::new(self.model, self.tree.table());
        let mut paths = LagrangianPaths::new(&legs, &rules);
        let mut best = legs.clone();
        // The best bound after each round.
        let mut bounds = vec![f64::NEG_INFINITY];
        let mut is_best = true;
        for round in 1..=ROUNDS {
            if !paths.fill(&legs, self.pool, self.stop) {
                return;
            }
            let before = bounds[round - 1];
            is_best = paths.root_bound() > before;
            if is_best {
                best.clone_from(&legs);
            }
            bounds.push(paths.root_bound().max(before));
            if self.is_enough(&bounds) {
                break;
            }
            let orders = paths.orders(ORDERS);
            self.evaluate_new(&orders);
            self.tree.tidy();
            self.reporter.announce(&self.tree);
            self.reporter.report(&self.tree);
            if !legs.learn(&orders, self.model, self.pool, self.stop) {
                return;
            }
        }
        if (is_best || paths.fill(&best, self.pool, self.stop))
            && let Some(CoupledBounds::Paths(charged)) = self.tree.decouple()
        {
            let lagrangian = CoupledBounds::Lagrangian(charged, Box::new(paths));
            self.tree.couple(lagrangian);
        }
    }

    /// Whether the bounds no longer rise, or all is proved.
    fn is_enough(&self, bounds: &[f64]) -> bool {
        let rounds = bounds.len() - 1;
        let last = bounds[rounds];
        let proved = self.tree.best_s().is_some_and(|best_s| last >= best_s);
        let earlier = rounds.checked_sub(MAX_STALE_ROUNDS);
        proved || earlier.is_some_and(|round| last <= bounds[round] * (1.0 + MIN_RELATIVE_GAIN))
    }
}
