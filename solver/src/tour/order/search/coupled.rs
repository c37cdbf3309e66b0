//! What a search knows beyond the pair table when legs couple: bounds from several places in a row,
//! and orders that are short in what is known so far.
//!
//! A few targets are searched with pairs alone at first, since most searches end before the bounds
//! of longer paths would pay. Many targets need them from the beginning: they are the bound that is
//! told, and they tell which orders are worth flying.

use super::OrderSearch;
use crate::model::order_rules::OrderRules;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::{MAX_EXACT_TARGETS, SpanningTrees};
use crate::tour::order::heuristics::SearchEffort;
use crate::tour::order::lagrangian::LagrangianPaths;
use crate::tour::order::triple_bounds::{AscentEffort, TripleBoundSubsets, TripleBounds};
use crate::tour::order::{PairTable, SearchEnd, TourModel};

/// Steps of an ascent at most.
const STEPS: usize = 400;
/// Paths asked for per target when few targets turn out to be hard: some seconds of work.
const TRIPLES_OF_FEW: usize = 30;
const FIVES_OF_FEW: usize = 20;
/// Rounds of raising the bound and improving orders of many targets, what is asked for per target in
/// a round, and the orders searched after it.
const ROUNDS: u64 = 6;
const TRIPLES_OF_MANY: usize = 12;
const FIVES_OF_MANY: usize = 8;
const ORDERS_PER_ROUND: u64 = 4;
/// Kicks per target of a search for an order, and how many of its best orders are flown.
const KICKS: usize = 60;
const ORDERS_EVALUATED: usize = 2;

/// Bounds from several places in a row.
pub(super) enum CoupledBounds {
    /// With the rest of an order relaxed to a tree.
    Trees(Box<TripleBounds>),
    /// With a shortest path in its place.
    Paths(Box<TripleBoundSubsets>),
    /// With that and with legs that pay each other for the states they meet in.
    Lagrangian(Box<TripleBoundSubsets>, Box<LagrangianPaths>),
}

impl CoupledBounds {
    /// What a first ascent finds for a few targets; nothing where no target couples its legs.
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
            steps: STEPS,
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
                let charged = subsets.bound(from, remaining);
                charged.max(lagrangian.bound(from, remaining))
            }
        }
    }

    /// Lower bound, s, of all orders that begin with a prefix, whatever is known of the prefix.
    pub(super) fn whole(&self, prefix: &[usize], remaining: &[usize]) -> f64 {
        match self {
            Self::Trees(_) | Self::Paths(_) => 0.0,
            Self::Lagrangian(_, lagrangian) => lagrangian.whole(prefix, remaining),
        }
    }
}

impl OrderSearch<'_> {
    /// Bounds and improves orders of many targets in turn, before the tree is opened.
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
                steps: STEPS,
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
            .couple(CoupledBounds::Trees(Box::new(triple_bounds)));
        self.stop.is_set().then(|| self.stopped())
    }

    /// Searches for orders that are short in all that is known of couplings, flies them, and learns
    /// what was unknown of their triples.
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

    /// Tightens the bounds of a search over few targets that is not about to end.
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
            self.tree.couple(couplings);
        }
    }
}
