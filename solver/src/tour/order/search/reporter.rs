//! Reports of the search, while it runs and at its end.

use super::tree::SearchTree;
use crate::run::progress::{Progress, Stage};
use crate::tour::order::incumbents::tie_class;
use crate::tour::order::{Incumbent, SearchEnd, SearchObserver, SearchResult};

/// Reports incumbents and bounds; a reported incumbent never rises, and a reported bound never
/// falls.
pub(super) struct SearchReporter<'a> {
    observer: &'a dyn SearchObserver,
    incumbent_s: Option<f64>,
    bound_s: f64,
    /// Duration of the order announced last, s.
    announced_s: f64,
}

impl<'a> SearchReporter<'a> {
    /// A reporter that has reported nothing yet.
    pub(super) fn new(observer: &'a dyn SearchObserver) -> Self {
        Self {
            observer,
            incumbent_s: None,
            bound_s: 0.0,
            announced_s: f64::INFINITY,
        }
    }

    /// Notes that orders of this duration, s, or longer need not be announced.
    pub(super) fn skip(&mut self, duration_s: f64) {
        self.announced_s = self.announced_s.min(duration_s);
    }

    /// Announces the best order if it is better than the one announced before and the search goes
    /// on.
    pub(super) fn announce(&mut self, tree: &SearchTree) {
        let Some((best, alternatives)) = tree.orders().split_first() else {
            return;
        };
        if tree.is_exhausted() || tie_class(best.duration_s) >= tie_class(self.announced_s) {
            return;
        }
        self.announced_s = best.duration_s;
        self.update(tree);
        self.observer.improved(&Incumbent {
            best,
            alternatives,
            lower_bound_s: self.bound_s,
            statistics: *tree.statistics(),
        });
    }

    /// Reports the state of the tree.
    pub(super) fn report(&mut self, tree: &SearchTree) {
        self.update(tree);
        self.observer.progress(Progress {
            stage: Stage::Search,
            done: tree.statistics().nodes_explored,
            total: None,
            incumbent_s: self.incumbent_s,
            lower_bound_s: Some(self.bound_s),
            value: None,
            value_bound: None,
        });
    }

    /// Takes incumbent and bound from the tree.
    fn update(&mut self, tree: &SearchTree) {
        // Among ties the tree's best is the lexicographically first order, which may be longer than
        // the one reported before by rounding.
        self.incumbent_s = match (self.incumbent_s, tree.best_s()) {
            (Some(reported), Some(now)) => Some(reported.min(now)),
            (reported, now) => reported.or(now),
        };
        let bound = tree.open_bound().max(self.bound_s);
        // Bounds above the incumbent are not admissible.
        self.bound_s = self
            .incumbent_s
            .map_or(bound, |incumbent| bound.min(incumbent));
    }

    /// The result of a search after its last report.
    pub(super) fn finish(self, tree: SearchTree, end: SearchEnd) -> SearchResult {
        let complete = end == SearchEnd::Exhausted && tree.is_complete();
        let statistics = *tree.statistics();
        let mut orders = tree.into_orders().into_iter();
        let best = orders.next();
        let lower_bound_s = match &best {
            // Orders ruled out as ties of the best are as long as the best.
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
