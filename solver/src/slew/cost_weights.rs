//! What a program minimises and what it is held to: every objective is a choice of these.
//!
//! ```text
//!   minimise    a T + b integral u'u dt + c E
//!   subject to  T = given,  E <= given        (where they are)
//! ```
//!
//! with `E` the integral of the wheels' power or of what the supply gives for it.

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
    /// The most energy, J.
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

    /// Least energy in a time, s.
    pub(super) fn energy_in(duration: f64, measure: EnergyMeasure) -> Self {
        Self {
            time: 0.0,
            energy: 1.0,
            measure,
            duration: Some(duration),
            ..Self::TIME
        }
    }

    /// What of the motor's energy counts as the objective's: the bill is at the supply.
    pub(super) fn supply_factor(&self, efficiency: f64) -> f64 {
        match self.measure {
            EnergyMeasure::Proxy => 1.0,
            EnergyMeasure::Bill => efficiency.recip(),
        }
    }

    /// Whether only time counts.
    pub(super) fn is_time_only(&self) -> bool {
        self.effort == 0.0 && !self.uses_energy()
    }

    /// Whether energy matters.
    pub(super) fn uses_energy(&self) -> bool {
        self.energy > 0.0 || self.budget.is_some()
    }

    /// Whether only what the supply gives counts, never what a braking wheel would return.
    pub(super) fn uses_bill(&self) -> bool {
        self.uses_energy() && self.measure == EnergyMeasure::Bill
    }
}
