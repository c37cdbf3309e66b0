//! Progress as an injected observer.

use crate::model::plan::Plan;
use crate::run::contradiction::Contradiction;

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
