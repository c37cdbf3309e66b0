//! Which targets to visit, and in what order, where time counts: windows, values and a latest end.
//!
//! # Problem
//!
//! Legs take given times, a visit lasts its service time and lies inside one of the target's windows,
//! and it is always possible to arrive early and wait. Of all schedules that visit the required
//! targets wanted is one whose optional targets have the greatest sum of values, and among those one
//! that ends first (an orienteering problem with time windows). Where legs take longer than the given
//! times, the answers are an upper bound on the value and a lower bound on the time.
//!
//! Bounds on the times of two legs together hold from the departure before the first to the arrival after
//! the second: where they are known, the arrivals are no earlier ([`TravelTimes::coupling_gaps_s`]).
//!
//! # Labels
//!
//! A label is a beginning: its last target, when that visit begins, the worth of its targets, and which
//! targets cannot follow. It dominates another with the same last target that begins no earlier, is
//! worth no more and bars at least the same targets. Where legs couple, it has to begin earlier by the
//! most that the coupling may delay what follows, or to come from the same target and have left that no
//! later.
//!
//! With all barred targets kept in mind labels are exact; a label that keeps only those near each target
//! in mind (ng-routes: Baldacci, Mingozzi and Roberti 2011) may visit a target twice, of which there are
//! far fewer, and its best path bounds all schedules. What the best path did wrong is then kept in mind
//! (decremental state space relaxation: Righini and Salani 2009), and labels run in the other direction,
//! from the end back to the start, with the bounds of the last run to discard all that cannot reach the
//! goal.
//!
//! First the goal is more worth than that of the best known schedule, then an earlier end with the
//! same worth. A run that ends without a path is the proof.

mod continuations;
mod coupling_gaps;
mod instance;
mod labels;
mod local_search;
mod reach;
mod route_memory;
mod search;
mod target_set;
#[cfg(test)]
mod tests;
mod worth;

use crate::model::order_rules::OrderRules;
use crate::tour::order::Place;

pub use continuations::{Beginning, Continuation, Continuations, Rank};
pub use reach::{Reach, possible_legs, reaches};
pub use search::{LABEL_BYTES, MAX_LABELS, SearchLimits, labels_in_time, search, search_from};

/// Most targets for which bounds are computed by labels.
pub const MAX_LABELLED: usize = target_set::MAX_MEMBERS;

/// When a target may be visited, how long that takes, and what it is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedTarget {
    /// Duration of a visit, s.
    pub service_s: f64,
    /// Begin and end of spans of time, s, in order and disjoint; a visit lies inside one of them. `None`
    /// at any time.
    pub windows: Option<Vec<[f64; 2]>>,
    /// Worth of a visit, above zero; `None` where the target has to be visited.
    pub value: Option<f64>,
}

/// What is to be scheduled.
#[derive(Debug, Clone)]
pub struct TimedProblem {
    /// The targets.
    pub targets: Vec<TimedTarget>,
    /// Positions and precedences among the targets that are visited.
    pub rules: OrderRules,
    /// Whether the schedule goes on to an end after the last target.
    pub has_end: bool,
    /// When it ends at the latest, s.
    pub latest_end_s: Option<f64>,
}

impl TimedProblem {
    /// Sum of the values of targets, added in the order of the scenario: it does not depend on the order
    /// of visits.
    #[must_use]
    pub fn value_of(&self, order: &[usize]) -> f64 {
        let mut visited = order.to_vec();
        visited.sort_unstable();
        let values = visited
            .iter()
            .filter_map(|target| self.targets[*target].value);
        // The sum of nothing would be minus zero.
        values.fold(0.0, |sum, value| sum + value)
    }
}

impl TimedProblem {
    /// The schedule of an order, each visit as early as the legs on their own allow; `None` where it breaks a window, a rule or
    /// the latest end.
    #[must_use]
    pub fn schedule_of(
        &self,
        order: &[usize],
        times: &(impl TravelTimes + ?Sized),
    ) -> Option<TimedOrder> {
        let (mut at, mut time) = (Place::Start, 0.0);
        let mut begins_s = Vec::with_capacity(order.len());
        for (place, &target) in order.iter().enumerate() {
            let misplaced = self.rules.position(target).is_some_and(|p| p != place);
            let before = self.rules.predecessors(target);
            if misplaced || before.iter().any(|other| order[place..].contains(other)) {
                return None;
            }
            let begin =
                self.begin_after(target, time + times.travel_s(at, Place::Target(target)))?;
            begins_s.push(begin);
            (at, time) = (
                Place::Target(target),
                begin + self.targets[target].service_s,
            );
        }
        if self.has_end {
            time += times.travel_s(at, Place::End);
        }
        let is_in_time = time <= self.latest_end_s.unwrap_or(f64::MAX);
        is_in_time.then(|| TimedOrder {
            value: self.value_of(order),
            order: order.to_vec(),
            begins_s,
            end_s: time,
        })
    }

    /// When a visit begins at the earliest after an arrival, s.
    fn begin_after(&self, target: usize, arrival: f64) -> Option<f64> {
        let TimedTarget {
            service_s, windows, ..
        } = &self.targets[target];
        let Some(windows) = windows else {
            return arrival.is_finite().then_some(arrival);
        };
        let next = windows.iter().find(|[_, to]| arrival <= to - service_s)?;
        Some(arrival.max(next[0]))
    }
}

/// Times of the legs between the places of a problem.
pub trait TravelTimes {
    /// Time, s, of the leg between two places, not negative; infinite where there is none.
    fn travel_s(&self, from: Place, to: Place) -> f64;

    /// By how much, s, the legs between three places take longer together than each on its own, where
    /// that is known and more than nothing.
    fn coupling_gaps_s(&self) -> Vec<([Place; 3], f64)> {
        Vec::new()
    }
}

impl<F: Fn(Place, Place) -> f64> TravelTimes for F {
    fn travel_s(&self, from: Place, to: Place) -> f64 {
        self(from, to)
    }
}

/// A schedule.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedOrder {
    /// The targets that are visited, in that order.
    pub order: Vec<usize>,
    /// When each of these visits begins, s, as early as possible.
    pub begins_s: Vec<f64>,
    /// When the schedule ends, s.
    pub end_s: f64,
    /// Sum of the values of the targets that are visited.
    pub value: f64,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedResult {
    /// The best schedule that visits all required targets.
    pub best: Option<TimedOrder>,
    /// No schedule has more value.
    pub value_bound: f64,
    /// No schedule with at least the value of the best one ends earlier, s.
    pub end_bound_s: f64,
    /// Whether the best schedule is proved to be one, or that there is none.
    pub complete: bool,
    /// Labels made.
    pub labels: u64,
}
