//! One job from its scenario to how it ended.

use super::progress::Reporter;
use crate::store::{Ended, JobState};
use crate::wire;
use slewplan_solver::legs::{LegStore, SegmentStore};
use slewplan_solver::plan::{Optimality, Outcome, Plan};
use slewplan_solver::planner::{self, Run};
use slewplan_solver::pool::SolverPool;
use slewplan_solver::problem::Problem;
use slewplan_solver::scenario::Validated;
use slewplan_solver::stop::{StopReason, StopSignal};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What a job is solved with.
pub(super) struct Means<'a> {
    /// Where the work is done.
    pub(super) pool: &'a SolverPool,
    /// Requests of callers.
    pub(super) stop: &'a StopSignal,
    /// Told about progress and better plans.
    pub(super) reporter: &'a Reporter,
    /// The remembered legs.
    pub(super) legs: &'a dyn LegStore,
    /// What an earlier attempt has solved.
    pub(super) segments: &'a dyn SegmentStore,
}

/// Solves a scenario as stored. A panic costs this job and no other.
pub(super) fn solve(scenario: &[u8], means: &Means<'_>) -> Ended {
    catch_unwind(AssertUnwindSafe(|| attempt(scenario, means))).unwrap_or_else(|_| broken())
}

/// The end of a job that met an error of ours.
pub(super) fn broken() -> Ended {
    without_plan(
        JobState::Failed,
        "internal_error",
        "an internal error ended the solve; please report the scenario",
    )
}

fn attempt(scenario: &[u8], means: &Means<'_>) -> Ended {
    let Validated { scenario, warnings } = match wire::scenario::read(scenario, None) {
        Ok(valid) => valid,
        // It was valid when it was accepted: another version of the program reads it now.
        Err(problems) => return refused(JobState::Failed, &problems),
    };
    #[cfg(feature = "faults")]
    crate::faults::strike(scenario.name(), means.pool, means.stop);
    let observer = means.reporter.observer(&warnings);
    let run = Run {
        pool: means.pool,
        stop: means.stop,
        observer: &observer,
        legs: means.legs,
        segments: means.segments,
    };
    let outcome = planner::solve(&scenario, run);
    if run.stop.reason() == Some(StopReason::Cancelled) {
        return without_plan(JobState::Cancelled, "cancelled", "abandoned on request");
    }
    match serde_json::to_vec(&wire::plan::document(&outcome, &warnings)) {
        Ok(document) => Ended {
            document: Some(document),
            ..described(&outcome)
        },
        Err(error) => without_plan(
            JobState::Failed,
            "internal_error",
            &format!("the plan cannot be written: {error}"),
        ),
    }
}

fn described(outcome: &Outcome) -> Ended {
    match outcome {
        Outcome::Planned(plan) => planned(plan),
        Outcome::Infeasible(reasons) => refused(JobState::Infeasible, reasons),
        Outcome::Failed(reasons) => refused(JobState::Failed, reasons),
        Outcome::StoppedEmpty => Ended {
            early: true,
            ..without_plan(
                JobState::Failed,
                "stopped_without_plan",
                "stopped before a first plan was found",
            )
        },
    }
}

fn planned(plan: &Plan) -> Ended {
    Ended {
        state: match plan.optimality {
            Optimality::Optimal => JobState::Succeeded,
            Optimality::Feasible => JobState::Stopped,
        },
        document: None,
        incumbent_s: Some(plan.total_time_s),
        lower_bound_s: Some(plan.lower_bound_s),
        detail: None,
        cause: "",
        early: plan.optimality == Optimality::Feasible,
    }
}

fn without_plan(state: JobState, cause: &'static str, detail: &str) -> Ended {
    Ended {
        state,
        document: None,
        incumbent_s: None,
        lower_bound_s: None,
        detail: Some(detail.to_owned()),
        cause,
        early: false,
    }
}

fn refused(state: JobState, problems: &[Problem]) -> Ended {
    let cause = problems
        .first()
        .map_or("unknown", |first| first.code.as_str());
    without_plan(state, cause, &sentence(problems))
}

fn sentence(problems: &[Problem]) -> String {
    let parts: Vec<String> = problems
        .iter()
        .map(|problem| {
            format!(
                "{}: {} [{}]",
                problem.pointer, problem.message, problem.code
            )
        })
        .collect();
    parts.join("; ")
}
