//! What a solve may take of the memory, before it begins.
//!
//! Three things grow: the table of pairs with its motions, the tables of subsets of the targets while
//! there are few, and, where rates at targets are left free, the segments and nodes that a search
//! goes on remembering until their bounds are reached.

use crate::leg::solve::Resolution;
use crate::model::dynamics::Dynamics;
use crate::model::scenario::{RateCondition, Scenario, Target};
use crate::tour::order::completion::MAX_EXACT_TARGETS;
use crate::tour::order::lagrangian::{LagrangianPaths, MAX_LAGRANGIAN_TARGETS};
use std::f64::consts::FRAC_PI_2;

/// What the smallest solve takes with its plan, what each pair of places adds, and what a search
/// remembers for each target at most within a minute on two cores. Measured as growth of the
/// resident memory, with a quarter as much again, bytes.
const BASE_BYTES: u64 = 3 << 20;
const PAIR_BYTES: u64 = 5 << 10;
const SEARCH_BYTES_PER_TARGET: u64 = 1280 << 10;
/// Intervals of the legs of which that was measured; of more they take more.
const MEASURED_INTERVALS: u64 = 18;
/// SegmentCache and nodes are bounded, bytes.
const MAX_SEARCH_BYTES: u64 = 144 << 20;

/// Memory that solving a scenario may need, bytes: as a rule too much, by less than four times
/// where it is worth counting.
#[must_use]
pub fn memory_estimate(scenario: &Scenario) -> u64 {
    let count = scenario.targets().len();
    let targets = count as u64;
    let places = targets + 2;
    // With more than three wheels the null space is free too.
    let turns = |target: &Target| {
        target
            .rate
            .iter()
            .any(|rate| !matches!(rate, RateCondition::Fixed(_)))
    };
    let couples =
        scenario.targets().iter().any(turns) || scenario.spacecraft().enabled_wheels().count() > 3;
    let subsets = if count <= MAX_EXACT_TARGETS {
        // One duration for every subset and its first target; where legs charge each other, the
        // table with triple_bounds beside the one before.
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
    // Of a hard search over few targets, the states of lagrangian legs.
    let lagrangian = if couples && count <= MAX_LAGRANGIAN_TARGETS {
        LagrangianPaths::bytes(count)
    } else {
        0
    };
    let dynamics = Dynamics::of(scenario);
    let resolution = Resolution::of(scenario.options().accuracy, &dynamics);
    let intervals = resolution.intervals_of(&dynamics, FRAC_PI_2) as u64;
    let pair = PAIR_BYTES * intervals.max(MEASURED_INTERVALS) / MEASURED_INTERVALS;
    BASE_BYTES + places * places * pair + subsets + searched + lagrangian
}
