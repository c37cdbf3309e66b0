//! Motions along a route, joined leg by leg: initial guesses of a segment's program, and flights
//! that need no program.

use super::legs::LegSolver;
use super::places::Places;
use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::leg::solve::around_cones::is_clear;
use crate::leg::solve::eigenaxis::Perturbation;
use crate::leg::solve::rolls::rolled_routes;
use crate::model::waypoint::Waypoint;
use crate::nlp::NlpStatus;
use crate::tour::legs::LegKind;
use crate::tour::order::Place;
use std::sync::Arc;

/// How the initial guess of a segment is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum InitialGuess {
    /// The solution of the segment without its last leg, and a perturbed eigenaxis slew for that.
    Shorter,
    /// Perturbed eigenaxis slews.
    Eigenaxes,
    /// Extremals of the kinematic problem.
    Extremals,
    /// Legs around cones, each with only the conditions of its own ends.
    AroundCones,
    /// Legs from rest to rest, from a moving start and to a moving end: feasible as they are where every
    /// place between admits rest.
    AtRest,
}

/// A feasible flight along a route, constructed without solving a program: one solution for each
/// segment. `None` where a leg cannot be constructed.
pub(super) fn constructed(places: &Places<'_>, route: &[Place]) -> Option<Vec<Arc<LegSolution>>> {
    let segments = places.split(route).into_iter().map(|segment| {
        let mut whole = LegSolution {
            status: NlpStatus::Constructed,
            ..LegSolution::nowhere()
        };
        for ends in places.waypoints(segment).windows(2) {
            let leg = places.slew(&ends[0], &ends[1]).constructed()?;
            if !is_clear(&places.with_cones, &leg.profile) {
                return None;
            }
            whole.profile.append(&leg.profile);
            whole.intervals.extend(leg.intervals);
        }
        Some(Arc::new(whole))
    });
    segments.collect()
}

/// The legs of a route joined end to end, and the number of intervals of each; `None` where a leg
/// from rest to rest has no solution. For [`InitialGuess::Shorter`] see [`extended`].
pub(super) fn joined(
    legs: &LegSolver<'_>,
    (route, waypoints): (&[Place], &[Waypoint]),
    kind: InitialGuess,
) -> Option<(Profile, Vec<usize>)> {
    let places = legs.places();
    let mut guess = Profile::empty();
    let mut intervals = Vec::new();
    let is_rolled = waypoints.iter().any(|waypoint| waypoint.roll.is_some());
    for (pair, ends) in route.windows(2).zip(waypoints.windows(2)) {
        let slew = places.slew(&ends[0], &ends[1]);
        let perturbed_eigenaxis = || slew.perturbed_eigenaxis(Perturbation::Near);
        let solved = |leg: LegSolution| leg.duration().map(|_| leg.profile);
        let leg = match kind {
            InitialGuess::Shorter | InitialGuess::Eigenaxes => perturbed_eigenaxis(),
            InitialGuess::Extremals => slew
                .extremal()
                .unwrap_or_else(|| slew.perturbed_eigenaxis(Perturbation::Far)),
            // Legs of their own pass a place with different rolls.
            InitialGuess::AroundCones | InitialGuess::AtRest if is_rolled => {
                solved(legs.rest_to_rest_between([&ends[0], &ends[1]]))?
            }
            InitialGuess::AroundCones => solved(legs.leg(LegKind::LowerBound, pair[0], pair[1]))?,
            InitialGuess::AtRest => solved(legs.stopping_leg(pair[0], pair[1]))?,
        };
        guess.append(&leg);
        intervals.push(leg.intervals());
    }
    Some((guess, intervals))
}

/// The solution of all but the last leg of a route, with a perturbed eigenaxis slew as its last
/// leg; `None` where that solution did not converge.
pub(super) fn extended(
    legs: &LegSolver<'_>,
    shorter: &LegSolution,
    last_leg: &[Place],
) -> Option<(Profile, Vec<usize>)> {
    shorter.duration()?;
    let (mut guess, mut intervals) = (shorter.profile.clone(), shorter.intervals.clone());
    let places = legs.places();
    let mut ends = last_leg.iter().map(|place| places.waypoint(*place));
    // From the roll at which the solution ends.
    let reached = guess.attitudes.last()?;
    let from = ends.next()?.rolled_towards(reached).pinned();
    let route = vec![from, ends.next()?];
    let ends = rolled_routes(&places.dynamics, &places.extremals, route, 1).swap_remove(0);
    let slew = places.slew(&ends[0], &ends[1]);
    let last = slew.perturbed_eigenaxis(Perturbation::Near);
    guess.append(&last);
    intervals.push(last.intervals());
    Some((guess, intervals))
}
