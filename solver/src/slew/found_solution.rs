//! A solution with the number of guesses and iterations spent on it.

use super::solving::ProgramSolution;

/// A solution, and what all solves on the way to it took.
pub(super) struct FoundSolution {
    pub(super) solved: ProgramSolution,
    pub(super) starts: usize,
    pub(super) iterations: usize,
    pub(super) continuous_time: Option<f64>,
    /// Why the solution does not answer the slew, if it does not.
    pub(super) refusal: Option<String>,
}

impl FoundSolution {
    /// The same solution, counting what an earlier one took too.
    pub(super) fn after(self, before: &Self) -> Self {
        Self {
            starts: before.starts + self.starts,
            iterations: before.iterations + self.iterations,
            ..self
        }
    }
}
