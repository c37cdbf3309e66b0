//! What a plan says of the clock: values, targets left out and waits.

use super::clock::SolvedChain;
use crate::checker::ScheduleClaims;
use crate::model::plan::{Objective, Schedule, SkippedTarget, Wait};

/// What is known of a schedule beside its motion.
#[derive(Debug, Clone)]
pub(super) struct ClockFacts {
    /// Sum of the values of the targets that are visited.
    pub(super) value: f64,
    /// No schedule has a greater sum.
    pub(super) value_bound: f64,
    /// The targets left out.
    pub(super) skipped: Vec<SkippedTarget>,
    /// The motion, where it is not that of the tour's segments each on its own.
    pub(super) chains: Option<Vec<SolvedChain>>,
}

impl ClockFacts {
    /// What the plan will say, for the checker to test.
    pub(super) fn claims(&self, waits: &[Wait]) -> ScheduleClaims {
        ScheduleClaims::from(&self.clone().schedule(waits.to_vec()))
    }

    /// The same as part of a plan with waits.
    pub(super) fn schedule(self, waits: Vec<Wait>) -> Schedule {
        Schedule {
            objective: Objective::ValueThenTime,
            value: self.value,
            value_bound: self.value_bound,
            skipped: self.skipped,
            waits,
        }
    }
}
