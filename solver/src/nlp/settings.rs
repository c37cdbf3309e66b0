//! Settings and endings of the interior point.

use std::fmt;

/// Tolerances and limits; all in the problem's own scaled variables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Settings {
    /// Largest error of stationarity and complementarity (absolute; the scaled variables are of
    /// order one, and so is a minimum's share that this can cost).
    pub(crate) tolerance: f64,
    /// Largest gap, equality or slack error.
    pub(crate) feasibility: f64,
    /// Barrier parameter to begin with.
    pub(crate) initial_barrier: f64,
    /// Smallest slack of an inequality to begin with.
    pub(crate) initial_slack: f64,
    /// Iterations before giving up.
    pub(crate) max_iterations: usize,
}

impl Settings {
    /// From a guess without multipliers to an accurate solution.
    pub(crate) const COLD: Self = Self {
        tolerance: 1e-5,
        feasibility: 1e-9,
        initial_barrier: 1e-2,
        initial_slack: 3e-2,
        max_iterations: 200,
    };
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case", const_into_str)]
pub(crate) enum NlpStatus {
    /// A local minimum within the tolerance.
    Converged,
    /// No minimum was found; what there is satisfies all conditions.
    Constructed,
    /// No further progress towards feasibility: probably there is none nearby.
    InfeasibleSuspected,
    /// Out of iterations.
    IterationLimit,
    /// The time is up.
    TimeLimit,
    /// The caller asked for an end.
    Cancelled,
    /// A number stopped being finite, or no step was possible.
    NumericalError(Breakdown),
}

/// Why a solve is to end before its time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Interruption {
    /// The time is up.
    TimeLimit,
    /// The caller asked for it.
    Cancelled,
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
    /// The step is the longest there, and no part of it makes progress.
    Step,
    /// The solution does not fly there when it is integrated by other means.
    Flight,
}

impl NlpStatus {
    /// Whether the solve was ended from outside.
    pub(crate) const fn is_interrupted(self) -> bool {
        matches!(self, Self::TimeLimit | Self::Cancelled)
    }
}

impl From<Interruption> for NlpStatus {
    fn from(interruption: Interruption) -> Self {
        match interruption {
            Interruption::TimeLimit => Self::TimeLimit,
            Interruption::Cancelled => Self::Cancelled,
        }
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

/// What a solve did.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NlpReport {
    /// How it ended.
    pub(crate) status: NlpStatus,
    /// Iterations, restoration included.
    pub(crate) iterations: usize,
    /// Largest gap, equality or inequality violation at the end.
    pub(crate) infeasibility: f64,
}
