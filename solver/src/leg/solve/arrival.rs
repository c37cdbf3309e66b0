//! The quaternion sign with which a motion has to arrive at its target.

use crate::model::attitude::Attitude;

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

    /// The turn between two attitudes as far as signs count, rad.
    pub(crate) fn turn(self, from: &Attitude, to: &Attitude) -> f64 {
        from.signed_turn_to(&self.signed(to, from)).norm()
    }
}
