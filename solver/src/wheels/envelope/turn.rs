//! Parts of a turn at which the momentum of the resting body lies outside the envelope of the wheels.
//!
//! If the wheels can hold the momentum in every direction, there is always a slew about the eigenaxis,
//! if it is slow enough. Otherwise a body may be able to rest at both ends of a turn, but not at
//! attitudes in between.

use super::hold_momentum;
use crate::model::attitude::Attitude;
use crate::model::scenario::Scenario;
use nalgebra::Vector3;
use std::fmt;

/// Steps of a turn at which the momentum is tested.
const STEPS: usize = 180;

/// A part of a turn at which the wheels cannot hold the momentum of the resting body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutsideEnvelope {
    /// The angle of the whole turn, rad.
    angle: f64,
    /// Beginning and end of that part, rad.
    part: [f64; 2],
    /// The attitude in the middle of it.
    attitude: Attitude,
}

/// The first part of a turn, a rotation vector in body axes (rad), that lies outside the envelope.
pub(crate) fn outside_envelope(
    scenario: &Scenario,
    from: &Attitude,
    turn: Vector3<f64>,
) -> Option<OutsideEnvelope> {
    let share = |step: usize| step as f64 / STEPS as f64;
    let at = |share: f64| from.retract(turn * share);
    let held = |step: &usize| {
        let total = at(share(*step)).to_body(scenario.momentum());
        hold_momentum(
            scenario.spacecraft(),
            scenario.options().momentum_authority,
            &scenario.start().wheel_speed,
            total,
        )
        .is_none_or(|hold| hold.fits())
    };
    let first = (0..=STEPS).find(|step| !held(step))?;
    let last = (first..=STEPS).find(held).unwrap_or(STEPS + 1) - 1;
    let angle = turn.norm();
    Some(OutsideEnvelope {
        angle,
        part: [first, last].map(|step| share(step) * angle),
        attitude: at(0.5 * (share(first) + share(last))),
    })
}

impl fmt::Display for OutsideEnvelope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, last] = self.part.map(f64::to_degrees);
        let [x, y, z, w] = self.attitude.xyzw();
        write!(
            f,
            "about the eigenaxis, at rest, the wheels cannot hold the momentum from {first:.1} to \
             {last:.1} of {:.1} degrees, as at the attitude ({x:.4}, {y:.4}, {z:.4}, {w:.4})",
            self.angle.to_degrees(),
        )
    }
}
