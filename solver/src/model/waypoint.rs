//! An attitude that a motion passes, and the conditions that hold there.

use super::attitude::Attitude;
use super::dynamics::Dynamics;
use super::roll::RollArcs;
use super::scenario::RateCondition;
use nalgebra::{DVector, Matrix2, Vector2};
use std::f64::consts::PI;

/// The condition on the wheel momenta at a waypoint.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum WheelCondition {
    /// None but the limits.
    Free,
    /// These null-space components, N m s.
    NullSpace(DVector<f64>),
    /// These momenta, N m s; with the attitude they fix the rates too.
    Fixed(DVector<f64>),
}

/// An attitude to pass, with conditions.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Waypoint {
    /// The attitude with the sign that the continuous quaternion has there.
    pub(crate) attitude: Attitude,
    /// The admissible rolls beside that attitude, where only an axis is pointed.
    pub(crate) roll: Option<RollArcs>,
    /// Condition of each rate component.
    pub(crate) rate: [RateCondition; 3],
    /// Condition of the wheels.
    pub(crate) wheels: WheelCondition,
    /// Cost of the wheel momenta here, s per N m s of each enabled wheel, `None` for no cost.
    /// Costates of a longer motion make legs that are solved alone add up to it (Lagrangian
    /// bounds).
    pub(crate) costates: Option<DVector<f64>>,
}

impl Waypoint {
    /// Whether the conditions fix attitude, rates and wheel momenta.
    pub(crate) fn is_fixed(&self, dynamics: &Dynamics) -> bool {
        self.roll.is_none() && self.fixes_wheels(dynamics)
    }

    /// Whether the conditions fix rates and wheel momenta at every admissible attitude.
    fn fixes_wheels(&self, dynamics: &Dynamics) -> bool {
        let rates_fixed = self
            .rate
            .iter()
            .all(|c| matches!(c, RateCondition::Fixed(_)));
        match self.wheels {
            WheelCondition::Fixed(_) => true,
            WheelCondition::NullSpace(_) => rates_fixed,
            WheelCondition::Free => rates_fixed && dynamics.wheel_count() == 3,
        }
    }

    /// Whether the limits of the wheels and of the rate are a matter of the conditions alone: nothing
    /// that depends on the motion can exceed them.
    pub(crate) fn fixes_limits(&self, dynamics: &Dynamics) -> bool {
        // Stored momentum makes the wheels' momenta depend on the roll.
        self.fixes_wheels(dynamics) && (self.roll.is_none() || !dynamics.has_momentum())
    }

    /// The same waypoint, described from the attitude after a roll, rad.
    pub(crate) fn rolled(&self, roll: f64) -> Self {
        let Some(free) = &self.roll else {
            return self.clone();
        };
        Self {
            attitude: free.rolled(&self.attitude, roll),
            roll: Some(free.after(roll)),
            ..self.clone()
        }
    }

    /// The same waypoint, described from its attitude that is nearest to another.
    pub(crate) fn rolled_towards(&self, attitude: &Attitude) -> Self {
        let Some(free) = &self.roll else {
            return self.clone();
        };
        self.rolled(free.towards(&self.attitude, attitude))
    }

    /// An admissible attitude of each arc of its rolls: the attitudes of an arc hang together.
    pub(crate) fn attitude_of_each_arc(&self) -> Vec<Attitude> {
        match &self.roll {
            Some(rolls) if !rolls.arcs.is_empty() => {
                let middles = rolls.arcs.iter().map(|arc| 0.5 * (arc[0] + arc[1]));
                middles.map(|roll| self.rolled(roll).attitude).collect()
            }
            _ => vec![self.attitude],
        }
    }

    /// The waypoint whose attitude is given.
    pub(crate) fn pinned(&self) -> Self {
        Self {
            roll: None,
            ..self.clone()
        }
    }

    /// The waypoint in the state in which a motion passes it: with the roll of an attitude and with
    /// wheel momenta, N m s, which fix its rates too.
    pub(crate) fn passed_in(&self, attitude: &Attitude, wheels: &DVector<f64>) -> Self {
        Self {
            attitude: self.rolled_towards(attitude).attitude,
            roll: None,
            rate: [RateCondition::Free; 3],
            wheels: WheelCondition::Fixed(wheels.clone()),
            costates: None,
        }
    }
}

/// Two waypoints, described from admissible rolls at which the turn between them is least, or nearly so
/// where the rolls of both are free and one is limited.
pub(crate) fn nearest_rolls(from: &Waypoint, to: &Waypoint) -> [Waypoint; 2] {
    let from = match (&from.roll, &to.roll) {
        (Some(free), Some(_)) => from.rolled(free.nearest(closest(from, to).0)),
        (Some(_), None) => from.rolled_towards(&to.attitude),
        (None, _) => from.clone(),
    };
    let to = to.rolled_towards(&from.attitude);
    [from.rolled_towards(&to.attitude), to]
}

/// A lower bound on the angle, rad, of all turns between rolls of two waypoints whose rolls are both
/// free; the least angle where none is limited.
pub(crate) fn least_angle(from: &Waypoint, to: &Waypoint) -> f64 {
    2.0 * closest(from, to).1.min(1.0).acos()
}

/// The roll of the first waypoint, rad, at which the turn to the second one is least if no roll is
/// limited, and the scalar part of that turn.
///
/// With `u` and `v` the cosine and sine of half the rolls, `q (u_1 + u_2 b)` and `p (v_1 + v_2 c)` are the
/// quaternions of the attitudes. The scalar part of the turn between them is their inner product
/// `u^T M v`, `M = [q.p, q.pc; qb.p, qb.pc]`, whose maximum is the largest singular value.
fn closest(from: &Waypoint, to: &Waypoint) -> (f64, f64) {
    // A roll by half a turn multiplies the quaternion by the axis.
    let [begins, arrivals] = [from, to].map(|end| [0.0, PI].map(|roll| end.rolled(roll).attitude));
    let products = Matrix2::from_fn(|i, j| {
        let pairs = begins[i].xyzw().into_iter().zip(arrivals[j].xyzw());
        pairs.map(|(a, b)| a * b).sum::<f64>()
    });
    // The leading eigenvector of M M^T is the direction of u.
    let squares = products * products.transpose();
    let (a, b, c) = (squares[(0, 0)], squares[(0, 1)], squares[(1, 1)]);
    let half_roll = 0.5 * (2.0 * b).atan2(a - c);
    let u = Vector2::new(half_roll.cos(), half_roll.sin());
    (2.0 * half_roll, products.tr_mul(&u).norm())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn pointed(attitude: Vector3<f64>, axis: Vector3<f64>) -> Waypoint {
        Waypoint {
            attitude: Attitude::from_rotation_vector(attitude),
            roll: Some(RollArcs {
                axis: axis.normalize(),
                arcs: Vec::new(),
            }),
            rate: [RateCondition::Fixed(0.0); 3],
            wheels: WheelCondition::Free,
            costates: None,
        }
    }

    #[test]
    fn the_least_turn_is_that_of_the_best_rolls_on_a_grid() {
        let from = pointed(Vector3::new(0.3, -0.8, 1.4), Vector3::new(1.0, 0.2, -0.3));
        let to = pointed(Vector3::new(-1.1, 0.4, 0.2), Vector3::new(-0.4, 0.1, 0.9));
        let angle = |a: &Waypoint, b: &Waypoint| a.attitude.angle_to(&b.attitude);
        let rolls = || (0..360).map(|degrees| f64::from(degrees).to_radians());
        let [one, other] = nearest_rolls(&from, &to);
        let least = least_angle(&from, &to);
        assert!((angle(&one, &other) - least).abs() < 1e-12);
        let pairs = rolls().flat_map(|a| rolls().map(move |b| (a, b)));
        let on_grid = pairs.map(|(a, b)| angle(&from.rolled(a), &to.rolled(b)));
        let on_grid = on_grid.fold(f64::INFINITY, f64::min);
        assert!(least <= on_grid && on_grid < least + 0.01);

        let [_, other] = nearest_rolls(&from.pinned(), &to);
        let on_grid = rolls().map(|b| angle(&from, &to.rolled(b)));
        let on_grid = on_grid.fold(f64::INFINITY, f64::min);
        let least = angle(&from, &other);
        assert!(least <= on_grid && on_grid < least + 0.01);
    }
}
