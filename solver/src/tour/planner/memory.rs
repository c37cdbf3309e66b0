//! An estimate of the memory that a solve may need, made before it begins.
//!
//! It follows the structure of a solve: tables of pairs; the motions of the legs that are solved, all
//! of few targets and some per target of many; the programs of tours, where legs couple; for
//! few targets, tables over subsets of the targets; and the open nodes and solved segments that a
//! search keeps, which grow with its time up to fixed limits. What a search over subsets will need
//! beyond its first table depends on how hard it turns out, and the estimate is that of a hard one.

use super::places::MAX_TARGETS_ALL_LEGS;
use crate::leg::multiphase::MAX_LEGS_AT_ONCE;
use crate::leg::solve::Resolution;
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::scenario::{RateCondition, Scenario, Target};
use crate::tour::order::completion::MAX_EXACT_TARGETS;
use crate::tour::order::lagrangian::{LagrangianPaths, MAX_LAGRANGIAN_TARGETS};
use crate::tour::schedule::{LABEL_BYTES, MAX_LABELS, labels_in_time};
use std::f64::consts::FRAC_PI_2;

/// Memory of the smallest solve with its plan, bytes.
const BASE_BYTES: u64 = 3 << 20;
/// Memory of a solved leg with its motion, bytes, for legs of [`MEASURED_INTERVALS`] intervals: the
/// measured growth of the resident memory plus a quarter.
const LEG_BYTES: u64 = 5 << 10;
/// Number of intervals of the legs for which [`LEG_BYTES`] was measured.
const MEASURED_INTERVALS: u64 = 18;
/// Memory of a pair of places in the tables of a search over many targets, bytes. Independent legs
/// have pair bounds, edges and their copies; where legs couple, multipliers, rankings and the rates
/// at the ends of legs as well.
const PAIR_BYTES: u64 = 40;
const COUPLED_PAIR_BYTES: u64 = 130;
/// Legs solved per target where they are solved as they are needed, and where legs couple.
const LEGS_PER_TARGET: u64 = 10;
const COUPLED_LEGS_PER_TARGET: u64 = 45;
/// Memory of a program of a tour with three wheels, bytes an interval: derivatives and factors of all
/// stages; and the number of tours that are solved at a time.
const PROGRAM_BYTES: u64 = 6 << 10;
const PROGRAMS: u64 = 2;
/// Nodes of a search whose legs are independent, bytes per target, what a minute keeps at most, and
/// in a second of its time on two cores.
const NODE_BYTES_PER_TARGET: u64 = 550 << 10;
const QUICK_NODE_BYTES_PER_SECOND: u64 = 4 << 20;
/// Nodes and segments of a search whose legs couple, in a second of its time on two cores, bytes.
const NODE_BYTES_PER_SECOND: u64 = 768 << 10;
const SEGMENT_BYTES_PER_SECOND: u64 = 1 << 20;
/// Number of targets beyond which tours take so long that there are fewer nodes in a second, by the
/// square of the number.
const MANY_TARGETS: u64 = 40;
/// Nodes and segments of the hardest searches over few targets whose legs couple, bytes for every
/// subset of the targets.
const BYTES_PER_SUBSET: u64 = 192;
/// Limits of the open nodes and of the cached segments, bytes.
const MAX_NODE_BYTES: u64 = 64 << 20;
const MAX_SEGMENT_BYTES: u64 = 40 << 20;

/// Memory that solving a scenario may need beyond what the process has, bytes: at least what it
/// does, and for scenarios of noticeable size at most four times as much.
#[must_use]
pub fn memory_estimate(scenario: &Scenario) -> u64 {
    let size = Size::of(scenario);
    BASE_BYTES + size.legs() + size.programs() + size.subsets() + size.searched() + size.labels()
}

/// What the memory depends on.
struct Size {
    targets: u64,
    /// Whether consecutive legs are parts of one program.
    couples: bool,
    wheels: u64,
    /// Intervals of a leg of mean length.
    intervals: u64,
    time_limit_s: Option<f64>,
    /// Whether windows, values or a latest end are searched with labels.
    has_clock: bool,
}

impl Size {
    fn of(scenario: &Scenario) -> Self {
        let has_free_rate = |target: &Target| {
            target
                .rate
                .iter()
                .any(|rate| !matches!(rate, RateCondition::Fixed(_)))
        };
        let wheels = scenario.spacecraft().enabled_wheels().count();
        let authority = Authority::of(scenario.options());
        let dynamics = Dynamics::of(scenario.spacecraft(), scenario.start(), authority);
        let resolution = Resolution::of(scenario.options().accuracy, &dynamics);
        let intervals = resolution.intervals_of(&dynamics, FRAC_PI_2) as u64;
        Self {
            targets: scenario.targets().len() as u64,
            // With more than three wheels the null-space momentum is free too.
            couples: scenario.targets().iter().any(has_free_rate) || wheels > 3,
            wheels: wheels as u64,
            intervals: intervals.max(MEASURED_INTERVALS),
            time_limit_s: scenario.options().time_limit_s,
            has_clock: scenario.has_clock(),
        }
    }

    /// Tables of pairs, and solved legs.
    fn legs(&self) -> u64 {
        let leg = LEG_BYTES * self.intervals / MEASURED_INTERVALS;
        let pairs = (self.targets + 2).pow(2);
        let (pair, solved) = if self.couples {
            (COUPLED_PAIR_BYTES, COUPLED_LEGS_PER_TARGET)
        } else {
            (PAIR_BYTES, LEGS_PER_TARGET)
        };
        if self.targets <= MAX_TARGETS_ALL_LEGS as u64 {
            pairs * leg
        } else {
            pairs * pair + self.targets * solved * leg
        }
    }

    /// Programs of tours.
    fn programs(&self) -> u64 {
        if !self.couples {
            return 0;
        }
        // Derivatives and factors are matrices of the states of a stage: three angles and the momenta.
        let stage = PROGRAM_BYTES * (3 + self.wheels.max(3)).pow(2) / 36;
        let legs = (self.targets + 1).min(MAX_LEGS_AT_ONCE as u64);
        PROGRAMS * legs * self.intervals * stage
    }

    /// Tables over subsets of few targets.
    fn subsets(&self) -> u64 {
        let count = usize::try_from(self.targets).unwrap_or(usize::MAX);
        if count > MAX_EXACT_TARGETS {
            return 0;
        }
        // One duration for every subset and its first target; where legs couple, the table of the
        // triple bounds beside that of the pair bounds.
        let tables = if self.couples { 2 } else { 1 };
        // The states of the Lagrangian paths.
        let lagrangian = if self.couples && count <= MAX_LAGRANGIAN_TARGETS {
            LagrangianPaths::bytes(count)
        } else {
            0
        };
        (self.targets << self.targets) * 8 * tables * 17 / 16 + lagrangian
    }

    /// Labels of one run, of few targets for a few times of every subset and last target.
    fn labels(&self) -> u64 {
        if !self.has_clock {
            return 0;
        }
        let few = u32::try_from(self.targets).unwrap_or(u32::MAX).min(32);
        let targets = usize::try_from(self.targets).unwrap_or(usize::MAX);
        let most = labels_in_time(MAX_LABELS, targets);
        most.min((2 * self.targets) << few) * LABEL_BYTES
    }

    /// Open nodes and solved segments.
    fn searched(&self) -> u64 {
        let within = |bytes_per_second: u64, limit: u64| {
            let seconds = self.time_limit_s.unwrap_or(f64::INFINITY);
            limit.min(float_to_bytes(seconds * bytes_per_second as f64))
        };
        let slower = (self.targets.max(MANY_TARGETS) / MANY_TARGETS).pow(2);
        if !self.couples {
            let nodes = MAX_NODE_BYTES.min(self.targets * NODE_BYTES_PER_TARGET);
            return within(QUICK_NODE_BYTES_PER_SECOND, nodes);
        }
        let nodes = within(NODE_BYTES_PER_SECOND / slower, MAX_NODE_BYTES);
        let segments = within(SEGMENT_BYTES_PER_SECOND, MAX_SEGMENT_BYTES);
        if self.targets <= MAX_EXACT_TARGETS as u64 {
            (nodes + segments).min(BYTES_PER_SUBSET << self.targets)
        } else {
            nodes + segments
        }
    }
}

/// The whole part of a number of bytes; any number beyond the largest is the largest.
fn float_to_bytes(bytes: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates, and time limits are positive"
    )]
    let whole = bytes as u64;
    whole
}
