//! A flight that goes on to one more waypoint.
//!
//! What is best on the legs of a flight changes little when it goes on: the last legs before the
//! former end adapt, and less the farther they are from it. So a tail of a few legs is solved first,
//! with the motion before it held, and then the whole from there. On the beginnings of random orders
//! of twelve targets this takes a third to a half of the work from scratch, and ends in
//! minima that are as good: those of the former flight's, which were the best of several starts.

use super::rolling::fly_from_windows;
use super::{Flight, LegSolution, fly, from_a_guess};
use crate::leg::profile::Profile;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::nlp::Interruption;

/// Legs of the tail, the new one among them: with two the minima are a little worse, with four they
/// are not better.
const TAIL: usize = 3;

/// Flies through waypoints, of which all but the last have been flown through: from that motion and a
/// guess of the last leg, joined.
pub(crate) fn fly_on(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    motion: &Profile,
    stop: &dyn Fn() -> Option<Interruption>,
) -> LegSolution {
    let held = intervals.len().saturating_sub(TAIL);
    let begin: usize = intervals[..held].iter().sum();
    let tail = motion.part(begin..motion.intervals());
    let mut through = waypoints[held..].to_vec();
    if held > 0 {
        through[0] = through[0].passed_with(&tail.wheels[0]);
    }
    let mut flight = Flight::new(dynamics, &through, &intervals[held..], &tail);
    if flight.passes(from_a_guess(dynamics), stop) {
        let mut joined = motion.part(0..begin);
        joined.append(&flight.flown.profile);
        if let Some(flown) = fly_from_windows(dynamics, waypoints, intervals, &joined, stop) {
            return flown;
        }
    }
    fly(dynamics, waypoints, intervals, motion, stop)
}
