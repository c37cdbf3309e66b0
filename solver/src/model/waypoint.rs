//! A place that a motion passes through, and what must hold there.

use super::attitude::Attitude;
use super::dynamics::Dynamics;
use super::scenario::RateCondition;
use nalgebra::DVector;

/// What the wheel momenta must satisfy at a waypoint.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum WheelCondition {
    /// Only the limits.
    Free,
    /// These null-space components, N m s.
    NullSpace(DVector<f64>),
    /// These momenta, N m s; with the attitude they fix the rates too.
    Fixed(DVector<f64>),
}

/// A place to pass through.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Waypoint {
    /// The attitude with the sign that the continuous quaternion has there.
    pub(crate) attitude: Attitude,
    /// Condition of each rate component.
    pub(crate) rate: [RateCondition; 3],
    /// Condition of the wheels.
    pub(crate) wheels: WheelCondition,
    /// What the wheel momenta cost here, s per N m s of each enabled wheel; nothing without.
    pub(crate) price: Option<DVector<f64>>,
}

impl Waypoint {
    /// Whether conditions leave nothing free.
    pub(crate) fn is_fixed(&self, dynamics: &Dynamics) -> bool {
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

    /// The same place, passed with these wheel momenta, N m s, and so with the rates that they mean.
    pub(crate) fn passed_with(&self, wheels: &DVector<f64>) -> Self {
        Self {
            attitude: self.attitude,
            rate: [RateCondition::Free; 3],
            wheels: WheelCondition::Fixed(wheels.clone()),
            price: None,
        }
    }
}
