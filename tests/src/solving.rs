//! From a description to an outcome in one call.

use slewplan_solver::model::plan::{Outcome, Plan};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::progress::Silent;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::planner::{self, Run};
use std::num::NonZeroUsize;

/// The scenario of a description without its time limit, so that results do not depend on the load of
/// the machine.
///
/// # Panics
///
/// When the description is not valid, with all problems.
#[must_use]
pub fn scenario_of(spec: &ScenarioSpec) -> Scenario {
    let mut spec = spec.clone();
    spec.options.time_limit_s = None;
    match Scenario::try_new(&spec) {
        Ok(validated) => validated.scenario,
        Err(problems) => panic!("{problems:?}"),
    }
}

/// A pool with a number of threads.
///
/// # Panics
///
/// When the threads cannot be started, or their number is zero.
#[must_use]
pub fn pool(threads: usize) -> SolverPool {
    let threads = NonZeroUsize::new(threads).expect("at least one thread");
    SolverPool::new(Some(threads)).expect("threads can be started")
}

/// Calls with a run without observer, stop and store, on a number of threads.
pub fn on_threads<R>(threads: usize, work: impl FnOnce(Run<'_>) -> R) -> R {
    let pool = pool(threads);
    work(Run {
        pool: &pool,
        stop: &StopSignal::new(),
        observer: &Silent,
        legs: &slewplan_solver::tour::legs::NoStore,
        segments: &slewplan_solver::tour::legs::NoStore,
    })
}

/// Solves on two threads, without a wall-clock limit.
#[must_use]
pub fn outcome_of(spec: &ScenarioSpec) -> Outcome {
    let scenario = scenario_of(spec);
    on_threads(2, |run| planner::solve(&scenario, run))
}

/// The plan of a scenario that has one.
///
/// # Panics
///
/// When there is no plan, with the outcome.
#[must_use]
pub fn plan_of(spec: &ScenarioSpec) -> Plan {
    planned(outcome_of(spec))
}

/// The plan in an outcome, which has passed its verification.
///
/// # Panics
///
/// When there is no plan, with the outcome.
#[must_use]
pub fn planned(outcome: Outcome) -> Plan {
    let Outcome::Planned(plan) = outcome else {
        panic!("no plan but {outcome:?}");
    };
    assert!(plan.verification.passed, "{:?}", plan.verification);
    *plan
}

/// The visited targets in order, their identifiers joined.
#[must_use]
pub fn order_of(plan: &Plan) -> String {
    let passages = plan.flight.passages.iter();
    passages.map(|passage| passage.target.as_str()).collect()
}

/// Whether two durations agree to a relative tolerance.
#[must_use]
pub fn agree(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}
