//! The flight as slews, waits and rests, each with samples at its ends and at every switch.

use super::ExportError;
use super::phases::{SegmentKind, phases};
use super::sampling::{self, CLOSEST_S, Sampling};
use nalgebra::Vector3;
use slewplan_solver::checker::PropagatedMotion;
use slewplan_solver::model::plan::{Flight, State};
use slewplan_solver::model::scenario::Scenario;

/// A sampled flight.
#[derive(Debug)]
pub(super) struct SampledFlight<'a> {
    /// In order of time; the last sample of a segment is the first of the next.
    pub(super) segments: Vec<FlightSegment<'a>>,
    /// Number of wheels.
    pub(super) wheels: usize,
}

/// One slew, one wait, or one rest at a target.
#[derive(Debug)]
pub(super) struct FlightSegment<'a> {
    pub(super) kind: SegmentKind<'a>,
    /// At least two, strictly increasing in time.
    pub(super) samples: Vec<FlightSample>,
}

/// The flight at one time.
#[derive(Debug, Clone)]
pub(super) struct FlightSample {
    pub(super) state: State,
    /// Angular acceleration in body axes after this time, rad/s².
    pub(super) acceleration: Vector3<f64>,
    /// Motor torques after this time, N m; at the end those of the last interval.
    pub(super) torque: Vec<f64>,
}

impl<'a> SampledFlight<'a> {
    /// Samples a motion.
    pub(super) fn of(
        scenario: &Scenario,
        flight: &'a Flight,
        motion: &PropagatedMotion,
        sampling: Sampling,
    ) -> Result<Self, ExportError> {
        let mut segments = Vec::new();
        let mut left = sampling.most;
        for (kind, begin, end) in phases(scenario, flight) {
            let knots = knots(flight, begin, end);
            let times = sampling::times(
                motion,
                &knots,
                Sampling {
                    most: left,
                    ..sampling
                },
            )?;
            left = left.saturating_sub(times.len());
            let samples = times.iter().map(|time| sample(flight, motion, *time));
            segments.push(FlightSegment {
                kind,
                samples: samples.collect::<Result<_, _>>()?,
            });
        }
        let wheels = flight.controls.first();
        Ok(Self {
            segments,
            wheels: wheels.map_or(0, |control| control.wheel_torque_nm.len()),
        })
    }

    /// All samples in order of time, without repetition.
    pub(super) fn samples(&self) -> impl Iterator<Item = &FlightSample> {
        let segments = self.segments.iter().enumerate();
        segments.flat_map(|(index, segment)| segment.samples.iter().skip(usize::from(index > 0)))
    }
}

/// Begin, switch times and end of a piece.
fn knots(flight: &Flight, begin: f64, end: f64) -> Vec<f64> {
    let switches = flight.controls.iter().map(|control| control.start_s);
    let mut knots = vec![begin];
    knots.extend(switches.filter(|time| *time > begin + CLOSEST_S && *time < end - CLOSEST_S));
    knots.push(end);
    knots.dedup_by(|later, earlier| *later - *earlier < CLOSEST_S);
    knots
}

fn sample(
    flight: &Flight,
    motion: &PropagatedMotion,
    time_s: f64,
) -> Result<FlightSample, ExportError> {
    let state = motion.state(time_s).ok_or(ExportError::NotFinite)?;
    let acceleration = motion.acceleration(time_s).ok_or(ExportError::NotFinite)?;
    let controls = &flight.controls;
    // A boundary within rounding counts as passed.
    let begun = controls.partition_point(|control| control.start_s <= time_s + CLOSEST_S);
    let torque = controls
        .get(begun.saturating_sub(1))
        .map(|control| control.wheel_torque_nm.clone())
        .unwrap_or_default();
    let numbers = state.body_rate_rad_s.iter().chain(acceleration.iter());
    let mut numbers = numbers.chain(&state.wheel_speed_rad_s).chain(&torque);
    if !(time_s.is_finite() && numbers.all(|number| number.is_finite())) {
        return Err(ExportError::NotFinite);
    }
    Ok(FlightSample {
        state,
        acceleration,
        torque,
    })
}
