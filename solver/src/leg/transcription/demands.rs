//! The changes of rates and momenta that the ends of a leg require beside the turn between them.

use super::{Waypoint, WheelCondition};
use crate::model::dynamics::Dynamics;
use crate::model::scenario::RateCondition;
use nalgebra::{DVector, Vector3};

impl Waypoint {
    /// Time, s, that the wheels need for the change of rates and of null-space momentum between
    /// this waypoint and the next one; zero where both admit the same values.
    pub(crate) fn change_time(&self, next: &Self, dynamics: &Dynamics) -> f64 {
        let change = Vector3::from_fn(|axis, _| between(self.rate[axis], next.rate[axis]));
        let size = change.norm();
        let of_rates = if size > 0.0 {
            size / dynamics.axis_acceleration(&(change / size))
        } else {
            0.0
        };
        let nulls = self.null(dynamics).zip(next.null(dynamics));
        let of_null = nulls.map_or(0.0, |(here, there)| {
            let shift = &dynamics.null_space * (there - here);
            let wheels = dynamics.actuators.iter().zip(shift.iter());
            wheels
                .map(|(wheel, shift)| shift.abs() / wheel.max_torque.min(-wheel.min_torque))
                .fold(0.0, f64::max)
        });
        of_rates + of_null
    }

    /// The null-space momentum at the waypoint, N m s, where it is given.
    fn null(&self, dynamics: &Dynamics) -> Option<DVector<f64>> {
        match &self.wheels {
            WheelCondition::Free => None,
            WheelCondition::NullSpace(null) => Some(null.clone()),
            WheelCondition::Fixed(momenta) => Some(dynamics.null_component(momenta)),
        }
    }
}

/// The least change, rad/s, from a rate that meets one condition to a rate that meets another.
fn between(one: RateCondition, other: RateCondition) -> f64 {
    let ([a, b], [c, d]) = (one.range(), other.range());
    (c - b).max(0.0) + (d - a).min(0.0)
}
