//! Settings and endings of the interior point.

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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NlpStatus {
    /// A local minimum within the tolerance.
    Converged,
    /// No further progress towards feasibility: probably there is none nearby.
    InfeasibleSuspected,
    /// Out of iterations.
    IterationLimit,
    /// A stop signal was seen.
    Stopped,
    /// A number stopped being finite, or no regularisation made a step possible.
    NumericalError,
}

impl NlpStatus {
    /// The stable text of the status.
    pub(crate) const fn as_str(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::InfeasibleSuspected => "infeasible_suspected",
            Self::IterationLimit => "iteration_limit",
            Self::Stopped => "stopped",
            Self::NumericalError => "numerical_error",
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
