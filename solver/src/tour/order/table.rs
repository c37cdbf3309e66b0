//! The table of pair bounds, and which orders it is for.

use super::{Place, TourModel};
use crate::model::order_rules::OrderRules;

/// Lower bounds of all legs, s, between places numbered: targets `0..n`, then start, then end.
///
/// A tour without a prescribed end goes on to a place that is reached from everywhere in no time,
/// so that whoever reads the table need not tell the two cases apart.
#[derive(Debug, Clone)]
pub struct PairTable {
    targets: usize,
    bounds: Vec<f64>,
    rules: OrderRules,
}

impl PairTable {
    /// Asks the model for every pair.
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

    /// Times are not negative, and 0 is a valid bound when nothing is known.
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

    /// Which orders of the targets may be flown.
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

    /// Place that a prefix ends at.
    #[must_use]
    pub fn last_place(&self, prefix: &[usize]) -> usize {
        prefix.last().copied().unwrap_or(self.start())
    }
}
