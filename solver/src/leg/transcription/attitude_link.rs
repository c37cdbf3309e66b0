//! The attitude link of an interval, with derivatives.
//!
//! With `r = q_{k+1}* q_k`, a step `d` of `q_k` entering as `(d / 2, 1 - |d|^2 / 8)` and the turn
//! `p(z)`, the gap is `2 vec(r (x) d (x) p)`. Weighted by a covector `l` the product is bilinear in
//! `d` and `p`, with `mu = r* (x) [2 l, 0]`:
//!
//! ```text
//!   2 l . vec(r d p) = mu . (d (x) p)
//! ```

mod momentum;
mod without_momentum;

use super::rows::add_attitude_block;
use super::{Transcription, quaternion_of};
use crate::leg::kinematics::{TurnDerivatives, TurnInputs};
use crate::math::quaternion::{Quat, conjugate, dot4, imaginary, product, quat, rotate_back};
use crate::nlp::{Chain, Link, LinkModel};
use nalgebra::{Matrix3, Vector3};

/// The terms of one link's derivatives.
pub(super) struct LinkTerms<'a> {
    /// Length of the interval.
    pub(super) tau: f64,
    /// Minus the rate that the wheels make, at the beginning and at the end, per unit of time.
    pub(super) begin: Vector3<f64>,
    pub(super) end: Vector3<f64>,
    /// `ts R(q)^T H`.
    pub(super) momentum: Vector3<f64>,
    /// Slopes of the gap, three numbers, by the turn's inputs.
    slopes: [Matrix3<f64>; 3],
    /// Mixed second derivatives: rows an attitude step, columns an input.
    mixed: [Matrix3<f64>; 3],
    /// Gradient of the weighted turn by its inputs.
    gradient: [Vector3<f64>; 3],
    /// Slopes of the rate in the middle by the turn's inputs.
    pub(super) middle: [Matrix3<f64>; 3],
    /// That rate, where its norm is limited.
    pub(super) middle_rate: Vector3<f64>,
    turn: &'a TurnDerivatives,
}

impl Transcription {
    pub(super) fn turn_inputs(&self, link: &Link<'_>) -> TurnInputs {
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

    /// The gap in the attitude.
    pub(crate) fn attitude_gap(&self, link: &Link<'_>) -> Vector3<f64> {
        let turn = product(
            &self.turn_map.turn(&self.turn_inputs(link)),
            &self.corrections[link.node],
        );
        let relative = relative_attitude(link);
        chart(&product(&relative, &turn)) / self.scales.angle
    }

    /// Writes the gap of a link: attitude, then wheel momenta.
    pub(super) fn write_gap(&self, link: &Link<'_>, gap: &mut [f64]) {
        let (attitude, wheels) = gap.split_at_mut(3);
        attitude.copy_from_slice(self.attitude_gap(link).as_slice());
        let (begin, end) = (link.point[4..].iter(), link.next[4..].iter());
        for (((gap, h), m), next) in wheels.iter_mut().zip(begin).zip(link.control).zip(end) {
            *gap = h + m - next;
        }
    }

    /// Writes the attitude rows of the link Jacobian and the link's share of the Hessian.
    ///
    /// `first` is the first of the rows of the rates in the middle, if they are to be written too.
    pub(crate) fn write_attitude_link(
        &self,
        link: &Link<'_>,
        lambda: &[f64],
        (first, z): (usize, &[f64]),
        out: &mut LinkModel,
    ) {
        if self.writes_closed_form(link, lambda, out) {
            return;
        }
        let angle = self.scales.angle;
        let relative = relative_attitude(link);
        let covector = Vector3::new(lambda[0], lambda[1], lambda[2]) * (2.0 / angle);
        let mu = product(&conjugate(&relative), &quat(&covector, 0.0));
        let rate = if self.bends_in_the_middle() {
            self.middle_rate(link)
        } else {
            Vector3::zeros()
        };
        let pull = self.middle_pull(&rate, z);
        let turn = self.corrected_turn(link, &mu, &pull);
        let mut terms = self.terms(link, &relative, (&mu, &pull), &turn);
        terms.middle_rate = rate;
        for column in 0..3 {
            // The unit of the step cancels the unit of the gap.
            let unit = quat(&Vector3::ith(column, 1.0), 0.0);
            let moved = imaginary(&product(&product(&relative, &unit), &turn.turn));
            for row in 0..3 {
                out.link_jacobian[row * out.vars + column] = moved[row];
            }
        }
        self.write_wheel_slopes(&terms, out);
        self.add_wheel_curvature(&terms, out);
        if self.dynamics.has_momentum() {
            self.add_momentum_terms(&terms, out);
            self.write_middle_rows(&terms, (link.node, first), z, out);
        }
        let bend = -0.25 * angle * angle * dot4(&mu, &turn.turn);
        add_attitude_block(out, &(Matrix3::identity() * bend));
    }

    fn terms<'a>(
        &self,
        link: &Link<'_>,
        relative: &Quat,
        (mu, pull): (&Quat, &Vector3<f64>),
        turn: &'a TurnDerivatives,
    ) -> LinkTerms<'a> {
        let factor = 2.0 / self.scales.angle;
        let half_units: [Quat; 3] = std::array::from_fn(|axis| {
            product(
                &quat(&Vector3::ith(axis, -0.5 * self.scales.angle), 0.0),
                mu,
            )
        });
        let mut terms = LinkTerms {
            tau: link.control[self.wheels()],
            begin: self.wheel_rate(&link.point[4..]),
            end: Vector3::zeros(),
            momentum: Vector3::zeros(),
            slopes: [Matrix3::zeros(); 3],
            mixed: [Matrix3::zeros(); 3],
            gradient: [Vector3::zeros(); 3],
            middle: [Matrix3::zeros(); 3],
            middle_rate: Vector3::zeros(),
            turn,
        };
        terms.end = terms.begin;
        for (gain, m) in self.rate_gain.iter().zip(link.control) {
            terms.end += gain * *m;
        }
        if self.dynamics.has_momentum() {
            terms.momentum = self.scaled_momentum(link.point);
        }
        for (j, first) in turn.first.iter().take(self.turn_map.inputs()).enumerate() {
            let (input, axis) = (j / 3, j % 3);
            let slope = imaginary(&product(relative, first)) * factor;
            terms.slopes[input].set_column(axis, &slope);
            for row in 0..3 {
                terms.mixed[input][(row, axis)] = dot4(&half_units[row], first);
            }
            let middle = &turn.middle[j];
            terms.middle[input].set_column(axis, middle);
            terms.gradient[input][axis] = dot4(mu, first) + middle.dot(pull);
        }
        terms
    }

    /// The turn with its correction `e` and derivatives; `mu . (d p e) = (mu e*) . (d p)`.
    fn corrected_turn(&self, link: &Link<'_>, mu: &Quat, pull: &Vector3<f64>) -> TurnDerivatives {
        let correction = &self.corrections[link.node];
        let pulled = product(mu, &conjugate(correction));
        let inputs = self.turn_inputs(link);
        let mut turn = self.turn_map.derivatives(&inputs, &pulled, pull);
        turn.turn = product(&turn.turn, correction);
        for first in turn.first.iter_mut().take(self.turn_map.inputs()) {
            *first = product(first, correction);
        }
        turn
    }

    /// Derivatives of the gap by wheel momenta, their changes and the length: `a = -tau b`,
    /// `c = -tau e` with the wheels' rates `b = offset + gain h` and `e = b + gain m`.
    fn write_wheel_slopes(&self, terms: &LinkTerms<'_>, out: &mut LinkModel) {
        let (controls, vars) = (self.state_dim(), out.vars);
        let [by_begin, by_end, _] = terms.slopes;
        let by_both = by_begin + by_end;
        for (i, gain) in self.rate_gain.iter().enumerate() {
            let by_start = by_both * gain * -terms.tau;
            let by_change = by_end * gain * -terms.tau;
            for row in 0..3 {
                out.link_jacobian[row * vars + 3 + i] = by_start[row];
                out.link_jacobian[row * vars + controls + i] = by_change[row];
            }
        }
        let by_length = by_begin * terms.begin + by_end * terms.end;
        for row in 0..3 {
            out.link_jacobian[row * vars + controls + self.wheels()] = -by_length[row];
        }
    }

    /// Second derivatives by the same variables and attitude steps.
    fn add_wheel_curvature(&self, terms: &LinkTerms<'_>, out: &mut LinkModel) {
        let (controls, vars, tau) = (self.state_dim(), out.vars, terms.tau);
        let length = controls + self.wheels();
        let [aa, ac, cc] = [(0, 0), (0, 1), (1, 1)].map(|(i, j)| terms.block(i, j));
        let (with_end, [mixed_begin, mixed_end, _]) = (ac.transpose() + cc, terms.mixed);
        let (both, mixed_both) = (aa + ac + with_end, mixed_begin + mixed_end);
        // Of a change of length, as the slopes of (a, c) along (b, e).
        let along_end = ac.tr_mul(&terms.begin) + cc * terms.end;
        let along_both = aa * terms.begin + ac * terms.end + along_end;
        let [by_begin, by_end, _] = terms.gradient;
        let (length_h, length_m) = (
            along_both * tau - by_begin - by_end,
            along_end * tau - by_end,
        );
        let length_row = length * vars;
        for (i, gain) in self.rate_gain.iter().enumerate() {
            let (h_row, m_row) = ((3 + i) * vars, (controls + i) * vars);
            let weighted = gain * (tau * tau);
            let (hh, mh, mm) = (both * weighted, with_end.tr_mul(&weighted), cc * weighted);
            for (j, other) in self.rate_gain.iter().enumerate() {
                if j <= i {
                    out.hessian[h_row + 3 + j] += hh.dot(other);
                    out.hessian[m_row + controls + j] += mm.dot(other);
                }
                out.hessian[m_row + 3 + j] += mh.dot(other);
            }
            let (h_mixed, m_mixed) = (mixed_both * gain * -tau, mixed_end * gain * -tau);
            for axis in 0..3 {
                out.hessian[h_row + axis] += h_mixed[axis];
                out.hessian[m_row + axis] += m_mixed[axis];
            }
            out.hessian[length_row + 3 + i] += length_h.dot(gain);
            out.hessian[length_row + controls + i] += length_m.dot(gain);
        }
        let mixed = mixed_begin * terms.begin + mixed_end * terms.end;
        for axis in 0..3 {
            out.hessian[length_row + axis] -= mixed[axis];
        }
        let along = terms.begin.dot(&(along_both - along_end)) + terms.end.dot(&along_end);
        out.hessian[length_row + length] += along;
    }
}

impl LinkTerms<'_> {
    /// Second derivatives of the weighted turn by two of its inputs, three components each.
    fn block(&self, row: usize, column: usize) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.turn.second[3 * row + i][3 * column + j])
    }
}

/// The chart `2 vec(q)` of the hemisphere around the identity. Beyond it the vector part shrinks
/// again towards `-1`, which would look like no error at all: there the chart is NaN, so that the
/// line search stays inside the hemisphere.
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
