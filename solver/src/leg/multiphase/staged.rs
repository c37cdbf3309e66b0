//! A motion solved in stages, so that several starts can be compared after each of them.

use super::passes::{Pass, from_a_guess};
use super::{LegSolution, MultiphaseSolve};
use crate::leg::profile::Profile;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::nlp::NlpStatus;
use crate::run::stop::StopReason;

/// A motion between its first pass and its exact solution.
pub(crate) struct StagedSolve<'a> {
    solve: MultiphaseSolve<'a>,
    left: &'static [Pass],
}

impl<'a> StagedSolve<'a> {
    /// The rough motion through waypoints after the first pass, from a guess whose nodes are split
    /// into legs by `intervals`.
    pub(crate) fn rough(
        dynamics: &'a Dynamics,
        waypoints: &[Waypoint],
        intervals: &[usize],
        guess: &Profile,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> Self {
        let passes = from_a_guess(dynamics);
        let mut solve = MultiphaseSolve::new(dynamics, waypoints, intervals, guess);
        solve.run_passes(&passes[..1], stop);
        Self {
            solve,
            left: &passes[1..],
        }
    }

    /// Duration, s, of the motion so far; `None` where it has not converged.
    pub(crate) fn duration(&self) -> Option<f64> {
        self.solve.solution.duration()
    }

    /// The motion so far.
    pub(crate) fn motion(&self) -> &Profile {
        &self.solve.solution.profile
    }

    /// Runs the passes that are left. The motion is optimal then, but not exact between its nodes.
    pub(crate) fn refine(&mut self, stop: &dyn Fn() -> Option<StopReason>) {
        let left = std::mem::take(&mut self.left);
        if !left.is_empty() && self.solve.solution.status == NlpStatus::Converged {
            self.solve.anticipate();
            self.solve.run_passes(left, stop);
        }
    }

    /// The exact solution.
    pub(crate) fn exact(self, stop: &dyn Fn() -> Option<StopReason>) -> LegSolution {
        self.solve.exact(stop)
    }
}
