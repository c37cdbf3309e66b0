//! Legs whose fastest motion would enter cones: starting guesses on either side of them.
//!
//! The leg is solved without cones first. Where that motion is clear, it is the leg. Otherwise its
//! path, and the one the long way round, are pushed out of the cones that they enter to either side
//! of each ([`crate::leg::detour`]), and the program with cones is solved from there; the best
//! solution counts.

use super::arrival::Arrival;
use super::eigenaxis::Perturbation;
use super::{LegOutcome, LegProblem};
use crate::leg::clear_path::{self, PathOutcome, PathProblem};
use crate::leg::detour::guess::{along, expected_duration};
use crate::leg::detour::{AttitudePath, Side};
use crate::leg::multiphase::{LegSolution, StagedSolve, attitudes_inside};
use crate::leg::profile::Profile;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::run::stop::StopReason;

/// Entered cones whose sides are tried in all combinations; others are passed on the shorter side.
const MAX_BOTH_SIDES: usize = 2;
/// Depth, rad, up to which a motion is clear.
const CLEAR: f64 = crate::leg::multiphase::CONE_TOLERANCE;
/// Expected duration, relative to the least, up to which a path is tried: on random slews the best
/// path of all was within 1.61.
const MAX_EXPECTED: f64 = 1.7;
/// Ratio of a rough duration to that of an optimal motion above which it will not become faster.
const MAX_ROUGH: f64 = 1.2;
/// Relative difference of durations below which two motions are taken for the same: what is left to
/// correct between nodes.
const SAME_DURATION: f64 = 3e-5;
/// Relative excess over the motion without cones at which no other guess is tried.
const NEAR_FREE: f64 = 1e-3;

/// Solves a leg with cones.
pub(super) fn solve_with_cones(
    leg: &LegProblem<'_>,
    bound: Option<f64>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegOutcome {
    let without = leg.dynamics.with_cones(Vec::new());
    let free_leg = LegProblem {
        dynamics: &without,
        ..*leg
    };
    let free = super::solve(&free_leg, bound, stop);
    if is_clear(leg.dynamics, &free.solution.profile) || free.solution.status.is_interrupted() {
        return free;
    }
    let around = solve_around(leg, &free.solution, stop);
    LegOutcome {
        solves: free.solves + around.solves,
        ..around
    }
}

/// The same where the solution without cones is known, and enters some of them.
pub(crate) fn solve_around(
    leg: &LegProblem<'_>,
    free: &LegSolution,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegOutcome {
    let direct = free.duration();
    let direct = direct.map(|_| path_of(leg.dynamics, &free.profile));
    let mut starts = Vec::new();
    for guess in guesses(leg, direct) {
        let (waypoints, intervals) = (leg.waypoints(&guess), [guess.intervals()]);
        starts.push(StagedSolve::rough(
            leg.dynamics,
            &waypoints,
            &intervals,
            &guess,
            stop,
        ));
    }
    LegOutcome {
        solves: starts.len() as u64,
        solution: best_of(starts, free.duration(), stop),
    }
}

/// The best exact solution of starts of which there are rough motions: only those are continued
/// that may still become the fastest, a motion without cones taking this time, s, at least.
fn best_of(
    mut starts: Vec<StagedSolve<'_>>,
    least: Option<f64>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegSolution {
    let duration = |start: &StagedSolve<'_>| start.duration().unwrap_or(f64::INFINITY);
    let by_duration =
        |one: &StagedSolve<'_>, other: &StagedSolve<'_>| duration(one).total_cmp(&duration(other));
    starts.sort_by(by_duration);
    let mut fastest = f64::INFINITY;
    for start in &mut starts {
        if duration(start) <= MAX_ROUGH * fastest {
            start.refine(stop);
            fastest = fastest.min(duration(start));
        }
    }
    starts.sort_by(by_duration);
    let mut best = LegSolution::nowhere();
    for mut start in starts {
        let better = |best: f64| duration(&start) < (1.0 - SAME_DURATION) * best;
        let near = |(duration, least): (f64, f64)| duration <= (1.0 + NEAR_FREE) * least;
        let settled = best.duration().zip(least).is_some_and(near);
        if settled || !best.duration().is_none_or(better) {
            break;
        }
        start.refine(stop);
        let solution = start.exact(stop);
        if solution.improves(&best) || best.profile.intervals() == 0 {
            best = solution;
        }
        if best.status.is_interrupted() {
            break;
        }
    }
    best
}

/// Motions along ways around the cones, from rest to rest: along a direct path, or that about the
/// eigenaxis, and the long way round, pushed out of the cones, and along the shortest path of a search;
/// the one that is expected to be fastest first.
pub(crate) fn guesses(
    leg: &LegProblem<'_>,
    direct: Option<AttitudePath>,
) -> impl Iterator<Item = Profile> {
    let mut paths = pushed_out(leg, direct);
    paths.extend(searched(leg));
    let promising = promising(leg.dynamics, paths);
    promising.map(|path| along(leg.dynamics, &path, leg.null, leg.intervals()))
}

/// The paths that are not expected to take much longer than the fastest, that one first.
fn promising(dynamics: &Dynamics, paths: Vec<AttitudePath>) -> impl Iterator<Item = AttitudePath> {
    let expected = paths
        .into_iter()
        .map(|path| (expected_duration(dynamics, &path), path));
    let mut expected: Vec<_> = expected.collect();
    expected.sort_by(|one, other| one.0.total_cmp(&other.0));
    expected.dedup_by(|(_, later), (_, earlier)| later.is(earlier));
    let least = expected.first().map_or(0.0, |(duration, _)| *duration);
    let near = expected
        .into_iter()
        .take_while(move |(duration, _)| *duration <= MAX_EXPECTED * least);
    near.map(|(_, path)| path)
}

/// Whether a motion stays out of all cones, between its nodes too.
pub(crate) fn is_clear(dynamics: &Dynamics, profile: &Profile) -> bool {
    dynamics.cones.is_empty() || path_of(dynamics, profile).depth(&dynamics.cones) <= CLEAR
}

/// The attitudes of a motion, between its nodes too.
pub(crate) fn path_of(dynamics: &Dynamics, profile: &Profile) -> AttitudePath {
    let inside = (0..profile.intervals()).flat_map(|k| attitudes_inside(dynamics, profile, k));
    AttitudePath::through(profile.attitudes.first().copied().into_iter().chain(inside))
}

/// The shortest path that a search over attitudes finds.
fn searched(leg: &LegProblem<'_>) -> Option<AttitudePath> {
    let search = clear_path::find(&PathProblem {
        cones: &leg.dynamics.cones,
        from: leg.from.attitude,
        to: leg.to.attitude,
        signed: leg.arrival == Arrival::Quaternion,
    });
    match search.outcome {
        PathOutcome::Found(attitudes) => Some(AttitudePath::through(attitudes)),
        PathOutcome::Disconnected | PathOutcome::Unknown { .. } => None,
    }
}

/// A direct path, or that about the eigenaxis, and the long way round, pushed out of the cones.
fn pushed_out(leg: &LegProblem<'_>, direct: Option<AttitudePath>) -> Vec<AttitudePath> {
    let direct = direct.unwrap_or_else(|| {
        let direct = leg.perturbed_eigenaxis(Perturbation::Far);
        AttitudePath::through(direct.attitudes)
    });
    let mut sources = vec![direct];
    if leg.arrival == Arrival::Rotation {
        let near = &leg.from.attitude;
        let short = leg.arrival.signed(&leg.to.attitude, near);
        let there = Waypoint {
            attitude: short.negated(),
            ..leg.to.clone()
        };
        let long = LegProblem {
            to: &there,
            arrival: Arrival::Quaternion,
            ..*leg
        };
        let long = long.perturbed_eigenaxis(Perturbation::Far);
        sources.push(AttitudePath::through(long.attitudes));
    }
    let cones = &leg.dynamics.cones;
    let mut paths = Vec::new();
    for source in sources {
        let entered: Vec<usize> = (0..cones.len())
            .filter(|i| source.depth_in(&cones[*i]) > 0.0)
            .take(MAX_BOTH_SIDES)
            .collect();
        for choice in 0..1 << entered.len() {
            let side = |cone| {
                let bit = entered.iter().position(|entered| *entered == cone);
                match bit.filter(|bit| choice >> bit & 1 == 1) {
                    Some(_) => Side::Longer,
                    None => Side::Shorter,
                }
            };
            let mut passed: Vec<_> = cones
                .iter()
                .enumerate()
                .map(|(i, cone)| (*cone, side(i)))
                .collect();
            paths.extend(source.pushed_out(&passed));
            // Where one cone leads into another, the way depends on which is left first.
            passed.reverse();
            paths.extend(source.pushed_out(&passed));
        }
    }
    paths
}
