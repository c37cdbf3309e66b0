//! How a solve went, as its plans report it.

use crate::model::plan::{Milestone, SearchWork};
use crate::tour::order::SearchStatistics;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Time, duration and bound of every plan found so far.
pub(super) struct History {
    begin: Instant,
    milestones: Mutex<Vec<Milestone>>,
}

impl History {
    /// The empty history of a solve that began at this instant.
    pub(super) fn since(begin: Instant) -> Self {
        Self {
            begin,
            milestones: Mutex::default(),
        }
    }

    /// The history with a plan of this duration and bound, s, found now.
    pub(super) fn with(&self, total_time_s: f64, lower_bound_s: f64) -> Vec<Milestone> {
        let known = self.milestones.lock();
        let mut milestones = known.unwrap_or_else(PoisonError::into_inner).clone();
        milestones.push(Milestone {
            time_s: self.begin.elapsed().as_secs_f64(),
            total_time_s,
            lower_bound_s,
        });
        milestones
    }

    /// Replaces the history by that of a reported plan.
    pub(super) fn replace(&self, milestones: &[Milestone]) {
        let known = self.milestones.lock();
        *known.unwrap_or_else(PoisonError::into_inner) = milestones.to_vec();
    }
}

/// The counts of a search as a plan reports them.
pub(super) fn search_work(search: &SearchStatistics) -> SearchWork {
    SearchWork {
        prefixes: search.prefixes,
        prefixes_unresolved: search.prefixes_unresolved,
        tours: search.tours,
        tours_unresolved: search.tours_unresolved,
        pruned_by_table: search.pruned_by_table,
        pruned_by_prefix: search.pruned_by_prefix,
        pruned_by_incumbent: search.pruned_by_incumbent,
        dropped_for_memory: search.dropped,
    }
}
