//! Settings and endings of the interior point.

/// Tolerances and limits; all in the problem's own scaled variables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Settings {
    /// Largest allowed optimality, feasibility and complementarity error (absolute; the scaled
    /// variables are of order one).
    pub(crate) tolerance: f64,
    /// Barrier parameter to begin with.
    pub(crate) initial_barrier: f64,
    /// Smallest slack of an inequality to begin with.
    pub(crate) initial_slack: f64,
    /// Iterations before giving up.
    pub(crate) max_iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            initial_barrier: 1e-1,
            initial_slack: 1e-2,
            max_iterations: 200,
        }
    }
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
