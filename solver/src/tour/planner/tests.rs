//! Set-up that the planner's unit tests share.

use super::Run;
use super::legs::LegSolver;
use super::places::Places;
use crate::model::scenario::Scenario;
use crate::run::pool::SolverPool;
use crate::run::progress::Observer;
use crate::run::stop::StopSignal;
use crate::tour::legs::{LegStore, NoStore};
use std::num::NonZeroUsize;

/// Calls with the leg solver of a scenario, on one thread and without stored segments.
pub(super) fn with_leg_solver<T>(
    scenario: &Scenario,
    observer: &dyn Observer,
    stored_legs: &dyn LegStore,
    stop: &StopSignal,
    work: impl FnOnce(&LegSolver<'_>, Run<'_>) -> T,
) -> T {
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
    let run = Run {
        pool: &pool,
        stop,
        observer,
        legs: stored_legs,
        segments: &NoStore,
    };
    let places = Places::of(scenario);
    work(&LegSolver::new(&places, run, stop), run)
}
