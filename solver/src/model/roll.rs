//! The roll about a body axis that is pointed, where it is not given.
//!
//! A telescope is pointed at a direction; the attitudes that do so are `q(r) = q(0) exp(r b)`, with the
//! unit vector `b` along its boresight, body axes, and the roll `r`. The boresight `b` is the same at all
//! of them, seen from the body and from the reference frame.

mod arcs;
mod clear;

pub(crate) use arcs::RollArcs;

use super::attitude::Attitude;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Rolls closer than this are the same, rad.
const SAME_ROLL: f64 = 1e-11;

/// The rolls that are admissible at an attitude beside its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeRoll {
    /// The body axis that is pointed, of unit length.
    pub axis: Vector3<f64>,
    /// Least and greatest right-handed turn about the axis from the attitude it belongs to, rad, less than
    /// a whole turn apart; `None` where every roll is admissible.
    pub range: Option<[f64; 2]>,
}

impl FreeRoll {
    /// The attitude after a roll, rad.
    #[must_use]
    pub fn rolled(&self, attitude: &Attitude, roll: f64) -> Attitude {
        attitude.retract(self.axis * roll)
    }

    /// The roll, rad, in `(-pi, pi]`, from one attitude to the attitude with the same boresight that is
    /// nearest to another.
    #[must_use]
    pub fn between(&self, from: &Attitude, to: &Attitude) -> f64 {
        let [x, y, z, w] = from.turn_to(to).xyzw();
        let along = Vector3::new(x, y, z).dot(&self.axis);
        // The half angle, of either quaternion sign.
        let roll = 2.0 * along.atan2(w);
        if roll > PI {
            roll - TAU
        } else if roll <= -PI {
            roll + TAU
        } else {
            roll
        }
    }

    /// The admissible roll that is nearest to a roll, rad, whole turns apart being the same.
    #[must_use]
    pub fn nearest(&self, roll: f64) -> f64 {
        let Some([low, high]) = self.range else {
            return roll;
        };
        let middle = 0.5 * (low + high);
        let away = roll - middle;
        let away = away - TAU * (away / TAU).round();
        (middle + away).clamp(low, high)
    }

    /// Whether every roll from a least to a greatest one, rad, is admissible.
    #[must_use]
    pub fn admits(&self, [least, greatest]: [f64; 2]) -> bool {
        let Some([low, high]) = self.range else {
            return true;
        };
        // How far inside the range it begins, whole turns apart being the same.
        let inside = (least - low + SAME_ROLL).rem_euclid(TAU) - SAME_ROLL;
        low + inside + (greatest - least) <= high + SAME_ROLL
    }

    /// Angle, rad, between the boresights at two attitudes.
    #[must_use]
    pub fn off_boresight(&self, one: &Attitude, other: &Attitude) -> f64 {
        let [one, other] = [one, other].map(|attitude| attitude.to_reference(self.axis));
        one.cross(&other).norm().atan2(one.dot(&other))
    }
}

/// A boresight that is pointed, as its target or end says it.
#[derive(Debug, Clone, PartialEq)]
pub struct Pointing {
    /// The attitude of roll 0.
    pub level: Attitude,
    /// The admissible rolls from there, also where limits leave a single one.
    pub roll: FreeRoll,
}

impl Pointing {
    /// The roll of an attitude that points the boresight, rad: the one in the middle of the limits, or
    /// in `(-pi, pi]`, of those that are whole turns apart.
    #[must_use]
    pub fn roll_of(&self, attitude: &Attitude) -> f64 {
        let roll = self.roll.between(&self.level, attitude);
        let Some([low, high]) = self.roll.range else {
            return roll;
        };
        roll + TAU * ((0.5 * (low + high) - roll) / TAU).round()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted() -> (Attitude, FreeRoll) {
        let attitude = Attitude::from_rotation_vector(Vector3::new(0.4, -1.1, 0.3));
        let axis = Vector3::new(1.0, 2.0, -0.5).normalize();
        (attitude, FreeRoll { axis, range: None })
    }

    #[test]
    fn a_roll_keeps_the_boresight_and_is_found_again() {
        let (attitude, free) = tilted();
        for roll in [-3.0, -0.7, 0.0, 0.2, 3.1] {
            let rolled = free.rolled(&attitude, roll);
            assert!(free.off_boresight(&attitude, &rolled) < 1e-12);
            for signed in [rolled, rolled.negated()] {
                assert!((free.between(&attitude, &signed) - roll).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_roll_of_an_attitude_is_told_where_its_limits_are() {
        let (level, free) = tilted();
        let within = |range| {
            let roll = FreeRoll { range, ..free };
            Pointing { level, roll }.roll_of(&free.rolled(&level, 3.3))
        };
        assert!((within(None) - (3.3 - TAU)).abs() < 1e-12);
        assert!((within(Some([3.0, 3.5])) - 3.3).abs() < 1e-12);
        assert!((within(Some([-9.5, -9.0])) - (3.3 - 2.0 * TAU)).abs() < 1e-12);
    }

    #[test]
    fn another_reference_frame_changes_no_roll() {
        let (level, free) = tilted();
        let frame = Attitude::from_rotation_vector(Vector3::new(-2.0, 0.4, 0.9));
        let seen = |attitude: &Attitude| frame.then_in_body(attitude);
        for roll in [-2.0, 0.3, 3.0] {
            let across = free.axis.cross(&Vector3::y()).normalize() * 0.2;
            let rolled = free.rolled(&level, roll).retract(across);
            let there = [seen(&level), seen(&rolled)];
            let found = free.between(&there[0], &there[1]);
            assert!((found - free.between(&level, &rolled)).abs() < 1e-12);
            let off = free.off_boresight(&there[0], &there[1]);
            assert!((off - free.off_boresight(&level, &rolled)).abs() < 1e-12);
            assert!((off - 0.2).abs() < 1e-12);
        }
    }

    #[test]
    fn the_nearest_admissible_roll_lies_in_the_range() {
        let (_, free) = tilted();
        let limited = FreeRoll {
            range: Some([3.0, 4.0]),
            ..free
        };
        assert!((free.nearest(7.0) - 7.0).abs() < 1e-15);
        assert!((limited.nearest(3.5 - TAU) - 3.5).abs() < 1e-12);
        assert!((limited.nearest(4.2 - TAU) - 4.0).abs() < 1e-12);
        assert!((limited.nearest(0.0) - 4.0).abs() < 1e-12);
        assert!(limited.admits([3.0 - TAU, 4.0 - TAU]) && free.admits([0.0, 9.0]));
        assert!(!limited.admits([3.0, 9.0]) && !limited.admits([3.5, 4.1]));
    }
}
