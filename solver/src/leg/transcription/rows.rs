//! Constraints on a state: rows that are affine in body rate and wheel momenta.
//!
//! A row is posed as `c + y . w + g . h`, `w` in rad/s, `h` scaled. The rate depends on the
//! attitude through the momentum `eta = R(q)^T H`, `w = Ji (eta - h_locked - hs A h)`, so the row
//! is kept as `c' + p . eta + g' . h` with `p = Ji^T y`: without momentum its derivatives are
//! constants. With an attitude step `d`, to second order,
//!
//! ```text
//!   eta(d) = eta + eta x d + 1/2 d x (d x eta)
//! ```
//!
//! Where locked wheels take momentum in the course of time ([`Drift`]), every row has
//! `p . (eta - drift)` instead of `p . eta`.

use super::{Transcription, quaternion_of};
use crate::math::quaternion::rotate_back;
use crate::nlp::{LinkModel, MAX_STATES};
use nalgebra::{Matrix3, Vector3};

/// `c' + p . eta + g' . h`.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Row {
    /// `c'`.
    constant: f64,
    /// `p`, per N m s.
    pub(crate) momentum: Vector3<f64>,
    /// `g'`, one per wheel.
    pub(crate) wheels: Vec<f64>,
}

/// One side of a speed or rate limit, `limit -+ value >= reserve limit`.
#[derive(Debug, Clone)]
pub(super) struct LimitRow {
    /// The margin without a reserve.
    pub(super) row: Row,
    /// The limit in the row's unit.
    pub(super) limit: f64,
    /// Index among the shares of [`crate::model::dynamics::Dynamics::limit_shares`].
    pub(super) share: usize,
}

/// Momentum that the locked wheels have taken since the beginning, as a function of a clock.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Drift {
    /// N m s, and its first two derivatives by the clock.
    pub(crate) taken: [Vector3<f64>; 3],
    /// Index of the clock among the directions of a state; `None` where nothing drifts.
    pub(crate) clock: Option<usize>,
}

/// What rows are evaluated on.
pub(crate) struct StateView<'a> {
    /// `R(q)^T H`, N m s.
    pub(super) momentum: Vector3<f64>,
    pub(super) drift: Drift,
    /// Scaled wheel momenta, then the rest of the state.
    pub(super) wheels: &'a [f64],
}

impl Row {
    pub(crate) fn value(&self, state: &StateView<'_>) -> f64 {
        let wheels = self.wheels.iter().zip(state.wheels);
        let by_wheels: f64 = wheels.map(|(g, h)| g * h).sum();
        self.constant + self.momentum.dot(&(state.momentum - state.drift.taken[0])) + by_wheels
    }
}

impl Transcription {
    /// The row `c + y . w + g . h`; `g` lists wheels with their coefficients, the others have zero.
    pub(crate) fn row(&self, constant: f64, rate: Vector3<f64>, wheels: &[(usize, f64)]) -> Row {
        let momentum = self.dynamics.inertia_inverse.tr_mul(&rate);
        let of_rate = |axis: &Vector3<f64>| -self.scales.momentum * momentum.dot(axis);
        let actuators = self.dynamics.actuators.iter();
        let mut row = Row {
            constant: constant - momentum.dot(&self.dynamics.locked_momentum),
            wheels: actuators.map(|wheel| of_rate(&wheel.axis)).collect(),
            momentum,
        };
        for (i, g) in wheels {
            row.wheels[*i] += g;
        }
        row
    }

    /// What rows are evaluated on at a node.
    pub(crate) fn view<'a>(&self, point: &'a [f64], drift: Drift) -> StateView<'a> {
        StateView {
            momentum: rotate_back(&quaternion_of(point), &self.dynamics.momentum),
            drift,
            wheels: &point[4..],
        }
    }

    /// Writes a row's derivative with respect to the state.
    pub(crate) fn write_row(&self, row: &Row, state: &StateView<'_>, out: &mut [f64]) {
        if self.dynamics.has_momentum() {
            let by_attitude = row.momentum.cross(&state.momentum) * self.scales.angle;
            out[..3].copy_from_slice(by_attitude.as_slice());
        }
        for (out, g) in out[3..].iter_mut().zip(&row.wheels) {
            *out = *g;
        }
        if let Some(clock) = state.drift.clock {
            out[clock] = -row.momentum.dot(&state.drift.taken[1]);
        }
    }

    /// Adds the curvature of `p . (eta - drift)` in attitude and clock to a Hessian.
    pub(crate) fn add_momentum_curvature(
        &self,
        p: &Vector3<f64>,
        state: &StateView<'_>,
        out: &mut LinkModel,
    ) {
        if self.dynamics.has_momentum() {
            let curvature = double_cross_curvature(p, &state.momentum);
            add_attitude_block(out, &(curvature * self.scales.angle.powi(2)));
        }
        if let Some(clock) = state.drift.clock {
            out.hessian[clock * out.vars + clock] -= p.dot(&state.drift.taken[2]);
        }
    }

    /// Value of the norm limit `(1 - reserve)^2 - |w|^2 / limit^2`.
    pub(super) fn norm_margin(&self, state: &StateView<'_>, reserve: f64) -> f64 {
        let squares: f64 = self.rates.iter().map(|w| w.value(state).powi(2)).sum();
        (1.0 - reserve).powi(2) - squares / self.dynamics.max_rate_norm.powi(2)
    }

    /// Writes the norm limit's derivative and adds its curvature times `-z`, except the curvature
    /// of the rates, which is returned as a covector on the momentum. `states` is the number of
    /// directions.
    pub(super) fn write_norm_row(
        &self,
        state: &StateView<'_>,
        z: f64,
        row: &mut [f64],
        hessian: &mut [f64],
        (states, stride): (usize, usize),
    ) -> Vector3<f64> {
        let scale = self.dynamics.max_rate_norm.powi(2).recip();
        let mut pull = Vector3::zeros();
        let mut gradient = [0.0; MAX_STATES];
        for component in &self.rates {
            let rate = component.value(state);
            self.write_row(component, state, &mut gradient[..states]);
            for j in 0..states {
                row[j] -= 2.0 * scale * rate * gradient[j];
            }
            for a in 0..states {
                for b in 0..=a {
                    hessian[a * stride + b] += 2.0 * z * scale * gradient[a] * gradient[b];
                }
            }
            pull += component.momentum * (2.0 * scale * z * rate);
        }
        pull
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
