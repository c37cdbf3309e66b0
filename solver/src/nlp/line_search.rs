//! The way along a Newton step: as far as the filter accepts.

use super::barrier::BarrierProblem;
use super::chain::Chain;
use super::filter::{Acceptance, Filter};
use super::interruption::Interruptible;
use super::iterate::Iterate;
use super::merit::Merit;
use super::newton::Newton;
use super::status::NlpStatus;
use super::trial::Trial;
use std::ops::ControlFlow;

/// Largest fraction of the way to the boundary of slacks and multipliers that a step may go.
pub(super) const TO_BOUNDARY: f64 = 0.99;
/// Bounds of the ratio between `z` and `mu / s`.
const KAPPA_SIGMA: f64 = 1e10;
/// Halvings of the step length before restoration.
const MAX_BACKTRACKS: usize = 24;
/// Second-order corrections of a step.
const MAX_CORRECTIONS: usize = 2;
/// Another correction is tried when one reduces the infeasibility to this fraction or less.
const CORRECTION_GAIN: f64 = 0.99;

/// One search along the Newton step of an iterate.
pub(super) struct LineSearch<'a, C> {
    pub(super) caller: &'a Interruptible<'a, C>,
    pub(super) problem: &'a BarrierProblem,
    pub(super) newton: &'a mut Newton,
    pub(super) trial: &'a mut Trial,
    pub(super) filter: &'a mut Filter,
    pub(super) iterate: &'a mut Iterate,
}

/// What a trial is judged against.
#[derive(Clone, Copy)]
struct Reference {
    merit: Merit,
    /// Derivative of the barrier cost along the step.
    slope: f64,
    /// Longest step that slacks allow.
    longest: f64,
}

impl<C: Chain> LineSearch<'_, C> {
    /// Goes along the step until the filter accepts a trial; false when it accepts none. Breaks
    /// when the caller stops the solve.
    pub(super) fn run(mut self) -> ControlFlow<NlpStatus, bool> {
        let longest = self.longest_step();
        let here = Reference {
            merit: self.problem.merit(&self.iterate.slack),
            slope: self.newton.slope(self.problem),
            longest,
        };
        let mut alpha = longest;
        for attempt in 0..MAX_BACKTRACKS {
            let trial = self.measure(alpha);
            if self.accepts(here, trial, alpha) {
                self.newton.was_taken(alpha / longest);
                return ControlFlow::Continue(true);
            }
            self.caller.check()?;
            if attempt == 0
                && let Some(trial) = trial
                && trial.theta >= here.merit.theta
            {
                if self.accepts_corrected(here, trial.theta)? {
                    self.newton.was_taken(1.0);
                    return ControlFlow::Continue(true);
                }
                self.caller.check()?;
            }
            alpha *= 0.5;
        }
        ControlFlow::Continue(false)
    }

    /// Second-order corrections: the curvature of the links makes full steps infeasible, and the
    /// filter would cut them short (the Maratos effect). Corrected steps return to feasibility.
    /// Leaves the step as it was when the filter does not accept a corrected one either.
    fn accepts_corrected(
        &mut self,
        here: Reference,
        mut theta: f64,
    ) -> ControlFlow<NlpStatus, bool> {
        self.newton.swap_uncorrected();
        let mut alpha = here.longest;
        for _ in 0..MAX_CORRECTIONS {
            let missed = (&*self.trial, alpha);
            self.newton.correct(self.problem, self.iterate, missed);
            alpha = self.longest_step();
            let trial = self.measure(alpha);
            if self.accepts(here, trial, alpha) {
                return ControlFlow::Continue(true);
            }
            match trial {
                Some(trial) if trial.theta < CORRECTION_GAIN * theta => theta = trial.theta,
                _ => break,
            }
            self.caller.check()?;
        }
        self.newton.swap_uncorrected();
        ControlFlow::Continue(false)
    }

    /// Takes the trial point when the filter accepts it.
    fn accepts(&mut self, here: Reference, trial: Option<Merit>, alpha: f64) -> bool {
        let verdict =
            trial.and_then(|trial| self.filter.judge(here.merit, trial, here.slope, alpha));
        if verdict == Some(Acceptance::Progress) {
            self.filter.add(here.merit);
        }
        if verdict.is_some() {
            self.take(alpha);
        }
        verdict.is_some()
    }

    fn measure(&mut self, alpha: f64) -> Option<Merit> {
        let step = (self.newton.step(), alpha);
        let chain = self.caller.chain;
        self.trial.measure(chain, self.problem, self.iterate, step)
    }

    fn longest_step(&self) -> f64 {
        let step = self.newton.step();
        to_boundary(&self.iterate.slack, &step.slack, self.fraction())
    }

    fn fraction(&self) -> f64 {
        TO_BOUNDARY.max(1.0 - self.problem.mu)
    }

    /// Takes the trial point and moves the multipliers.
    fn take(&mut self, alpha: f64) {
        self.trial.take(self.iterate);
        let (fraction, mu) = (self.fraction(), self.problem.mu);
        let (iterate, step) = (&mut *self.iterate, self.newton.step());
        move_towards(&mut iterate.lambda, &step.lambda, alpha);
        move_towards(&mut iterate.nu, &step.nu, alpha);
        let dual = to_boundary(&iterate.z, &step.z, fraction);
        for ((z, step), s) in iterate.z.iter_mut().zip(&step.z).zip(&iterate.slack) {
            let central = mu / s;
            *z = (*z + dual * step).clamp(central / KAPPA_SIGMA, central * KAPPA_SIGMA);
        }
    }
}

/// Longest step length in `(0, 1]` that takes no positive value farther than a fraction of its way
/// to zero.
pub(super) fn to_boundary(values: &[f64], steps: &[f64], fraction: f64) -> f64 {
    values.iter().zip(steps).fold(1.0, |alpha, (value, step)| {
        // A product where there is nothing to divide for: most steps are far from the boundary.
        if alpha * step < -fraction * value {
            -fraction * value / step
        } else {
            alpha
        }
    })
}

fn move_towards(values: &mut [f64], target: &[f64], alpha: f64) {
    for (value, target) in values.iter_mut().zip(target) {
        *value += alpha * (target - *value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_step_keeps_a_share_of_every_positive_value() {
        assert!((to_boundary(&[1.0, 2.0], &[-4.0, -1.0], 0.8) - 0.2).abs() < 1e-15);
        assert!((to_boundary(&[1.0, 2.0], &[-0.5, 3.0], 0.8) - 1.0).abs() < 1e-15);
    }
}
