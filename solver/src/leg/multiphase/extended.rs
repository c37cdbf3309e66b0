//! A solved motion extended to one more waypoint.
//!
//! The optimal motion changes little when a leg is added: the last legs before the former end
//! adapt, and less the farther they are from it. So a tail of a few legs is solved first, with the
//! motion before it fixed, and then the whole from there. That takes less work than a solve from
//! scratch, and keeps to the minimum of the former motion, the best of several starts.

use super::passes::from_a_guess;
use super::rolling::solve_from_windows;
use super::{LegSolution, MultiphaseSolve, solve_through};
use crate::leg::profile::Profile;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::run::stop::StopReason;

/// Legs of the tail, the new one among them. With two the minima are a little worse, with four no
/// better.
const TAIL: usize = 3;

/// Solves for the motion through waypoints from a `motion` that is a solution up to the last
/// waypoint but one, with a guess of the last leg appended.
pub(crate) fn solve_extended(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    motion: &Profile,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegSolution {
    let held = intervals.len().saturating_sub(TAIL);
    let begin: usize = intervals[..held].iter().sum();
    let tail = motion.part(begin..motion.intervals());
    let mut through = waypoints[held..].to_vec();
    if held > 0 {
        through[0] = through[0].passed_in(&tail.attitudes[0], &tail.wheels[0]);
    }
    let mut end = MultiphaseSolve::new(dynamics, &through, &intervals[held..], &tail);
    if end.run_passes(from_a_guess(dynamics), stop) {
        let mut joined = motion.part(0..begin);
        joined.append(&end.solution.profile);
        let whole = solve_from_windows(dynamics, waypoints, intervals, &joined, stop);
        if let Some(solution) = whole {
            return solution;
        }
    }
    solve_through(dynamics, waypoints, intervals, motion, stop)
}
