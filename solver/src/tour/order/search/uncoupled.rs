//! Short orders of many targets whose legs do not couple.
//!
//! Most legs among many targets have bounds that can still be raised. A search by these bounds is drawn to
//! the legs that are underestimated; they are raised, and another search follows, until the orders that are
//! found have none. A search beside it avoids such legs. The best order of both is short among all, although few
//! legs have been solved.

use super::OrderSearch;
use crate::tour::order::SearchEnd;
use crate::tour::order::heuristics::{self, LeastLegs, SearchEffort};

/// Kicks per target of a search, and at most.
const KICKS_PER_TARGET: usize = 50;
const MAX_KICKS: usize = 20_000;
/// Largest number of rounds of two searches, and the number without gain after which they end.
const MAX_ROUNDS: u64 = 20;
const ROUNDS_WITHOUT_GAIN: u64 = 5;

impl OrderSearch<'_> {
    /// For many targets whose legs do not couple, improves the best order before the root is opened. Where all
    /// legs are known there is nothing to be drawn to.
    pub(super) fn improve_uncoupled_orders(&mut self) -> Option<SearchEnd> {
        if !self.tree.table().has_open() || self.has_many_couplings() {
            return None;
        }
        let mut without_gain = 0;
        for round in 0..MAX_ROUNDS {
            if self.is_settled() || without_gain == ROUNDS_WITHOUT_GAIN {
                break;
            }
            let orders = self.uncoupled_orders(round);
            let raised = self.tree.table_mut().raise_along(self.model, &orders);
            let costs = LeastLegs(self.tree.table());
            let cost_s = |order: &Vec<usize>| heuristics::estimated(&costs, order);
            let best = orders.iter().min_by(|a, b| cost_s(a).total_cmp(&cost_s(b)));
            let before_s = self.tree.best_s();
            let shorter = best.filter(|best| before_s.is_none_or(|known_s| cost_s(best) < known_s));
            if self.evaluate_new(shorter.map(std::slice::from_ref).unwrap_or_default()) {
                break;
            }
            self.reporter.announce(&self.tree);
            self.reporter.report(&self.tree);
            let gained = raised || self.tree.best_s() < before_s;
            without_gain = if gained { 0 } else { without_gain + 1 };
        }
        self.stop.is_set().then(|| self.stopped())
    }

    /// Orders from the best one, short by bounds and by estimates.
    fn uncoupled_orders(&self, seed: u64) -> Vec<Vec<usize>> {
        let table = self.tree.table();
        let effort = SearchEffort {
            kicks: (KICKS_PER_TARGET * table.targets()).min(MAX_KICKS),
            alternatives: 0,
            seed,
        };
        let found = self.pool.map(&[true, false], |&by_bounds| {
            if by_bounds {
                let costs = LeastLegs(table);
                self.tree.short_orders(&costs, None, &effort, self.stop)
            } else {
                self.tree.short_orders(table, None, &effort, self.stop)
            }
        });
        found.into_iter().flatten().collect()
    }
}
