//! Settings of the interior point.

use super::status::NlpStatus;
use std::ops::ControlFlow;

/// Tolerances and limits; all in the problem's own scaled variables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Settings {
    /// Largest error of stationarity and complementarity. Absolute: scaled variables are of order
    /// one, and the cost exceeds its minimum by about this much.
    pub(crate) tolerance: f64,
    /// Multiple of the tolerance up to which stationarity counts as reached.
    pub(crate) stationarity: f64,
    /// Largest gap, equality or slack error.
    pub(crate) feasibility: f64,
    /// Barrier parameter of the first iteration.
    pub(crate) initial_barrier: f64,
    /// Smallest slack of an inequality in the first iteration.
    pub(crate) initial_slack: f64,
    /// Limit of the iterations, those of restoration included.
    pub(crate) max_iterations: usize,
}

impl Settings {
    /// From a guess without multipliers to an accurate solution.
    pub(crate) const COLD: Self = Self {
        tolerance: 1e-5,
        stationarity: 1.0,
        feasibility: 1e-9,
        initial_barrier: 1e-2,
        initial_slack: 3e-2,
        max_iterations: 200,
    };

    /// Counts an iteration; breaks when there are no more.
    pub(super) fn count(&self, iterations: &mut usize) -> ControlFlow<NlpStatus> {
        if *iterations >= self.max_iterations {
            return ControlFlow::Break(NlpStatus::IterationLimit);
        }
        *iterations += 1;
        ControlFlow::Continue(())
    }
}
