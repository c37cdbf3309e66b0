//! Long flights, a few legs at a time.
//!
//! In a flight of many legs there is always a switch somewhere that is in the way of the common step,
//! so a longer flight takes more iterations. Yet what is best on a leg depends little on legs far from
//! it. A window of a few legs with a free end rolls along the flight and hands on the state in which
//! it leaves all but its last legs. The whole flight then starts from a motion that can be flown and
//! is nearly the best one, and the work is in proportion to the number of legs: 48 iterations per leg
//! in flights of 10 legs, 55 in flights of 100, instead of 37 and 80. Durations are as good, and the
//! longer ones a little better.

use super::{Flight, LegSolution, Phase, fly, from_a_guess};
use crate::leg::profile::Profile;
use crate::leg::transcription::ControlPenalty;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::nlp::{Interruption, NlpStatus, Settings};

/// Legs of a window, and of a flight that is better solved at once.
const WINDOW: usize = 8;
const SHORT: usize = 14;
/// Legs at the end of a window that the next one solves again.
const OVERLAP: usize = 2;

/// From the motions of the windows, which are solutions but for where they meet.
const FROM_WINDOWS: [Phase; 1] = [Phase {
    settings: Settings {
        initial_barrier: 3e-5,
        initial_slack: 3e-5,
        ..Settings::COLD
    },
    penalty: ControlPenalty::of_lengths(0.02),
}];

/// Flies through waypoints from a guess as [`fly`] does, window by window first.
pub(crate) fn fly_rolling(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    guess: &Profile,
    stop: &dyn Fn() -> Option<Interruption>,
) -> LegSolution {
    if intervals.len() > SHORT {
        let motion = roll(dynamics, waypoints, intervals, guess, stop);
        let whole = motion
            .and_then(|motion| fly_from_windows(dynamics, waypoints, intervals, &motion, stop));
        if let Some(flown) = whole {
            return flown;
        }
    }
    fly(dynamics, waypoints, intervals, guess, stop)
}

/// Flies through waypoints from motions that are solutions but for where they meet; none when that
/// does not converge, unless it is stopped.
pub(super) fn fly_from_windows(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    motion: &Profile,
    stop: &dyn Fn() -> Option<Interruption>,
) -> Option<LegSolution> {
    let flight = Flight::new(dynamics, waypoints, intervals, motion);
    let flown = flight.solve(&FROM_WINDOWS, stop);
    (flown.status == NlpStatus::Converged || flown.status.is_interrupted()).then_some(flown)
}

/// The motions of the windows, joined; none when a window finds no motion, or when stopped.
fn roll(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    guess: &Profile,
    stop: &dyn Fn() -> Option<Interruption>,
) -> Option<Profile> {
    let node_of = |leg: usize| intervals[..leg].iter().sum::<usize>();
    let mut motion = Profile::empty();
    // What has been seen of the legs ahead.
    let mut ahead = Profile::empty();
    let mut first = 0;
    loop {
        let last = (first + WINDOW).min(intervals.len());
        let mut through = waypoints[first..=last].to_vec();
        if let Some(wheels) = ahead.wheels.first() {
            through[0] = through[0].passed_with(wheels);
        }
        let begin = node_of(first);
        ahead.append(&guess.part(begin + ahead.intervals()..node_of(last)));
        let mut flight = Flight::new(dynamics, &through, &intervals[first..last], &ahead);
        if !flight.passes(from_a_guess(dynamics), stop) {
            return None;
        }
        let flown = flight.flown.profile;
        if last == intervals.len() {
            motion.append(&flown);
            return Some(motion);
        }
        first = last - OVERLAP;
        let kept = node_of(first) - begin;
        motion.append(&flown.part(0..kept));
        ahead = flown.part(kept..flown.intervals());
    }
}
