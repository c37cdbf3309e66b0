//! What limits the slews of a spacecraft: rates and accelerations on the way, rates at the ends.

use nalgebra::Vector3;

/// What no motion of the spacecraft exceeds, per body axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlewLimits {
    /// Largest rates, rad/s, positive.
    pub rates_rad_s: Vector3<f64>,
    /// Largest angular accelerations, rad/s^2, positive.
    pub accelerations_rad_s2: Vector3<f64>,
}

/// What the rates do not exceed at the ends of a leg or tour, per body axis: 0 where they are
/// stopped, infinite where they are free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndRates {
    /// At the beginning, rad/s.
    pub begin_rad_s: Vector3<f64>,
    /// At the end, rad/s.
    pub end_rad_s: Vector3<f64>,
}

impl EndRates {
    /// All components stopped at both ends.
    #[must_use]
    pub fn at_rest() -> Self {
        Self {
            begin_rad_s: Vector3::zeros(),
            end_rad_s: Vector3::zeros(),
        }
    }
}
