//! Progress as an injected observer.

use crate::model::plan::Plan;
use crate::run::contradiction::Contradiction;
use std::sync::{Mutex, PoisonError};

/// The stage of a solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum Stage {
    /// Solving the table of leg times.
    Legs,
    /// Searching the order.
    Search,
    /// Re-integrating the plan.
    Verify,
}

/// A snapshot of a running solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The present stage.
    pub stage: Stage,
    /// Steps of the stage that are done.
    pub done: u64,
    /// Steps of the stage in all, when known.
    pub total: Option<u64>,
    /// Duration of the best plan so far, s.
    pub incumbent_s: Option<f64>,
    /// Lower bound on the duration of every plan so far, s.
    pub lower_bound_s: Option<f64>,
    /// Sum of the values that the best plan so far visits, where targets have values.
    pub value: Option<f64>,
    /// Upper bound on that sum of every plan so far.
    pub value_bound: Option<f64>,
}

impl Progress {
    /// Steps of a stage that are done, by a stage that knows no more.
    pub(crate) fn of_stage(stage: Stage, done: u64, total: Option<u64>) -> Self {
        Self {
            stage,
            done,
            total,
            incumbent_s: None,
            lower_bound_s: None,
            value: None,
            value_bound: None,
        }
    }

    /// The relative gap between incumbent and bound, when both are known.
    #[must_use]
    pub fn relative_gap(&self) -> Option<f64> {
        match (self.incumbent_s, self.lower_bound_s) {
            (Some(upper), Some(lower)) if upper > 0.0 => Some(((upper - lower) / upper).max(0.0)),
            _ => None,
        }
    }
}

/// Receives progress from any worker thread.
pub trait Observer: Sync {
    /// Called at every step of a stage; must return quickly.
    fn progress(&self, progress: Progress);

    /// Called whenever the search has found a better order and goes on, before the progress that
    /// reports it. The plan is verified and `feasible`, with the bound of that moment. The search
    /// waits: must return quickly.
    fn incumbent(&self, plan: &Plan) {
        let _ = plan;
    }

    /// Called when a solution contradicts a certified bound or a stored leg: a defect of the
    /// planner, whose answer then claims less. This default panics under debug assertions, as in
    /// tests.
    fn contradicted(&self, contradiction: &Contradiction) {
        debug_assert!(false, "{contradiction}");
    }
}

/// An observer that ignores everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Observer for Silent {
    fn progress(&self, _: Progress) {}
}

/// Passes progress on together with what earlier reports have told: a stage knows a part of it only, and stages
/// alternate where legs are solved when a search asks for them.
pub(crate) struct Continued<'a> {
    observer: &'a dyn Observer,
    told: Mutex<Option<Progress>>,
}

impl<'a> Continued<'a> {
    /// Nothing has been told yet.
    pub(crate) fn new(observer: &'a dyn Observer) -> Self {
        Self {
            observer,
            told: Mutex::default(),
        }
    }
}

impl Observer for Continued<'_> {
    fn progress(&self, progress: Progress) {
        let now = {
            let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
            let now = told.map_or(progress, |told| Progress {
                incumbent_s: progress.incumbent_s.or(told.incumbent_s),
                lower_bound_s: progress.lower_bound_s.or(told.lower_bound_s),
                value: progress.value.or(told.value),
                value_bound: progress.value_bound.or(told.value_bound),
                ..progress
            });
            *told = Some(now);
            now
        };
        self.observer.progress(now);
    }

    fn incumbent(&self, plan: &Plan) {
        self.observer.incumbent(plan);
    }

    fn contradicted(&self, contradiction: &Contradiction) {
        self.observer.contradicted(contradiction);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Default)]
    struct Recorded(Mutex<Vec<Progress>>);

    impl Observer for Recorded {
        fn progress(&self, progress: Progress) {
            self.0.lock().expect("no panic").push(progress);
        }
    }

    #[test]
    fn what_a_search_has_told_stays_while_legs_are_solved() {
        let recorded = Recorded::default();
        let continued = Continued::new(&recorded);
        let legs = Progress::of_stage(Stage::Legs, 1, Some(6));
        let search = Progress {
            stage: Stage::Search,
            incumbent_s: Some(9.0),
            lower_bound_s: Some(7.0),
            ..legs
        };
        let better = Progress {
            lower_bound_s: Some(8.0),
            ..search
        };
        for progress in [legs, search, legs, better, legs] {
            continued.progress(progress);
        }
        let told = recorded.0.into_inner().expect("no panic");
        let known = told
            .iter()
            .map(|told| (told.incumbent_s, told.lower_bound_s));
        let known: Vec<_> = known.collect();
        let (first, then) = ((Some(9.0), Some(7.0)), (Some(9.0), Some(8.0)));
        assert_eq!(known, [(None, None), first, first, then, then]);
        assert_eq!(told[4].stage, Stage::Legs);
    }
}
