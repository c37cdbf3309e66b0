//! What the search tells, while it runs and at its end.

use super::tree::SearchTree;
use crate::run::progress::{Progress, Stage};
use crate::tour::order::incumbents::tie_class;
use crate::tour::order::{Incumbent, SearchEnd, SearchObserver, SearchResult};

/// Incumbent and bound as last told: the one never rises, the other never falls.
pub(super) struct SearchReporter<'a> {
    observer: &'a dyn SearchObserver,
    incumbent_s: Option<f64>,
    bound_s: f64,
    /// Duration of the order handed over last, s.
    handed_over_s: f64,
}

impl<'a> SearchReporter<'a> {
    /// Nothing told yet.
    pub(super) fn new(observer: &'a dyn SearchObserver) -> Self {
        Self {
            observer,
            incumbent_s: None,
            bound_s: 0.0,
            handed_over_s: f64::INFINITY,
        }
    }

    /// Notes that an order of this duration, s, need not be handed over.
    pub(super) fn is_told(&mut self, duration_s: f64) {
        self.handed_over_s = self.handed_over_s.min(duration_s);
    }

    /// Hands over the best order when it is better than the last one and more is to come.
    pub(super) fn announce(&mut self, tree: &SearchTree) {
        let Some((best, alternatives)) = tree.orders().split_first() else {
            return;
        };
        if tree.is_exhausted() || tie_class(best.duration_s) >= tie_class(self.handed_over_s) {
            return;
        }
        self.handed_over_s = best.duration_s;
        self.take_in(tree);
        self.observer.improved(&Incumbent {
            best,
            alternatives,
            lower_bound_s: self.bound_s,
            statistics: *tree.statistics(),
        });
    }

    /// Tells the state of the tree.
    pub(super) fn report(&mut self, tree: &SearchTree) {
        self.take_in(tree);
        self.observer.progress(Progress {
            stage: Stage::Search,
            done: tree.statistics().nodes_explored,
            total: None,
            incumbent_s: self.incumbent_s,
            lower_bound_s: Some(self.bound_s),
        });
    }

    /// Takes incumbent and bound from the tree.
    fn take_in(&mut self, tree: &SearchTree) {
        // Among equals the incumbent is the first lexicographically, which may be longer by
        // rounding; the shorter one was flown all the same.
        self.incumbent_s = match (self.incumbent_s, tree.best_s()) {
            (Some(told), Some(now)) => Some(told.min(now)),
            (told, now) => told.or(now),
        };
        let bound = tree.open_bound().max(self.bound_s);
        // Only bounds that are not admissible can have risen above the incumbent.
        self.bound_s = self
            .incumbent_s
            .map_or(bound, |incumbent| bound.min(incumbent));
    }

    /// The result of a search that has ended and been reported.
    pub(super) fn finish(self, tree: SearchTree, end: SearchEnd) -> SearchResult {
        let complete = end == SearchEnd::Exhausted && tree.is_complete();
        let statistics = *tree.statistics();
        let mut orders = tree.into_orders().into_iter();
        let best = orders.next();
        let lower_bound_s = match &best {
            // What was ruled out as equal to the best is equal to the best.
            Some(best) if tie_class(self.bound_s) >= tie_class(best.duration_s) => best.duration_s,
            _ => self.bound_s,
        };
        SearchResult {
            best,
            alternatives: orders.collect(),
            lower_bound_s,
            complete,
            end,
            statistics,
        }
    }
}
