//! A rigid spacecraft with reaction wheels, valid by construction.
//!
//! Symbols and dynamics (all vectors in body axes):
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `J` | inertia of the whole spacecraft, wheels locked | kg m² |
//! | `a_i`, `I_i` | spin axis and spin inertia of wheel `i` | -, kg m² |
//! | `W_i` | wheel speed relative to the body | rad/s |
//! | `w` | body rate | rad/s |
//! | `h_i = I_i (W_i + a_i . w)` | momentum of wheel `i` about its axis | N m s |
//! | `u_i = h_i'` | motor torque on wheel `i` | N m |
//! | `J_eff = J - sum I_i a_i a_i^T` | inertia without the enabled wheels' spin | kg m² |
//!
//! Total momentum `J_eff w + sum a_i h_i + (locked wheels)` is constant in the reference frame.

use nalgebra::{Matrix3, Vector3};

/// A valid wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// Spin axis as it enters the equations (unit length unless the caller asked otherwise).
    pub axis: Vector3<f64>,
    /// Spin inertia, kg m².
    pub inertia: f64,
    /// Smallest motor torque, N m, below zero.
    pub min_torque: f64,
    /// Largest motor torque, N m, above zero.
    pub max_torque: f64,
    /// Limit of the speed relative to the body, rad/s; infinite when unlimited.
    pub max_speed: f64,
    /// Whether the wheel may be commanded; otherwise it is locked at its start speed.
    pub enabled: bool,
}

/// A named body axis of unit length.
#[derive(Debug, Clone, PartialEq)]
pub struct Boresight {
    /// Its name.
    pub name: String,
    /// Unit direction in body axes.
    pub axis: Vector3<f64>,
}

/// A valid spacecraft.
#[derive(Debug, Clone, PartialEq)]
pub struct Spacecraft {
    inertia: Matrix3<f64>,
    effective_inertia: Matrix3<f64>,
    effective_inertia_inverse: Matrix3<f64>,
    wheels: Vec<Wheel>,
    max_rate: Vector3<f64>,
    max_rate_norm: f64,
    boresights: Vec<Boresight>,
}

impl Spacecraft {
    /// Inertia of the whole spacecraft with its wheels locked, kg m².
    #[must_use]
    pub fn inertia(&self) -> &Matrix3<f64> {
        &self.inertia
    }

    /// `J_eff`, kg m².
    #[must_use]
    pub fn effective_inertia(&self) -> &Matrix3<f64> {
        &self.effective_inertia
    }

    /// Inverse of `J_eff`, 1/(kg m²).
    #[must_use]
    pub fn effective_inertia_inverse(&self) -> &Matrix3<f64> {
        &self.effective_inertia_inverse
    }

    /// All wheels, disabled ones included, in the caller's order.
    #[must_use]
    pub fn wheels(&self) -> &[Wheel] {
        &self.wheels
    }

    /// The enabled wheels with their index among all wheels.
    pub fn enabled_wheels(&self) -> impl Iterator<Item = (usize, &Wheel)> {
        self.wheels.iter().enumerate().filter(|(_, w)| w.enabled)
    }

    /// Limit of each body rate component, rad/s; infinite where unlimited.
    #[must_use]
    pub fn max_rate(&self) -> Vector3<f64> {
        self.max_rate
    }

    /// Limit of the norm of the body rate, rad/s; infinite when unlimited.
    #[must_use]
    pub fn max_rate_norm(&self) -> f64 {
        self.max_rate_norm
    }

    /// Named instrument axes.
    #[must_use]
    pub fn boresights(&self) -> &[Boresight] {
        &self.boresights
    }

    /// Total angular momentum in body axes, N m s, of a body rate (rad/s) and wheel speeds
    /// relative to the body (rad/s, one per wheel): `J w + sum a_i I_i W_i`.
    #[must_use]
    pub fn body_momentum(&self, rate: Vector3<f64>, wheel_speed: &[f64]) -> Vector3<f64> {
        let spin: Vector3<f64> = self
            .wheels
            .iter()
            .zip(wheel_speed)
            .map(|(wheel, speed)| wheel.axis * (wheel.inertia * speed))
            .sum();
        self.inertia * rate + spin
    }
}
