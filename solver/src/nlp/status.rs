//! How a solve ended, and what it reports.

use crate::run::stop::StopReason;
use std::fmt;

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NlpStatus {
    /// A local minimum within the tolerance.
    Converged,
    /// Not a minimum, but all conditions hold: the solution was constructed without the engine.
    Constructed,
    /// No further progress towards feasibility: probably there is no feasible point nearby.
    InfeasibleSuspected,
    /// The iterations are used up.
    IterationLimit,
    /// The caller ended the solve.
    Interrupted(StopReason),
    /// A number stopped being finite, or no step was possible.
    NumericalError(Breakdown),
}

/// Where the numbers broke down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Breakdown {
    /// Index of the node with its interval.
    pub(crate) stage: usize,
    /// What broke down there.
    pub(crate) quantity: Quantity,
}

/// What can break down at a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case", const_into_str)]
pub(crate) enum Quantity {
    /// The cost is not finite.
    Cost,
    /// The gap to the next node is not finite.
    Gap,
    /// An equality is not finite.
    Equality,
    /// An inequality is not finite.
    Inequality,
    /// A derivative is not finite.
    Derivative,
    /// No regularisation makes the curvature positive.
    Curvature,
    /// The step is longest there, and no part of it makes progress.
    Step,
    /// The solution fails when an independent integrator propagates it.
    Flight,
}

impl NlpStatus {
    /// The stable text of the status.
    pub(crate) const fn into_str(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Constructed => "constructed",
            Self::InfeasibleSuspected => "infeasible_suspected",
            Self::IterationLimit => "iteration_limit",
            Self::Interrupted(StopReason::TimeLimit) => "time_limit",
            // Neither wants the solution of the program that is being solved.
            Self::Interrupted(StopReason::Requested | StopReason::Cancelled) => "cancelled",
            Self::NumericalError(_) => "numerical_error",
        }
    }

    /// Whether the caller ended the solve.
    pub(crate) const fn is_interrupted(self) -> bool {
        matches!(self, Self::Interrupted(_))
    }
}

/// The stable text, with where the numbers broke down.
impl fmt::Display for NlpStatus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.into_str())?;
        match self {
            Self::NumericalError(Breakdown { stage, quantity }) => {
                write!(f, " ({} of stage {stage})", quantity.into_str())
            }
            _ => Ok(()),
        }
    }
}

/// What a solve reports.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NlpReport {
    /// How it ended.
    pub(crate) status: NlpStatus,
    /// Iterations, those of restoration included.
    pub(crate) iterations: usize,
    /// Largest gap, equality or inequality violation at the end.
    pub(crate) infeasibility: f64,
}
