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
use crate::tour::order::{PairTable, SearchEnd, TourModel};

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
/// Work on the bounds for many targets while a first order is evaluated, before the first round, and
/// in a round. The paths are counted per target; those of five places are for when the triples are
/// exhausted.
const BESIDE_FIRST_ORDER: AscentEffort = AscentEffort {
    triples: 4,
    fives: 0,
    fives_before_triples_end: false,
    steps: 60,
};
const BEFORE_ROUNDS: AscentEffort = AscentEffort {
    triples: 24,
    steps: MAX_STEPS,
    ..BESIDE_FIRST_ORDER
};
const OF_ROUND: AscentEffort = AscentEffort {
    triples: 12,
    fives: 8,
    ..BEFORE_ROUNDS
};
/// Passes of a round: each learns the couplings along the orders that it finds.
const PASSES: u64 = 2;
/// Heuristic searches for orders in a pass.
const ORDERS_PER_PASS: u64 = 2;
/// Kicks per target of a heuristic search, at least and at most.
const KICKS_PER_TARGET: usize = 15;
const MIN_KICKS: usize = 2_000;
const MAX_KICKS: usize = 4_000;
/// Kicks of the search for a first order.
const FIRST_KICKS: usize = 1_000;
/// Orders of a pass that are evaluated.
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

impl OrderSearch<'_> {
    /// Whether there are many targets, some of which couple their legs.
    pub(super) fn has_many_couplings(&self) -> bool {
        let targets = self.tree.table().targets();
        targets > MAX_EXACT_TARGETS && (0..targets).any(|via| self.model.couples(via))
    }

    /// For many targets, improves orders and raises the triple bounds in turn, before the root is
    /// opened, until neither gains much.
    pub(super) fn bound_and_improve_orders(&mut self) -> Option<SearchEnd> {
        if !self.has_many_couplings() {
            return None;
        }
        let table = self.tree.table();
        let trees = self.tree.spanning_trees()?;
        let mut triple_bounds = TripleBounds::new(self.model, table, trees)?;
        if self.tree.best_s().is_none() {
            self.fly_a_first_order(&mut triple_bounds);
        }
        // Orders that are short in estimated couplings alone are far from short.
        self.raise_triple_bounds(&mut triple_bounds, BEFORE_ROUNDS);
        let mut without_gain = 0;
        for round in 0..MAX_ROUNDS {
            let before = (self.tree.best_s(), triple_bounds.root_bound());
            for pass in 1..=PASSES {
                let pass = round * PASSES + pass;
                self.improve_orders(&mut triple_bounds, pass);
                if self.stop.is_set() {
                    break;
                }
            }
            if self.stop.is_set() {
                break;
            }
            self.raise_triple_bounds(&mut triple_bounds, OF_ROUND);
            let raised = triple_bounds.root_bound() > before.1 * (1.0 + MIN_RELATIVE_GAIN);
            let gained = raised || self.tree.best_s() < before.0;
            without_gain = if gained { 0 } else { without_gain + 1 };
            if self.stop.is_set() || without_gain >= ROUNDS_WITHOUT_GAIN {
                break;
            }
        }
        self.tree
            .set_coupled_bounds(CoupledBounds::Trees(Box::new(triple_bounds)));
        self.stop.is_set().then(|| self.stopped())
    }

    /// Evaluates an order that is short in estimated couplings, and begins to raise the triple bounds
    /// meanwhile: one tour of many targets keeps one worker busy for seconds.
    fn fly_a_first_order(&mut self, triple_bounds: &mut TripleBounds) {
        let orders = self.orders_to_evaluate(triple_bounds, 0, FIRST_KICKS);
        let Some(order) = orders.into_iter().next() else {
            return;
        };
        let (model, pool, stop) = (self.model, self.pool, self.stop);
        let (answer, ()) = pool.join(
            || evaluate_order(model, &order, stop),
            || self.raise_triple_bounds(triple_bounds, BESIDE_FIRST_ORDER),
        );
        self.tree.record_candidate(&order, answer);
        self.learn(triple_bounds, &[order]);
    }

    /// Raises the triple bounds for many targets and the bound of the root, by an effort per target.
    fn raise_triple_bounds(&mut self, triple_bounds: &mut TripleBounds, effort: AscentEffort) {
        let targets = triple_bounds.table().targets();
        let effort = AscentEffort {
            triples: effort.triples * targets,
            fives: effort.fives * targets,
            ..effort
        };
        let mut tell = |bound_s| {
            self.tree.bound_root(bound_s);
            self.reporter.report(&self.tree);
        };
        triple_bounds.raise(self.model, &effort, self.pool, self.stop, &mut tell);
        tell(triple_bounds.root_bound());
    }

    /// Evaluates orders that are short in the known and estimated couplings.
    fn improve_orders(&mut self, triple_bounds: &mut TripleBounds, pass: u64) {
        let kicks = KICKS_PER_TARGET * self.tree.table().targets();
        let kicks = kicks.clamp(MIN_KICKS, MAX_KICKS);
        let mut orders = self.orders_to_evaluate(triple_bounds, pass, kicks);
        orders.truncate(ORDERS_EVALUATED);
        self.evaluate_new(&orders);
        self.learn(triple_bounds, &orders);
    }

    /// Has the estimates learn from evaluated orders, and reports what they changed.
    fn learn(&mut self, triple_bounds: &mut TripleBounds, orders: &[Vec<usize>]) {
        for order in orders {
            triple_bounds.learn(order, self.model);
        }
        self.reporter.announce(&self.tree);
        self.reporter.report(&self.tree);
    }

    /// Searches for orders that are short in the known and estimated couplings, and solves their unknown
    /// triples. The shortest comes first.
    fn orders_to_evaluate(
        &self,
        triple_bounds: &mut TripleBounds,
        pass: u64,
        kicks: usize,
    ) -> Vec<Vec<usize>> {
        let first = pass * ORDERS_PER_PASS;
        let seeds: Vec<u64> = (first..first + ORDERS_PER_PASS).collect();
        let found = self.pool.map(&seeds, |&seed| {
            let effort = SearchEffort {
                kicks,
                alternatives: 0,
                seed,
            };
            self.tree.short_orders(triple_bounds, &effort, self.stop)
        });
        let mut orders: Vec<Vec<usize>> = found.into_iter().flatten().collect();
        triple_bounds.ask_along(&orders, self.model, self.pool, self.stop);
        let estimated = |order: &Vec<usize>| heuristics::estimated(triple_bounds, order);
        orders.sort_by(|a, b| estimated(a).total_cmp(&estimated(b)));
        orders.dedup();
        orders
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
