//! Adaptive integration over all control intervals, with a new step at the beginning of each.
//!
//! A step is a [Taylor expansion](super::series). Its length follows from the decay of the
//! coefficients. It is accepted only when the polynomials satisfy the equations of motion at its end,
//! evaluated directly by the [dynamics](super::dynamics): this tests the recurrences of the
//! coefficients in every step.

use super::NOT_COMPUTED;
use super::dynamics::{Body, Snapshot, norm, to_reference};
use super::number_format::figure;
use super::series::Expansion;
use nalgebra::Vector3;
use std::borrow::Cow;

/// Neglected terms relative to leading ones, per step. The errors of some hundred steps then add up to
/// less than 1e-12 rad, far below the tolerances of the verification.
pub(super) const STEP_TOLERANCE: f64 = 1e-15;

/// Largest relative defect of an accepted step: well above rounding, and far below the effect of a
/// wrong recurrence or an underestimated remainder.
const DEFECT_TOLERANCE: f64 = 1e-12;

/// Greatest number of steps, including rejected ones, beyond one per control interval. A day of slewing
/// at 0.04 rad/s takes about a thousand, so that only absurd torques reach the limit.
const MAX_EXTRA_STEPS: usize = 200_000;

/// Points per full-length step at which slopes are compared. A full step spans about three
/// radians of the fastest oscillation, so that two extrema cannot hide between two points.
const GRID: f64 = 16.0;

/// Torques from one time to another, s.
#[derive(Debug, Clone, Copy)]
pub(super) struct TorqueSpan<'a> {
    pub(super) begin_s: f64,
    pub(super) end_s: f64,
    /// At the beginning, N m.
    pub(super) torque: &'a [f64],
    /// Growth, N m/s; empty for constant torques.
    pub(super) slope: &'a [f64],
}

impl TorqueSpan<'_> {
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
pub(super) struct IntegrationStep<'a> {
    /// The motion as a function of the time since the beginning of the step.
    pub(super) motion: &'a Expansion,
    /// Absolute time of the beginning, s.
    pub(super) begin_s: f64,
    /// Absolute time of the end, s.
    pub(super) end_s: f64,
    /// Times since the beginning at which quantities are evaluated, s, both ends included.
    pub(super) grid: &'a [f64],
    /// The torques of the interval to which the step belongs.
    pub(super) interval: &'a TorqueSpan<'a>,
}

/// Statistics of a complete integration.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Integration {
    /// Accepted steps.
    pub(super) steps: usize,
    /// Largest change of the total momentum in the reference frame, relative to its parts.
    pub(super) momentum_drift: f64,
}

/// Integrates from a state over the intervals and calls `observe` with every accepted step.
///
/// # Errors
///
/// A sentence, when the step budget is used up or a number is no longer finite.
pub(super) fn integrate(
    body: &Body,
    start: Snapshot,
    intervals: &[TorqueSpan<'_>],
    tolerance: f64,
    mut observe: impl FnMut(&IntegrationStep<'_>),
) -> Result<Integration, String> {
    let mut state = start;
    let mut budget = MAX_EXTRA_STEPS;
    let mut ledger = Ledger::open(body, &state);
    let mut grid = Vec::new();
    for interval in intervals {
        budget += 1;
        state.time_s = interval.begin_s;
        while state.time_s < interval.end_s {
            let torque = interval.torque_at(state.time_s);
            let motion = Expansion::about(body, &state, &torque, interval.slope);
            let full = motion.step_length(tolerance);
            let length = accept(body, &motion, full, interval, state.time_s, &mut budget)?;
            let remaining = interval.end_s - state.time_s;
            let end_s = if length < remaining {
                state.time_s + length
            } else {
                interval.end_s
            };
            fill_grid(&mut grid, length, full);
            observe(&IntegrationStep {
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

/// The length, s, of the step that begins at `now`, s: at most `full`, and halved until the defect is
/// within its tolerance.
fn accept(
    body: &Body,
    motion: &Expansion,
    full: f64,
    interval: &TorqueSpan<'_>,
    now: f64,
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

/// Fills the grid with equal parts of a step; their number is in proportion to its length relative to
/// the `full` one.
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

/// Change of the conserved momentum along the integration.
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

    fn close(self) -> Integration {
        // Very large numbers overflow: a drift that cannot be computed must not pass.
        let momentum_drift = match self.drift / self.scale {
            _ if self.drift == 0.0 => 0.0,
            ratio if ratio.is_finite() => ratio,
            _ => NOT_COMPUTED,
        };
        Integration {
            steps: self.steps,
            momentum_drift,
        }
    }
}
