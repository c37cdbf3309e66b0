//! The quaternion sign with which a motion has to arrive at its target.

use crate::model::attitude::Attitude;
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

    /// Its angle, rad.
    pub(crate) fn turn(self, from: &Attitude, to: &Attitude) -> f64 {
        self.turn_vector(from, to).norm()
    }
}
