//! Independent verification: re-integrates a flight and tests every limit and boundary.
//!
//! No plan is given out that this module has not verified. It shares no code with the optimiser, and on
//! purpose implements the dynamics again, with the full state: quaternion, body rate and all wheel
//! speeds. Limits are tested between integration steps too: a step is a polynomial, whose extrema can
//! be found.
//!
//! A flight may be of any origin. Everything wrong with it is reported as a sentence in
//! [`Verification::failures`], never by a panic.

mod claims;
mod clock;
mod cones;
mod dynamics;
mod extremum;
mod integrator;
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

pub use claims::ScheduleClaims;
pub(crate) use leg::{LegEnd, leg_faults};
pub use propagated::PropagatedMotion;
pub(crate) use ramped::{StepPart, TorqueRamp, propagate_ramps};

use crate::model::attitude::Attitude;
use crate::model::cone::Cone;
use crate::model::plan::{ConeClearance, Flight, Margins, State, Verification};
use crate::model::problem::Problem;
use crate::model::scenario::Scenario;
pub use crate::model::tolerances::{
    ATTITUDE_TOLERANCE, END_SPEED_TOLERANCE, LIMIT_TOLERANCE, RATE_TOLERANCE,
    REST_TORQUE_TOLERANCE, TIME_TOLERANCE,
};
use cones::ConeObservers;
use dynamics::{Body, Snapshot};
use integrator::{Integration, STEP_TOLERANCE, TorqueSpan};
use limits::{LimitObserver, excess, margin};
use samples::Sampler;
use visits::Misses;

/// Largest relative change of the conserved momentum; beyond it the integration itself has failed.
pub const MOMENTUM_TOLERANCE: f64 = 1e-10;

/// Value of a number that could not be computed, negative for margins: so large that it passes no
/// test, and finite, so that every format can hold it.
pub const NOT_COMPUTED: f64 = f64::MAX;

/// Distance of a passage from a control boundary, relative to the duration of the flight, that counts
/// as rounding.
const SNAP: f64 = 1e-12;

/// The result of a flight's re-integration.
///
/// Where a flight cannot be propagated (controls that do not fit the wheels or leave gaps, numbers that
/// are not finite, an integration that breaks off), every number that depends on the motion is
/// [`NOT_COMPUTED`].
#[derive(Debug, Clone)]
pub struct CheckReport {
    /// Errors against the tolerances.
    pub verification: Verification,
    /// Margins to every limit. Unlike the excesses these refer to the limits of the hardware, not to
    /// the shares of them that the options allow the plan to use.
    pub margins: Margins,
    /// States in order of time, strictly increasing: at every control boundary, every arrival and
    /// departure, the ends of waits, and evenly in between so that no gap exceeds a 500th of the flight or a 20th of
    /// a leg. The sign of the quaternion is continuous from the start's.
    pub states: Vec<State>,
    /// Violations of cones that are only reported, with time and depth: one warning per cone. The
    /// margins have them one by one.
    pub keep_out: Vec<Problem>,
    /// Sum of the values of the targets that are visited; `None` where no target has a value.
    pub value: Option<f64>,
    /// Largest relative error of a prescribed final wheel speed; `None` when none is prescribed.
    pub end_wheel_speed_error: Option<f64>,
    /// Largest change of the total momentum in the reference frame relative to its parts: a measure of
    /// the integration error.
    pub momentum_drift: f64,
    /// Steps of the integration.
    pub steps: usize,
}

/// Re-integrates a flight of any origin from the scenario's start and tests it.
#[must_use]
pub fn verify(scenario: &Scenario, flight: &Flight) -> CheckReport {
    verify_with_claims(scenario, flight, &ScheduleClaims::default())
}

/// Does what [`verify`] does, and tests what a plan says of its schedule: a false claim is a failure too.
#[must_use]
pub fn verify_with_claims(
    scenario: &Scenario,
    flight: &Flight,
    claims: &ScheduleClaims,
) -> CheckReport {
    CheckReport {
        value: clock::value(scenario, flight),
        ..examine(scenario, flight, claims)
    }
}

fn examine(scenario: &Scenario, flight: &Flight, claims: &ScheduleClaims) -> CheckReport {
    let spacecraft = scenario.spacecraft();
    let mut untimely = clock::untimely(scenario, flight);
    untimely.extend(claims.false_ones(scenario, flight));
    let intervals = match timeline::intervals(flight, spacecraft.wheels()) {
        Ok(intervals) => intervals,
        Err(mut failures) => {
            failures.extend(visits::book(scenario, flight, &[]).1);
            failures.extend(untimely);
            return CheckReport::not_propagated(scenario, failures);
        }
    };
    let (visits, mut failures) = visits::book(scenario, flight, &intervals);
    failures.extend(untimely);
    let body = match Body::new(spacecraft.inertia(), spacecraft.wheels()) {
        Ok(body) => body,
        Err(sentence) => {
            failures.push(sentence);
            return CheckReport::not_propagated(scenario, failures);
        }
    };
    let (torque_usage, torque_failures) = limits::torque(scenario, flight);
    failures.extend(torque_failures);
    failures.extend(visits::driven_rests(scenario, &visits, &intervals));
    let stays = cones::stays(&visits);
    let mut observed = FlightObserver::new(scenario, &stays);
    let waits = claims.wait_times(flight.total_time_s);
    let waits = waits.map(|time| visits::snapped(time, flight, &intervals));
    let times = samples::times(&intervals, &visits, waits, flight.total_time_s);
    match observed.integrate(&body, &intervals, &times) {
        Ok(integration) => {
            let flown = (&intervals[..], &observed.states[..]);
            failures.extend(claims.false_waits(scenario, &visits, flown));
            let misses = visits::inspect(scenario, &visits, &observed.states);
            failures.extend(misses.failures.iter().cloned());
            observed.report(scenario, torque_usage, integration, &misses, failures)
        }
        Err(sentence) => {
            failures.push(sentence);
            let mut report = CheckReport::not_propagated(scenario, failures);
            report.states = observed.states.iter().filter_map(state).collect();
            report
        }
    }
}

/// The observers of an integration.
struct FlightObserver<'a> {
    start: Snapshot,
    states: Vec<Snapshot>,
    limits: LimitObserver<'a>,
    cones: ConeObservers<'a>,
}

impl<'a> FlightObserver<'a> {
    /// `stays` are those at targets.
    fn new(scenario: &'a Scenario, stays: &'a [[f64; 2]]) -> Self {
        let start = Snapshot::at_start(scenario);
        Self {
            cones: ConeObservers::new(scenario.cones(), stays, &start.quaternion),
            limits: LimitObserver::new(scenario),
            states: Vec::new(),
            start,
        }
    }

    fn integrate(
        &mut self,
        body: &Body,
        intervals: &[TorqueSpan<'_>],
        times: &[f64],
    ) -> Result<Integration, String> {
        let mut sampler = Sampler::new(times, &self.start);
        let (limits, cones) = (&mut self.limits, &mut self.cones);
        let integration = integrator::integrate(
            body,
            self.start.clone(),
            intervals,
            STEP_TOLERANCE,
            |step| {
                sampler.observe(step);
                limits.observe(step);
                cones.observe(step);
            },
        );
        self.states = sampler.states;
        integration
    }

    fn report(
        mut self,
        scenario: &Scenario,
        torque_usage: f64,
        integration: Integration,
        misses: &Misses,
        mut failures: Vec<String>,
    ) -> CheckReport {
        failures.extend(self.limits.failures());
        let cones = self.cones.finish();
        failures.extend(cones.failures);
        if integration.momentum_drift > MOMENTUM_TOLERANCE {
            failures.push(format!(
                "the integration lost momentum ({} of it), so that its results are invalid",
                number_format::figure(integration.momentum_drift)
            ));
        }
        let options = scenario.options();
        let (wheel_usage, rate_usage) = (self.limits.wheel_usage(), self.limits.rate_usage());
        CheckReport {
            margins: Margins {
                torque: margin(torque_usage, options.torque_authority),
                wheel_speed: wheel_usage.map(|usage| margin(usage, options.momentum_authority)),
                body_rate: rate_usage.map(|usage| margin(usage, 1.0)),
                wheel_zero_crossings: self.limits.zero_crossings(),
                keep_out_clearance_deg: cones.clearances,
                keep_out_intrusions: cones.intrusions,
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
            keep_out: cones.warnings,
            value: None,
            end_wheel_speed_error: misses.end_speed,
            momentum_drift: integration.momentum_drift,
            steps: integration.steps,
        }
    }
}

impl CheckReport {
    /// The report of a flight that cannot be propagated: the worst value of every number.
    fn not_propagated(scenario: &Scenario, failures: Vec<String>) -> Self {
        let unknown = |cone: &Cone| ConeClearance::new(cone, -NOT_COMPUTED, 0.0);
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
                keep_out_clearance_deg: scenario.cones().iter().map(unknown).collect(),
                keep_out_intrusions: Vec::new(),
            },
            states: Vec::new(),
            keep_out: Vec::new(),
            value: None,
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
