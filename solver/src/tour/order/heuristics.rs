//! Heuristic orders: short in the pair table, or in the pair bounds with the known or estimated coupling gaps.

mod cost;
mod iterated;
mod joints;
mod local_search;
mod neighbours;
mod path;
#[cfg(test)]
mod tests;

use super::completion::CompletionBound;
use super::triple_bounds::{FreeEnds, GapEstimates};
use super::{PairTable, TourModel};
use crate::model::order_rules::OrderRules;
use crate::run::stop::StopSignal;
use cost::EstimatedCost;
pub(super) use cost::{LeastLegs, OrderCost};
use iterated::IteratedSearch;
use local_search::OrderTask;

/// Candidates besides the best where the shortest order of the table is not computed exactly.
const ALTERNATIVES: usize = 3;
/// Kicks per target for the candidates: about half a second at 200 targets.
const CANDIDATE_KICKS: usize = 100;
/// Largest number of kicks for the first order and for the candidates.
const MAX_FIRST_KICKS: usize = 20_000;
const MAX_CANDIDATE_KICKS: usize = 60_000;
/// Kicks per target for the completion of a prefix: about fifty milliseconds at 200 targets.
const COMPLETION_KICKS: usize = 10;
/// Kicks per target for the first order where legs couple, and at most: a second at 1000 targets.
const COUPLED_KICKS: usize = 20;
const MAX_COUPLED_KICKS: usize = 4_000;
/// Seed of all searches of this file, so that they are reproducible.
const SEED: u64 = 0;

/// An order that is short in the table of a model's pair bounds; `None` where there are no targets.
#[must_use]
pub fn short_order(model: &dyn TourModel, stop: &StopSignal) -> Option<Vec<usize>> {
    let table = PairTable::new(model);
    let kicks = MAX_FIRST_KICKS.min(CANDIDATE_KICKS * table.targets());
    let found = searched(&table, &table, (kicks, 0), stop);
    found.into_iter().next()
}

/// The same where legs couple that would like to be in these states at their ends.
pub(crate) fn short_coupled_order(
    model: &dyn TourModel,
    free_ends: FreeEnds<'_>,
    stop: &StopSignal,
) -> Option<Vec<usize>> {
    let table = PairTable::new(model);
    let cost = EstimatedCost {
        gaps: GapEstimates::new(&table, free_ends),
        table: &table,
    };
    let kicks = MAX_COUPLED_KICKS.min(COUPLED_KICKS * table.targets());
    let found = searched(&table, &cost, (kicks, 0), stop);
    found.into_iter().next()
}

/// A few different orders that are short in the pair table, shortest first except for the reverse
/// of the shortest one, which comes second.
pub(super) fn candidates(
    table: &PairTable,
    completion: &CompletionBound,
    stop: &StopSignal,
) -> Vec<Vec<usize>> {
    let all: Vec<usize> = (0..table.targets()).collect();
    let mut orders = match completion {
        _ if all.is_empty() => return Vec::new(),
        CompletionBound::Exact(subsets) => vec![subsets.shortest_order(table, table.start(), &all)],
        CompletionBound::Relaxed(_) => {
            let kicks = MAX_CANDIDATE_KICKS.min(CANDIDATE_KICKS * all.len());
            searched(table, table, (kicks, ALTERNATIVES), stop)
        }
    };
    // Tours are nearly symmetric in time, while the table of legs with free ends is not: the
    // reverse of the table's shortest order is often the shorter tour.
    let reverse: Vec<usize> = orders[0].iter().rev().copied().collect();
    if table.rules().admits(&reverse) {
        orders.insert(1, reverse);
    }
    let mut distinct: Vec<Vec<usize>> = Vec::with_capacity(orders.len());
    for order in orders {
        if !distinct.contains(&order) {
            distinct.push(order);
        }
    }
    distinct
}

/// Length and seed of a heuristic search.
#[derive(Debug, Clone, Copy)]
pub(super) struct SearchEffort {
    /// Number of kicks.
    pub(super) kicks: usize,
    /// Number of orders to list besides the best.
    pub(super) alternatives: usize,
    /// Seed of the random kicks.
    pub(super) seed: u64,
}

/// Orders of the targets after a prefix that are short by some costs, best first. The search begins
/// at the given order of them, which must be admitted.
pub(super) fn shorter_orders<C: OrderCost>(
    costs: &C,
    rules: &OrderRules,
    (prefix, order): (&[usize], &[usize]),
    effort: &SearchEffort,
    stop: &StopSignal,
) -> Vec<Vec<usize>> {
    let admits = |order: &[usize]| rules.admits(&[prefix, order].concat());
    let task = OrderTask {
        cost: costs,
        from: prefix.last().copied().unwrap_or(costs.targets()),
        admits: (!rules.is_free()).then_some(&admits),
    };
    let mut search = IteratedSearch::new(&task, order, effort.alternatives, effort.seed);
    search.run(effort.kicks, stop);
    let best = search.best().iter();
    best.map(|best| best.order.clone()).collect()
}

/// Duration of an order by some costs, s.
pub(super) fn estimated<C: OrderCost>(costs: &C, order: &[usize]) -> f64 {
    cost::length(costs, costs.targets(), order)
}

/// Orders that are short by some costs, found by iterated search from the nearest-neighbour order, best first.
fn searched<C: OrderCost>(
    table: &PairTable,
    costs: &C,
    (kicks, alternatives): (usize, usize),
    stop: &StopSignal,
) -> Vec<Vec<usize>> {
    let all: Vec<usize> = (0..table.targets()).collect();
    let built = nearest_neighbours(table, &[], &all);
    let effort = SearchEffort {
        kicks,
        alternatives,
        seed: SEED,
    };
    shorter_orders(costs, table.rules(), (&[], &built), &effort, stop)
}

/// An order that completes a prefix by a short path. An admitted order must begin with the prefix.
pub(super) fn complete(
    table: &PairTable,
    completion: &CompletionBound,
    prefix: &[usize],
    remaining: &[usize],
    stop: &StopSignal,
) -> Vec<usize> {
    let completion = match completion {
        CompletionBound::Exact(subsets) => {
            subsets.shortest_order(table, table.last_place(prefix), remaining)
        }
        CompletionBound::Relaxed(_) => {
            let built = nearest_neighbours(table, prefix, remaining);
            let effort = SearchEffort {
                kicks: COMPLETION_KICKS * built.len(),
                alternatives: 0,
                seed: SEED,
            };
            let order = (prefix, built.as_slice());
            let found = shorter_orders(table, table.rules(), order, &effort, stop);
            found.into_iter().next().unwrap_or(built)
        }
    };
    [prefix, &completion].concat()
}

/// The nearest-neighbour order after a prefix: the next target is the nearest one, the smallest
/// index among equals, of those after which an admitted order remains possible.
fn nearest_neighbours(table: &PairTable, prefix: &[usize], targets: &[usize]) -> Vec<usize> {
    let mut path = prefix.to_vec();
    let mut left = targets.to_vec();
    while !left.is_empty() {
        let from = table.last_place(&path);
        // Sorted first, since the rules are more expensive to evaluate than distances.
        left.sort_by(|&a, &b| {
            let distance = |target| table.estimate(from, target);
            distance(a).total_cmp(&distance(b)).then(a.cmp(&b))
        });
        let admitted = |target: &usize| {
            path.push(*target);
            let admitted = table.rules().completable(&path);
            path.pop();
            admitted
        };
        let Some(nearest) = left.iter().position(admitted) else {
            break;
        };
        path.push(left.remove(nearest));
    }
    path.split_off(prefix.len())
}
