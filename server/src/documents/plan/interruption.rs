//! Solves that were stopped before there was a plan.

use slewplan_solver::model::problem::{Code, Problem};

/// What has stopped a solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Interruption {
    /// The time limit of its scenario.
    TimeLimit,
    /// A caller.
    Request,
    /// The memory that a job may take.
    Memory {
        /// How much that is, bytes.
        limit: u64,
    },
}

impl Interruption {
    /// Why there is no plan.
    pub(crate) fn reason(self) -> Problem {
        match self {
            Self::TimeLimit => Problem::new(
                "/options/time_limit_s",
                Code::StoppedWithoutPlan,
                "the time limit passed before a first plan was found",
                "allow more time, or plan fewer targets at once",
            ),
            Self::Request => Problem::new(
                "",
                Code::StoppedWithoutPlan,
                "stopped on request before a first plan was found",
                "stop it when it has an incumbent",
            ),
            Self::Memory { limit } => Problem::new(
                "/targets",
                Code::MemoryLimit,
                format!(
                    "the solve needed more than {} MiB of memory before there was a plan",
                    limit >> 20
                ),
                "plan fewer targets at once, or raise --job-memory of the service",
            ),
        }
    }
}
