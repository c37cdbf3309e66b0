//! Adaptive integration over all control intervals, restarted at each of them.
//!
//! A step is a [Taylor expansion](super::series). Its length follows from the decay of the
//! coefficients, and it is accepted only when the polynomials satisfy the equations of motion at
//! its end, as evaluated by the plain [dynamics](super::dynamics): the recurrences that make the
//! coefficients are thereby tested in every step.

use super::NOT_COMPUTED;
use super::dynamics::{Body, Snapshot, norm, to_reference};
use super::number_format::figure;
use super::series::Expansion;
use nalgebra::Vector3;
use std::borrow::Cow;

/// Neglected terms relative to leading ones, per step. A few hundred steps then add up to less
/// than 1e-12 rad, a hundredth of what the verification needs at most.
pub(super) const STEP_TOLERANCE: f64 = 1e-15;

/// Largest relative defect of an accepted step: well above rounding, and far below the error of
/// a wrong recurrence or an underestimated tail.
const DEFECT_TOLERANCE: f64 = 1e-12;

/// Steps, rejected ones included, beyond one per control interval. A day of slewing at
/// 0.04 rad/s takes about a thousand, so that only absurd torques come here.
const MAX_EXTRA_STEPS: usize = 200_000;

/// Points per full-length step at which slopes are compared. A full step spans about three
/// radians of the fastest oscillation, so that two extrema cannot hide between two points.
const GRID: f64 = 16.0;

/// Torques from one moment to another, s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interval<'a> {
    pub(super) begin_s: f64,
    pub(super) end_s: f64,
    /// At the beginning, N m.
    pub(super) torque: &'a [f64],
    /// Growth, N m/s; empty for constant torques.
    pub(super) slope: &'a [f64],
}

impl Interval<'_> {
    /// The torques at a time, N m.
    pub(super) fn torque_at(&self, time_s: f64) -> Cow<'_, [f64]> {
        if self.slope.is_empty() {
            return Cow::Borrowed(self.torque);
        }
        let since = time_s - self.begin_s;
        let pairs = self.torque.iter().zip(self.slope);
        Cow::Owned(pairs.map(|(u, slope)| u + slope * since).collect())
    }
}

/// An accepted step.
#[derive(Debug)]
pub(super) struct Step<'a> {
    /// The motion in the time since the begin of the step.
    pub(super) motion: &'a Expansion,
    /// Absolute begin, s.
    pub(super) begin_s: f64,
    /// Absolute end, s.
    pub(super) end_s: f64,
    /// Times since the begin at which to look, s, both ends included.
    pub(super) grid: &'a [f64],
    /// The torques of the interval to which the step belongs.
    pub(super) interval: &'a Interval<'a>,
}

/// What is known after the flight.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Propagation {
    /// Accepted steps.
    pub(super) steps: usize,
    /// Largest change of the total momentum in the reference frame, relative to its parts.
    pub(super) momentum_drift: f64,
}

/// Integrates from a state over the intervals and shows every accepted step to `observe`.
///
/// # Errors
///
/// A sentence, when the step budget is used up or a number is no longer finite.
pub(super) fn fly(
    body: &Body,
    start: Snapshot,
    intervals: &[Interval<'_>],
    tolerance: f64,
    mut observe: impl FnMut(&Step<'_>),
) -> Result<Propagation, String> {
    let mut state = start;
    let mut budget = MAX_EXTRA_STEPS;
    let mut ledger = Ledger::open(body, &state);
    let mut grid = Vec::new();
    for interval in intervals {
        budget += 1;
        state.time_s = interval.begin_s;
        while state.time_s < interval.end_s {
            let torque = interval.torque_at(state.time_s);
            let motion = Expansion::about(body, &state, (&torque, interval.slope));
            let full = motion.step_length(tolerance);
            let length = accept(body, &motion, (full, interval, state.time_s), &mut budget)?;
            let remaining = interval.end_s - state.time_s;
            let end_s = if length < remaining {
                state.time_s + length
            } else {
                interval.end_s
            };
            fill_grid(&mut grid, length, full);
            observe(&Step {
                motion: &motion,
                begin_s: state.time_s,
                end_s,
                grid: &grid,
                interval,
            });
            state = normalised(motion.state(length), end_s);
            ledger.enter(body, &state);
        }
    }
    Ok(ledger.close())
}

/// The length of the step that the defect allows, s.
fn accept(
    body: &Body,
    motion: &Expansion,
    (full, interval, now): (f64, &Interval<'_>, f64),
    budget: &mut usize,
) -> Result<f64, String> {
    let mut length = full.min(interval.end_s - now);
    loop {
        if *budget == 0 {
            return Err(format!(
                "the integration ran out of steps at {} s: the motion there is too fast",
                figure(now)
            ));
        }
        *budget -= 1;
        if !(length > 0.0 && now + length > now) {
            return Err(format!(
                "the integration broke down at {} s: the numbers leave the range that can be computed",
                figure(now)
            ));
        }
        if motion.defect(body, &interval.torque_at(now + length), length) <= DEFECT_TOLERANCE {
            return Ok(length);
        }
        length *= 0.5;
    }
}

/// Equal parts of a step, the finer the longer it is relative to what the series allows.
fn fill_grid(grid: &mut Vec<f64>, length: f64, full: f64) {
    let wanted = (GRID * length / full).ceil().clamp(2.0, GRID);
    grid.clear();
    let mut index = 0.0;
    while index < wanted {
        grid.push(length * (index / wanted));
        index += 1.0;
    }
    grid.push(length);
}

fn normalised(mut state: Snapshot, time_s: f64) -> Snapshot {
    let length = norm(&state.quaternion);
    state.quaternion = state.quaternion.map(|c| c / length);
    state.time_s = time_s;
    state
}

/// Book-keeping of the conserved momentum.
struct Ledger {
    initial: Vector3<f64>,
    scale: f64,
    drift: f64,
    steps: usize,
}

impl Ledger {
    fn open(body: &Body, state: &Snapshot) -> Self {
        let momentum = body.momentum(&state.rate, &state.wheel_speed);
        Self {
            initial: to_reference(&state.quaternion, &momentum),
            scale: body.momentum_scale(&state.rate, &state.wheel_speed),
            drift: 0.0,
            steps: 0,
        }
    }

    fn enter(&mut self, body: &Body, state: &Snapshot) {
        let momentum = body.momentum(&state.rate, &state.wheel_speed);
        let change = to_reference(&state.quaternion, &momentum) - self.initial;
        self.drift = self.drift.max(change.norm());
        self.scale = self
            .scale
            .max(body.momentum_scale(&state.rate, &state.wheel_speed));
        self.steps += 1;
    }

    fn close(self) -> Propagation {
        // Numbers near the largest overflow in between; what cannot be told is no success.
        let momentum_drift = match self.drift / self.scale {
            _ if self.drift == 0.0 => 0.0,
            ratio if ratio.is_finite() => ratio,
            _ => NOT_COMPUTED,
        };
        Propagation {
            steps: self.steps,
            momentum_drift,
        }
    }
}
