//! An attitude that a motion passes, and the conditions that hold there.

use super::attitude::Attitude;
use super::dynamics::Dynamics;
use super::scenario::RateCondition;
use nalgebra::DVector;

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
    /// Whether the conditions fix rates and wheel momenta.
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

    /// The waypoint with these wheel momenta, N m s, which fix its rates too.
    pub(crate) fn passed_with(&self, wheels: &DVector<f64>) -> Self {
        Self {
            attitude: self.attitude,
            rate: [RateCondition::Free; 3],
            wheels: WheelCondition::Fixed(wheels.clone()),
            costates: None,
        }
    }
}
