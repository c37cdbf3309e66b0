//! One slew between two waypoints: guesses, solves, the best of them.

pub(crate) mod eigenaxis;
pub(crate) mod kinematic;
#[cfg(test)]
mod tests;

use crate::dynamics::Dynamics;
use crate::multiphase::{Flown, fly};
use crate::nlp::NlpStatus;
use crate::profile::Profile;
use crate::transcription::Waypoint;
use eigenaxis::EigenaxisSlew;
use kinematic::Arrival;
use nalgebra::DVector;

/// Intervals of a leg: beyond twelve the measured durations of 171 legs gain less than 1e-4.
pub(crate) const INTERVALS: usize = 12;
/// Kinematic extremals that are tried as guesses beside the eigenaxis slew.
const EXTREMALS: usize = 2;

/// The best solution of a slew.
#[derive(Debug, Clone)]
pub(crate) struct Slew {
    /// The best converged flight, or one that tells why there is none.
    pub(crate) flown: Flown,
    /// NLPs solved.
    pub(crate) solves: u64,
}

/// Solves a slew from all its guesses; the quaternion sign of `to` is free with
/// [`Arrival::Rotation`].
pub(crate) fn solve(
    dynamics: &Dynamics,
    from: &Waypoint,
    to: &Waypoint,
    arrival: Arrival,
    null: &DVector<f64>,
    stop: &dyn Fn() -> bool,
) -> Slew {
    let mut best: Option<Flown> = None;
    let mut solves = 0;
    for guess in guesses(dynamics, from, to, arrival, null) {
        let mut signed = to.clone();
        if let (Some(last), Arrival::Rotation) = (guess.attitudes.last(), arrival) {
            signed.attitude = to.attitude.nearest_sign(last);
        }
        let flown = fly(
            dynamics,
            &[from.clone(), signed],
            &[INTERVALS],
            &guess,
            stop,
        );
        solves += 1;
        if best.as_ref().is_none_or(|best| improves(&flown, best)) {
            best = Some(flown);
        }
        if stop() {
            break;
        }
    }
    // There is always the eigenaxis guess.
    let flown = best.expect("at least one guess");
    Slew { flown, solves }
}

fn guesses(
    dynamics: &Dynamics,
    from: &Waypoint,
    to: &Waypoint,
    arrival: Arrival,
    null: &DVector<f64>,
) -> Vec<Profile> {
    let target = match arrival {
        Arrival::Rotation => to.attitude.nearest_sign(&from.attitude),
        Arrival::Quaternion => to.attitude,
    };
    let eigenaxis = EigenaxisSlew::fastest(dynamics, &from.attitude, &target, null);
    let mut all = vec![eigenaxis.guess(dynamics, INTERVALS)];
    all.extend(kinematic::guesses(
        dynamics,
        &from.attitude,
        &target,
        arrival,
        null,
        INTERVALS,
        EXTREMALS,
    ));
    all
}

/// Whether a flight beats another; converged ones beat all others, and ties go to the earlier.
fn improves(flown: &Flown, best: &Flown) -> bool {
    match (flown.duration(), best.duration()) {
        (Some(new), Some(old)) => new < old * (1.0 - 1e-9),
        (Some(_), None) => true,
        (None, Some(_)) => false,
        (None, None) => best.status == NlpStatus::NumericalError && flown.status != best.status,
    }
}
