//! Constraints on a state: rows that are affine in body rate and wheel momenta.
//!
//! A row is `c + y . w + g . h`, `w` in rad/s, `h` scaled. Through the momentum `R(q)^T H` the
//! rate depends on the attitude; with `eta = R(q)^T H` and an attitude step `d`, to second order
//!
//! ```text
//!   w(d) = w + Ji (eta x d + 1/2 d x (d x eta)),      w(h + dh) = w - Ji A dh
//! ```

use super::Transcription;
use crate::nlp::LinkModel;
use nalgebra::{Matrix3, Vector3};

/// `c + y . w + g . h`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// `c`.
    pub(super) constant: f64,
    /// `y`, per rad/s.
    pub(super) rate: Vector3<f64>,
    /// `g`: index of the wheel and coefficient.
    pub(super) wheels: Vec<(usize, f64)>,
}

/// One side of a speed or rate limit, `1 -+ share >= reserve`.
#[derive(Debug, Clone)]
pub(super) struct LimitRow {
    /// The margin without a reserve.
    pub(super) row: Row,
    /// Index among the shares of [`crate::dynamics::Dynamics::limit_shares`].
    pub(super) share: usize,
}

/// A state seen through the dynamics.
pub(super) struct StateView<'a> {
    /// Body rate, rad/s.
    pub(super) rate: Vector3<f64>,
    /// `R(q)^T H`, N m s.
    pub(super) momentum: Vector3<f64>,
    /// Scaled wheel momenta.
    pub(super) wheels: &'a [f64],
}

impl Row {
    pub(super) fn value(&self, state: &StateView<'_>) -> f64 {
        let wheels: f64 = self.wheels.iter().map(|(i, g)| g * state.wheels[*i]).sum();
        self.constant + self.rate.dot(&state.rate) + wheels
    }
}

impl Transcription {
    /// Writes a row's derivative with respect to the state.
    pub(super) fn write_row(&self, row: &Row, state: &StateView<'_>, out: &mut [f64]) {
        let pulled = self.dynamics.inertia_inverse.tr_mul(&row.rate);
        if self.dynamics.has_momentum() {
            let by_attitude = pulled.cross(&state.momentum) * self.scales.angle;
            out[..3].copy_from_slice(by_attitude.as_slice());
        }
        for (i, wheel) in self.dynamics.actuators.iter().enumerate() {
            out[3 + i] = -self.scales.momentum * pulled.dot(&wheel.axis);
        }
        for (i, g) in &row.wheels {
            out[3 + i] += g;
        }
    }

    /// Adds the curvature of `y . w(d)` in the attitude to a Hessian.
    pub(super) fn add_rate_curvature(
        &self,
        y: &Vector3<f64>,
        state: &StateView<'_>,
        out: &mut LinkModel,
    ) {
        if self.dynamics.has_momentum() {
            let pulled = self.dynamics.inertia_inverse.tr_mul(y);
            let curvature = double_cross_curvature(&pulled, &state.momentum);
            add_attitude_block(out, &(curvature * self.scales.angle.powi(2)));
        }
    }

    /// Value of the norm limit `(1 - reserve)^2 - |w|^2 / limit^2`.
    pub(super) fn norm_margin(&self, state: &StateView<'_>, reserve: f64) -> f64 {
        (1.0 - reserve).powi(2) - state.rate.norm_squared() / self.dynamics.max_rate_norm.powi(2)
    }

    /// Writes the norm limit's derivative and adds its curvature times `-z`.
    pub(super) fn write_norm_row(
        &self,
        state: &StateView<'_>,
        z: f64,
        row: &mut [f64],
        hessian: &mut [f64],
        stride: usize,
    ) {
        let scale = self.dynamics.max_rate_norm.powi(2).recip();
        let unit = |i: usize| Row {
            constant: 0.0,
            rate: Vector3::ith(i, 1.0),
            wheels: Vec::new(),
        };
        let states = 3 + self.dynamics.wheel_count();
        let mut gradients = [[0.0; 32]; 3];
        for (i, gradient) in gradients.iter_mut().enumerate() {
            self.write_row(&unit(i), state, &mut gradient[..states]);
            for j in 0..states {
                row[j] -= 2.0 * scale * state.rate[i] * gradient[j];
            }
            for a in 0..states {
                for b in 0..=a {
                    hessian[a * stride + b] += 2.0 * z * scale * gradient[a] * gradient[b];
                }
            }
        }
    }
}

/// Second derivative of `y . 1/2 d x (d x eta)` with respect to `d`.
pub(super) fn double_cross_curvature(y: &Vector3<f64>, eta: &Vector3<f64>) -> Matrix3<f64> {
    let outer = y * eta.transpose();
    (outer + outer.transpose()) * 0.5 - Matrix3::identity() * y.dot(eta)
}

/// Adds to the attitude block of a Hessian, lower triangle.
pub(super) fn add_attitude_block(out: &mut LinkModel, block: &Matrix3<f64>) {
    for i in 0..3 {
        for j in 0..=i {
            out.hessian[i * out.vars + j] += block[(i, j)];
        }
    }
}
