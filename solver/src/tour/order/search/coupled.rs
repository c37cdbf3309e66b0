//! Bounds for legs that couple, from several places in a row, and orders that are short in what is
//! known of the couplings.
//!
//! A search over few targets begins with pair bounds alone, since most of them end before tighter
//! bounds would save work. A search over many targets computes the triple bounds first: they are
//! the bound that it reports, and they guide the choice of orders to evaluate.

use super::OrderSearch;
use crate::model::order_rules::OrderRules;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::{MAX_EXACT_TARGETS, SpanningTrees};
use crate::tour::order::heuristics::SearchEffort;
use crate::tour::order::lagrangian::LagrangianPaths;
use crate::tour::order::triple_bounds::{AscentEffort, TripleBoundSubsets, TripleBounds};
use crate::tour::order::{PairTable, SearchEnd, TourModel};

/// Largest number of steps of an ascent.
const MAX_STEPS: usize = 400;
/// Triples solved per target in a search over few targets. With [`FIVES_OF_FEW`] some seconds of
/// work.
const TRIPLES_OF_FEW: usize = 30;
/// Paths of five places solved per target in a search over few targets.
const FIVES_OF_FEW: usize = 20;
/// Rounds in which the bound for many targets is raised and orders are improved.
const ROUNDS: u64 = 6;
/// Triples solved per target in a round.
const TRIPLES_OF_MANY: usize = 12;
/// Paths of five places solved per target in a round.
const FIVES_OF_MANY: usize = 8;
/// Heuristic searches for orders in a round.
const ORDERS_PER_ROUND: u64 = 4;
/// Kicks per target of a heuristic search.
const KICKS: usize = 60;
/// Orders of a heuristic search that are evaluated.
const ORDERS_EVALUATED: usize = 2;

/// Bounds that take couplings into account.
pub(super) enum CoupledBounds {
    /// Triple bounds with the remaining targets relaxed to a spanning tree.
    Trees(Box<TripleBounds>),
    /// Triple bounds with a shortest path through the remaining targets.
    Paths(Box<TripleBoundSubsets>),
    /// The same and Lagrangian bounds.
    Lagrangian(Box<TripleBoundSubsets>, Box<LagrangianPaths>),
}

impl CoupledBounds {
    /// The triple bounds of a few targets after one ascent; `None` where no target couples its
    /// legs.
    pub(super) fn of_few(
        model: &dyn TourModel,
        table: &PairTable,
        rules: &OrderRules,
        pool: &SolverPool,
        stop: &StopSignal,
    ) -> Option<Self> {
        let mut triple_bounds = TripleBounds::new(model, table, &SpanningTrees::new(table))?;
        let targets = table.targets();
        let effort = AscentEffort {
            triples: TRIPLES_OF_FEW * targets,
            fives: FIVES_OF_FEW * targets,
            steps: MAX_STEPS,
        };
        triple_bounds.raise(model, &effort, pool, stop);
        let subsets = TripleBoundSubsets::new(triple_bounds, rules, stop);
        Some(Self::Paths(Box::new(subsets)))
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    pub(super) fn bound(&self, from: usize, remaining: &[usize]) -> f64 {
        match self {
            Self::Trees(triple_bounds) => triple_bounds.bound(from, remaining),
            Self::Paths(subsets) => subsets.bound(from, remaining),
            Self::Lagrangian(subsets, lagrangian) => {
                let triple = subsets.bound(from, remaining);
                triple.max(lagrangian.bound(from, remaining))
            }
        }
    }

    /// Lower bound, s, of all orders that begin with a prefix; 0 without Lagrangian bounds.
    pub(super) fn whole(&self, prefix: &[usize], remaining: &[usize]) -> f64 {
        match self {
            Self::Trees(_) | Self::Paths(_) => 0.0,
            Self::Lagrangian(_, lagrangian) => lagrangian.whole(prefix, remaining),
        }
    }
}

impl OrderSearch<'_> {
    /// For many targets, raises the triple bounds and improves orders in turn, before the root is
    /// opened.
    pub(super) fn bound_and_improve_orders(&mut self) -> Option<SearchEnd> {
        if self.tree.table().targets() <= MAX_EXACT_TARGETS {
            return None;
        }
        let table = self.tree.table();
        let targets = table.targets();
        let mut triple_bounds = TripleBounds::new(self.model, table, &SpanningTrees::new(table))?;
        for round in 0..ROUNDS {
            let effort = AscentEffort {
                triples: TRIPLES_OF_MANY * targets,
                fives: FIVES_OF_MANY * targets,
                steps: MAX_STEPS,
            };
            triple_bounds.raise(self.model, &effort, self.pool, self.stop);
            self.tree.bound_root(triple_bounds.root_bound());
            self.reporter.report(&self.tree);
            for order in 0..ORDERS_PER_ROUND {
                self.improve_orders(&mut triple_bounds, round * ORDERS_PER_ROUND + order);
                if self.stop.is_set() {
                    break;
                }
            }
            if self.stop.is_set() {
                break;
            }
        }
        self.tree
            .set_coupled_bounds(CoupledBounds::Trees(Box::new(triple_bounds)));
        self.stop.is_set().then(|| self.stopped())
    }

    /// Searches for orders that are short in the known couplings, evaluates them, and solves their
    /// unknown triples.
    fn improve_orders(&mut self, triple_bounds: &mut TripleBounds, seed: u64) {
        let effort = SearchEffort {
            kicks_per_target: KICKS,
            alternatives: ORDERS_EVALUATED - 1,
            seed,
        };
        let orders = self.tree.short_orders(triple_bounds, &effort, self.stop);
        triple_bounds.ask_along(&orders, self.model, self.pool, self.stop);
        self.evaluate_new(&orders);
        self.reporter.announce(&self.tree);
        self.reporter.report(&self.tree);
    }

    /// Computes the triple bounds of a long search over few targets.
    pub(super) fn tighten(&mut self) {
        if self.tree.table().targets() > MAX_EXACT_TARGETS {
            return;
        }
        let couplings = CoupledBounds::of_few(
            self.model,
            self.tree.table(),
            self.tree.rules(),
            self.pool,
            self.stop,
        );
        if let Some(couplings) = couplings {
            self.tree.set_coupled_bounds(couplings);
        }
    }
}
