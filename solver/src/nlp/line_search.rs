//! The way along a Newton step: as far as the filter accepts.

use super::chain::Chain;
use super::dense::dot;
use super::filter::Acceptance;
use super::interior_point::InteriorPoint;
use super::iterate::Iterate;
use super::merit::Merit;
use super::settings::Interruption;

/// Largest fraction of the way to the boundary of slacks and multipliers that a step may go.
const TO_BOUNDARY: f64 = 0.99;
/// Bounds of the ratio between `z` and `mu / s`.
const KAPPA_SIGMA: f64 = 1e10;
/// Halvings of the step length before restoration.
const MAX_BACKTRACKS: usize = 24;
/// Second-order corrections of a step, and the decrease of infeasibility that earns another one.
const MAX_CORRECTIONS: usize = 2;
const CORRECTION_GAIN: f64 = 0.99;

/// What a trial is judged against.
#[derive(Clone, Copy)]
struct Here {
    merit: Merit,
    /// Derivative of the barrier cost along the step.
    slope: f64,
    /// Longest step that slacks allow.
    longest: f64,
}

impl InteriorPoint {
    /// Goes along the step until the filter accepts; false when it never does, or stopped.
    pub(super) fn line_search<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &mut Iterate,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> bool {
        let longest = to_boundary(&iterate.slack, &self.slack_step, self.fraction());
        let here = Here {
            merit: self.merit_of_models(&iterate.slack),
            slope: self.slope(iterate),
            longest,
        };
        let mut alpha = longest;
        for attempt in 0..MAX_BACKTRACKS {
            let trial = self.trial_merit(chain, iterate, alpha);
            if self.accepts(iterate, here, trial, alpha) {
                self.regularisation.stepped(alpha / longest);
                return true;
            }
            if stop().is_some() {
                return false;
            }
            if attempt == 0
                && let Some(trial) = trial
                && trial.theta >= here.merit.theta
                && self.corrected(chain, iterate, here, trial.theta, stop)
            {
                self.regularisation.stepped(1.0);
                return true;
            }
            if stop().is_some() {
                return false;
            }
            alpha *= 0.5;
        }
        false
    }

    /// Second-order correction: full steps that the curvature of the links has thrown off are bent
    /// back to feasibility, which the filter would otherwise cut short (the Maratos effect).
    /// Leaves the step as it was when the filter does not accept a corrected one either.
    fn corrected<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &mut Iterate,
        here: Here,
        mut theta: f64,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> bool {
        std::mem::swap(&mut self.step, &mut self.uncorrected);
        let mut alpha = here.longest;
        for _ in 0..MAX_CORRECTIONS {
            self.correct_residuals(alpha);
            self.solve_system(iterate);
            alpha = to_boundary(&iterate.slack, &self.slack_step, self.fraction());
            let trial = self.trial_merit(chain, iterate, alpha);
            if self.accepts(iterate, here, trial, alpha) {
                return true;
            }
            match trial {
                Some(trial) if trial.theta < CORRECTION_GAIN * theta && stop().is_none() => {
                    theta = trial.theta;
                }
                _ => break,
            }
        }
        std::mem::swap(&mut self.step, &mut self.uncorrected);
        self.fill_residuals(iterate);
        self.inequality_steps(iterate);
        false
    }

    /// Adds what the trial at a step length has missed to the residuals.
    fn correct_residuals(&mut self, alpha: f64) {
        let add = |residuals: &mut [f64], missed: &[f64]| {
            for (residual, missed) in residuals.iter_mut().zip(missed) {
                *residual = alpha * *residual + missed;
            }
        };
        for (node, values) in self.trial_values.iter().enumerate() {
            add(&mut self.rhs.gap[self.layout.link(node)], &values.gap);
            let equalities = self.layout.equality(node);
            add(&mut self.rhs.equality[equalities], &values.equality);
            for (i, index) in self.layout.inequality(node).enumerate() {
                let missed = values.inequality[i] - self.trial.slack[index];
                let residual = &mut self.rhs.slack[index];
                *residual = alpha * *residual + missed;
            }
        }
    }

    /// Takes the trial point when the filter accepts it.
    fn accepts(
        &mut self,
        iterate: &mut Iterate,
        here: Here,
        trial: Option<Merit>,
        alpha: f64,
    ) -> bool {
        let verdict =
            trial.and_then(|trial| self.filter.judge(here.merit, trial, here.slope, alpha));
        if verdict == Some(Acceptance::Progress) {
            self.filter.add(here.merit);
        }
        if verdict.is_some() {
            self.accept(iterate, alpha);
        }
        verdict.is_some()
    }

    fn fraction(&self) -> f64 {
        TO_BOUNDARY.max(1.0 - self.mu)
    }

    /// Derivative of the barrier cost along the step.
    fn slope(&self, iterate: &Iterate) -> f64 {
        let mut slope = 0.0;
        for (node, model) in self.models.iter().enumerate() {
            let (by_state, by_control) = model.gradient.split_at(self.layout.states);
            slope += dot(by_state, &self.step.states[self.layout.state(node)]);
            slope += dot(by_control, &self.step.controls[self.layout.control(node)]);
        }
        let steps = self.slack_step.iter().zip(&iterate.slack);
        slope - self.mu * steps.map(|(ds, s)| ds / s).sum::<f64>()
    }

    /// Moves the trial point along the step and measures it; `None` when it is not finite.
    pub(super) fn trial_merit<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &Iterate,
        alpha: f64,
    ) -> Option<Merit> {
        for (out, step) in self.trial_step.iter_mut().zip(&self.step.states) {
            *out = alpha * step;
        }
        for node in 0..=self.layout.intervals {
            let range = self.layout.point(node);
            chain.retract(
                &iterate.points[range.clone()],
                &self.trial_step[self.layout.state(node)],
                &mut self.trial.points[range],
            );
        }
        let (controls, slack) = (&mut self.trial.controls, &mut self.trial.slack);
        advance(&iterate.controls, &self.step.controls, alpha, controls);
        advance(&iterate.slack, &self.slack_step, alpha, slack);
        for (node, values) in self.trial_values.iter_mut().enumerate() {
            chain.values(&self.trial.link(&self.layout, node), values);
            if !values.is_finite() {
                return None;
            }
        }
        Some(self.merit_of_values(&self.trial.slack))
    }

    /// Takes the trial point and moves the multipliers.
    fn accept(&mut self, iterate: &mut Iterate, alpha: f64) {
        self.take_trial(iterate);
        toward(&mut iterate.lambda, &self.step.lambda, alpha);
        toward(&mut iterate.nu, &self.step.nu, alpha);
        let dual = to_boundary(&iterate.z, &self.z_step, self.fraction());
        for ((z, step), s) in iterate.z.iter_mut().zip(&self.z_step).zip(&iterate.slack) {
            let central = self.mu / s;
            *z = (*z + dual * step).clamp(central / KAPPA_SIGMA, central * KAPPA_SIGMA);
        }
    }

    /// Makes the trial point the current one.
    pub(super) fn take_trial(&mut self, iterate: &mut Iterate) {
        std::mem::swap(&mut iterate.points, &mut self.trial.points);
        std::mem::swap(&mut iterate.controls, &mut self.trial.controls);
        std::mem::swap(&mut iterate.slack, &mut self.trial.slack);
    }
}

/// Longest step length in `(0, 1]` that keeps positive values at a fraction of their distance
/// to zero.
pub(super) fn to_boundary(values: &[f64], steps: &[f64], fraction: f64) -> f64 {
    values.iter().zip(steps).fold(1.0, |alpha, (value, step)| {
        if *step < 0.0 {
            alpha.min(-fraction * value / step)
        } else {
            alpha
        }
    })
}

fn advance(from: &[f64], step: &[f64], alpha: f64, to: &mut [f64]) {
    for ((out, value), step) in to.iter_mut().zip(from).zip(step) {
        *out = value + alpha * step;
    }
}

fn toward(values: &mut [f64], target: &[f64], alpha: f64) {
    for (value, target) in values.iter_mut().zip(target) {
        *value += alpha * (target - *value);
    }
}
