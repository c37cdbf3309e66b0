//! Limits of the slews of a spacecraft: of rates and accelerations on the way and of rates at the
//! ends.

use nalgebra::Vector3;

/// Limits that every motion of the spacecraft satisfies, per body axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlewLimits {
    /// Largest rates, rad/s, positive.
    pub rates_rad_s: Vector3<f64>,
    /// Largest angular accelerations, rad/s^2, positive.
    pub accelerations_rad_s2: Vector3<f64>,
}

/// Limits of the rates at the ends of a leg or tour, per body axis: 0 where a component is stopped,
/// infinite where it is free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndRates {
    /// At the beginning, rad/s.
    pub begin_rad_s: Vector3<f64>,
    /// At the end, rad/s.
    pub end_rad_s: Vector3<f64>,
}

impl EndRates {
    /// Rest at both ends.
    #[must_use]
    pub fn at_rest() -> Self {
        Self {
            begin_rad_s: Vector3::zeros(),
            end_rad_s: Vector3::zeros(),
        }
    }
}
