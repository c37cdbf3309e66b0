//! Restoration: when the filter accepts no part of a step, steps towards feasibility alone.
//!
//! Steps solve the Newton system without cost and Lagrangian curvature, with a small multiple of
//! the identity instead: damped Gauss-Newton on gaps, equalities and slack errors, the barrier
//! kept on the slacks.

use super::barrier::BarrierProblem;
use super::breakdown;
use super::chain::Chain;
use super::filter::Filter;
use super::interruption::Interruptible;
use super::iterate::Iterate;
use super::line_search::{TO_BOUNDARY, to_boundary};
use super::newton::Newton;
use super::settings::Settings;
use super::status::NlpStatus;
use super::trial::Trial;
use std::ops::ControlFlow;

/// Infeasibility must fall to this fraction before the normal method resumes.
const ENOUGH: f64 = 0.9;
/// Limit of the steps of one restoration.
const MAX_STEPS: usize = 40;
/// Halvings of a step.
const MAX_BACKTRACKS: usize = 30;
/// Sufficient decrease of the infeasibility, relative and per step length.
const SUFFICIENT: f64 = 1e-4;

/// One restoration of an iterate.
pub(super) struct Restoration<'a, C> {
    pub(super) caller: &'a Interruptible<'a, C>,
    pub(super) settings: &'a Settings,
    pub(super) problem: &'a mut BarrierProblem,
    pub(super) newton: &'a mut Newton,
    pub(super) trial: &'a mut Trial,
    pub(super) filter: &'a mut Filter,
    pub(super) iterate: &'a mut Iterate,
    /// Iterations of the whole solve.
    pub(super) iterations: &'a mut usize,
}

impl<C: Chain> Restoration<'_, C> {
    /// Reduces infeasibility until the filter admits the point again; breaks when that fails.
    pub(super) fn run(mut self) -> ControlFlow<NlpStatus> {
        let begin = self.problem.merit(&self.iterate.slack);
        if begin.theta <= self.settings.feasibility {
            // Feasible, and yet no step is accepted: floating point resolves no better cost.
            let stuck = breakdown::of_step(&self.problem.layout, self.newton.step());
            return ControlFlow::Break(stuck);
        }
        self.filter.add(begin);
        for _ in 0..MAX_STEPS {
            self.settings.count(self.iterations)?;
            self.step()?;
            let slack = &self.iterate.slack;
            let now = self.problem.merit_of(self.trial.values(), slack);
            if now.theta <= ENOUGH * begin.theta && self.filter.admits(now) {
                self.reset_multipliers();
                return ControlFlow::Continue(());
            }
            let (chain, values) = (self.caller.chain, self.trial.values());
            self.problem.linearise(chain, self.iterate, values);
        }
        ControlFlow::Break(NlpStatus::InfeasibleSuspected)
    }

    /// One damped step that reduces infeasibility; breaks when there is none.
    fn step(&mut self) -> ControlFlow<NlpStatus> {
        let convex = self
            .newton
            .compute_towards_feasibility(self.problem, self.iterate);
        if !convex {
            return ControlFlow::Break(NlpStatus::InfeasibleSuspected);
        }
        let (step, chain) = (self.newton.step(), self.caller.chain);
        let current = self.problem.merit(&self.iterate.slack).theta;
        let mut alpha = to_boundary(&self.iterate.slack, &step.slack, TO_BOUNDARY);
        for _ in 0..MAX_BACKTRACKS {
            self.caller.check()?;
            let along = (step, alpha);
            let trial = self.trial.measure(chain, self.problem, self.iterate, along);
            if trial.is_some_and(|trial| trial.theta <= (1.0 - SUFFICIENT * alpha) * current) {
                self.trial.take(self.iterate);
                return ControlFlow::Continue(());
            }
            alpha *= 0.5;
        }
        ControlFlow::Break(NlpStatus::InfeasibleSuspected)
    }

    /// Multipliers of the restored point: zero, and `mu / s` of the inequalities.
    fn reset_multipliers(&mut self) {
        self.iterate.lambda.fill(0.0);
        self.iterate.nu.fill(0.0);
        for (z, s) in self.iterate.z.iter_mut().zip(&self.iterate.slack) {
            *z = self.problem.mu / s;
        }
    }
}
