//! The phases of a flight: slews, waits, and rests at targets.
//!
//! A wait follows from the torques: a body that leaves a target, or reaches it, at rest without torque is
//! still there. Flights of scenarios without a clock do not wait.

use super::sampling::CLOSEST_S;
use slewplan_solver::checker::REST_TORQUE_TOLERANCE;
use slewplan_solver::model::plan::{Control, Flight};
use slewplan_solver::model::scenario::Scenario;

/// The kind of a phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SegmentKind<'a> {
    /// From start or a target to a target or the end.
    Slew(&'a str, &'a str),
    /// At rest in the attitude of the start or a target, outside a visit.
    Wait(&'a str),
    /// Settle and dwell at a target.
    Rest(&'a str),
}

/// All phases with begin and end, s; those of zero duration are left out.
pub(super) fn phases<'a>(
    scenario: &Scenario,
    flight: &'a Flight,
) -> Vec<(SegmentKind<'a>, f64, f64)> {
    let mut phases = Vec::new();
    let resting = Resting { scenario, flight };
    let (mut from, mut since) = ("start", 0.0);
    for passage in &flight.passages {
        let target = passage.target.as_str();
        let left = resting.until(from, since, passage.time_s);
        let reached = resting.since(target, passage.time_s, left);
        phases.push((SegmentKind::Wait(from), since, left));
        phases.push((SegmentKind::Slew(from, target), left, reached));
        phases.push((SegmentKind::Wait(target), reached, passage.time_s));
        phases.push((
            SegmentKind::Rest(target),
            passage.time_s,
            passage.departure_s,
        ));
        (from, since) = (target, passage.departure_s);
    }
    let left = resting.until(from, since, flight.total_time_s);
    phases.push((SegmentKind::Wait(from), since, left));
    phases.push((SegmentKind::Slew(from, "end"), left, flight.total_time_s));
    phases.retain(|(_, begin, end)| end - begin > CLOSEST_S);
    phases
}

/// Where a flight may wait.
struct Resting<'a> {
    scenario: &'a Scenario,
    flight: &'a Flight,
}

impl Resting<'_> {
    /// The end of the torque-free time that begins at a place at a time, s, and ends before another.
    fn until(&self, place: &str, begin: f64, end: f64) -> f64 {
        if !self.is_at_rest(place) {
            return begin;
        }
        let after = |control: &&Control| control.start_s + control.duration_s > begin + CLOSEST_S;
        let controls = self.flight.controls.iter().filter(after);
        let driven = controls.into_iter().find(|control| self.is_driven(control));
        driven.map_or(end, |control| control.start_s.clamp(begin, end.max(begin)))
    }

    /// The begin of the torque-free time that ends at a place at a time, s, and begins after another.
    fn since(&self, place: &str, end: f64, begin: f64) -> f64 {
        if !self.is_at_rest(place) {
            return end;
        }
        let before = |control: &&Control| control.start_s < end - CLOSEST_S;
        let controls = self.flight.controls.iter().rev().filter(before);
        let driven = controls.into_iter().find(|control| self.is_driven(control));
        let since = driven.map_or(begin, |control| control.start_s + control.duration_s);
        since.clamp(begin, end.max(begin))
    }

    fn is_at_rest(&self, place: &str) -> bool {
        if !self.scenario.has_clock() {
            return false;
        }
        let targets = self.scenario.targets();
        match targets.iter().find(|target| target.id == place) {
            Some(target) => target.rests(),
            None => self.scenario.start().rate.amax() == 0.0,
        }
    }

    fn is_driven(&self, control: &Control) -> bool {
        let wheels = self.scenario.spacecraft().wheels();
        control
            .wheel_torque_nm
            .iter()
            .zip(wheels)
            .any(|(torque, wheel)| {
                let largest = wheel.max_torque.max(-wheel.min_torque);
                torque.abs() > REST_TORQUE_TOLERANCE * largest
            })
    }
}
