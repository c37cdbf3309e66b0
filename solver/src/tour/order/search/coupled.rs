//! Bounds for legs that couple, from several places in a row, and orders that are short in what is
//! known of the couplings.
//!
//! A search over few targets begins with pair bounds alone, since most of them end before tighter
//! bounds would save work. A search over many targets computes the triple bounds first: they are
//! the bound that it reports, and they guide the choice of orders to evaluate.

use super::{OrderSearch, evaluate_order};
use crate::model::order_rules::OrderRules;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::{MAX_EXACT_TARGETS, SpanningTrees};
use crate::tour::order::heuristics::{self, SearchEffort};
use crate::tour::order::lagrangian::LagrangianPaths;
use crate::tour::order::triple_bounds::{AscentEffort, TripleBoundSubsets, TripleBounds};
use crate::tour::order::{PairTable, SearchEnd, TourEvaluation, TourModel};
use std::sync::{Mutex, PoisonError};

/// Largest number of steps of an ascent.
const MAX_STEPS: usize = 400;
/// Triples solved per target in a search over few targets. With [`FIVES_OF_FEW`] some seconds of
/// work.
const TRIPLES_OF_FEW: usize = 30;
/// Paths of five places solved per target in a search over few targets.
const FIVES_OF_FEW: usize = 20;
/// Largest number of rounds in which orders are improved and the bound for many targets is raised.
const MAX_ROUNDS: u64 = 100;
/// The rounds end when so many in a row gain nothing.
const ROUNDS_WITHOUT_GAIN: u64 = 2;
/// Relative rise of the bound in a round that counts as none.
const MIN_RELATIVE_GAIN: f64 = 2e-4;
/// Work on the bounds for many targets while the first order is evaluated, and in a later round. The paths
/// are counted per target; those of five places are for when the triples are exhausted.
const BESIDE_FIRST_ORDER: AscentEffort = AscentEffort {
    triples: 4,
    fives: 0,
    fives_before_triples_end: false,
    steps: 60,
};
const OF_ROUND: AscentEffort = AscentEffort {
    triples: 12,
    fives: 8,
    steps: MAX_STEPS,
    ..BESIDE_FIRST_ORDER
};
/// The same while the second orders are evaluated, where a round has several passes.
const BESIDE_SECOND_ORDERS: AscentEffort = AscentEffort {
    triples: 24,
    steps: MAX_STEPS,
    ..BESIDE_FIRST_ORDER
};
/// Passes of a round, of which the last one raises the bounds, as does the very first; one where a single order is
/// evaluated in each.
const PASSES: u64 = 2;
/// Heuristic searches for orders at a time.
const ORDERS_PER_SEARCH: u64 = 2;
/// Kicks of a heuristic search; twice as many after each round without a shorter tour, up to so many per target.
const KICKS: usize = 2_000;
const MAX_KICKS_PER_TARGET: usize = 50;
/// Largest number of searches in a pass, each from the best order of those before, and the relative excess of
/// an order over what a search expected from which another one follows.
const MAX_SEARCHES: u64 = 5;
const UNDERESTIMATED: f64 = 2e-3;
/// Orders around the best one that are evaluated at a time, most targets in all of them if there are more than two,
/// how many in a row are no gain, and the first seed of the searches for them.
const ORDERS_AROUND: usize = 24;
const TARGETS_AROUND: usize = 2_400;
const ORDERS_WITHOUT_GAIN: usize = 48;
const FIRST_SEED_AROUND: u64 = 1 << 32;
/// Orders of a pass that are evaluated, and most targets in all of them if there are several.
const ORDERS_EVALUATED: usize = 2;
const TARGETS_EVALUATED: usize = 600;

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
            fives_before_triples_end: true,
            steps: MAX_STEPS,
        };
        triple_bounds.raise(model, &effort, pool, stop, &mut |_| ());
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

/// Number of orders of so many targets that a pass evaluates.
fn orders_evaluated(targets: usize) -> usize {
    (TARGETS_EVALUATED / targets).clamp(1, ORDERS_EVALUATED)
}

/// Number of passes of a round.
fn passes(targets: usize) -> u64 {
    if orders_evaluated(targets) > 1 {
        PASSES
    } else {
        1
    }
}

/// Sorts orders by their estimated durations, and drops repeated ones.
fn sort_by_estimate(orders: &mut Vec<Vec<usize>>, costs: &TripleBounds) {
    let estimated = |order: &Vec<usize>| heuristics::estimated(costs, order);
    orders.sort_by(|a, b| estimated(a).total_cmp(&estimated(b)));
    orders.dedup();
}

impl OrderSearch<'_> {
    /// Whether there are many targets, some of which couple their legs.
    pub(super) fn has_many_couplings(&self) -> bool {
        self.tree.table().targets() > MAX_EXACT_TARGETS && self.model.has_couplings()
    }

    /// For many targets, improves orders and raises the triple bounds, in rounds before the root is opened,
    /// until neither gains much. Then the orders around the best one are evaluated.
    pub(super) fn bound_and_improve_orders(&mut self) -> Option<SearchEnd> {
        if !self.has_many_couplings() {
            return None;
        }
        let table = self.tree.table();
        let trees = self.tree.spanning_trees()?;
        let mut triple_bounds = TripleBounds::new(self.model, table, trees)?;
        self.tree.bound_root(triple_bounds.root_bound());
        self.reporter.report(&self.tree);
        self.evaluate_first_order(&mut triple_bounds);
        let kicks = self.improve_in_rounds(&mut triple_bounds);
        self.evaluate_around_best(&mut triple_bounds, kicks);
        self.tree
            .set_coupled_bounds(CoupledBounds::Trees(Box::new(triple_bounds)));
        self.stop.is_set().then(|| self.stopped())
    }

    /// Evaluates the first order beside the first triples.
    fn evaluate_first_order(&mut self, triple_bounds: &mut TripleBounds) {
        let first: Vec<_> = self.tree.first_order().into_iter().cloned().collect();
        if passes(self.tree.table().targets()) == 1 {
            // With its own triples its estimate is right, and searches leave it only for what is estimated to be
            // shorter. Fewer targets leave time for tours far from it, which end shorter.
            triple_bounds.ask_along(&first, self.model, self.pool, self.stop);
        }
        self.evaluate_and_raise(&first, triple_bounds, Some(BESIDE_FIRST_ORDER));
    }

    /// The rounds; returns the number of kicks of the last searches.
    fn improve_in_rounds(&mut self, triple_bounds: &mut TripleBounds) -> usize {
        let targets = self.tree.table().targets();
        let passes = passes(targets);
        let most_kicks = KICKS.max(MAX_KICKS_PER_TARGET * targets);
        let mut kicks = KICKS;
        let mut without_gain = 0;
        for round in 0..MAX_ROUNDS {
            let (before_s, before_bound_s) = (self.tree.best_s(), triple_bounds.root_bound());
            for pass in 1..=passes {
                if self.is_settled() {
                    break;
                }
                let seed = round * PASSES + pass;
                let orders = self.orders_to_evaluate(triple_bounds, seed, kicks);
                let effort = match round {
                    0 if pass == 1 && passes > 1 => Some(BESIDE_SECOND_ORDERS),
                    _ => (pass == passes).then_some(OF_ROUND),
                };
                self.evaluate_and_raise(&orders, triple_bounds, effort);
            }
            let raised = triple_bounds.root_bound() > before_bound_s * (1.0 + MIN_RELATIVE_GAIN);
            let shortened = self.has_shorter_than(before_s);
            let gains = raised || shortened || kicks < most_kicks;
            if !shortened {
                kicks = (2 * kicks).min(most_kicks);
            }
            without_gain = if gains { 0 } else { without_gain + 1 };
            if self.is_settled() || without_gain >= ROUNDS_WITHOUT_GAIN {
                break;
            }
        }
        kicks
    }

    /// Whether a tour is known that is shorter than so many seconds, or any if none was known.
    fn has_shorter_than(&self, before_s: Option<f64>) -> bool {
        let shorter = |best_s| before_s.is_none_or(|before_s| best_s < before_s);
        self.tree.best_s().is_some_and(shorter)
    }

    /// Evaluates many orders that are estimated to be hardly longer than the best one, again and again while that
    /// finds a better one. The estimates learn from them, and come close to the tours around the best order.
    fn evaluate_around_best(&mut self, triple_bounds: &mut TripleBounds, kicks: usize) {
        let targets = self.tree.table().targets();
        let at_once = (TARGETS_AROUND / targets).clamp(ORDERS_EVALUATED, ORDERS_AROUND);
        let mut seed = FIRST_SEED_AROUND;
        let mut without_gain = 0;
        while !self.is_settled() && without_gain < ORDERS_WITHOUT_GAIN {
            let before_s = self.tree.best_s();
            let mut orders = self.short_orders(triple_bounds, None, (kicks, at_once), seed);
            seed += ORDERS_PER_SEARCH;
            orders.retain(|order| self.tree.is_new(order));
            triple_bounds.ask_along(&orders, self.model, self.pool, self.stop);
            sort_by_estimate(&mut orders, triple_bounds);
            orders.truncate(at_once);
            self.evaluate_and_raise(&orders, triple_bounds, None);
            let shortened = self.has_shorter_than(before_s);
            without_gain = if shortened { 0 } else { without_gain + at_once };
        }
    }

    /// Orders that some searches find, each with so many kicks and listing so many alternatives, from a given order
    /// or else the best one.
    fn short_orders(
        &self,
        triple_bounds: &TripleBounds,
        from: Option<&[usize]>,
        (kicks, alternatives): (usize, usize),
        first_seed: u64,
    ) -> Vec<Vec<usize>> {
        let seeds: Vec<u64> = (first_seed..first_seed + ORDERS_PER_SEARCH).collect();
        let found = self.pool.map(&seeds, |&seed| {
            let effort = SearchEffort {
                kicks,
                alternatives,
                seed,
            };
            let tree = &self.tree;
            tree.short_orders(triple_bounds, from, &effort, self.stop)
        });
        found.into_iter().flatten().collect()
    }

    /// Searches for orders that are short in the known and estimated couplings, and solves their unknown
    /// triples. Searches are drawn to those that are underestimated; then others follow, which know them.
    /// Returns the shortest orders, the best first.
    fn orders_to_evaluate(
        &self,
        triple_bounds: &mut TripleBounds,
        pass: u64,
        kicks: usize,
    ) -> Vec<Vec<usize>> {
        let mut orders: Vec<Vec<usize>> = Vec::new();
        for search in 0..MAX_SEARCHES {
            let from = orders.first().map(Vec::as_slice);
            let seed = (pass * MAX_SEARCHES + search) * ORDERS_PER_SEARCH;
            let found = self.short_orders(triple_bounds, from, (kicks, 0), seed);
            orders.extend(found);
            let least = |costs: &TripleBounds, orders: &[Vec<usize>]| {
                let estimates = orders
                    .iter()
                    .map(|order| heuristics::estimated(costs, order));
                estimates.fold(f64::INFINITY, f64::min)
            };
            let expected_s = least(triple_bounds, &orders);
            triple_bounds.ask_along(&orders, self.model, self.pool, self.stop);
            sort_by_estimate(&mut orders, triple_bounds);
            let known_s = least(triple_bounds, &orders);
            if self.stop.is_set() || known_s <= expected_s * (1.0 + UNDERESTIMATED) {
                break;
            }
        }
        // The shortest of them may well be the best known one.
        orders.retain(|order| self.tree.is_new(order));
        orders.truncate(orders_evaluated(triple_bounds.table().targets()));
        orders
    }

    /// Evaluates orders, and raises the triple bounds and the bound of the root meanwhile, by an effort per
    /// target if there is one: one tour of many targets keeps one worker busy for seconds. The estimates learn from the
    /// tours.
    fn evaluate_and_raise(
        &mut self,
        orders: &[Vec<usize>],
        triple_bounds: &mut TripleBounds,
        effort: Option<AscentEffort>,
    ) {
        let targets = triple_bounds.table().targets();
        let effort = effort.map(|effort| AscentEffort {
            triples: effort.triples * targets,
            fives: effort.fives * targets,
            ..effort
        });
        let fresh = orders.iter().filter(|order| self.tree.is_new(order));
        let fresh: Vec<Vec<usize>> = fresh.cloned().collect();
        let (model, pool, stop) = (self.model, self.pool, self.stop);
        let evaluated = Mutex::new(None);
        let mut tell = |bound_s| {
            self.tree.bound_root(bound_s);
            let mut evaluated = evaluated.lock().unwrap_or_else(PoisonError::into_inner);
            let answers: Vec<TourEvaluation> = evaluated.take().unwrap_or_default();
            for (order, answer) in fresh.iter().zip(answers) {
                self.tree.record_candidate(order, answer);
            }
            self.reporter.announce(&self.tree);
            self.reporter.report(&self.tree);
        };
        pool.join(
            || {
                let answers = pool.map(&fresh, |order| evaluate_order(model, order, stop));
                *evaluated.lock().unwrap_or_else(PoisonError::into_inner) = Some(answers);
            },
            || effort.map(|effort| triple_bounds.raise(model, &effort, pool, stop, &mut tell)),
        );
        tell(triple_bounds.root_bound());
        for order in orders {
            triple_bounds.learn(order, model);
        }
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
