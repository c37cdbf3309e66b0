//! The targets and the conditions on the rate there.

use super::limits::{Limits, exceeds};
use super::pointing::Surroundings;
use super::windows::Calendar;
use super::{RateCondition, Target};
use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spec::{MAX_TARGETS, MAX_VALUE, ScenarioSpec, TargetSpec};
use std::collections::HashSet;

/// Reserved names of the ends of the tour.
const RESERVED: [&str; 2] = ["start", "end"];

pub(super) fn read_all(
    spec: &ScenarioSpec,
    surroundings: Surroundings<'_>,
    (limits, calendar): (&Limits, Calendar),
    findings: &mut Findings,
) -> Option<Vec<Target>> {
    if spec.targets.is_empty() && spec.end.is_none() {
        findings.refuse(
            "/targets",
            Code::OutOfRange,
            "there are 0 targets and no end, so there is nothing to plan",
            "give at least one target, or an end",
        );
        return None;
    }
    if !findings.at_most("/targets", spec.targets.len(), MAX_TARGETS) {
        return None;
    }
    let mut ids = HashSet::new();
    // All are read before they are collected: collecting into an option stops at the first fault.
    let targets: Vec<_> = spec
        .targets
        .iter()
        .enumerate()
        .map(|(i, target)| {
            let pointer = format!("/targets/{i}");
            let id_valid = check_id(&target.id, &mut ids, &pointer, findings);
            let pointing = target.pointing.as_ref();
            let orientation =
                surroundings.orientation(&target.attitude, pointing, &pointer, findings);
            let rate = read_rate(target, &pointer, limits, findings);
            let dwell = read_time(target.dwell_s, &format!("{pointer}/dwell_s"), findings);
            let settle = read_time(target.settle_s, &format!("{pointer}/settle_s"), findings);
            let windows = target.windows.as_ref();
            let windows =
                windows.map(|listed| calendar.windows(listed, target, &pointer, findings));
            let value = target.value;
            let value = value.map(|value| read_value(value, &format!("{pointer}/value"), findings));
            let orientation = orientation?;
            Some(Target {
                id: id_valid.then(|| target.id.clone())?,
                attitude: orientation.attitude,
                roll: orientation.roll,
                pointing: orientation.pointing,
                rate: rate?,
                settle: settle?,
                dwell: dwell?,
                windows: match windows {
                    Some(windows) => Some(windows?),
                    None => None,
                },
                value: match value {
                    Some(value) => Some(value?),
                    None => None,
                },
            })
        })
        .collect();
    targets.into_iter().collect()
}

fn check_id<'a>(
    id: &'a str,
    ids: &mut HashSet<&'a str>,
    pointer: &str,
    findings: &mut Findings,
) -> bool {
    let (code, message) = if id.is_empty() {
        (Code::MissingField, "the target's id is empty".to_owned())
    } else if RESERVED.contains(&id) {
        (
            Code::DuplicateId,
            format!("\"{id}\" already names that end of the tour in legs"),
        )
    } else if !ids.insert(id) {
        (
            Code::DuplicateId,
            format!("another target is already called \"{id}\""),
        )
    } else {
        return true;
    };
    findings.refuse(
        format!("{pointer}/id"),
        code,
        message,
        "give each target an id of its own, other than \"start\" and \"end\"",
    );
    false
}

fn read_time(time: f64, pointer: &str, findings: &mut Findings) -> Option<f64> {
    let time = findings.finite(pointer, time)?;
    if time >= 0.0 {
        return Some(time);
    }
    findings.refuse(
        pointer,
        Code::OutOfRange,
        format!("the time is {time} s, it must not be below 0"),
        "give a time of at least 0 s",
    );
    None
}

/// A value that a target has.
fn read_value(value: f64, pointer: &str, findings: &mut Findings) -> Option<f64> {
    let value = findings.positive(pointer, value)?;
    if value > MAX_VALUE {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!("the value is {value}, it may be {MAX_VALUE:e} at most"),
            "scale all values down: only their ratios matter",
        );
        return None;
    }
    Some(value)
}

fn read_rate(
    spec: &TargetSpec,
    pointer: &str,
    limits: &Limits,
    findings: &mut Findings,
) -> Option<[RateCondition; 3]> {
    let rests = spec.dwell_s > 0.0 || spec.settle_s > 0.0;
    let bounded = spec.rate_min_rad_s.is_some() || spec.rate_max_rad_s.is_some();
    if !bounded {
        let zero = spec.zero_rate_axes.unwrap_or([true; 3]);
        return Some(zero.map(|zero| {
            if zero || rests {
                RateCondition::Fixed(0.0)
            } else {
                RateCondition::Free
            }
        }));
    }
    let exclusive = spec.zero_rate_axes.is_none();
    if !exclusive {
        findings.refuse(
            format!("{pointer}/zero_rate_axes"),
            Code::ConflictingFields,
            "zero_rate_axes is given together with rate_min_rad_s or rate_max_rad_s",
            "give either; a component is zero when both its bounds are 0",
        );
    }
    let ranges = read_ranges(spec, pointer, findings)?;
    let bounds = Bounds { ranges, pointer };
    let reachable = bounds.check_limits(spec, limits, findings);
    let restful = !rests || bounds.check_rest(findings);
    (exclusive && reachable && restful).then(|| {
        if rests {
            [RateCondition::Fixed(0.0); 3]
        } else {
            ranges.map(condition)
        }
    })
}

fn condition((min, max): (f64, f64)) -> RateCondition {
    if min.total_cmp(&max).is_eq() {
        RateCondition::Fixed(min)
    } else if min.is_infinite() && max.is_infinite() {
        RateCondition::Free
    } else {
        RateCondition::Within(min, max)
    }
}

/// Lower and upper bound of each component, infinite where open.
fn read_ranges(
    spec: &TargetSpec,
    pointer: &str,
    findings: &mut Findings,
) -> Option<[(f64, f64); 3]> {
    let given_min = spec.rate_min_rad_s.unwrap_or_default();
    let given_max = spec.rate_max_rad_s.unwrap_or_default();
    let mut ranges = [(f64::NEG_INFINITY, f64::INFINITY); 3];
    let mut valid = true;
    let mut bound = |value: Option<f64>, open: f64, pointer: String| match value {
        None => Some(open),
        Some(value) => findings.finite(&pointer, value),
    };
    for (i, range) in ranges.iter_mut().enumerate() {
        let min = bound(
            given_min[i],
            range.0,
            format!("{pointer}/rate_min_rad_s/{i}"),
        );
        let max = bound(
            given_max[i],
            range.1,
            format!("{pointer}/rate_max_rad_s/{i}"),
        );
        match min.zip(max) {
            Some(read) => *range = read,
            None => valid = false,
        }
    }
    for (i, (min, max)) in ranges.into_iter().enumerate() {
        if min > max {
            valid = false;
            findings.refuse(
                format!("{pointer}/rate_min_rad_s/{i}"),
                Code::EmptyRange,
                format!("the lower bound {min} rad/s is above the upper bound {max} rad/s"),
                "swap or widen the bounds",
            );
        }
    }
    valid.then_some(ranges)
}

/// Bounds of the rate at one target.
struct Bounds<'a> {
    ranges: [(f64, f64); 3],
    pointer: &'a str,
}

impl Bounds<'_> {
    /// Refuses bounds that exclude all rates within the spacecraft's limits.
    fn check_limits(&self, spec: &TargetSpec, limits: &Limits, findings: &mut Findings) -> bool {
        let mut reachable = true;
        let mut refuse = |pointer: String, least: f64, limit: f64| {
            reachable = false;
            findings.refuse(
                pointer,
                Code::BodyRateLimit,
                format!(
                    "the bounds ask for at least {least} rad/s, beyond the limit of {limit} rad/s"
                ),
                "widen the bounds towards 0 or raise the spacecraft's rate limits",
            );
        };
        for (i, (range, limit)) in self.ranges.into_iter().zip(limits.rate).enumerate() {
            let least = least_size(range);
            if exceeds(least, limit) {
                refuse(self.at(i), least, limit);
            }
        }
        let least = self
            .ranges
            .map(least_size)
            .iter()
            .map(|c| c * c)
            .sum::<f64>()
            .sqrt();
        if exceeds(least, limits.rate_norm) {
            let field = match spec.rate_min_rad_s {
                Some(_) => "rate_min_rad_s",
                None => "rate_max_rad_s",
            };
            refuse(format!("{}/{field}", self.pointer), least, limits.rate_norm);
        }
        reachable
    }

    /// Refuses bounds that exclude rest, which settling and dwelling require.
    fn check_rest(&self, findings: &mut Findings) -> bool {
        let mut allowed = true;
        for (i, &(min, max)) in self.ranges.iter().enumerate() {
            if least_size((min, max)) > 0.0 {
                allowed = false;
                findings.refuse(
                    self.at(i),
                    Code::ConflictingFields,
                    format!(
                        "the bounds {min} to {max} rad/s exclude 0, but settle_s or dwell_s above \
                         0 requires rest"
                    ),
                    "drop the bounds, or set settle_s and dwell_s to 0",
                );
            }
        }
        allowed
    }

    /// Pointer to the bound of a component that keeps it away from zero.
    fn at(&self, i: usize) -> String {
        let field = if self.ranges[i].0 > 0.0 {
            "rate_min_rad_s"
        } else {
            "rate_max_rad_s"
        };
        format!("{}/{field}/{i}", self.pointer)
    }
}

/// Smallest size of the values in a range.
fn least_size((min, max): (f64, f64)) -> f64 {
    min.max(-max).max(0.0)
}
