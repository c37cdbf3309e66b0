//! Where on the way the wheels cannot hold the stored momentum.
//!
//! Inside the sphere of momenta that the wheels hold in every direction a slew always exists
//! ([`super::steered`]). Outside of it a body may be able to rest at both ends of a slew, but nowhere
//! between them.

use super::SlewProblem;
use super::centred::centred;
use crate::attitude::Attitude;
use nalgebra::Vector3;
use std::ops::RangeInclusive;

/// Steps into which the turn is cut.
const STEPS: usize = 360;

/// A part of the turn about the eigenaxis at which the wheels cannot hold a resting body's momentum.
#[derive(Debug, Clone)]
pub(crate) struct Unheld {
    /// The whole turn, rad.
    pub(crate) turn: f64,
    /// The first part of it, rad.
    pub(crate) part: RangeInclusive<f64>,
    /// The attitude in the middle of that part.
    pub(crate) attitude: Attitude,
}

impl SlewProblem<'_> {
    /// The first attitudes of the turn about the eigenaxis at which the wheels cannot hold the
    /// momentum of the resting body.
    pub(crate) fn unheld(&self) -> Option<Unheld> {
        let from = self.from.attitude;
        let turn = from.signed_turn_to(&self.arrival.signed(&self.to.attitude, &from));
        let share = |step: usize| step as f64 / STEPS as f64;
        let at = |share: f64| from.retract(turn * share);
        let held = |step: &usize| {
            let attitude = at(share(*step));
            let demand = self.dynamics.demanded(&attitude, &Vector3::zeros());
            centred(self.dynamics, &demand).is_some()
        };
        let first = (0..=STEPS).find(|step| !held(step))?;
        let last = (first..=STEPS).find(held).unwrap_or(STEPS + 1) - 1;
        let angle = turn.norm();
        Some(Unheld {
            turn: angle,
            part: share(first) * angle..=share(last) * angle,
            attitude: at(0.5 * (share(first) + share(last))),
        })
    }
}
