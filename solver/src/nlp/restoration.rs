//! Restoration: when no step pleases the filter, walk back towards feasibility.
//!
//! Steps solve the Newton system without cost and Lagrangian curvature, with a small multiple of
//! the identity instead: damped Gauss-Newton on gaps, equalities and slack errors, the barrier
//! kept on the slacks.

use super::chain::Chain;
use super::interior_point::InteriorPoint;
use super::iterate::Iterate;
use super::line_search::to_boundary;
use super::settings::{Interruption, NlpStatus};

/// Weight of the proximity to the current point.
const DAMPING: f64 = 1e-4;
/// Infeasibility must fall to this fraction before the normal method resumes.
const ENOUGH: f64 = 0.9;
/// Steps before giving up.
const MAX_STEPS: usize = 40;
/// Halvings of a step.
const MAX_BACKTRACKS: usize = 30;

impl InteriorPoint {
    /// Reduces infeasibility until the filter admits the point again.
    pub(super) fn restore<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &mut Iterate,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> Result<(), NlpStatus> {
        if let Some(reason) = stop() {
            return Err(reason.into());
        }
        let begin = self.merit_of_models(&iterate.slack);
        if begin.theta <= self.settings.feasibility {
            // Feasible and yet stuck: the cost cannot be improved in floating point.
            return Err(self.broken_step());
        }
        self.filter.add(begin);
        for _ in 0..MAX_STEPS {
            if self.iterations >= self.settings.max_iterations {
                return Err(NlpStatus::IterationLimit);
            }
            self.iterations += 1;
            if !self.feasibility_step(chain, iterate, stop) {
                return Err(stop().map_or(NlpStatus::InfeasibleSuspected, NlpStatus::from));
            }
            let now = self.merit_of_values(&iterate.slack);
            if now.theta <= ENOUGH * begin.theta && self.filter.admits(now) {
                iterate.lambda.fill(0.0);
                iterate.nu.fill(0.0);
                for (z, s) in iterate.z.iter_mut().zip(&iterate.slack) {
                    *z = self.mu / s;
                }
                return Ok(());
            }
            self.evaluate(chain, iterate);
        }
        Err(NlpStatus::InfeasibleSuspected)
    }

    /// One damped step that reduces infeasibility; false when none does, or stopped.
    fn feasibility_step<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &mut Iterate,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> bool {
        for (sigma, s) in self.sigma.iter_mut().zip(&iterate.slack) {
            *sigma = self.mu / (s * s);
        }
        let factored = self
            .system
            .factor(&self.models, &self.sigma, DAMPING, false);
        if factored.is_err() {
            return false;
        }
        self.fill_residuals(iterate);
        self.fill_gradient(iterate, 0.0);
        self.step.nu.fill(0.0);
        self.system.solve(&self.models, &self.rhs, &mut self.step);
        self.inequality_steps(iterate);
        let current = self.merit_of_models(&iterate.slack).theta;
        let mut alpha = to_boundary(&iterate.slack, &self.slack_step, 0.99);
        for _ in 0..MAX_BACKTRACKS {
            if stop().is_some() {
                return false;
            }
            let trial = self.trial_merit(chain, iterate, alpha);
            if trial.is_some_and(|trial| trial.theta <= (1.0 - 1e-4 * alpha) * current) {
                self.take_trial(iterate);
                return true;
            }
            alpha *= 0.5;
        }
        false
    }
}
