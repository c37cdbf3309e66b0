//! Limits on the size of scenarios.

use super::App;
use super::error::{ApiError, ErrorCode};
use crate::documents::document::Node;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::planner;

/// Refuses scenarios with too many targets.
pub(super) fn check_targets(app: &App, count: usize) -> Result<(), ApiError> {
    let limit = app.limits().targets;
    if count <= limit {
        return Ok(());
    }
    let detail = format!("{count} targets; the limit is {limit} (max_targets)");
    Err(ApiError::new(ErrorCode::TooManyTargets, detail))
}

/// The same before the scenario is read, which takes long with many targets.
pub(super) fn check_size(app: &App, scenario: &Node) -> Result<(), ApiError> {
    match scenario.member("targets") {
        Some(Node::List(targets)) => check_targets(app, targets.len()),
        _ => Ok(()),
    }
}

/// Refuses scenarios that may need more memory than a job may take. Returns what it may need, bytes.
pub(super) fn check_memory(app: &App, scenario: &Scenario) -> Result<u64, ApiError> {
    let (needed, given) = (
        planner::memory_estimate(scenario),
        app.jobs().memory_limit(),
    );
    if needed <= given {
        return Ok(needed);
    }
    let count = scenario.targets().len();
    let detail = format!(
        "{count} targets may need {needed} bytes of memory; the limit is {given} (job_memory_bytes)"
    );
    Err(ApiError::new(ErrorCode::TooMuchMemory, detail))
}
