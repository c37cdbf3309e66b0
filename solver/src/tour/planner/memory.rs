//! An estimate of the memory that a solve may need, made before it begins.
//!
//! Four parts grow with the scenario: the tables of pairs; the motions of the legs that are solved,
//! which are all for few targets and some per target for many; for few targets, the tables over
//! subsets of the targets; and the nodes and, where rates at targets are left free, the segments
//! that a search keeps, up to fixed limits.

use super::places::MAX_TARGETS_ALL_LEGS;
use crate::leg::solve::Resolution;
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::scenario::{RateCondition, Scenario, Target};
use crate::tour::order::completion::MAX_EXACT_TARGETS;
use crate::tour::order::lagrangian::{LagrangianPaths, MAX_LAGRANGIAN_TARGETS};
use std::f64::consts::FRAC_PI_2;

/// Memory of the smallest solve with its plan, bytes. This and the next two are the measured growth
/// of the resident memory plus a quarter.
const BASE_BYTES: u64 = 3 << 20;
/// Memory of a solved leg with its motion, bytes, for legs of [`MEASURED_INTERVALS`] intervals.
const LEG_BYTES: u64 = 5 << 10;
/// Number of intervals of the legs for which [`LEG_BYTES`] was measured.
const MEASURED_INTERVALS: u64 = 18;
/// Memory of a pair of places in the tables of a scenario whose legs are solved as they are needed,
/// bytes, without motions.
const PAIR_BYTES: u64 = 300;
/// Legs solved per target of such a scenario.
const LEGS_PER_TARGET: u64 = 20;
/// Memory that a search of one minute on two cores keeps for each target at most, bytes: nodes,
/// and segments where legs couple.
const NODE_BYTES_PER_TARGET: u64 = 300 << 10;
const SEARCH_BYTES_PER_TARGET: u64 = 3 << 20;
/// Limits of the open nodes, and of the nodes and the cached segments together, bytes.
const MAX_NODE_BYTES: u64 = 64 << 20;
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
        (targets * NODE_BYTES_PER_TARGET).min(MAX_NODE_BYTES)
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
    let leg = LEG_BYTES * intervals.max(MEASURED_INTERVALS) / MEASURED_INTERVALS;
    let pairs = places * places;
    let legs = if count <= MAX_TARGETS_ALL_LEGS {
        pairs * leg
    } else {
        pairs * PAIR_BYTES + targets * LEGS_PER_TARGET * leg
    };
    BASE_BYTES + legs + subsets + searched + lagrangian
}
