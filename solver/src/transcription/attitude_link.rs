//! The attitude link of an interval and the attitude rows of a node, with derivatives.
//!
//! With `r = q_{k+1}* q_k`, a step `d` of `q_k` entering as `(d / 2, 1 - |d|^2 / 8)` and the turn
//! `p(z)`, the gap is `2 vec(r (x) d (x) p)`. Weighted by a covector `l` the product is bilinear in
//! `d` and `p`, with `mu = r* (x) [2 l, 0]`:
//!
//! ```text
//!   2 l . vec(r d p) = mu . (d (x) p)
//! ```

use super::rows::{add_attitude_block, double_cross_curvature};
use super::{Transcription, quaternion_of};
use crate::kinematics::{
    INPUTS, Quat, TurnDerivatives, TurnInputs, conjugate, dot4, imaginary, product, quat,
    rotate_back,
};
use crate::nlp::{Link, LinkModel};
use nalgebra::{Matrix3, Vector3};

/// Most variables of an interval.
const MAX_VARS: usize = 32;

/// Derivatives of the turn's inputs with respect to the variables of a link.
type InputJacobian = [[f64; MAX_VARS]; INPUTS];

impl Transcription {
    fn turn_inputs(&self, link: &Link<'_>) -> TurnInputs {
        let tau = link.control[self.wheels()];
        let begin = self.wheel_rate(&link.point[4..]);
        let mut end = begin;
        for (gain, m) in self.rate_gain.iter().zip(link.control) {
            end += gain * *m;
        }
        TurnInputs {
            begin: begin * -tau,
            end: end * -tau,
            momentum: self.scaled_momentum(link.point) * tau,
        }
    }

    /// `ts R(q)^T H`.
    fn scaled_momentum(&self, point: &[f64]) -> Vector3<f64> {
        rotate_back(&quaternion_of(point), &self.dynamics.momentum) * self.scales.time
    }

    /// Writes the gap of a link: attitude, then wheel momenta.
    pub(super) fn write_gap(&self, link: &Link<'_>, gap: &mut [f64]) {
        let turn = self.turn_map.turn(&self.turn_inputs(link));
        let relative = relative_attitude(link);
        let error = chart(&product(&relative, &turn)) / self.scales.angle;
        gap[..3].copy_from_slice(error.as_slice());
        for i in 0..self.wheels() {
            gap[3 + i] = link.point[4 + i] + link.control[i] - link.next[4 + i];
        }
    }

    /// Writes the attitude rows of the link Jacobian and the link's share of the Hessian.
    pub(super) fn write_attitude_link(&self, link: &Link<'_>, lambda: &[f64], out: &mut LinkModel) {
        let angle = self.scales.angle;
        let relative = relative_attitude(link);
        let covector = Vector3::new(lambda[0], lambda[1], lambda[2]) * (2.0 / angle);
        let mu = product(&conjugate(&relative), &quat(&covector, 0.0));
        let turn = self.turn_map.derivatives(&self.turn_inputs(link), &mu);
        let inputs = self.input_jacobian(link);
        self.write_attitude_jacobian(&relative, &turn, &inputs, out);
        self.add_input_curvature(&turn, &inputs, out);
        self.add_cross_curvature(&mu, &turn, &inputs, out);
        let gradient: [f64; INPUTS] = std::array::from_fn(|j| dot4(&mu, &turn.first[j]));
        self.add_curvature_of_inputs(link, &gradient, out);
        let bend = -0.25 * angle * angle * dot4(&mu, &turn.turn);
        add_attitude_block(out, &(Matrix3::identity() * bend));
    }

    fn input_jacobian(&self, link: &Link<'_>) -> InputJacobian {
        let (wheels, tau) = (self.wheels(), link.control[self.wheels()]);
        let tau_column = 3 + 2 * wheels;
        let mut jacobian = [[0.0; MAX_VARS]; INPUTS];
        let begin = self.wheel_rate(&link.point[4..]);
        let mut end = begin;
        for (i, gain) in self.rate_gain.iter().enumerate() {
            end += gain * link.control[i];
            for axis in 0..3 {
                let slope = -tau * gain[axis];
                jacobian[axis][3 + i] = slope;
                jacobian[3 + axis][3 + i] = slope;
                jacobian[3 + axis][3 + wheels + i] = slope;
            }
        }
        for axis in 0..3 {
            jacobian[axis][tau_column] = -begin[axis];
            jacobian[3 + axis][tau_column] = -end[axis];
        }
        if self.dynamics.has_momentum() {
            let momentum = self.scaled_momentum(link.point);
            let by_attitude = momentum.cross_matrix() * (tau * self.scales.angle);
            for axis in 0..3 {
                for column in 0..3 {
                    jacobian[6 + axis][column] = by_attitude[(axis, column)];
                }
                jacobian[6 + axis][tau_column] = momentum[axis];
            }
        }
        jacobian
    }

    fn write_attitude_jacobian(
        &self,
        relative: &Quat,
        turn: &TurnDerivatives,
        inputs: &InputJacobian,
        out: &mut LinkModel,
    ) {
        let factor = 2.0 / self.scales.angle;
        let mut by_input = [Vector3::zeros(); INPUTS];
        for (column, first) in by_input.iter_mut().zip(&turn.first) {
            *column = imaginary(&product(relative, first)) * factor;
        }
        for row in 0..3 {
            let line = &mut out.link_jacobian[row * out.vars..(row + 1) * out.vars];
            for (column, weights) in by_input.iter().zip(inputs).take(self.turn_map.inputs()) {
                for (out, weight) in line.iter_mut().zip(weights) {
                    *out += column[row] * weight;
                }
            }
        }
        for column in 0..3 {
            // The unit of the step cancels the unit of the gap.
            let unit = quat(&Vector3::ith(column, 1.0), 0.0);
            let moved = imaginary(&product(&product(relative, &unit), &turn.turn));
            for row in 0..3 {
                out.link_jacobian[row * out.vars + column] += moved[row];
            }
        }
    }

    /// `Z^T (mu . d2p/dz2) Z`.
    fn add_input_curvature(
        &self,
        turn: &TurnDerivatives,
        inputs: &InputJacobian,
        out: &mut LinkModel,
    ) {
        let (n, vars) = (self.turn_map.inputs(), out.vars);
        for i in 0..n {
            let mut image = [0.0; MAX_VARS];
            for j in 0..n {
                let weight = turn.second[i][j];
                for (out, value) in image[..vars].iter_mut().zip(&inputs[j]) {
                    *out += weight * value;
                }
            }
            for a in 0..vars {
                let weight = inputs[i][a];
                if weight != 0.0 {
                    for b in 0..=a {
                        out.hessian[a * vars + b] += weight * image[b];
                    }
                }
            }
        }
    }

    /// Second derivatives that pair an attitude step with the turn's inputs.
    fn add_cross_curvature(
        &self,
        mu: &Quat,
        turn: &TurnDerivatives,
        inputs: &InputJacobian,
        out: &mut LinkModel,
    ) {
        let vars = out.vars;
        for axis in 0..3 {
            let half_unit = quat(&Vector3::ith(axis, -0.5 * self.scales.angle), 0.0);
            let covector = product(&half_unit, mu);
            for j in 0..self.turn_map.inputs() {
                let weight = dot4(&covector, &turn.first[j]);
                for (column, value) in inputs[j][..vars].iter().enumerate() {
                    let (high, low) = if column > axis {
                        (column, axis)
                    } else {
                        (axis, column)
                    };
                    let twice = if column == axis { 2.0 } else { 1.0 };
                    out.hessian[high * vars + low] += twice * weight * value;
                }
            }
        }
    }

    /// Curvature of the inputs themselves, weighted by the gradient with respect to them.
    fn add_curvature_of_inputs(
        &self,
        link: &Link<'_>,
        gradient: &[f64; INPUTS],
        out: &mut LinkModel,
    ) {
        let (wheels, vars) = (self.wheels(), out.vars);
        let tau_row = (3 + 2 * wheels) * vars;
        let part = |at: usize| Vector3::new(gradient[at], gradient[at + 1], gradient[at + 2]);
        let (begin, end) = (part(0), part(3));
        for (i, gain) in self.rate_gain.iter().enumerate() {
            out.hessian[tau_row + 3 + i] -= (begin + end).dot(gain);
            out.hessian[tau_row + 3 + wheels + i] -= end.dot(gain);
        }
        if self.dynamics.has_momentum() {
            let (angle, tau) = (self.scales.angle, link.control[wheels]);
            let momentum = self.scaled_momentum(link.point);
            let weight = part(6);
            let mixed = weight.cross(&momentum) * angle;
            for column in 0..3 {
                out.hessian[tau_row + column] += mixed[column];
            }
            let bend = double_cross_curvature(&weight, &momentum) * (tau * angle * angle);
            add_attitude_block(out, &bend);
        }
    }

    /// Rows of `2 vec(target* q) = 0`.
    pub(super) fn write_attitude_rows(
        &self,
        target: &Quat,
        point: &[f64],
        nu: &[f64],
        out: &mut LinkModel,
    ) {
        let states = 3 + self.wheels();
        let relative = product(&conjugate(target), &quaternion_of(point));
        for column in 0..3 {
            let moved = product(&relative, &quat(&Vector3::ith(column, 1.0), 0.0));
            for row in 0..3 {
                out.equality_jacobian[row * states + column] = moved[row];
            }
        }
        let weight = Vector3::new(nu[0], nu[1], nu[2]) * (2.0 / self.scales.angle);
        let bend = -0.25 * self.scales.angle.powi(2) * weight.dot(&imaginary(&relative));
        add_attitude_block(out, &(Matrix3::identity() * bend));
    }
}

/// The chart `2 vec(q)` of the hemisphere around the identity. Beyond it the vector part shrinks
/// again towards `-1`, where it would pass for no error at all: not a number there, so that the
/// line search stays on its side.
pub(super) fn chart(q: &Quat) -> Vector3<f64> {
    if q[3] > 0.0 {
        imaginary(q) * 2.0
    } else {
        Vector3::repeat(f64::NAN)
    }
}

fn relative_attitude(link: &Link<'_>) -> Quat {
    product(
        &conjugate(&quaternion_of(link.next)),
        &quaternion_of(link.point),
    )
}
