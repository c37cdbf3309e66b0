//! Taylor expansion of the motion under wheel torques that are constant or linear in time.
//!
//! The right-hand sides of the [dynamics](super::dynamics) are products of at most two unknowns,
//! so the coefficients of any order follow from Cauchy products of the lower ones. The truncated
//! series is both the integration step and an interpolation of the same accuracy, in which peaks
//! between two steps can be found.

use super::dynamics::{Body, QuaternionComponents, Snapshot, norm, quaternion_derivative};
use nalgebra::Vector3;

/// Degree of the series. In double precision the work per unit of time is least at about 20; a step then
/// covers about three radians of the fastest oscillation.
pub(super) const ORDER: usize = 20;
const LEN: usize = ORDER + 1;

/// Number of last coefficients that determine the step length: of symmetric motions every second
/// coefficient or more vanishes.
const TAIL: usize = 4;

/// The motion as polynomials in the time since the beginning of the step, s.
#[derive(Debug, Clone)]
pub(super) struct Expansion {
    quaternion: [QuaternionComponents; LEN],
    rate: [Vector3<f64>; LEN],
    wheel: Vec<[f64; LEN]>,
}

impl Expansion {
    /// Expands the motion about a state under motor torques: those at the state, N m, and their
    /// growth, N m/s, empty when they are constant.
    pub(super) fn about(body: &Body, state: &Snapshot, torque: &[f64], growth: &[f64]) -> Self {
        let mut series = Self {
            quaternion: [[0.0; 4]; LEN],
            rate: [Vector3::zeros(); LEN],
            wheel: vec![[0.0; LEN]; body.rotors.len()],
        };
        series.quaternion[0] = state.quaternion;
        series.rate[0] = state.rate;
        for (wheel, speed) in series.wheel.iter_mut().zip(&state.wheel_speed) {
            wheel[0] = *speed;
        }
        let mut momentum = [Vector3::zeros(); LEN];
        for k in 0..ORDER {
            momentum[k] = series.momentum_coefficient(body, k);
            series.append(body, torque, growth, &momentum, k);
        }
        series
    }

    fn momentum_coefficient(&self, body: &Body, k: usize) -> Vector3<f64> {
        let mut momentum = body.inertia * self.rate[k];
        for (rotor, wheel) in body.rotors.iter().zip(&self.wheel) {
            momentum += rotor.axis * (rotor.inertia * wheel[k]);
        }
        momentum
    }

    /// Coefficients of order `k + 1` from those up to `k`.
    fn append(
        &mut self,
        body: &Body,
        torque: &[f64],
        growth: &[f64],
        momentum: &[Vector3<f64>; LEN],
        k: usize,
    ) {
        let mut moment = Vector3::zeros();
        let mut turn = [0.0; 4];
        for j in 0..=k {
            moment -= self.rate[j].cross(&momentum[k - j]);
            let part = quaternion_derivative(&self.quaternion[j], &self.rate[k - j]);
            turn.iter_mut().zip(part).for_each(|(sum, c)| *sum += c);
        }
        let driven: &[f64] = match k {
            0 => torque,
            1 => growth,
            _ => &[],
        };
        moment += body.motor_torque(driven);
        for (i, rotor) in body.rotors.iter().enumerate() {
            if let Some((rate, speed)) = rotor.law {
                let held = if k == 0 { speed } else { 0.0 };
                let acceleration = -rate * (self.wheel[i][k] - held);
                moment -= rotor.axis * (rotor.inertia * acceleration);
                self.wheel[i][k + 1] = acceleration / (k + 1) as f64;
            }
        }
        let next = (k + 1) as f64;
        self.rate[k + 1] = body.effective_inverse * moment / next;
        self.quaternion[k + 1] = turn.map(|c| c / next);
        for (i, rotor) in body.rotors.iter().enumerate().filter(|(_, r)| r.driven) {
            let drive = driven.get(i).map_or(0.0, |u| u / rotor.inertia);
            self.wheel[i][k + 1] = drive / next - rotor.axis.dot(&self.rate[k + 1]);
        }
    }

    /// The longest step, s, whose first neglected terms are below `tolerance` relative to the
    /// leading ones; infinite when nothing moves.
    pub(super) fn step_length(&self, tolerance: f64) -> f64 {
        // Wheel speeds are not tested: beyond the linear term they are combinations of the body rate.
        let quaternion = longest(&self.quaternion.map(|c| norm(&c)), tolerance);
        let rate = longest(&self.rate.map(|c| c.norm()), tolerance);
        quaternion.min(rate)
    }

    /// Defect of the polynomials in the equations of motion at time `s` into the step, multiplied by `s`
    /// and relative to the size of the terms.
    pub(super) fn defect(&self, body: &Body, torque: &[f64], s: f64) -> f64 {
        let state = self.state(s);
        let rate_derivative = body.rate_derivative(&state, torque);
        let turn = quaternion_derivative(&state.quaternion, &state.rate);
        let turn_defect: QuaternionComponents =
            std::array::from_fn(|c| slope(s, |k| self.quaternion[k][c]) - turn[c]);
        // Torques that cancel each other leave rounding errors, so that the scale includes their size.
        let push: f64 = body
            .rotors
            .iter()
            .zip(torque)
            .map(|(rotor, u)| (body.effective_inverse * rotor.axis * *u).norm())
            .sum();
        let rate_scale = value(s, |k| self.rate[k].norm()) + push * s;
        let rate_defect = (self.rate_slope(s) - rate_derivative).norm();
        let mut worst = (norm(&turn_defect) * s).max(ratio(rate_defect * s, rate_scale));
        for (i, wheel) in self.wheel.iter().enumerate() {
            let expected =
                body.wheel_derivative(i, torque[i], state.wheel_speed[i], &rate_derivative);
            let drive = (torque[i] / body.rotors[i].inertia).abs() * s;
            let scale = value(s, |k| wheel[k].abs()) + drive;
            worst = worst.max(ratio((self.wheel_slope(i, s) - expected).abs() * s, scale));
        }
        // `max` drops NaN, which must not pass for accuracy.
        if state.is_finite() {
            worst
        } else {
            f64::INFINITY
        }
    }

    /// The state at time `s` into the step; its own time is left at `s`.
    pub(super) fn state(&self, s: f64) -> Snapshot {
        Snapshot {
            time_s: s,
            quaternion: self.quaternion(s),
            rate: self.rate(s),
            wheel_speed: (0..self.wheel.len())
                .map(|i| self.wheel_speed(i, s))
                .collect(),
        }
    }

    /// The quaternion at time `s` into the step.
    pub(super) fn quaternion(&self, s: f64) -> QuaternionComponents {
        std::array::from_fn(|c| value(s, |k| self.quaternion[k][c]))
    }

    /// The body rate at time `s` into the step, rad/s.
    pub(super) fn rate(&self, s: f64) -> Vector3<f64> {
        self.rate
            .iter()
            .rev()
            .fold(Vector3::zeros(), |sum, c| sum * s + c)
    }

    /// One component of the body rate at time `s` into the step, rad/s.
    pub(super) fn rate_component(&self, axis: usize, s: f64) -> f64 {
        value(s, |k| self.rate[k][axis])
    }

    /// Derivative of one component of the body rate, rad/s².
    pub(super) fn rate_component_slope(&self, axis: usize, s: f64) -> f64 {
        slope(s, |k| self.rate[k][axis])
    }

    /// Derivative of the body rate at time `s` into the step, rad/s².
    pub(super) fn rate_slope(&self, s: f64) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.rate_component_slope(axis, s))
    }

    /// Speed of a wheel at time `s` into the step, rad/s.
    pub(super) fn wheel_speed(&self, wheel: usize, s: f64) -> f64 {
        value(s, |k| self.wheel[wheel][k])
    }

    /// Derivative of a wheel's speed at time `s` into the step, rad/s².
    pub(super) fn wheel_slope(&self, wheel: usize, s: f64) -> f64 {
        slope(s, |k| self.wheel[wheel][k])
    }
}

/// Horner's scheme.
fn value(s: f64, coefficient: impl Fn(usize) -> f64) -> f64 {
    (0..LEN).rev().fold(0.0, |sum, k| sum * s + coefficient(k))
}

/// Horner's scheme for the derivative.
fn slope(s: f64, coefficient: impl Fn(usize) -> f64) -> f64 {
    (1..LEN)
        .rev()
        .fold(0.0, |sum, k| sum * s + k as f64 * coefficient(k))
}

fn ratio(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// The longest step for which every tail term is below `tolerance` times the largest of the
/// first three terms.
fn longest(size: &[f64; LEN], tolerance: f64) -> f64 {
    // Logarithms, because powers of very short or very long times overflow.
    let leading: [f64; 3] = std::array::from_fn(|j| tolerance.ln() + size[j].ln());
    let mut shortest = f64::INFINITY;
    for k in LEN - TAIL..LEN {
        if size[k] == 0.0 {
            continue;
        }
        let last = size[k].ln();
        let against = |j: usize| (leading[j] - last) / (k - j) as f64;
        shortest = shortest.min((0..3).map(against).fold(f64::NEG_INFINITY, f64::max));
    }
    shortest.exp()
}

#[cfg(test)]
mod tests;
