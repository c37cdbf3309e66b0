//! Beginnings of schedules.

use crate::model::scenario::{Target, Window};
use crate::tour::order::Place;
use crate::tour::planner::clock::chains::Visit;
use crate::tour::schedule::Rank;
use std::cmp::Ordering;

/// A target with the window in which it is visited.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Choice {
    pub(super) target: usize,
    /// The window by its number; `None` where the target has no list of them.
    pub(super) window: Option<usize>,
}

impl Choice {
    /// The visit, with its window.
    pub(super) fn visit(self, targets: &[Target]) -> Visit {
        let windows = targets[self.target].windows.as_ref();
        Visit {
            place: Place::Target(self.target),
            window: self.window.and_then(|number| windows?.get(number).copied()),
        }
    }
}

/// A beginning.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// No schedule that begins so is better.
    pub(super) bound: Rank,
    pub(super) visits: Vec<Choice>,
    /// When the last target is left at the earliest, s.
    pub(super) departure: f64,
    /// Number of visits up to the last place at which the body may wait, and when that is left, s.
    pub(super) anchor: (usize, f64),
    /// Whether its program has been solved.
    pub(super) is_evaluated: bool,
    /// Whether a motion leaves the last target at that time, and not only none earlier.
    pub(super) is_flown: bool,
}

impl Node {
    /// The beginning without visits, with a bound on all schedules.
    pub(super) fn root(bound: Rank) -> Self {
        Self {
            bound,
            visits: Vec::new(),
            departure: 0.0,
            anchor: (0, 0.0),
            is_evaluated: true,
            is_flown: true,
        }
    }

    /// The targets in order.
    pub(super) fn order(&self) -> Vec<usize> {
        self.visits.iter().map(|choice| choice.target).collect()
    }

    /// The last place.
    pub(super) fn last(&self) -> Place {
        place_of(self.visits.last())
    }

    /// The last place at which the body may wait, and the visits after it.
    pub(super) fn chain(&self, targets: &[Target]) -> (Place, Vec<Visit>) {
        let (before, after) = self.visits.split_at(self.anchor.0);
        let visits = after.iter().map(|choice| choice.visit(targets));
        (place_of(before.last()), visits.collect())
    }

    /// Beginnings with one more target, one for each window that is left after an arrival.
    pub(super) fn with(&self, target: usize, arrival: f64, targets: &[Target]) -> Vec<Self> {
        let service = targets[target].service();
        let with_window = |number: Option<usize>, window: Option<Window>| {
            let begin = arrival.max(window.map_or(0.0, |window| window.from));
            let late = window.is_some_and(|w| begin * (1.0 - 1e-9) + service > w.to);
            (!late).then(|| {
                let mut visits = self.visits.clone();
                let window = number;
                visits.push(Choice { target, window });
                Self {
                    visits,
                    departure: begin + service,
                    is_evaluated: false,
                    ..*self
                }
            })
        };
        match &targets[target].windows {
            None => with_window(None, None).into_iter().collect(),
            Some(windows) => {
                let all = windows.iter().enumerate();
                all.filter_map(|(number, window)| with_window(Some(number), Some(*window)))
                    .collect()
            }
        }
    }
}

fn place_of(choice: Option<&Choice>) -> Place {
    choice.map_or(Place::Start, |choice| Place::Target(choice.target))
}

impl Ord for Node {
    fn cmp(&self, other: &Self) -> Ordering {
        // Of equal ones the longer beginning, and then the first, for the same search every time.
        let by_length = || self.visits.len().cmp(&other.visits.len());
        let choices = |node: &Self| -> Vec<(usize, Option<usize>)> {
            let visits = node.visits.iter();
            visits
                .map(|choice| (choice.target, choice.window))
                .collect()
        };
        let by_bound = self.bound.compare(&other.bound);
        by_bound
            .then_with(by_length)
            .then_with(|| choices(other).cmp(&choices(self)))
    }
}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Node {}
