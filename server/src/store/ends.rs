//! The end of a job: final state, result and stable code.

use super::{JobState, PackedPlan};
use slewplan_solver::model::problem::Code;

/// How a job ended.
#[derive(Debug, Clone)]
pub(crate) struct Ended {
    /// One of the final states.
    pub(crate) state: JobState,
    /// The result document, if any: a plan, or the reasons why there is none.
    pub(crate) document: Option<PackedPlan>,
    /// Duration of the plan, s; `None` without one.
    pub(crate) incumbent_s: Option<f64>,
    /// Lower bound on the duration, s.
    pub(crate) lower_bound_s: Option<f64>,
    /// Sum of the values that the plan visits, where targets have values.
    pub(crate) value: Option<f64>,
    /// Upper bound on that sum.
    pub(crate) value_bound: Option<f64>,
    /// Whether the plan violates a cone; `None` without a plan, or where it was stored before this
    /// was noted.
    pub(crate) keep_out_violated: Option<bool>,
    /// Why the job ended without a plan.
    pub(crate) detail: Option<String>,
    /// The same reason as a stable code.
    pub(crate) code: Option<EndCode>,
    /// Whether the solve was cut short: then a better plan of an earlier attempt is the result.
    pub(crate) early: bool,
}

/// Why a job ended without a plan, as a stable code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EndCode {
    /// A problem of the scenario or of its solve.
    Problem(Code),
    /// An error of the program.
    Internal,
    /// The process ended at every attempt.
    ProcessDied,
}

impl EndCode {
    /// The codes that are not problems of an input, for the error index.
    pub(crate) const OWN: [Self; 2] = [Self::Internal, Self::ProcessDied];

    /// The stable text of the code.
    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Problem(code) => code.into(),
            Self::Internal => "internal_error",
            Self::ProcessDied => "process_died",
        }
    }

    /// The meaning of the code, as a sentence.
    pub(crate) fn meaning(self) -> &'static str {
        match self {
            Self::Problem(code) => code.meaning(),
            Self::Internal => "An error of the program ended the solve.",
            Self::ProcessDied => "The process of the service ended unexpectedly at every attempt.",
        }
    }

    /// What to do about it, as a sentence.
    pub(crate) fn remedy(self) -> &'static str {
        match self {
            Self::Problem(code) => code.remedy(),
            Self::Internal => "Report it with the scenario.",
            Self::ProcessDied => {
                "Look into the logs of service and machine, at the memory first; report it with \
                 the scenario."
            }
        }
    }
}
