//! Solving a request for slews, for the command line and the service alike.

use crate::documents::slew::SlewRequest;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::slew::evidence::{self, Evidence};
use slewplan_solver::slew::{self, SlewOutcome};
use std::time::Duration;

/// What came of a request.
pub(crate) struct Solved {
    /// Every slew that was reached, with its evidence where that was asked for and there is any.
    pub(crate) outcomes: Vec<(SlewOutcome, Option<Evidence>)>,
    /// Whether every slew was reached.
    pub(crate) complete: bool,
}

/// Solves the slew, or those along the sweep, within the time that the request has.
///
/// # Errors
///
/// Problems with the values of the sweep.
pub(crate) fn solve(request: &SlewRequest, stop: &StopSignal) -> Result<Solved, Vec<Problem>> {
    let slew = &request.slew;
    let stop = &match request.time_limit_s {
        Some(seconds) => stop.with_time_limit(Duration::from_secs_f64(seconds)),
        None => stop.clone(),
    };
    let outcomes = match &request.sweep {
        Some(sweep) => slew::trade_curve(slew, sweep, stop)?,
        None => vec![slew::solve(slew, stop)],
    };
    // What was interrupted is not complete, however far it came.
    let complete = !stop.is_set();
    let witnessed = outcomes.into_iter().map(|outcome| {
        let evidence = request
            .evidence
            .then(|| evidence::of(slew, &outcome, stop))
            .flatten();
        (outcome, evidence)
    });
    Ok(Solved {
        outcomes: witnessed.collect(),
        complete,
    })
}
