//! A solution and what it took to find it.

use super::solving::ProgramSolution;

/// A solution with the way to it.
pub(super) struct FoundSolution {
    pub(super) solved: ProgramSolution,
    pub(super) starts: usize,
    pub(super) iterations: usize,
    pub(super) continuous_time: Option<f64>,
    /// Why this is no answer, although it is a solution.
    pub(super) refusal: Option<String>,
}

impl FoundSolution {
    /// The same, which took another solution first.
    pub(super) fn after(self, before: &Self) -> Self {
        Self {
            starts: before.starts + self.starts,
            iterations: before.iterations + self.iterations,
            ..self
        }
    }
}
