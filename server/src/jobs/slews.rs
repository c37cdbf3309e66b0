//! Solves a request for slews, for the command line and the service.

use crate::documents::slew::SlewRequest;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::slew::evidence::{self, Evidence};
use slewplan_solver::slew::{self, SlewOutcome};
use std::time::Duration;

/// The result of a request.
pub(crate) struct SlewSolutions {
    /// Every slew that was solved, with its optimality evidence if requested and available.
    pub(crate) outcomes: Vec<(SlewOutcome, Option<Evidence>)>,
    /// Whether all requested slews were solved.
    pub(crate) complete: bool,
}

/// Solves the slew, or the slews of the sweep, within the time limit of the request.
///
/// # Errors
///
/// Problems with the values of the sweep.
pub(crate) fn solve(
    request: &SlewRequest,
    stop: &StopSignal,
) -> Result<SlewSolutions, Vec<Problem>> {
    let slew = &request.slew;
    let stop = &match request.time_limit_s {
        Some(seconds) => stop.with_time_limit(Duration::from_secs_f64(seconds)),
        None => stop.clone(),
    };
    let outcomes = match &request.sweep {
        Some(sweep) => slew::trade_curve(slew, sweep, stop)?,
        None => vec![slew::solve(slew, stop)],
    };
    // An interrupted request is not complete, even if all slews have answers.
    let complete = !stop.is_set();
    let with_evidence = outcomes.into_iter().map(|outcome| {
        let evidence = request
            .evidence
            .then(|| evidence::of(slew, &outcome, stop))
            .flatten();
        (outcome, evidence)
    });
    Ok(SlewSolutions {
        outcomes: with_evidence.collect(),
        complete,
    })
}
