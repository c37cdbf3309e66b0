//! An estimate of the memory that a solve may need, made before it begins.
//!
//! Three parts grow with the scenario: the table of pairs with its motions; for few targets, the
//! tables over subsets of the targets; and, where rates at targets are left free, the segments and
//! nodes that a search keeps, up to fixed limits.

use crate::leg::solve::Resolution;
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::scenario::{RateCondition, Scenario, Target};
use crate::tour::order::completion::MAX_EXACT_TARGETS;
use crate::tour::order::lagrangian::{LagrangianPaths, MAX_LAGRANGIAN_TARGETS};
use std::f64::consts::FRAC_PI_2;

/// Memory of the smallest solve with its plan, bytes. This and the next two are the measured growth
/// of the resident memory plus a quarter.
const BASE_BYTES: u64 = 3 << 20;
/// Memory that each pair of places adds, bytes, for legs of [`MEASURED_INTERVALS`] intervals.
const PAIR_BYTES: u64 = 5 << 10;
/// Memory that a search of one minute on two cores keeps for each target at most, bytes.
const SEARCH_BYTES_PER_TARGET: u64 = 1280 << 10;
/// Number of intervals of the legs for which [`PAIR_BYTES`] was measured.
const MEASURED_INTERVALS: u64 = 18;
/// Limit of the cached segments and the open nodes together, bytes.
const MAX_SEARCH_BYTES: u64 = 144 << 20;

/// Memory that solving a scenario may need, bytes. As a rule an overestimate, by a factor below
/// four for scenarios of noticeable size.
#[must_use]
pub fn memory_estimate(scenario: &Scenario) -> u64 {
    let count = scenario.targets().len();
    let targets = count as u64;
    let places = targets + 2;
    // With more than three wheels the null-space momentum is free too.
    let has_free_rate = |target: &Target| {
        target
            .rate
            .iter()
            .any(|rate| !matches!(rate, RateCondition::Fixed(_)))
    };
    let couples = scenario.targets().iter().any(has_free_rate)
        || scenario.spacecraft().enabled_wheels().count() > 3;
    let subsets = if count <= MAX_EXACT_TARGETS {
        // One duration for every subset and its first target; where legs couple, the table of the
        // triple bounds beside that of the pair bounds.
        let tables = if couples { 2 } else { 1 };
        (targets << targets) * 8 * tables * 9 / 8
    } else {
        0
    };
    let searched = if couples {
        (targets * SEARCH_BYTES_PER_TARGET).min(MAX_SEARCH_BYTES)
    } else {
        0
    };
    // The states of the Lagrangian paths, which a hard search over few targets uses.
    let lagrangian = if couples && count <= MAX_LAGRANGIAN_TARGETS {
        LagrangianPaths::bytes(count)
    } else {
        0
    };
    let authority = Authority::of(scenario.options());
    let dynamics = Dynamics::of(scenario.spacecraft(), scenario.start(), authority);
    let resolution = Resolution::of(scenario.options().accuracy, &dynamics);
    let intervals = resolution.intervals_of(&dynamics, FRAC_PI_2) as u64;
    let pair = PAIR_BYTES * intervals.max(MEASURED_INTERVALS) / MEASURED_INTERVALS;
    BASE_BYTES + places * places * pair + subsets + searched + lagrangian
}
