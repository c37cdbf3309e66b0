//! Integration of torques that are linear in time, with wheels under speed laws and with friction.
//!
//! Tours have constant torques and ideal drives; the commands of a single slew may be linear in time,
//! some of its wheels may follow a speed law, and motors may compensate friction.

use super::cones::ConeObservers;
use super::dynamics::{Body, Snapshot};
use super::integrator::{IntegrationStep, STEP_TOLERANCE, TorqueSpan, integrate};
use super::limits::LimitObserver;
use super::state;
use crate::model::drive::Drive;
use crate::model::plan::{ConeClearance, Intrusion, State};
use crate::model::problem::Problem;
use crate::model::scenario::Scenario;

/// Torques that change linearly over a time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TorqueRamp {
    /// Time at the beginning, s.
    pub(crate) start_s: f64,
    /// Length, s.
    pub(crate) duration_s: f64,
    /// Commanded torque of each wheel at the beginning, N m.
    pub(crate) begin_nm: Vec<f64>,
    /// The same at the end.
    pub(crate) end_nm: Vec<f64>,
}

/// The result of propagating ramps.
#[derive(Debug, Clone)]
pub(crate) struct RampedFlight {
    /// States at the beginning of every ramp of positive duration, and at the end.
    pub(crate) states: Vec<State>,
    /// Largest motor torque as a share of its limit.
    pub(crate) torque_usage: f64,
    /// Largest share of an allowed wheel speed, when any is limited.
    pub(crate) wheel_usage: Option<f64>,
    /// Largest share of a body rate limit, when any is set.
    pub(crate) rate_usage: Option<f64>,
    /// Largest relative change of the total momentum: a measure of the integration.
    pub(crate) momentum_drift: f64,
    /// Closest approach to every cone.
    pub(crate) clearances: Vec<ConeClearance>,
    /// Times on the wrong side of cones.
    pub(crate) intrusions: Vec<Intrusion>,
    /// Warnings about cones that are only reported.
    pub(crate) warnings: Vec<Problem>,
    /// Sentences about exceeded limits of wheel speeds and rates, and about enforced cones.
    pub(crate) failures: Vec<String>,
}

/// A part of an integration step: torques and speeds as functions of the time since its beginning.
pub(crate) struct StepPart<'a> {
    step: &'a IntegrationStep<'a>,
    since: f64,
    /// Length, s.
    pub(crate) length_s: f64,
}

impl StepPart<'_> {
    /// Commanded torque on a wheel, N m.
    pub(crate) fn torque(&self, wheel: usize, s: f64) -> f64 {
        let interval = self.step.interval;
        let time = self.step.begin_s + self.since + s - interval.begin_s;
        interval.torque[wheel] + interval.slope[wheel] * time
    }

    /// Speed of a wheel relative to the body, rad/s.
    pub(crate) fn speed(&self, wheel: usize, s: f64) -> f64 {
        self.step.motion.wheel_speed(wheel, self.since + s)
    }

    /// Largest motor torque at both ends as a share of the allowed one; 0 without driven wheels.
    fn torque_usage(&self, scenario: &Scenario, drives: &[Drive]) -> f64 {
        let authority = scenario.options().torque_authority;
        let mut usage = 0.0_f64;
        for (index, wheel) in scenario.spacecraft().enabled_wheels() {
            for s in [0.0, self.length_s] {
                let (torque, speed) = (self.torque(index, s), self.speed(index, s));
                let motor = drives[index].motor_torque(torque, speed);
                let limit = if motor < 0.0 {
                    wheel.min_torque
                } else {
                    wheel.max_torque
                };
                usage = usage.max(motor / (limit * authority));
            }
        }
        usage
    }
}

/// Integrates ramps from the scenario's start and calls `observe` with every part of every step;
/// `drives` are those of all wheels.
///
/// # Errors
///
/// A sentence about why the ramps cannot be propagated.
pub(crate) fn propagate_ramps(
    scenario: &Scenario,
    drives: &[Drive],
    ramps: &[TorqueRamp],
    mut observe: impl FnMut(&StepPart<'_>),
) -> Result<RampedFlight, String> {
    let spacecraft = scenario.spacecraft();
    let mut body = Body::new(spacecraft.inertia(), spacecraft.wheels())?;
    for (rotor, drive) in body.rotors.iter_mut().zip(drives) {
        rotor.law = drive.speed_law.map(|law| (law.rate, law.speed));
    }
    let slopes: Vec<Vec<f64>> = ramps.iter().map(slope).collect();
    let intervals: Vec<_> = ramps
        .iter()
        .zip(&slopes)
        .map(|(ramp, slope)| TorqueSpan {
            begin_s: ramp.start_s,
            end_s: ramp.start_s + ramp.duration_s,
            torque: &ramp.begin_nm,
            slope,
        })
        .collect();
    let mut limits = LimitObserver::new(scenario);
    let mut torque_usage = 0.0_f64;
    let mut last = Snapshot::at_start(scenario);
    // A flight of ramps stays at no target.
    let mut cones = ConeObservers::new(scenario.cones(), &[], &last.quaternion);
    let mut states: Vec<State> = state(&last).into_iter().collect();
    let integration = integrate(&body, last.clone(), &intervals, STEP_TOLERANCE, |step| {
        limits.observe(step);
        cones.observe(step);
        for pair in step.grid.windows(2) {
            let part = StepPart {
                step,
                since: pair[0],
                length_s: pair[1] - pair[0],
            };
            observe(&part);
            torque_usage = torque_usage.max(part.torque_usage(scenario, drives));
        }
        last = step.motion.state(step.end_s - step.begin_s);
        last.time_s = step.end_s;
        if step.end_s >= step.interval.end_s {
            states.extend(state(&last));
        }
    })?;
    let cones = cones.finish();
    let mut failures = limits.failures();
    failures.extend(cones.failures);
    Ok(RampedFlight {
        states,
        clearances: cones.clearances,
        intrusions: cones.intrusions,
        warnings: cones.warnings,
        torque_usage,
        wheel_usage: limits.wheel_usage(),
        rate_usage: limits.rate_usage(),
        momentum_drift: integration.momentum_drift,
        failures,
    })
}

/// Rate of change of the torques, N m/s.
fn slope(ramp: &TorqueRamp) -> Vec<f64> {
    let pairs = ramp.begin_nm.iter().zip(&ramp.end_nm);
    pairs
        .map(|(begin, end)| {
            let grown = end - begin;
            if grown == 0.0 {
                0.0
            } else {
                grown / ramp.duration_s
            }
        })
        .collect()
}
