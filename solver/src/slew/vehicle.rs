//! The spacecraft as a slew's program and its propagation see it: dynamics, drives, and wheels
//! that follow a speed law.
//!
//! A wheel under a speed law is no control. Its speed relative to the body is a known function of
//! time, `W(t) = speed + (W(0) - speed) exp(-rate t)`, so it is a locked wheel whose momentum
//! drifts. The program has a clock among its states where there is such a wheel.

use crate::model::drive::{Drive, SpeedLaw};
use crate::model::dynamics::Dynamics;
use nalgebra::{DVector, Vector3};

/// A wheel under a speed law.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SpeedLawWheel {
    /// `a I`, kg m².
    spin: Vector3<f64>,
    law: SpeedLaw,
    /// Speed at the start, rad/s.
    start: f64,
}

/// All wheels under a speed law.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct SpeedLawWheels(Vec<SpeedLawWheel>);

impl SpeedLawWheels {
    /// Adds a wheel, with `spin` its axis times its inertia, kg m², and its speed at the start, rad/s.
    pub(super) fn add(&mut self, spin: Vector3<f64>, law: SpeedLaw, start: f64) {
        self.0.push(SpeedLawWheel { spin, law, start });
    }

    /// Change of the locked momentum since the start, N m s, and its first two derivatives by time.
    pub(super) fn drift(&self, time: f64) -> [Vector3<f64>; 3] {
        let mut drift = [Vector3::zeros(); 3];
        for SpeedLawWheel { spin, law, start } in &self.0 {
            let excess = spin * (start - law.speed);
            let left = (-law.rate * time).exp();
            drift[0] += excess * (-law.rate * time).exp_m1();
            drift[1] -= excess * (law.rate * left);
            drift[2] += excess * (law.rate * law.rate * left);
        }
        drift
    }

    /// Whether any wheel's speed changes.
    pub(super) fn any_drift(&self) -> bool {
        self.0
            .iter()
            .any(|f| f.law.rate > 0.0 && (f.start - f.law.speed).abs() > 0.0)
    }
}

/// A spacecraft with its wheels and drives.
#[derive(Debug, Clone)]
pub(super) struct Vehicle {
    pub(super) dynamics: Dynamics,
    /// Drives of the commanded wheels.
    pub(super) drives: Vec<Drive>,
    pub(super) speed_law_wheels: SpeedLawWheels,
    /// The null-space component of the commanded wheels' momenta, N m s, which stays constant where the
    /// pseudo-inverse allocates torques; `None` where every torque is chosen by itself.
    pub(super) pinned_null: Option<DVector<f64>>,
}
