//! Studies: effects of options, and envelopes of wheels.

pub(super) mod authority;
pub(super) mod comparison;
pub(super) mod envelopes;
pub(super) mod flight;

use super::access::Caller;
use super::error::ApiError;
use super::{App, admission, stored};
use crate::base::contradictions::ContradictionObserver;
use crate::documents::document::Node;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::Run;

/// Checks the size of a study's scenario and writes out its stored spacecraft.
async fn with_scenario(app: &App, caller: &Caller, mut node: Node) -> Result<Node, ApiError> {
    if let Some(scenario) = node.member_mut("scenario") {
        admission::check_size(app, scenario)?;
        let given = std::mem::take(scenario);
        (*scenario, _) = stored::write_out(app, caller, given, "/scenario").await?;
    }
    Ok(node)
}

/// The resources of planning for a study: no progress reports, no leg cache.
fn quiet_run<'a>(pool: &'a SolverPool, stop: &'a StopSignal) -> Run<'a> {
    Run {
        pool,
        stop,
        observer: &ContradictionObserver,
        legs: &NoStore,
        segments: &NoStore,
    }
}
