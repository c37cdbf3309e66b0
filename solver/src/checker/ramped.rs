//! Flights whose torques are linear in time, with wheels that follow laws of their own.
//!
//! What a tour never has: the commands of a single slew may be held linearly, some wheels may
//! return to a speed by themselves, and friction may take its share of a motor's torque.

use super::dynamics::{Body, Snapshot};
use super::integrator::{Interval, STEP_TOLERANCE, Step, fly};
use super::limits::Limits;
use super::state;
use crate::model::drive::Drive;
use crate::model::plan::State;
use crate::model::scenario::Scenario;

/// Torques that change at a constant rate for a while.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ramp {
    /// Begin, s.
    pub(crate) start_s: f64,
    /// Length, s.
    pub(crate) duration_s: f64,
    /// Commanded torque on each wheel at the begin, N m.
    pub(crate) begin_nm: Vec<f64>,
    /// The same at the end.
    pub(crate) end_nm: Vec<f64>,
}

/// What a flight of ramps turned out to be.
#[derive(Debug, Clone)]
pub(crate) struct RampedFlight {
    /// States at the begin of every ramp that takes time, and at the end.
    pub(crate) states: Vec<State>,
    /// Largest share of its limit that a motor torque has.
    pub(crate) torque_usage: f64,
    /// Largest share of an allowed wheel speed, when any is limited.
    pub(crate) wheel_usage: Option<f64>,
    /// Largest share of a body rate limit, when any is set.
    pub(crate) rate_usage: Option<f64>,
    /// Largest relative change of the total momentum: a measure of the integration.
    pub(crate) momentum_drift: f64,
    /// What is wrong with wheel speeds and rates, in sentences.
    pub(crate) failures: Vec<String>,
}

/// A short while of the flight: torques and speeds as functions of the time since its begin.
pub(crate) struct Moment<'a> {
    step: &'a Step<'a>,
    since: f64,
    /// Length, s.
    pub(crate) length_s: f64,
}

impl Moment<'_> {
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
}

/// Integrates ramps from the scenario's start and shows the flight moment by moment; `drives` are
/// those of all wheels.
///
/// # Errors
///
/// Sentences about what keeps the flight from being flown.
pub(crate) fn propagate_ramps(
    scenario: &Scenario,
    drives: &[Drive],
    ramps: &[Ramp],
    mut observe: impl FnMut(&Moment<'_>),
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
        .map(|(ramp, slope)| Interval {
            begin_s: ramp.start_s,
            end_s: ramp.start_s + ramp.duration_s,
            torque: &ramp.begin_nm,
            slope,
        })
        .collect();
    let mut limits = Limits::new(scenario);
    let mut torque_usage = 0.0_f64;
    let authority = scenario.options().torque_authority;
    let mut last = Snapshot::at_start(scenario);
    let mut states: Vec<State> = state(&last).into_iter().collect();
    let flown = fly(&body, last.clone(), &intervals, STEP_TOLERANCE, |step| {
        limits.observe(step);
        for pair in step.grid.windows(2) {
            let moment = Moment {
                step,
                since: pair[0],
                length_s: pair[1] - pair[0],
            };
            observe(&moment);
            for (index, wheel) in spacecraft.enabled_wheels() {
                for s in [0.0, moment.length_s] {
                    let (torque, speed) = (moment.torque(index, s), moment.speed(index, s));
                    let motor = drives[index].motor_torque(torque, speed);
                    let limit = if motor < 0.0 {
                        wheel.min_torque
                    } else {
                        wheel.max_torque
                    };
                    torque_usage = torque_usage.max(motor / (limit * authority));
                }
            }
        }
        last = step.motion.state(step.end_s - step.begin_s);
        last.time_s = step.end_s;
        if step.end_s >= step.interval.end_s {
            states.extend(state(&last));
        }
    })?;
    Ok(RampedFlight {
        states,
        torque_usage,
        wheel_usage: limits.wheel_usage(),
        rate_usage: limits.rate_usage(),
        momentum_drift: flown.momentum_drift,
        failures: limits.failures(),
    })
}

/// Growth of the torques, N m/s.
fn slope(ramp: &Ramp) -> Vec<f64> {
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
