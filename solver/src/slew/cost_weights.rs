//! Weights of a program's cost, and its limits on duration and energy; they stand for all objectives.
//!
//! ```text
//!   minimise    a T + b integral u'u dt + c E
//!   subject to  T = given,  E <= given        (where they are)
//! ```
//!
//! with `E` the energy of the motors in the measure of the weights.

use super::spec::EnergyMeasure;

/// Weights and prescriptions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CostWeights {
    /// `a`.
    pub(super) time: f64,
    /// `b`, per (N m)^2.
    pub(super) effort: f64,
    /// `c`, s/J when the others are seconds.
    pub(super) energy: f64,
    /// How energy is counted.
    pub(super) measure: EnergyMeasure,
    /// The duration, s.
    pub(super) duration: Option<f64>,
    /// The limit on the energy, J.
    pub(super) budget: Option<f64>,
}

impl CostWeights {
    /// Minimum time.
    pub(super) const TIME: Self = Self {
        time: 1.0,
        effort: 0.0,
        energy: 0.0,
        measure: EnergyMeasure::Proxy,
        duration: None,
        budget: None,
    };

    /// Minimum energy in a duration, s.
    pub(super) fn energy_in(duration: f64, measure: EnergyMeasure) -> Self {
        Self {
            time: 0.0,
            energy: 1.0,
            measure,
            duration: Some(duration),
            ..Self::TIME
        }
    }

    /// Energy in the measure per energy at the motor: the bill is counted at the supply.
    pub(super) fn supply_factor(&self, efficiency: f64) -> f64 {
        match self.measure {
            EnergyMeasure::Proxy => 1.0,
            EnergyMeasure::Bill => efficiency.recip(),
        }
    }

    /// Whether the cost is the duration alone.
    pub(super) fn is_time_only(&self) -> bool {
        self.effort == 0.0 && !self.uses_energy()
    }

    /// Whether energy is in the cost or limited.
    pub(super) fn uses_energy(&self) -> bool {
        self.energy > 0.0 || self.budget.is_some()
    }

    /// Whether energy is counted as the bill: drawn from the supply, nothing returned by braking.
    pub(super) fn uses_bill(&self) -> bool {
        self.uses_energy() && self.measure == EnergyMeasure::Bill
    }
}
