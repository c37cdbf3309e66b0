//! The attitude of a target or the end, and by how much another one misses it.

use crate::checker::dynamics::{QuaternionComponents, conjugate, norm, product, to_reference};
use crate::model::roll::FreeRoll;
use crate::model::spec::AttitudeEquivalence;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The attitude to be passed, or where the roll is free that of roll 0.
pub(super) struct Goal<'a> {
    pub(super) attitude: QuaternionComponents,
    pub(super) roll: Option<&'a FreeRoll>,
    pub(super) sign: AttitudeEquivalence,
}

/// By how much an attitude is missed, rad.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Miss {
    /// The whole turn; where the roll is free, the angle between the boresights.
    pub(super) turn: f64,
    /// Angle from the roll to its limits.
    pub(super) roll: f64,
}

impl Miss {
    pub(super) fn larger(self, other: Self) -> Self {
        Self {
            turn: self.turn.max(other.turn),
            roll: self.roll.max(other.roll),
        }
    }
}

impl Goal<'_> {
    pub(super) fn missed_by(&self, q: &QuaternionComponents) -> Miss {
        let Some(free) = self.roll else {
            return Miss {
                turn: attitude_error(q, &self.attitude, self.sign),
                roll: 0.0,
            };
        };
        let goal = to_reference(&self.attitude, &free.axis);
        let axis = to_reference(q, &free.axis);
        Miss {
            turn: goal.cross(&axis).norm().atan2(goal.dot(&axis)),
            roll: free.range.map_or(0.0, |range| self.outside(q, free, range)),
        }
    }

    /// Angle, rad, from the roll of an attitude to the nearest one in a range. Of the turn from roll 0,
    /// the roll is the part about the axis.
    fn outside(&self, q: &QuaternionComponents, free: &FreeRoll, [low, high]: [f64; 2]) -> f64 {
        let [x, y, z, w] = product(&conjugate(&self.attitude), q);
        let roll = 2.0 * Vector3::new(x, y, z).dot(&free.axis).atan2(w);
        // From the lower limit on, in positive direction.
        let beyond = (roll - low).rem_euclid(TAU);
        let width = high - low;
        (beyond - width).min(TAU - beyond).max(0.0)
    }
}

/// Angle of the turn between two unit quaternions, rad. With [`AttitudeEquivalence::Quaternion`] the
/// opposite sign is a full turn away.
fn attitude_error(
    q: &QuaternionComponents,
    goal: &QuaternionComponents,
    equivalence: AttitudeEquivalence,
) -> f64 {
    let turn = product(&conjugate(goal), q);
    let sine = norm(&[turn[0], turn[1], turn[2], 0.0]);
    let cosine = match equivalence {
        AttitudeEquivalence::Rotation => turn[3].abs(),
        AttitudeEquivalence::Quaternion => turn[3],
    };
    2.0 * sine.atan2(cosine)
}
