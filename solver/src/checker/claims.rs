//! What a plan says of its schedule beside the flight: its value, the targets that it leaves out, and
//! where it waits.

use super::dynamics::Snapshot;
use super::integrator::TorqueSpan;
use super::number_format::figure;
use super::visits::{Visit, driven_between, turn_between};
use super::{ATTITUDE_TOLERANCE, RATE_TOLERANCE, TIME_TOLERANCE, clock};
use crate::model::plan::{Flight, Schedule, Wait};
use crate::model::scenario::Scenario;

/// Largest difference of a claimed value from the sum of values, relative: rounding of sums and of written
/// numbers.
const VALUE_TOLERANCE: f64 = 1e-9;
/// Where a flight begins, as waits name it.
const START: &str = "start";

/// What a plan says of its schedule. What is left out is not tested.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ScheduleClaims {
    /// Sum of the values of the targets that are visited.
    pub value: Option<f64>,
    /// Identifiers of all targets that are not visited.
    pub skipped: Option<Vec<String>>,
    /// Stays at rest outside visits.
    pub waits: Vec<Wait>,
}

impl From<&Schedule> for ScheduleClaims {
    fn from(schedule: &Schedule) -> Self {
        let skipped = schedule.skipped.iter().map(|one| one.target.clone());
        Self {
            value: Some(schedule.value),
            skipped: Some(skipped.collect()),
            waits: schedule.waits.clone(),
        }
    }
}

impl ScheduleClaims {
    /// Sentences about a wrong value, and about targets that are not where the plan says.
    pub(super) fn false_ones(&self, scenario: &Scenario, flight: &Flight) -> Vec<String> {
        let mut failures: Vec<String> = self.wrong_value(scenario, flight).into_iter().collect();
        let Some(skipped) = &self.skipped else {
            return failures;
        };
        let visited = |id: &str| flight.passages.iter().any(|p| p.target == id);
        for id in skipped {
            match scenario.targets().iter().find(|t| t.id == *id) {
                None => failures.push(format!("'{id}' is left out, but is no target")),
                Some(_) if visited(id) => {
                    failures.push(format!("target '{id}' is left out and visited"));
                }
                Some(_) => {}
            }
        }
        for target in scenario.targets() {
            let (id, is_optional) = (&target.id, target.value.is_some());
            if is_optional && !visited(id) && !skipped.contains(id) {
                failures.push(format!("target '{id}' is neither visited nor left out"));
            }
        }
        failures
    }

    fn wrong_value(&self, scenario: &Scenario, flight: &Flight) -> Option<String> {
        let claimed = self.value?;
        let value = clock::value(scenario, flight).unwrap_or(0.0);
        // Not `<=` of the opposite: a claim that is no number is wrong too.
        let right = (claimed - value).abs() <= VALUE_TOLERANCE * value.abs();
        (!right).then(|| {
            format!(
                "the plan claims a value of {}, its visits are worth {}",
                figure(claimed),
                figure(value)
            )
        })
    }

    /// Begin and end of the waits that can be tested, s.
    pub(super) fn wait_times(&self, total_s: f64) -> impl Iterator<Item = f64> {
        let times = self.waits.iter().flat_map(|wait| [wait.from_s, wait.to_s]);
        times.filter(move |time| (0.0..=total_s).contains(time))
    }

    /// Sentences about waits that are no rests where they are said to be. Visits and states are in order
    /// of time, and there are states at the ends of all waits.
    pub(super) fn false_waits(
        &self,
        scenario: &Scenario,
        visits: &[Visit<'_>],
        (intervals, states): (&[TorqueSpan<'_>], &[Snapshot]),
    ) -> Vec<String> {
        let total = intervals.last().map_or(0.0, |interval| interval.end_s);
        let slack = TIME_TOLERANCE * total;
        let fault = |wait: &Wait| {
            let reason = misplaced(wait, visits, (total, slack))
                .or_else(|| driven(wait, scenario, intervals))
                .or_else(|| moving(wait, states, slack))?;
            let place = &wait.target;
            let (from, to) = (figure(wait.from_s), figure(wait.to_s));
            Some(format!(
                "the wait at '{place}' from {from} s to {to} s {reason}"
            ))
        };
        self.waits.iter().filter_map(fault).collect()
    }
}

/// Why a wait is not beside the visit, or at the start, that it names.
fn misplaced(wait: &Wait, visits: &[Visit<'_>], (total, slack): (f64, f64)) -> Option<String> {
    let (from, to) = (wait.from_s, wait.to_s);
    if !(from <= to && from >= -slack && to <= total + slack) {
        return Some("is no span of time inside the flight".to_owned());
    }
    let overlaps = |visit: &&Visit<'_>| {
        visit.departure_s.min(to) - visit.arrival_s.max(from) > slack
            // A visit without a stay has no length to overlap with.
            || (visit.arrival_s - slack > from && visit.departure_s + slack < to)
    };
    if let Some(visit) = visits.iter().find(overlaps) {
        return Some(format!("overlaps the visit of '{}'", visit.target.id));
    }
    if wait.target == START {
        return (from > slack).then(|| "does not begin with the flight".to_owned());
    }
    let touches = |visit: &Visit<'_>| {
        visit.target.id == wait.target
            && ((visit.arrival_s - to).abs() <= slack || (visit.departure_s - from).abs() <= slack)
    };
    let touching = visits.iter().any(touches);
    (!touching).then(|| "is not beside a visit there".to_owned())
}

/// Why the wheels do not rest during a wait.
fn driven(wait: &Wait, scenario: &Scenario, intervals: &[TorqueSpan<'_>]) -> Option<String> {
    let wheels = scenario.spacecraft().wheels();
    let since = driven_between(wheels, intervals, [wait.from_s, wait.to_s])?;
    Some(format!(
        "is no rest: a wheel is driven at {} s",
        figure(since)
    ))
}

/// Why the body does not rest during a wait. Without torque its wheels keep their momenta where it does.
fn moving(wait: &Wait, states: &[Snapshot], slack: f64) -> Option<String> {
    let from = states.partition_point(|state| state.time_s < wait.from_s - slack);
    let to = states.partition_point(|state| state.time_s <= wait.to_s + slack);
    let Some(stay @ [first, ..]) = states.get(from..to) else {
        return Some("cannot be tested: there is no state".to_owned());
    };
    let fastest = |state: &Snapshot| state.rate.amax();
    let rate = stay.iter().map(fastest).fold(0.0, f64::max);
    let turn = stay.iter().map(|state| turn_between(first, state));
    let turn = turn.fold(0.0, f64::max);
    if rate > RATE_TOLERANCE {
        Some(format!(
            "is no rest: the body turns at {} rad/s",
            figure(rate)
        ))
    } else if turn > ATTITUDE_TOLERANCE {
        Some(format!(
            "is no rest: the body turns by {} rad",
            figure(turn)
        ))
    } else {
        None
    }
}
