//! Long motions, a few legs at a time.
//!
//! All legs of a program share one step length, and some switch of some leg limits it, so a longer
//! motion takes more iterations. Yet the optimum on a leg depends little on legs far from it. A
//! window of a few legs with a free end rolls along the motion; each window begins in the state in
//! which the one before it passed its last legs but a few. The whole then starts from a motion that
//! is feasible and nearly optimal, and the iterations per leg hardly grow with the number of legs.
//!
//! Of very long motions the whole is never one program: blocks of many legs are solved between the
//! states of the windows, and again between the middles of these blocks. Tours of 200 and 1,000 random
//! targets are as short as from one program (by 5e-6 and 1e-5 shorter) in a third of the time.

use super::passes::{Pass, from_a_guess};
use super::{LegSolution, MultiphaseSolve, solve_through};
use crate::leg::profile::Profile;
use crate::leg::transcription::ControlPenalty;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::nlp::{NlpStatus, Settings};
use crate::run::stop::StopReason;

/// Legs of a window, and most legs of a motion that is solved at once.
const WINDOW: usize = 8;
const SHORT: usize = 14;
/// Legs at the end of a window that the next one solves again.
const OVERLAP: usize = 2;
/// Most legs of a motion whose whole is one program, and legs of a block of a longer one.
pub(crate) const MAX_LEGS_AT_ONCE: usize = 60;
const BLOCK: usize = 40;

/// From the motions of the windows, which are solutions except where they meet.
const FROM_WINDOWS: [Pass; 1] = [Pass {
    settings: Settings {
        initial_barrier: 3e-5,
        initial_slack: 3e-5,
        ..Settings::COLD
    },
    penalty: ControlPenalty::of_lengths(0.02),
}];

/// Solves for the motion through waypoints from a guess like [`solve_through`], window by window
/// first.
pub(crate) fn solve_rolling(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    guess: &Profile,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegSolution {
    if intervals.len() > SHORT {
        let motion = roll(dynamics, waypoints, intervals, guess, stop);
        let whole = motion.and_then(|motion| {
            let solve = if intervals.len() > MAX_LEGS_AT_ONCE {
                solve_blocks
            } else {
                solve_from_windows
            };
            solve(dynamics, waypoints, intervals, &motion, stop)
        });
        if let Some(solution) = whole {
            return solution;
        }
    }
    solve_through(dynamics, waypoints, intervals, guess, stop)
}

/// Solves for the motion through waypoints from motions that are solutions except where they meet;
/// `None` when that does not converge, unless it was stopped.
pub(super) fn solve_from_windows(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    motion: &Profile,
    stop: &dyn Fn() -> Option<StopReason>,
) -> Option<LegSolution> {
    let whole = MultiphaseSolve::new(dynamics, waypoints, intervals, motion);
    let solution = whole.run(&FROM_WINDOWS, stop);
    let status = solution.status;
    (status == NlpStatus::Converged || status.is_interrupted()).then_some(solution)
}

/// The same for a very long motion, block by block, twice.
fn solve_blocks(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    motion: &Profile,
    stop: &dyn Fn() -> Option<StopReason>,
) -> Option<LegSolution> {
    let legs = intervals.len();
    let mut solution: Option<LegSolution> = None;
    for first_end in [BLOCK, BLOCK / 2] {
        let motion = solution
            .take()
            .map_or_else(|| motion.clone(), |solution| solution.profile);
        let mut joined = LegSolution {
            status: NlpStatus::Converged,
            infeasibility: 0.0,
            ..LegSolution::nowhere()
        };
        let ends = (first_end..legs).step_by(BLOCK).chain([legs]);
        let mut begin = 0;
        for end in ends {
            let block = solve_block(dynamics, waypoints, intervals, &motion, [begin, end], stop)?;
            if block.status.is_interrupted() {
                return Some(block);
            }
            joined.append(&block, dynamics.wheel_count());
            begin = end;
        }
        solution = Some(joined);
    }
    solution
}

/// A block of legs between the states in which a motion passes its ends.
fn solve_block(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    motion: &Profile,
    [begin, end]: [usize; 2],
    stop: &dyn Fn() -> Option<StopReason>,
) -> Option<LegSolution> {
    let node_of = |leg: usize| intervals[..leg].iter().sum::<usize>();
    let part = motion.part(node_of(begin)..node_of(end));
    let mut through = waypoints[begin..=end].to_vec();
    let last = through.len() - 1;
    if begin > 0 {
        through[0] = through[0].passed_in(&part.attitudes[0], &part.wheels[0]);
    }
    if end < intervals.len() {
        let node = part.intervals();
        through[last] = through[last].passed_in(&part.attitudes[node], &part.wheels[node]);
    }
    let intervals = &intervals[begin..end];
    let solved = solve_from_windows(dynamics, &through, intervals, &part, stop);
    solved.or_else(|| {
        let cold = solve_through(dynamics, &through, intervals, &part, stop);
        let known = cold.status == NlpStatus::Converged || cold.status.is_interrupted();
        known.then_some(cold)
    })
}

/// The motions of the windows, joined; `None` when stopped, or when a window does not converge. In a
/// very long motion that of such a window is a guess, and the blocks do the rest.
fn roll(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    guess: &Profile,
    stop: &dyn Fn() -> Option<StopReason>,
) -> Option<Profile> {
    let node_of = |leg: usize| intervals[..leg].iter().sum::<usize>();
    let mut motion = Profile::empty();
    // The part of the last window's motion that the next window solves again.
    let mut ahead = Profile::empty();
    let mut first = 0;
    loop {
        let last = (first + WINDOW).min(intervals.len());
        let mut through = waypoints[first..=last].to_vec();
        if let Some((attitude, wheels)) = ahead.attitudes.first().zip(ahead.wheels.first()) {
            through[0] = through[0].passed_in(attitude, wheels);
        }
        let begin = node_of(first);
        ahead.append(&guess.part(begin + ahead.intervals()..node_of(last)));
        let window = &intervals[first..last];
        let mut window = MultiphaseSolve::new(dynamics, &through, window, &ahead);
        if !window.run_passes(from_a_guess(dynamics), stop) {
            let status = window.solution.status;
            if status.is_interrupted() || intervals.len() <= MAX_LEGS_AT_ONCE {
                return None;
            }
        }
        let solved = window.solution.profile;
        if last == intervals.len() {
            motion.append(&solved);
            return Some(motion);
        }
        first = last - OVERLAP;
        let kept = node_of(first) - begin;
        motion.append(&solved.part(0..kept));
        ahead = solved.part(kept..solved.intervals());
    }
}
