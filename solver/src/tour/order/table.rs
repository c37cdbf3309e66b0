//! The table of pair bounds, with the rules of the orders.

use super::{Place, TourModel};
use crate::model::order_rules::OrderRules;

/// Lower bounds of all legs, s, between places that are numbered: targets `0..n`, then the start,
/// then the end.
///
/// Without a prescribed end, the table has an end that every place reaches in zero time, so that
/// both cases are treated alike.
#[derive(Debug, Clone)]
pub struct PairTable {
    targets: usize,
    bounds: Vec<f64>,
    rules: OrderRules,
}

impl PairTable {
    /// The table of a model: its bounds for every pair.
    #[must_use]
    pub fn new(model: &dyn TourModel) -> Self {
        let targets = model.target_count();
        let mut table = Self {
            targets,
            bounds: vec![0.0; (targets + 2) * (targets + 2)],
            rules: model.rules().clone(),
        };
        for to in 0..targets {
            table.set(
                table.start(),
                to,
                model.pair_bound(Place::Start, Place::Target(to)),
            );
            for from in (0..targets).filter(|&from| from != to) {
                let bound = model.pair_bound(Place::Target(from), Place::Target(to));
                table.set(from, to, bound);
            }
        }
        if model.has_end() {
            for from in 0..targets {
                table.set(
                    from,
                    table.end(),
                    model.pair_bound(Place::Target(from), Place::End),
                );
            }
            if targets == 0 {
                let bound = model.pair_bound(Place::Start, Place::End);
                table.set(table.start(), table.end(), bound);
            }
        }
        table
    }

    /// Sets a bound; one that is negative or not finite is replaced by 0.
    fn set(&mut self, from: usize, to: usize, bound: f64) {
        let place = from * (self.targets + 2) + to;
        self.bounds[place] = if bound.is_finite() {
            bound.max(0.0)
        } else {
            0.0
        };
    }

    /// Number of targets.
    #[must_use]
    pub fn targets(&self) -> usize {
        self.targets
    }

    /// Which orders of the targets are admitted.
    #[must_use]
    pub fn rules(&self) -> &OrderRules {
        &self.rules
    }

    /// Number of the start.
    #[must_use]
    pub fn start(&self) -> usize {
        self.targets
    }

    /// Number of the end, prescribed or not.
    #[must_use]
    pub fn end(&self) -> usize {
        self.targets + 1
    }

    /// Lower bound, s, from leaving one place to leaving the other.
    #[must_use]
    pub fn bound(&self, from: usize, to: usize) -> f64 {
        self.bounds[from * (self.targets + 2) + to]
    }

    /// Number of the last place of a prefix: the start, if it has no targets.
    #[must_use]
    pub fn last_place(&self, prefix: &[usize]) -> usize {
        prefix.last().copied().unwrap_or(self.start())
    }
}
