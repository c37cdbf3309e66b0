//! The result of a simulated flight, and its recording.

use super::cones::ConeApproaches;
use super::controller::Desired;
use super::sampled_plan::{MarkEvent, SampledPlan};
use super::wheel_loop::MotorCycle;
use crate::checker::NOT_COMPUTED;
use crate::model::attitude::Attitude;
use crate::model::plan::{ConeClearance, Flight};
use crate::model::scenario::Scenario;
use nalgebra::Vector3;

/// Difference of the true state from a desired one.
///
/// Once the motion is not finite any more, both errors are [`NOT_COMPUTED`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackingError {
    /// Angle between the attitudes, rad.
    pub attitude_rad: f64,
    /// Size of the difference of the body rates, rad/s.
    pub rate_rad_s: f64,
}

/// The error at an arrival.
#[derive(Debug, Clone, PartialEq)]
pub struct PassageError {
    /// Identifier of the target.
    pub target: String,
    /// Arrival by the plan, s.
    pub time_s: f64,
    /// Error against the plan's state there.
    pub error: TrackingError,
}

/// Share of the flight during which a wheel was commanded beyond a limit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Saturation {
    /// The motor's torque.
    pub torque: f64,
    /// The wheel's speed.
    pub speed: f64,
}

/// A state during the flight, for plots.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedState {
    /// Time, s.
    pub time_s: f64,
    /// True attitude.
    pub attitude: Attitude,
    /// True body rate, body axes, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// True wheel speeds relative to the body, rad/s.
    pub wheel_speed_rad_s: Vec<f64>,
    /// Commanded torques of the wheels from this time on, feed-forward and feedback, before the limits,
    /// N m.
    pub wheel_torque_nm: Vec<f64>,
    /// Whether each wheel reached its torque limit before the next state that is kept.
    pub torque_limited: Vec<bool>,
    /// The same for the speed limit.
    pub speed_limited: Vec<bool>,
    /// Error against what the controller follows.
    pub error: TrackingError,
}

/// One simulated flight.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedFlight {
    /// Error at the end of the plan, against its state there.
    pub plan_end: TrackingError,
    /// Error at the end of the flight: after the time to settle, when there is one.
    pub end: TrackingError,
    /// Errors at the arrivals, in order of the plan.
    pub passages: Vec<PassageError>,
    /// Largest errors at any sample, each by itself, against what the controller follows.
    pub peak: TrackingError,
    /// One entry per wheel.
    pub saturation: Vec<Saturation>,
    /// The closest approach to each cone that applies at some time, in order of the scenario: at the
    /// samples of the on-board computer, at arrivals and at the end. Of a flight that broke off it is
    /// minus [`NOT_COMPUTED`] or less, at the time at which the motion ceased to be finite.
    pub cones: Vec<ConeClearance>,
    /// States at every so many samples of the on-board computer, when asked for.
    pub states: Vec<SimulatedState>,
}

impl TrackingError {
    pub(super) const UNKNOWN: Self = Self {
        attitude_rad: NOT_COMPUTED,
        rate_rad_s: NOT_COMPUTED,
    };

    pub(super) fn of(attitude: &Attitude, rate: &Vector3<f64>, desired: &Desired) -> Self {
        let turn = desired.attitude.turn_to(attitude);
        let finite = |value: f64| {
            if value.is_finite() {
                value
            } else {
                NOT_COMPUTED
            }
        };
        Self {
            attitude_rad: finite(turn.angle_to(&Attitude::identity())),
            rate_rad_s: finite((rate - turn.to_body(desired.rate)).norm()),
        }
    }
}

/// Recorder of a simulated flight.
#[derive(Debug)]
pub(super) struct FlightLog<'a> {
    flight: SimulatedFlight,
    cones: ConeApproaches<'a>,
    seconds: f64,
    next_mark: usize,
}

impl<'a> FlightLog<'a> {
    pub(super) fn open(scenario: &'a Scenario, flight: &'a Flight) -> Self {
        let wheels = scenario.spacecraft().wheels().len();
        let passages = flight.passages.iter().map(|passage| PassageError {
            target: passage.target.clone(),
            time_s: passage.time_s,
            error: TrackingError::UNKNOWN,
        });
        let still = TrackingError {
            attitude_rad: 0.0,
            rate_rad_s: 0.0,
        };
        Self {
            flight: SimulatedFlight {
                plan_end: TrackingError::UNKNOWN,
                end: TrackingError::UNKNOWN,
                passages: passages.collect(),
                peak: still,
                saturation: vec![Saturation::default(); wheels],
                cones: Vec::new(),
                states: Vec::new(),
            },
            cones: ConeApproaches::new(scenario, flight),
            seconds: 0.0,
            next_mark: 0,
        }
    }

    /// Records the true attitude and its error at a sample, s.
    pub(super) fn sample(&mut self, time_s: f64, attitude: &Attitude, error: TrackingError) {
        self.cones.sample(time_s, attitude);
        self.note_peak(error);
    }

    fn note_peak(&mut self, error: TrackingError) {
        let peak = &mut self.flight.peak;
        peak.attitude_rad = peak.attitude_rad.max(error.attitude_rad);
        peak.rate_rad_s = peak.rate_rad_s.max(error.rate_rad_s);
    }

    /// Records a state.
    pub(super) fn keep(&mut self, state: SimulatedState) {
        self.flight.states.push(state);
    }

    /// Records which limits a wheel reached during a time, s.
    pub(super) fn wheel(&mut self, wheel: usize, cycle: &MotorCycle, seconds: f64) {
        let saturation = &mut self.flight.saturation[wheel];
        saturation.torque += if cycle.torque_limited { seconds } else { 0.0 };
        saturation.speed += if cycle.speed_limited { seconds } else { 0.0 };
        if let Some(state) = self.flight.states.last_mut() {
            state.torque_limited[wheel] |= cycle.torque_limited;
            state.speed_limited[wheel] |= cycle.speed_limited;
        }
    }

    /// Records that a time, s, has been reached, and the errors at the marks up to it.
    pub(super) fn reach(
        &mut self,
        sampled_plan: &SampledPlan,
        time_s: f64,
        state: Option<(&Attitude, &Vector3<f64>)>,
    ) {
        self.seconds = time_s;
        let reached = |mark: &&super::sampled_plan::ErrorMark| mark.time_s <= time_s;
        while let Some(mark) = sampled_plan.marks.get(self.next_mark).filter(reached) {
            let error = state.map_or(TrackingError::UNKNOWN, |(attitude, rate)| {
                TrackingError::of(attitude, rate, &mark.planned)
            });
            match (mark.event, state) {
                (MarkEvent::Arrival(_), Some((attitude, _))) => {
                    self.cones.arrive(mark.time_s, attitude);
                }
                (MarkEvent::End, Some((attitude, _))) => self.cones.sample(mark.time_s, attitude),
                (_, None) => self.cones.break_off(mark.time_s),
                (MarkEvent::PlanEnd, Some(_)) => {}
            }
            match mark.event {
                MarkEvent::Arrival(index) => self.flight.passages[index].error = error,
                MarkEvent::PlanEnd => self.flight.plan_end = error,
                MarkEvent::End => {
                    self.flight.end = error;
                    self.note_peak(error);
                }
            }
            self.next_mark += 1;
        }
    }

    /// Records that the motion is not finite any more from a time, s, on.
    pub(super) fn break_off(&mut self, time_s: f64) {
        self.cones.break_off(time_s);
        self.flight.peak = TrackingError::UNKNOWN;
    }

    pub(super) fn close(mut self) -> SimulatedFlight {
        self.flight.cones = self.cones.clearances();
        for saturation in &mut self.flight.saturation {
            let seconds = self.seconds.max(f64::MIN_POSITIVE);
            saturation.torque = (saturation.torque / seconds).min(1.0);
            saturation.speed = (saturation.speed / seconds).min(1.0);
        }
        self.flight
    }
}
