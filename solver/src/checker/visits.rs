//! Whether every required target is visited, none twice, with the required state and stay, and the end is
//! reached.

mod goal;

use super::dynamics::Snapshot;
use super::integrator::TorqueSpan;
use super::number_format::figure;
use super::order::misplaced;
use super::{
    ATTITUDE_TOLERANCE, END_SPEED_TOLERANCE, NOT_COMPUTED, RATE_TOLERANCE, REST_TORQUE_TOLERANCE,
    SNAP, TIME_TOLERANCE,
};
use crate::model::plan::{Flight, Passage};
use crate::model::scenario::{End, RateCondition, Scenario, Target};
use crate::model::spacecraft::Wheel;
use crate::model::spec::AttitudeEquivalence;
use goal::{Goal, Miss};
use nalgebra::Vector3;

/// A visit that can be tested: a known target at times inside the flight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Visit<'a> {
    pub(super) target: &'a Target,
    pub(super) arrival_s: f64,
    pub(super) departure_s: f64,
}

/// Errors at visits and at the end.
#[derive(Debug, Clone, Default)]
pub(super) struct Misses {
    pub(super) attitude_rad: f64,
    pub(super) rate_rad_s: f64,
    /// Relative to the wheel's limit; `None` when the end does not prescribe speeds.
    pub(super) end_speed: Option<f64>,
    pub(super) failures: Vec<String>,
}

/// The visits of a flight, with sentences about missing and unknown ones, and about impossible times.
/// Times within rounding of a control boundary are moved onto it.
pub(super) fn book<'a>(
    scenario: &'a Scenario,
    flight: &Flight,
    intervals: &[TorqueSpan<'_>],
) -> (Vec<Visit<'a>>, Vec<String>) {
    let mut failures = Vec::new();
    let mut visits = Vec::new();
    let mut earliest = 0.0;
    for passage in &flight.passages {
        let name = &passage.target;
        let Some(target) = scenario.targets().iter().find(|t| t.id == *name) else {
            failures.push(format!("the passage of '{name}' belongs to no target"));
            continue;
        };
        if let Some(reason) = impossible(passage, target, earliest, flight.total_time_s) {
            failures.push(format!("target '{name}' {reason}"));
        }
        let times = [passage.time_s, passage.departure_s];
        if times.iter().all(|t| t.is_finite()) {
            let [arrival_s, departure_s] = times.map(|t| snapped(t, flight, intervals));
            earliest = passage.departure_s.max(passage.time_s);
            visits.push(Visit {
                target,
                arrival_s,
                // By rounding a stay of length zero may end before it begins.
                departure_s: departure_s.max(arrival_s),
            });
        }
    }
    for target in scenario.targets() {
        match flight
            .passages
            .iter()
            .filter(|p| p.target == target.id)
            .count()
        {
            0 if target.value.is_some() => {}
            0 => failures.push(format!("target '{}' is not visited", target.id)),
            1 => {}
            n => failures.push(format!("target '{}' is visited {n} times", target.id)),
        }
    }
    failures.extend(misplaced(scenario, flight));
    failures.extend(loose_end(scenario, flight));
    (visits, failures)
}

/// Why a passage is impossible at its times, in a flight of `total` seconds that left the target before
/// at `earliest`.
fn impossible(passage: &Passage, target: &Target, earliest: f64, total: f64) -> Option<String> {
    let (arrival, departure) = (passage.time_s, passage.departure_s);
    let slack = TIME_TOLERANCE * total;
    let stay = target.settle + target.dwell;
    if !arrival.is_finite() || !departure.is_finite() {
        Some("has a passage time that is not finite".to_owned())
    } else if arrival < earliest - slack {
        Some(format!(
            "is reached at {} s, before the departure from the one before at {} s",
            figure(arrival),
            figure(earliest)
        ))
    } else if departure > total + slack {
        Some(format!(
            "is left at {} s, after the end of the flight at {} s",
            figure(departure),
            figure(total)
        ))
    } else if ((departure - arrival) - stay).abs() > slack {
        Some(format!(
            "is stayed at for {} s instead of {} s",
            figure(departure - arrival),
            figure(stay)
        ))
    } else {
        None
    }
}

/// A sentence when a flight without end conditions goes on after its last target.
fn loose_end(scenario: &Scenario, flight: &Flight) -> Option<String> {
    let last = flight.passages.last()?.departure_s;
    let rest = flight.total_time_s - last;
    let loose = scenario.end().is_none() && rest > TIME_TOLERANCE * flight.total_time_s;
    loose.then(|| {
        format!(
            "the flight goes on for {} s after the last target",
            figure(rest)
        )
    })
}

pub(super) fn snapped(time: f64, flight: &Flight, intervals: &[TorqueSpan<'_>]) -> f64 {
    let after = intervals.partition_point(|interval| interval.begin_s < time);
    let boundary = |index: usize| intervals.get(index).map(|interval| interval.begin_s);
    let near = |boundary: &f64| (boundary - time).abs() <= SNAP * flight.total_time_s;
    let candidates = [
        boundary(after),
        after.checked_sub(1).and_then(boundary),
        Some(flight.total_time_s),
    ];
    let onto = candidates.into_iter().flatten().find(near);
    // Not `clamp`, which would panic for a total time that is itself refused.
    onto.unwrap_or(time).max(0.0).min(flight.total_time_s)
}

/// Tests all visits and the end against the propagated states, which are in order of time.
pub(super) fn inspect(scenario: &Scenario, visits: &[Visit<'_>], states: &[Snapshot]) -> Misses {
    let mut misses = Misses::default();
    for visit in visits {
        let from = states.partition_point(|state| state.time_s < visit.arrival_s);
        let to = states.partition_point(|state| state.time_s <= visit.departure_s);
        match states.get(from..to) {
            Some(stay) if !stay.is_empty() => {
                misses.at_target(visit, stay, scenario.options().attitude_equivalence);
            }
            _ => misses.unseen(visit),
        }
    }
    if let (Some(end), Some(state)) = (scenario.end(), states.last()) {
        misses.at_end(end, state, scenario);
    }
    misses
}

impl Misses {
    fn at_target(&mut self, visit: &Visit<'_>, stay: &[Snapshot], sign: AttitudeEquivalence) {
        let target = visit.target;
        let goal = Goal {
            attitude: target.attitude.xyzw(),
            roll: target.roll.as_ref(),
            sign,
        };
        let (mut miss, mut rate) = (Miss::default(), 0.0_f64);
        for state in stay {
            miss = miss.larger(goal.missed_by(&state.quaternion));
            rate = rate.max(rate_error(&state.rate, &target.rate));
        }
        self.record(&format!("target '{}'", target.id), miss, rate);
    }

    /// A stay without any state cannot be tested and counts as failed.
    fn unseen(&mut self, visit: &Visit<'_>) {
        self.attitude_rad = NOT_COMPUTED;
        self.rate_rad_s = NOT_COMPUTED;
        self.failures.push(format!(
            "target '{}' cannot be tested: there is no state from {} s to {} s",
            visit.target.id,
            figure(visit.arrival_s),
            figure(visit.departure_s)
        ));
    }

    fn at_end(&mut self, end: &End, state: &Snapshot, scenario: &Scenario) {
        let goal = Goal {
            attitude: end.attitude.xyzw(),
            roll: end.roll.as_ref(),
            sign: scenario.options().attitude_equivalence,
        };
        let miss = goal.missed_by(&state.quaternion);
        let conditions = [end.rate.x, end.rate.y, end.rate.z].map(RateCondition::Fixed);
        self.record("the end", miss, rate_error(&state.rate, &conditions));
        let Some(speeds) = &end.wheel_speed else {
            return;
        };
        let fastest = speeds.iter().chain(&state.wheel_speed);
        let fastest = fastest.fold(0.0_f64, |peak, speed| peak.max(speed.abs()));
        let mut worst: f64 = 0.0;
        for (i, wheel) in scenario.spacecraft().wheels().iter().enumerate() {
            let scale = if wheel.max_speed.is_finite() {
                wheel.max_speed
            } else {
                fastest
            };
            let miss = (state.wheel_speed[i] - speeds[i]).abs();
            if miss > END_SPEED_TOLERANCE * scale {
                self.failures.push(format!(
                    "the end leaves wheel {i} at {} rad/s instead of {} rad/s",
                    figure(state.wheel_speed[i]),
                    figure(speeds[i])
                ));
            }
            worst = worst.max(if miss == 0.0 { 0.0 } else { miss / scale });
        }
        self.end_speed = Some(worst);
    }

    fn record(&mut self, place: &str, miss: Miss, rate: f64) {
        self.attitude_rad = self.attitude_rad.max(miss.turn).max(miss.roll);
        self.rate_rad_s = self.rate_rad_s.max(rate);
        if miss.turn > ATTITUDE_TOLERANCE {
            let turn = figure(miss.turn);
            self.failures
                .push(format!("{place} is missed by {turn} rad"));
        }
        if miss.roll > ATTITUDE_TOLERANCE {
            let roll = figure(miss.roll);
            self.failures.push(format!(
                "{place} is passed {roll} rad outside the limits of its roll"
            ));
        }
        if rate > RATE_TOLERANCE {
            let rate = figure(rate);
            self.failures.push(format!(
                "{place} is passed with a rate error of {rate} rad/s"
            ));
        }
    }
}

/// Sentences about visits during whose stay a wheel is driven.
pub(super) fn driven_rests(
    scenario: &Scenario,
    visits: &[Visit<'_>],
    intervals: &[TorqueSpan<'_>],
) -> Vec<String> {
    let wheels = scenario.spacecraft().wheels();
    let culprit = |visit: &Visit<'_>| {
        let since = driven_between(wheels, intervals, [visit.arrival_s, visit.departure_s])?;
        Some(format!(
            "target '{}' is to be held without torque, but a wheel is driven at {} s",
            visit.target.id,
            figure(since)
        ))
    };
    visits.iter().filter_map(culprit).collect()
}

/// The first time of a span, s, at which a wheel is driven.
pub(super) fn driven_between(
    wheels: &[Wheel],
    intervals: &[TorqueSpan<'_>],
    [from_s, to_s]: [f64; 2],
) -> Option<f64> {
    let total = intervals.last().map_or(0.0, |interval| interval.end_s);
    let slack = TIME_TOLERANCE * total;
    let driven = |interval: &&TorqueSpan<'_>| {
        interval.torque.iter().zip(wheels).any(|(torque, wheel)| {
            let largest = wheel.max_torque.max(-wheel.min_torque);
            torque.abs() > REST_TORQUE_TOLERANCE * largest
        })
    };
    let during = |interval: &&TorqueSpan<'_>| {
        interval.end_s.min(to_s) - interval.begin_s.max(from_s) > slack
    };
    let culprit = intervals.iter().filter(during).find(driven)?;
    Some(culprit.begin_s.max(from_s))
}

/// Angle of the turn from one state to another, rad.
pub(super) fn turn_between(one: &Snapshot, other: &Snapshot) -> f64 {
    let goal = Goal {
        attitude: one.quaternion,
        roll: None,
        sign: AttitudeEquivalence::Rotation,
    };
    goal.missed_by(&other.quaternion).turn
}

/// Largest deviation of a rate component from its condition, rad/s.
fn rate_error(rate: &Vector3<f64>, conditions: &[RateCondition; 3]) -> f64 {
    let misses = rate
        .iter()
        .zip(conditions)
        .map(|(rate, condition)| match condition {
            RateCondition::Free => 0.0,
            RateCondition::Fixed(value) => (rate - value).abs(),
            RateCondition::Within(low, high) => (low - rate).max(rate - high).max(0.0),
        });
    misses.fold(0.0, f64::max)
}
