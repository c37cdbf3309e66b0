//! The quaternion sign with which a motion has to arrive at its target.

use super::zero_length::SAME_ATTITUDE;
use crate::model::attitude::Attitude;
use crate::model::roll::{FreeRoll, RollArcs};
use crate::model::waypoint::Waypoint;
use nalgebra::Vector3;

/// Which quaternion signs of the target count as arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arrival {
    /// Either sign.
    Rotation,
    /// The sign as given.
    Quaternion,
}

impl Arrival {
    /// The target attitude with the sign at which a motion from near another attitude arrives.
    pub(crate) fn signed(self, attitude: &Attitude, near: &Attitude) -> Attitude {
        match self {
            Self::Rotation => attitude.nearest_sign(near),
            Self::Quaternion => *attitude,
        }
    }

    /// The rotation vector of the turn between two attitudes as far as signs count, rad, body axes of
    /// the first.
    pub(crate) fn turn_vector(self, from: &Attitude, to: &Attitude) -> Vector3<f64> {
        from.signed_turn_to(&self.signed(to, from))
    }

    /// Whether every attitude that one waypoint admits is admitted by another.
    pub(crate) fn implies(self, one: &Waypoint, other: &Waypoint) -> bool {
        let Some(free) = &other.roll else {
            let turn = self.turn(&one.attitude, &other.attitude);
            return one.roll.is_none() && turn <= SAME_ATTITUDE;
        };
        let given = RollArcs {
            axis: free.axis,
            arcs: vec![[0.0; 2]],
        };
        let rolls = one.roll.as_ref().unwrap_or(&given);
        let pointed = FreeRoll {
            axis: free.axis,
            range: None,
        };
        (rolls.axis - free.axis).amax() <= SAME_ATTITUDE
            && pointed.off_boresight(&one.attitude, &other.attitude) <= SAME_ATTITUDE
            && free.include(rolls, pointed.between(&other.attitude, &one.attitude))
    }

    /// Its angle, rad.
    pub(crate) fn turn(self, from: &Attitude, to: &Attitude) -> f64 {
        self.turn_vector(from, to).norm()
    }
}
