//! Independent verification: re-integrates a flight and tests every limit and boundary.
//!
//! Nothing is believed until this has flown it. The module shares no code with the optimiser and
//! repeats, on purpose, the dynamics with the full state: quaternion, body rate and all wheel
//! speeds. It looks between steps as well as at them, because a step of its integrator is a
//! polynomial whose extrema can be found.
//!
//! A flight may come from anyone. Whatever is wrong with it ends in
//! [`Verification::failures`] as sentences, never in a panic.

mod dynamics;
mod extremum;
mod integrator;
mod keep_out;
mod leg;
mod limits;
mod number_format;
mod order;
mod propagated;
mod ramped;
mod samples;
mod series;
mod timeline;
mod visits;

pub use keep_out::Intrusion;
pub(crate) use leg::{Arrival, leg_faults};
pub use propagated::PropagatedMotion;
pub(crate) use ramped::{Moment, Ramp, propagate_ramps};

use crate::model::attitude::Attitude;
use crate::model::plan::{Flight, Margins, State, Verification};
use crate::model::problem::Problem;
use crate::model::scenario::Scenario;
use dynamics::{Body, Snapshot};
use integrator::{Interval, Propagation, STEP_TOLERANCE};
use keep_out::Watch;
use limits::{Limits, excess, margin};
use samples::Sampler;
use visits::{Misses, Visit};

/// Largest angle, rad, by which a target or the end may be missed: 0.2 arc seconds, well below
/// what any attitude sensor resolves, well above the error of the integration.
pub const ATTITUDE_TOLERANCE: f64 = 1e-6;

/// Largest error of a required body rate component, rad/s: over ten seconds it turns the
/// spacecraft by no more than the attitude tolerance.
pub const RATE_TOLERANCE: f64 = 1e-7;

/// Largest excess over a limit, relative to the limit: what optimisers leave as rounding.
pub const LIMIT_TOLERANCE: f64 = 1e-6;

/// Largest error of a prescribed final wheel speed, relative to the wheel's speed limit or,
/// without one, to the fastest wheel.
pub const END_SPEED_TOLERANCE: f64 = 1e-6;

/// Largest disagreement of times, relative to the flight: text with ten digits passes.
pub const TIME_TOLERANCE: f64 = 1e-9;

/// Torque during settle and dwell, relative to the wheel's limit, that still counts as none.
pub const REST_TORQUE_TOLERANCE: f64 = 1e-9;

/// Largest relative change of the conserved momentum before the integration itself is doubted.
pub const MOMENTUM_TOLERANCE: f64 = 1e-10;

/// Stands for a figure that could not be computed, with its sign turned for margins: so large
/// that it passes no test, and finite, so that it can be written anywhere.
pub const NOT_COMPUTED: f64 = f64::MAX;

/// Distance of a passage from a control boundary, relative to the flight, that is rounding.
const SNAP: f64 = 1e-12;

/// What the re-integration of a flight found.
///
/// A flight that cannot be flown at all (controls that do not fit the wheels or leave gaps,
/// numbers that are not finite) or that breaks off has [`NOT_COMPUTED`] in every figure that rests
/// on the motion.
#[derive(Debug, Clone)]
pub struct Report {
    /// Errors against the tolerances.
    pub verification: Verification,
    /// What is left of every limit. Unlike the excesses these refer to the limits of the hardware,
    /// not to the shares of them that the options leave to the plan.
    pub margins: Margins,
    /// States in order of time, strictly increasing: at every control boundary, every arrival and
    /// departure, and evenly in between so that no gap exceeds a 500th of the flight or a 20th of
    /// a slew. The sign of the quaternion is continuous from the start's.
    pub states: Vec<State>,
    /// Keep-out violations, with time and depth: one warning per cone.
    pub keep_out: Vec<Problem>,
    /// The same violations one by one, in order of cone and time.
    pub intrusions: Vec<Intrusion>,
    /// Largest relative error of a prescribed final wheel speed; `None` when none is prescribed.
    pub end_wheel_speed_error: Option<f64>,
    /// Largest change of the total momentum in the reference frame relative to its parts, as a
    /// measure of the integration.
    pub momentum_drift: f64,
    /// Steps of the integration.
    pub steps: usize,
}

/// Re-integrates a flight made by anyone from the scenario's start and tests it.
#[must_use]
pub fn verify(scenario: &Scenario, flight: &Flight) -> Report {
    let spacecraft = scenario.spacecraft();
    let intervals = match timeline::intervals(flight, spacecraft.wheels()) {
        Ok(intervals) => intervals,
        Err(mut failures) => {
            failures.extend(visits::book(scenario, flight, &[]).1);
            return Report::not_flown(scenario, failures);
        }
    };
    let (visits, mut failures) = visits::book(scenario, flight, &intervals);
    let body = match Body::new(spacecraft.inertia(), spacecraft.wheels()) {
        Ok(body) => body,
        Err(sentence) => {
            failures.push(sentence);
            return Report::not_flown(scenario, failures);
        }
    };
    let (torque_usage, torque_failures) = limits::torque(scenario, flight);
    failures.extend(torque_failures);
    failures.extend(visits::driven_rests(scenario, &visits, &intervals));
    let mut observed = Observed::new(scenario);
    match observed.fly(&body, &intervals, &visits, flight.total_time_s) {
        Ok(flown) => {
            let misses = visits::inspect(scenario, &visits, &observed.states);
            failures.extend(misses.failures.iter().cloned());
            observed.report(scenario, (torque_usage, flown, &misses), failures)
        }
        Err(sentence) => {
            failures.push(sentence);
            let mut report = Report::not_flown(scenario, failures);
            report.states = observed.states.iter().filter_map(state).collect();
            report
        }
    }
}

/// Everything that watches the flight.
struct Observed<'a> {
    start: Snapshot,
    states: Vec<Snapshot>,
    limits: Limits<'a>,
    watches: Vec<Watch<'a>>,
}

impl<'a> Observed<'a> {
    fn new(scenario: &'a Scenario) -> Self {
        let start = Snapshot::at_start(scenario);
        let watches = scenario.keep_out().iter().enumerate();
        Self {
            watches: watches
                .map(|(index, cone)| Watch::new(index, cone, &start.quaternion))
                .collect(),
            limits: Limits::new(scenario),
            states: Vec::new(),
            start,
        }
    }

    fn fly(
        &mut self,
        body: &Body,
        intervals: &[Interval<'_>],
        visits: &[Visit<'_>],
        total_s: f64,
    ) -> Result<Propagation, String> {
        let times = samples::times(intervals, visits, total_s);
        let mut sampler = Sampler::new(&times, &self.start);
        let (limits, watches) = (&mut self.limits, &mut self.watches);
        let flown = integrator::fly(
            body,
            self.start.clone(),
            intervals,
            STEP_TOLERANCE,
            |step| {
                sampler.observe(step);
                limits.observe(step);
                for watch in watches.iter_mut() {
                    watch.observe(step);
                }
            },
        );
        self.states = sampler.states;
        flown
    }

    fn report(
        mut self,
        scenario: &Scenario,
        (torque_usage, flown, misses): (f64, Propagation, &Misses),
        mut failures: Vec<String>,
    ) -> Report {
        failures.extend(self.limits.failures());
        if flown.momentum_drift > MOMENTUM_TOLERANCE {
            failures.push(format!(
                "the integration lost momentum ({} of it), so that nothing it found counts",
                number_format::figure(flown.momentum_drift)
            ));
        }
        let options = scenario.options();
        let (wheel_usage, rate_usage) = (self.limits.wheel_usage(), self.limits.rate_usage());
        let keep_out: Vec<Problem> = self.watches.iter_mut().filter_map(Watch::finish).collect();
        let clearances = self
            .watches
            .iter()
            .map(|watch| watch.clearance.to_degrees());
        Report {
            margins: Margins {
                torque: margin(torque_usage, options.torque_authority),
                wheel_speed: wheel_usage.map(|usage| margin(usage, options.momentum_authority)),
                body_rate: rate_usage.map(|usage| margin(usage, 1.0)),
                wheel_zero_crossings: self.limits.zero_crossings(),
                keep_out_clearance_deg: clearances.collect(),
            },
            verification: Verification {
                passed: failures.is_empty(),
                max_attitude_error_rad: misses.attitude_rad,
                max_rate_error_rad_s: misses.rate_rad_s,
                max_wheel_speed_excess: wheel_usage.map_or(0.0, excess),
                max_torque_excess: excess(torque_usage),
                max_rate_excess: rate_usage.map_or(0.0, excess),
                integrator: integrator_name(),
                failures,
            },
            states: self.states.iter().filter_map(state).collect(),
            keep_out,
            intrusions: self
                .watches
                .into_iter()
                .flat_map(|w| w.intrusions)
                .collect(),
            end_wheel_speed_error: misses.end_speed,
            momentum_drift: flown.momentum_drift,
            steps: flown.steps,
        }
    }
}

impl Report {
    /// The report of a flight without a motion to judge: the worst of every figure.
    fn not_flown(scenario: &Scenario, failures: Vec<String>) -> Self {
        Self {
            verification: Verification {
                passed: false,
                max_attitude_error_rad: NOT_COMPUTED,
                max_rate_error_rad_s: NOT_COMPUTED,
                max_wheel_speed_excess: NOT_COMPUTED,
                max_torque_excess: NOT_COMPUTED,
                max_rate_excess: NOT_COMPUTED,
                integrator: integrator_name(),
                failures,
            },
            margins: Margins {
                torque: -NOT_COMPUTED,
                wheel_speed: Some(-NOT_COMPUTED),
                body_rate: Some(-NOT_COMPUTED),
                wheel_zero_crossings: Vec::new(),
                keep_out_clearance_deg: vec![-NOT_COMPUTED; scenario.keep_out().len()],
            },
            states: Vec::new(),
            keep_out: Vec::new(),
            intrusions: Vec::new(),
            end_wheel_speed_error: None,
            momentum_drift: NOT_COMPUTED,
            steps: 0,
        }
    }
}

fn integrator_name() -> String {
    format!(
        "Taylor series of order {}, relative tolerance {STEP_TOLERANCE:e} per step, \
         tested against the equations of motion at every step",
        series::ORDER
    )
}

fn state(snapshot: &Snapshot) -> Option<State> {
    Some(State {
        time_s: snapshot.time_s,
        attitude: Attitude::from_xyzw(snapshot.quaternion)?,
        body_rate_rad_s: snapshot.rate,
        wheel_speed_rad_s: snapshot.wheel_speed.clone(),
    })
}

#[cfg(test)]
mod tests;
