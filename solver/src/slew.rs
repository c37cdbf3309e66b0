//! One slew between two waypoints: guesses, solves, the best of them.

pub(crate) mod eigenaxis;
pub(crate) mod kinematic;
#[cfg(test)]
mod tests;

use crate::dynamics::Dynamics;
use crate::multiphase::{Flown, fly};
use crate::profile::Profile;
use crate::transcription::Waypoint;
use eigenaxis::{EigenaxisSlew, Side};
use kinematic::Arrival;
use nalgebra::DVector;

/// Intervals of a leg: beyond twelve the measured durations of 171 legs gain less than 1e-4.
pub(crate) const INTERVALS: usize = 12;
/// Kinematic extremals that are tried as guesses beside the eigenaxis slew.
const EXTREMALS: usize = 2;

/// A slew between two waypoints.
#[derive(Clone, Copy)]
pub(crate) struct SlewProblem<'a> {
    /// The spacecraft with its momentum.
    pub(crate) dynamics: &'a Dynamics,
    /// Where it begins.
    pub(crate) from: &'a Waypoint,
    /// Where it ends; the quaternion sign is free with [`Arrival::Rotation`].
    pub(crate) to: &'a Waypoint,
    /// Which signs count as arrived.
    pub(crate) arrival: Arrival,
    /// Null-space momentum of the wheels in the guesses, N m s.
    pub(crate) null: &'a DVector<f64>,
}

/// The best solution of a slew.
#[derive(Debug, Clone)]
pub(crate) struct Slew {
    /// The best converged flight, or one that tells why there is none.
    pub(crate) flown: Flown,
    /// NLPs solved.
    pub(crate) solves: u64,
}

/// Solves a slew from all its guesses.
pub(crate) fn solve(slew: &SlewProblem<'_>, stop: &dyn Fn() -> bool) -> Slew {
    let mut best: Option<Flown> = None;
    let mut solves = 0;
    for guess in guesses(slew) {
        let mut to = slew.to.clone();
        if let Some(last) = guess.attitudes.last() {
            to.attitude = slew.arrival.signed(&to.attitude, last);
        }
        let waypoints = [slew.from.clone(), to];
        let flown = fly(slew.dynamics, &waypoints, &[INTERVALS], &guess, stop);
        solves += 1;
        if best.as_ref().is_none_or(|best| flown.improves(best)) {
            best = Some(flown);
        }
        if stop() {
            break;
        }
    }
    let flown = best.expect("there is always the eigenaxis guess");
    Slew { flown, solves }
}

impl SlewProblem<'_> {
    /// The slew about the eigenaxis, the short way round unless the sign says otherwise.
    pub(crate) fn eigenaxis(&self) -> EigenaxisSlew {
        let from = &self.from.attitude;
        let target = self.arrival.signed(&self.to.attitude, from);
        EigenaxisSlew::fastest(self.dynamics, from, &target, self.null)
    }
}

fn guesses(slew: &SlewProblem<'_>) -> Vec<Profile> {
    let eigenaxis = slew.eigenaxis();
    let mut all: Vec<_> = [Side::Near, Side::Far]
        .map(|side| eigenaxis.guess(slew.dynamics, INTERVALS, side))
        .into();
    all.extend(kinematic::guesses(slew, INTERVALS, EXTREMALS));
    all
}
