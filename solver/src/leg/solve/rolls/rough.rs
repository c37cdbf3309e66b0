//! Rough motions from several starting rolls: which of them are worth a solve.

use crate::leg::multiphase::StagedSolve;
use crate::leg::profile::Profile;
use crate::leg::solve::LegProblem;
use crate::leg::solve::eigenaxis::Perturbation;
use crate::leg::solve::starts::ROUGH_INTERVALS;
use crate::model::waypoint::Waypoint;
use crate::run::stop::StopReason;

/// Excess of a rough motion over the fastest one up to which it is solved.
const PROMISING: f64 = 1.03;
/// Turn, rad, between attitudes that belong to the same minimum.
const SAME_MINIMUM: f64 = 0.05;

/// The waypoints of a motion, described from the rolls with which rough motions from several starts pass
/// them: the fastest first, each once, so many at most. The first starts themselves where no motion
/// converges. Spacecraft and extremals are those of `leg`.
pub(crate) fn promising(
    leg: &LegProblem<'_>,
    mut starts: Vec<Vec<Waypoint>>,
    most: usize,
    stop: &dyn Fn() -> Option<StopReason>,
) -> Vec<Vec<Waypoint>> {
    let rough = starts.iter().filter_map(|start| rough(leg, start, stop));
    let mut found: Vec<(f64, Vec<Waypoint>)> = rough.collect();
    found.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let slowest = PROMISING * found.first().map_or(0.0, |(least, _)| *least);
    let mut distinct: Vec<Vec<Waypoint>> = Vec::new();
    for (duration, waypoints) in found {
        let is_same = |known: &Vec<Waypoint>| {
            let mut pairs = known.iter().zip(&waypoints);
            pairs.all(|(one, other)| one.attitude.angle_to(&other.attitude) < SAME_MINIMUM)
        };
        if duration <= slowest && distinct.len() < most && !distinct.iter().any(is_same) {
            distinct.push(waypoints);
        }
    }
    if distinct.is_empty() {
        starts.truncate(most);
        return starts;
    }
    distinct
}

/// Duration, s, of the rough motion from a start, and the rolls with which it passes the waypoints.
fn rough(
    leg: &LegProblem<'_>,
    start: &[Waypoint],
    stop: &dyn Fn() -> Option<StopReason>,
) -> Option<(f64, Vec<Waypoint>)> {
    let mut guess = Profile::empty();
    for ends in start.windows(2) {
        let slew = leg.between(&ends[0], &ends[1]);
        guess.append(&slew.perturbed_eigenaxis_of(ROUGH_INTERVALS, Perturbation::Far));
    }
    let signed = |(i, waypoint): (usize, &Waypoint)| Waypoint {
        attitude: match guess.attitudes.get(i * ROUGH_INTERVALS) {
            Some(there) if i > 0 => leg.arrival.signed(&waypoint.attitude, there),
            _ => waypoint.attitude,
        },
        ..waypoint.clone()
    };
    let waypoints: Vec<Waypoint> = start.iter().enumerate().map(signed).collect();
    let intervals = vec![ROUGH_INTERVALS; start.len() - 1];
    let rough = StagedSolve::rough(leg.dynamics, &waypoints, &intervals, &guess, stop);
    let duration = rough.duration()?;
    let passed = rough.motion().attitudes.iter().step_by(ROUGH_INTERVALS);
    let rolled = start.iter().zip(passed);
    let rolled = rolled.map(|(waypoint, there)| waypoint.rolled_towards(there));
    Some((duration, rolled.collect()))
}
