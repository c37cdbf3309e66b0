//! Iterated local search (Lourenço, Martin and Stützle 2003): small random changes, each followed
//! by local search, from one good order to the next.
//!
//! A *kick* is a double bridge of three short segments. No move of the local search undoes it, and
//! only the places at its joints are looked at again, so that it takes tens of microseconds at 200
//! targets. An order that is worse than the best by little is kept all the same, less so towards the
//! end of a run.
//!
//! Measured on ten tables of random attitudes of the whole sphere each (5 s and 30 s per radian, one
//! core), above the bound of the spanning trees in the mean and at most: after 100 kicks per target
//! 0.24 and 0.63 % at 50 targets (0.07 s), 0.20 and 0.38 % at 100 (0.18 s), 0.31 and 0.53 % at 200
//! (0.4 s); local search alone 2.1 to 2.5 and 3.7 %. With other costs in either direction (200
//! targets) as many kicks end 0.2 % above eight times as many.

use super::cost::OrderCost;
use super::local_search::{LocalSearch, OrderTask};
use crate::math::random::SplitMix;
use crate::run::stop::StopSignal;
use crate::tour::order::SolvedOrder;
use crate::tour::order::incumbents::Incumbents;
use std::ops::RangeInclusive;

/// Longest segment of a kick.
const MAX_SEGMENT: usize = 30;
/// An order is kept if it is longer than the best by at most this share of a mean leg at the first
/// kick of a run, and by less and less until the last (threshold accepting, Dueck and Scheuer 1990).
/// A constant share gets stuck 0.2 % higher where bends cost much.
const TOLERANCE: f64 = 1.0;

/// A search under way.
///
/// What it finds follows from what it is given, the seed among that, unless it is stopped.
pub(in crate::tour::order) struct IteratedSearch<'a, C> {
    search: LocalSearch<'a, C>,
    /// The places of the order from which the kicks start.
    kept: Vec<usize>,
    /// The cost of that order, s.
    kept_s: f64,
    best: Incumbents,
    random: SplitMix,
}

impl<'a, C: OrderCost> IteratedSearch<'a, C> {
    /// Begins at an order that the rules allow, and keeps so many of the best besides the best one.
    pub(in crate::tour::order) fn new(
        task: &OrderTask<'a, C>,
        order: &[usize],
        alternatives: usize,
        seed: u64,
    ) -> Self {
        let search = LocalSearch::new(task, order);
        let mut begun = Self {
            kept: search.path.places().to_vec(),
            kept_s: search.path.length(),
            search,
            best: Incumbents::new(alternatives, 0.0),
            random: SplitMix::new(seed),
        };
        begun.kept_s = begun.offer(begun.kept_s);
        begun
    }

    /// Kicks so many times or until stopped, one long run being better than many short ones; says how many times it did. The first kick starts from
    /// a local minimum.
    pub(in crate::tour::order) fn run(&mut self, kicks: usize, stop: &StopSignal) -> usize {
        let change = self.search.settle(stop, |_| ());
        self.kept_s = self.offer(self.kept_s + change);
        self.kept.copy_from_slice(self.search.path.places());
        let targets = self.kept.len() - 2;
        if targets < 3 {
            return 0;
        }
        let tolerance_s = TOLERANCE * self.kept_s / (targets + 1) as f64;
        for done in 0..kicks {
            if stop.is_set() {
                return done;
            }
            let left = (kicks - done) as f64 / kicks as f64;
            self.kick(left * tolerance_s, stop);
        }
        kicks
    }

    /// The best orders so far with their costs, best first. The one begun at is among them until
    /// better ones displace it.
    pub(in crate::tour::order) fn best(&self) -> &[SolvedOrder] {
        self.best.orders()
    }

    /// Kicks, searches, and keeps the order or goes back.
    fn kick(&mut self, tolerance_s: f64, stop: &StopSignal) {
        let targets = self.kept.len() - 2;
        let longest = MAX_SEGMENT.min(targets / 3);
        let lengths = [(); 3].map(|()| 1 + self.random.below(longest));
        let moving: usize = lengths.iter().sum();
        let first = 1 + self.random.below(targets - moving + 1);
        let Some(change) = self.search.bridge(first, lengths) else {
            return;
        };
        let mut changed = first..=first + moving - 1;
        let change = change
            + self.search.settle(stop, |step| {
                changed = hull(&changed, &step.range());
            });
        let places = &self.search.path.places()[changed.clone()];
        if places == &self.kept[changed.clone()] {
            return;
        }
        let length_s = self.offer(self.kept_s + change);
        if self
            .best
            .best_s()
            .is_none_or(|best_s| length_s <= best_s + tolerance_s)
        {
            self.kept_s = length_s;
            self.kept[changed.clone()].copy_from_slice(&self.search.path.places()[changed]);
        } else {
            let first = *changed.start();
            self.search.path.restore(first, &self.kept[changed]);
        }
    }

    /// Lists the order if it is among the best. Costs are summed from changes: those of the listed
    /// ones anew, which is returned.
    fn offer(&mut self, length_s: f64) -> f64 {
        if self.best.rule_out_bound(length_s) {
            return length_s;
        }
        let duration_s = self.search.path.length();
        let order = self.search.path.order().to_vec();
        self.best.offer(SolvedOrder { order, duration_s });
        duration_s
    }
}

/// The least range that holds both.
fn hull(a: &RangeInclusive<usize>, b: &RangeInclusive<usize>) -> RangeInclusive<usize> {
    *a.start().min(b.start())..=*a.end().max(b.end())
}
