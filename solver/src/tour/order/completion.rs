//! Lower bounds on the time from a place through all remaining targets, from the pair table.

pub(super) mod least_tree;
mod spanning_tree;
pub(super) mod subsets;

pub(super) use spanning_tree::Ascent;
pub use spanning_tree::SpanningTrees;
pub use subsets::SubsetTable;

use super::PairTable;
use crate::model::order_rules::OrderRules;
use crate::run::stop::StopSignal;

/// Number of targets up to which the bound is the exact shortest path. The table has `n 2^n`
/// entries: 160 MiB and a quarter of a second for twenty targets, and half of both for each target
/// less.
pub const MAX_EXACT_TARGETS: usize = 20;

/// Costs of legs between places numbered as in [`PairTable`], s.
pub trait LegCosts {
    /// Number of targets.
    fn targets(&self) -> usize;

    /// Cost of a leg.
    fn cost(&self, from: usize, to: usize) -> f64;

    /// Number of the end.
    fn end(&self) -> usize {
        self.targets() + 1
    }
}

impl LegCosts for PairTable {
    fn targets(&self) -> usize {
        Self::targets(self)
    }

    fn cost(&self, from: usize, to: usize) -> f64 {
        self.bound(from, to)
    }
}

/// Lower bounds on the part of a tour after a prefix.
#[derive(Debug)]
pub enum CompletionBound {
    /// The shortest path in the pair table.
    Exact(SubsetTable),
    /// A relaxation of the shortest path.
    Relaxed(SpanningTrees),
}

impl CompletionBound {
    /// Prepares the bounds of a pair table for the orders that some rules admit. If the stop signal
    /// interrupts the exact table, the relaxation is used: the trees that are known, if any.
    #[must_use]
    pub fn new(
        table: &PairTable,
        rules: &OrderRules,
        trees: Option<SpanningTrees>,
        stop: &StopSignal,
    ) -> Self {
        let few = table.targets() <= MAX_EXACT_TARGETS;
        let exact = few.then(|| SubsetTable::new(table, rules, stop)).flatten();
        exact.map_or_else(
            || Self::Relaxed(trees.unwrap_or_else(|| SpanningTrees::new(table))),
            Self::Exact,
        )
    }

    /// Lower bound, s, of the path from a place (numbered as in the table) through all remaining
    /// targets and to the end.
    #[must_use]
    pub fn bound(&self, table: &PairTable, from: usize, remaining: &[usize]) -> f64 {
        match self {
            Self::Exact(subsets) => subsets.bound(table, from, remaining),
            Self::Relaxed(trees) => trees.bound(table, from, remaining),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::RandomModel;
    use super::*;

    /// Shortest path by trying all of them, s.
    fn shortest(table: &PairTable, from: usize, remaining: &[usize]) -> f64 {
        if remaining.is_empty() {
            return table.bound(from, table.end());
        }
        remaining
            .iter()
            .map(|&to| {
                let rest: Vec<usize> = remaining.iter().copied().filter(|&t| t != to).collect();
                table.bound(from, to) + shortest(table, to, &rest)
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// Start and last target of every case, and the targets between.
    fn cases(table: &PairTable) -> Vec<(usize, Vec<usize>)> {
        let all: Vec<usize> = (0..table.targets()).collect();
        let mut cases = vec![(table.start(), all.clone())];
        for from in 0..table.targets() {
            for size in 0..table.targets() {
                cases.push((
                    from,
                    all.iter()
                        .copied()
                        .filter(|&t| t != from)
                        .take(size)
                        .collect(),
                ));
            }
        }
        cases
    }

    #[test]
    fn the_table_of_subsets_gives_the_shortest_path() {
        for seed in 0..10 {
            let table = PairTable::new(&RandomModel::new(6, seed % 2 == 0, seed));
            let exact = SubsetTable::new(&table, table.rules(), &StopSignal::new());
            let exact = exact.expect("not stopped");
            for (from, remaining) in cases(&table) {
                let expected = shortest(&table, from, &remaining);
                assert!((exact.bound(&table, from, &remaining) - expected).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn spanning_trees_never_exceed_the_shortest_path() {
        for seed in 0..20 {
            let model = if seed < 10 {
                RandomModel::new
            } else {
                RandomModel::with_ties
            };
            let table = PairTable::new(&model(7, seed % 2 == 0, seed));
            let exact = SubsetTable::new(&table, table.rules(), &StopSignal::new());
            let exact = exact.expect("not stopped");
            let trees = SpanningTrees::new(&table);
            for (from, remaining) in cases(&table) {
                let expected = exact.bound(&table, from, &remaining);
                assert!(trees.bound(&table, from, &remaining) <= expected + 1e-9);
            }
        }
    }

    #[test]
    fn an_interrupted_exact_table_is_replaced_by_spanning_trees() {
        let table = PairTable::new(&RandomModel::new(14, false, 3));
        let stop = StopSignal::new();
        let exact = CompletionBound::new(&table, table.rules(), None, &stop);
        assert!(matches!(exact, CompletionBound::Exact(_)));
        stop.request();
        let relaxed = CompletionBound::new(&table, table.rules(), None, &stop);
        assert!(matches!(relaxed, CompletionBound::Relaxed(_)));
        let all: Vec<usize> = (0..14).collect();
        let bounds = [relaxed, exact].map(|bounds| bounds.bound(&table, table.start(), &all));
        assert!(
            0.0 < bounds[0] && bounds[0] <= bounds[1] + 1e-9,
            "{bounds:?}"
        );
    }
}
