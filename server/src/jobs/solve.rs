//! Solves one job: from its stored scenario to its end.

use super::memory::MemoryGuard;
use super::progress::Reporter;
use crate::base::contradictions::ContradictionObserver;
use crate::documents;
use crate::documents::plan::Interruption;
use crate::store::{EndCode, Ended, JobState, PackedPlan};
use slewplan_solver::model::plan::{Optimality, Outcome, Plan};
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::Validated;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::{StopReason, StopSignal};
use slewplan_solver::tour::legs::{LegStore, NoStore, SegmentStore};
use slewplan_solver::tour::planner::{self, Run};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

/// The resources of a job's solve.
pub(super) struct JobContext<'a> {
    /// The threads of the solver.
    pub(super) pool: &'a SolverPool,
    /// Requests to stop or cancel.
    pub(super) stop: &'a StopSignal,
    /// Receives progress and better plans.
    pub(super) reporter: &'a Reporter,
    /// The leg cache.
    pub(super) legs: &'a dyn LegStore,
    /// Segments that an earlier attempt has solved.
    pub(super) segments: &'a dyn SegmentStore,
    /// Stops the solve at its memory limit.
    pub(super) memory: &'a MemoryGuard,
}

impl JobContext<'_> {
    /// A run that solves legs and nothing else. Bounds that they contradict are reported.
    pub(super) fn run_of_legs(&self) -> Run<'_> {
        Run {
            pool: self.pool,
            stop: self.stop,
            observer: &ContradictionObserver,
            legs: self.legs,
            segments: &NoStore,
        }
    }

    /// The cause that stopped the solve.
    pub(super) fn interruption(&self) -> Interruption {
        match self.memory.exceeded() {
            Some(limit) => Interruption::Memory { limit },
            // The signal is set by requests, not by the time limit.
            None if self.stop.is_set() => Interruption::Request,
            None => Interruption::TimeLimit,
        }
    }
}

/// Solves a stored scenario. A panic ends this job only.
pub(super) fn solve(scenario: &[u8], context: &JobContext<'_>) -> Ended {
    catch_unwind(AssertUnwindSafe(|| attempt(scenario, context))).unwrap_or_else(|_| broken())
}

/// The end of a job after an error of the program.
pub(super) fn broken() -> Ended {
    without_plan(
        JobState::Failed,
        Some(EndCode::Internal),
        "an internal error ended the solve; please report the scenario",
    )
}

fn attempt(scenario: &[u8], context: &JobContext<'_>) -> Ended {
    let Validated { scenario, warnings } = match documents::scenario::read(scenario, None) {
        Ok(valid) => valid,
        // It was valid when it was accepted: another version of the program reads it now.
        Err(problems) => return refused(JobState::Failed, &problems),
    };
    #[cfg(feature = "faults")]
    crate::base::faults::strike(scenario.name(), context.pool, context.stop);
    let observer = context.reporter.observer(&warnings);
    let run = Run {
        pool: context.pool,
        stop: context.stop,
        observer: &observer,
        legs: context.legs,
        segments: context.segments,
    };
    let outcome = planner::solve(&scenario, run);
    #[cfg(feature = "faults")]
    crate::base::faults::strike_late(scenario.name());
    if run.stop.reason() == Some(StopReason::Cancelled) {
        return without_plan(JobState::Cancelled, None, "cancelled on request");
    }
    let stopped = context.interruption().reason();
    let document = documents::plan::document(&outcome, slice::from_ref(&stopped), &warnings);
    match serde_json::to_vec(&document) {
        Ok(document) => Ended {
            document: Some(PackedPlan::of(&document)),
            ..described(&outcome, &stopped)
        },
        Err(error) => without_plan(
            JobState::Failed,
            Some(EndCode::Internal),
            &format!("the plan cannot be written: {error}"),
        ),
    }
}

fn described(outcome: &Outcome, stopped: &Problem) -> Ended {
    match outcome {
        Outcome::Planned(plan) => planned(plan),
        Outcome::Infeasible(reasons) => refused(JobState::Infeasible, reasons),
        Outcome::Failed(reasons) => refused(JobState::Failed, reasons),
        Outcome::StoppedEmpty => {
            let code = Some(EndCode::Problem(stopped.code));
            Ended {
                early: true,
                ..without_plan(JobState::Failed, code, &stopped.message)
            }
        }
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
        value: plan.schedule.as_ref().map(|schedule| schedule.value),
        value_bound: plan.schedule.as_ref().map(|schedule| schedule.value_bound),
        keep_out_violated: Some(plan.margins.violates_cones()),
        detail: None,
        code: None,
        early: plan.optimality == Optimality::Feasible,
    }
}

pub(super) fn without_plan(state: JobState, code: Option<EndCode>, detail: &str) -> Ended {
    Ended {
        state,
        document: None,
        incumbent_s: None,
        lower_bound_s: None,
        value: None,
        value_bound: None,
        keep_out_violated: None,
        detail: Some(detail.to_owned()),
        code,
        early: false,
    }
}

pub(super) fn refused(state: JobState, problems: &[Problem]) -> Ended {
    let first = problems.first().map(|first| EndCode::Problem(first.code));
    without_plan(state, first, &sentence(problems))
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
