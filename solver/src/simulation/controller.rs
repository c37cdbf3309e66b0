//! The control laws at the samples of the on-board computer.
//!
//! With the measured attitude `R` and rate `w`, the commanded `R_d`, `w_d`, and the error quaternion
//! `q_e = q_d* (x) q` on the hemisphere of the identity (rotation by the angle `theta` about `n`):
//!
//! ```text
//!   q_e  = n sin(theta / 2)                                        vector part
//!   e_R  = 1/2 (R_d^T R - R^T R_d)^v = n sin(theta)                BIROS (19)
//!   e_w  = w - R^T R_d w_d                                         BIROS (20)
//!
//!   tau  = -k J q_e - c J e_w + (w x H_b - w_d x H_d)              thesis (28), (157)
//!   tau  = -k_R e_R - k_w e_w - k_I e_I                            BIROS (23)
//!   e_I  = t_s sum of (e_w + k_p e_R) over the samples before      BIROS (24)
//! ```
//!
//! While a wheel is at a limit of torque or speed, the integral of an error that the wheel cannot reduce
//! keeps growing and has to decay afterwards: it *winds up*. The remedy is conditional integration
//! (Astrom and Hagglund, PID Controllers, 1995, section 3.5; Visioli, IEE Proc. Control Theory Appl.
//! 150, 2003), here by direction. With `b_i` the rows of the pseudo-inverse and `s_i` the sign of the
//! torque that wheel `i` could not give since the last sample, a term `d = k_I t_s (e_w + k_p e_R)` of
//! the integral changes the demands on the wheels by `b_i . d`. The term added instead is the nearest
//! one that demands no more of a wheel at a limit,
//!
//! ```text
//!   minimise |d' - d|   subject to   s_i b_i . d' <= 0    for all wheels at a limit
//! ```
//!
//! so that the integral still grows about axes with torque left, and may always decay.
//!
//! The thesis has `w x J w` and treats the momentum of the wheels separately. Here `H_b` is the momentum
//! of body and wheels, and the gyroscopic torque `w_d x H_d` that the plan's torques contain is
//! subtracted, with `H_d` the plan's momentum.

use super::settings::{ControlLaw, SimulationSettings};
use crate::model::attitude::Attitude;
use crate::model::spacecraft::Spacecraft;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// The state that the controller follows at one time.
#[derive(Debug, Clone)]
pub(super) struct Desired {
    pub(super) attitude: Attitude,
    /// Body rate in the body axes of that attitude, rad/s.
    pub(super) rate: Vector3<f64>,
    /// `w_d x H_d`: the gyroscopic torque that the feed-forward compensates, N m.
    pub(super) gyroscopic: Vector3<f64>,
}

/// Measurements of the sensors.
#[derive(Debug, Clone)]
pub(super) struct Measured<'a> {
    pub(super) attitude: Attitude,
    pub(super) rate: Vector3<f64>,
    /// Speed of each wheel, rad/s.
    pub(super) wheel_speed: &'a [f64],
    /// Integral of each wheel's commanded torque beyond its limits since the last sample, N m s.
    pub(super) missing: &'a [f64],
}

/// A control law with its memory.
#[derive(Debug)]
pub(super) struct FeedbackController<'a> {
    settings: &'a SimulationSettings,
    spacecraft: &'a Spacecraft,
    /// `k_I e_I`, N m.
    integral: Vector3<f64>,
    /// The term of the last sample, not yet added, N m.
    pending: Vector3<f64>,
    /// Body torques that are delayed, N m, oldest first.
    late: VecDeque<Vector3<f64>>,
}

impl<'a> FeedbackController<'a> {
    pub(super) fn new(settings: &'a SimulationSettings, spacecraft: &'a Spacecraft) -> Self {
        Self {
            settings,
            spacecraft,
            integral: Vector3::zeros(),
            pending: Vector3::zeros(),
            late: std::iter::repeat_n(Vector3::zeros(), settings.delay).collect(),
        }
    }

    /// Writes the feedback torque of each wheel from this sample on, N m, to `torque`.
    pub(super) fn sample(
        &mut self,
        measured: &Measured<'_>,
        desired: &Desired,
        torque: &mut [f64],
    ) {
        let (body_torque, allocation) = match &self.settings.law {
            ControlLaw::Open => {
                torque.fill(0.0);
                return;
            }
            ControlLaw::Quaternion {
                gains,
                gyroscopic,
                allocation,
            } => {
                let (turn, rate_error) = errors(measured, desired);
                let wanted = turn.vector * gains.attitude + rate_error * gains.rate;
                let mut body_torque = -(self.spacecraft.inertia() * wanted);
                if *gyroscopic {
                    let momentum = self
                        .spacecraft
                        .body_momentum(measured.rate, measured.wheel_speed);
                    body_torque += measured.rate.cross(&momentum) - desired.gyroscopic;
                }
                (body_torque, allocation)
            }
            ControlLaw::Pid {
                gains,
                anti_windup,
                allocation,
            } => {
                let (turn, rate_error) = errors(measured, desired);
                let attitude_error = turn.vector * (2.0 * turn.scalar);
                self.integral += if *anti_windup {
                    allocation.relieved(&self.pending, measured.missing)
                } else {
                    self.pending
                };
                let body_torque =
                    -(gains.attitude * attitude_error + gains.rate * rate_error + self.integral);
                let slope = rate_error + attitude_error * gains.attitude_weight;
                self.pending = gains.integral * slope * self.settings.sample_s;
                (body_torque, allocation)
            }
        };
        self.late.push_back(body_torque);
        let due = self.late.pop_front().unwrap_or_default();
        for (wheel, torque) in torque.iter_mut().enumerate() {
            *torque = allocation.wheel_torque(wheel, &due);
        }
    }
}

/// The error quaternion with a scalar part that is not negative.
struct ErrorQuaternion {
    vector: Vector3<f64>,
    scalar: f64,
}

/// Errors of attitude and rate, the latter in rad/s.
fn errors(measured: &Measured<'_>, desired: &Desired) -> (ErrorQuaternion, Vector3<f64>) {
    let turn = desired.attitude.turn_to(&measured.attitude);
    let rate_error = measured.rate - turn.to_body(desired.rate);
    let [x, y, z, w] = turn.nearest_sign(&Attitude::identity()).xyzw();
    let error = ErrorQuaternion {
        vector: Vector3::new(x, y, z),
        scalar: w,
    };
    (error, rate_error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// The vector of a skew-symmetric matrix.
    fn vee(m: &Matrix3<f64>) -> Vector3<f64> {
        Vector3::new(m.m32, m.m13, m.m21)
    }

    #[test]
    fn errors_agree_with_their_definition_by_rotation_matrices() {
        let desired = Desired {
            attitude: Attitude::from_xyzw([0.1, -0.5, 0.5, 0.7]).unwrap(),
            rate: Vector3::new(0.01, -0.03, 0.02),
            gyroscopic: Vector3::zeros(),
        };
        let attitude = Attitude::from_xyzw([0.3, 0.2, -0.6, -0.4]).unwrap();
        let measured = Measured {
            attitude,
            rate: Vector3::new(-0.02, 0.04, 0.01),
            wheel_speed: &[],
            missing: &[],
        };
        let (turn, rate_error) = errors(&measured, &desired);
        let (r, d) = (attitude.matrix(), desired.attitude.matrix());
        let e_r = vee(&(d.transpose() * r - r.transpose() * d)) * 0.5;
        assert!((turn.vector * (2.0 * turn.scalar) - e_r).norm() < 1e-15);
        let e_w = measured.rate - r.transpose() * d * desired.rate;
        assert!((rate_error - e_w).norm() < 1e-15);
        assert!(turn.scalar >= 0.0);
    }
}
