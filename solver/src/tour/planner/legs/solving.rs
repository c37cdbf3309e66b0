//! One canonical leg, from its problem to a flight that the checker accepts.

use super::certify;
use crate::leg::solve;
use crate::leg::solve::around_cones;
use crate::nlp::{Breakdown, NlpStatus, Quantity};
use crate::run::stop::StopSignal;
use crate::tour::planner::canonical::CanonicalLeg;
use crate::tour::planner::places::Places;
use crate::tour::planner::tables::{CertifiedLeg, SolvedLeg};
use crate::tour::planner::verified::is_feasible;
use std::time::Instant;

/// Solves a leg, refines it until the checker accepts it, and verifies it. A bound certified before
/// is not computed again.
pub(super) fn solve(
    places: &Places<'_>,
    leg: &CanonicalLeg,
    certified: Option<CertifiedLeg>,
    stop: &StopSignal,
) -> SolvedLeg {
    let begin = Instant::now();
    let certified = certified
        .unwrap_or_else(|| certify(places, leg))
        .lower_bound;
    let problem = leg.problem(&places.extremals);
    let stop = || stop.reason();
    let mut solved = match &leg.free {
        Some(free) if leg.described_from() == [None, None] => {
            around_cones::solve_around(&problem, free, &stop)
        }
        _ => solve::solve(&problem, certified, &stop),
    };
    if solved.solution.duration().is_some() && !is_feasible(places, leg, &solved.solution.profile) {
        solved.solution.status = NlpStatus::NumericalError(Breakdown {
            stage: solved.solution.profile.intervals(),
            quantity: Quantity::Flight,
        });
    }
    SolvedLeg {
        solution: solved.solution,
        certified,
        solves: solved.solves,
        solve_time: begin.elapsed().as_secs_f64(),
        from_store: false,
        is_condensed: false,
        described_from: leg.described_from(),
    }
}
