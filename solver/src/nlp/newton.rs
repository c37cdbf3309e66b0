//! The Newton step of the barrier problem, inequalities condensed.

use super::barrier::BarrierProblem;
use super::breakdown;
use super::dense::{add_transpose_mul, dot, mul};
use super::interruption::Interruptible;
use super::iterate::{Iterate, Layout};
use super::regularisation::Regularisation;
use super::riccati::{MAX_CONTROLS, MAX_STATES, NewtonSystem, RightHandSide, Step, system_for};
use super::status::NlpStatus;
use super::trial::Trial;
use std::ops::ControlFlow;

/// Weight of the proximity to the current point in steps towards feasibility.
const DAMPING: f64 = 1e-4;

/// The Newton system with its right-hand side and its last step.
pub(super) struct Newton {
    system: Box<dyn NewtonSystem>,
    regularisation: Regularisation,
    rhs: RightHandSide,
    /// Weights of the condensed inequalities, `z / s` in Newton steps.
    sigma: Vec<f64>,
    /// `1 / s`.
    inverse_slack: Vec<f64>,
    /// What the slacks pull at the variables, negative.
    pull: Vec<f64>,
    step: Step,
    /// The step before its second-order correction.
    uncorrected: Step,
}

impl Newton {
    /// Storage for the steps of a chain.
    pub(super) fn of(layout: &Layout) -> Self {
        let step = Step::zeros(layout);
        Self {
            system: system_for(layout),
            regularisation: Regularisation::default(),
            rhs: RightHandSide::zeros(layout),
            sigma: vec![0.0; layout.all_inequalities()],
            inverse_slack: vec![0.0; layout.all_inequalities()],
            pull: vec![0.0; layout.all_inequalities()],
            uncorrected: step.clone(),
            step,
        }
    }

    /// Resets the regularisation for another solve.
    pub(super) fn restart(&mut self) {
        self.regularisation = Regularisation::default();
    }

    /// The last step.
    pub(super) fn step(&self) -> &Step {
        &self.step
    }

    /// Computes the step at an iterate; breaks when no regularisation makes the system convex, or
    /// when the caller stops the solve.
    pub(super) fn compute<C>(
        &mut self,
        caller: &Interruptible<'_, C>,
        problem: &BarrierProblem,
        iterate: &Iterate,
    ) -> ControlFlow<NlpStatus> {
        self.invert_slacks(iterate);
        let known = iterate.z.iter().zip(&self.inverse_slack);
        for (sigma, (z, inverse)) in self.sigma.iter_mut().zip(known) {
            *sigma = z * inverse;
        }
        let mut delta = self.regularisation.first();
        while let Err(stage) = self
            .system
            .factor(&problem.models, &self.sigma, delta, true)
        {
            let Some(next) = self.regularisation.next(delta) else {
                return ControlFlow::Break(breakdown::of_system(&problem.models, stage));
            };
            caller.check()?;
            delta = next;
        }
        self.regularisation.succeeded(delta);
        self.fill_residuals(problem, iterate);
        self.solve(problem, iterate);
        ControlFlow::Continue(())
    }

    /// Computes a step towards feasibility: the system without cost and without Lagrangian
    /// curvature, with a small multiple of the identity instead. False when it is not convex.
    pub(super) fn compute_towards_feasibility(
        &mut self,
        problem: &BarrierProblem,
        iterate: &Iterate,
    ) -> bool {
        self.invert_slacks(iterate);
        for (sigma, inverse) in self.sigma.iter_mut().zip(&self.inverse_slack) {
            *sigma = problem.mu * (inverse * inverse);
        }
        let factored = self
            .system
            .factor(&problem.models, &self.sigma, DAMPING, false);
        if factored.is_err() {
            return false;
        }
        self.fill_residuals(problem, iterate);
        self.fill_gradient(problem, 0.0);
        self.step.nu.fill(0.0);
        self.system
            .solve(&problem.models, &self.rhs, &mut self.step);
        self.fill_inequality_steps(problem, iterate);
        true
    }

    /// Computes a second-order correction: the step that also removes what a trial at `alpha` along
    /// the last one has left of the residuals, with the same factors.
    pub(super) fn correct(
        &mut self,
        problem: &BarrierProblem,
        iterate: &Iterate,
        (trial, alpha): (&Trial, f64),
    ) {
        self.add_residuals_of(&problem.layout, trial, alpha);
        self.solve(problem, iterate);
    }

    /// Puts the step aside while corrections of it are tried, or back when none serves.
    pub(super) fn swap_uncorrected(&mut self) {
        std::mem::swap(&mut self.step, &mut self.uncorrected);
    }

    /// Adapts the regularisation to the share of the longest possible step that was taken.
    pub(super) fn was_taken(&mut self, share: f64) {
        self.regularisation.stepped(share);
    }

    /// Derivative of the barrier cost along the step.
    pub(super) fn slope(&self, problem: &BarrierProblem) -> f64 {
        let layout = &problem.layout;
        let mut slope = 0.0;
        for (node, model) in problem.models.iter().enumerate() {
            let (by_state, by_control) = model.gradient.split_at(layout.states);
            slope += dot(by_state, &self.step.states[layout.state(node)]);
            slope += dot(by_control, &self.step.controls[layout.control(node)]);
        }
        let steps = self.step.slack.iter().zip(&self.inverse_slack);
        slope - problem.mu * steps.map(|(ds, inverse)| ds * inverse).sum::<f64>()
    }

    fn invert_slacks(&mut self, iterate: &Iterate) {
        for (inverse, slack) in self.inverse_slack.iter_mut().zip(&iterate.slack) {
            *inverse = slack.recip();
        }
    }

    /// Solves the factorised system for the residuals on the right-hand side.
    fn solve(&mut self, problem: &BarrierProblem, iterate: &Iterate) {
        self.fill_gradient(problem, 1.0);
        self.step.nu.copy_from_slice(&iterate.nu);
        self.system
            .solve(&problem.models, &self.rhs, &mut self.step);
        self.fill_inequality_steps(problem, iterate);
    }

    /// Residuals of links, equalities and slacks at the iterate.
    fn fill_residuals(&mut self, problem: &BarrierProblem, iterate: &Iterate) {
        let layout = &problem.layout;
        for (node, model) in problem.models.iter().enumerate() {
            let rows = layout.inequality(node);
            self.rhs.gap[layout.link(node)].copy_from_slice(&model.values.gap);
            self.rhs.equality[layout.equality(node)].copy_from_slice(&model.values.equality);
            let slack = iterate.slack[rows.clone()].iter();
            let values = model.values.inequality.iter().zip(slack);
            for (out, (g, s)) in self.rhs.slack[rows].iter_mut().zip(values) {
                *out = g - s;
            }
        }
    }

    /// Adds the residuals at a trial to the share of them that a step to there leaves.
    fn add_residuals_of(&mut self, layout: &Layout, trial: &Trial, alpha: f64) {
        let add = |residuals: &mut [f64], missed: &[f64]| {
            for (residual, missed) in residuals.iter_mut().zip(missed) {
                *residual = alpha * *residual + missed;
            }
        };
        for (node, values) in trial.values().iter().enumerate() {
            add(&mut self.rhs.gap[layout.link(node)], &values.gap);
            let equalities = layout.equality(node);
            add(&mut self.rhs.equality[equalities], &values.equality);
            for (index, missed) in trial.slack_errors(layout, node) {
                let residual = &mut self.rhs.slack[index];
                *residual = alpha * *residual + missed;
            }
        }
    }

    /// Gradient of the condensed system; `cost_weight` is zero towards feasibility.
    fn fill_gradient(&mut self, problem: &BarrierProblem, cost_weight: f64) {
        let weights = self.sigma.iter().zip(&self.rhs.slack);
        let known = weights.zip(&self.inverse_slack);
        for (pull, ((sigma, residual), inverse)) in self.pull.iter_mut().zip(known) {
            *pull = sigma * residual - problem.mu * inverse;
        }
        let layout = &problem.layout;
        let mut all = [0.0; MAX_STATES + MAX_CONTROLS];
        for (node, model) in problem.models.iter().enumerate() {
            let gradient = &mut all[..model.vars];
            for (out, value) in gradient.iter_mut().zip(&model.gradient) {
                *out = cost_weight * value;
            }
            let pull = &self.pull[layout.inequality(node)];
            add_transpose_mul(&model.inequality_jacobian, pull, gradient);
            let (states, controls) = gradient.split_at(layout.states);
            self.rhs.states[layout.state(node)].copy_from_slice(states);
            self.rhs.controls[layout.control(node)].copy_from_slice(controls);
        }
    }

    /// Steps of slacks and their multipliers that belong to the primal step.
    fn fill_inequality_steps(&mut self, problem: &BarrierProblem, iterate: &Iterate) {
        let layout = &problem.layout;
        let mut all = [0.0; MAX_STATES + MAX_CONTROLS];
        for (node, model) in problem.models.iter().enumerate() {
            let step = &mut all[..model.vars];
            let (states, controls) = step.split_at_mut(layout.states);
            states.copy_from_slice(&self.step.states[layout.state(node)]);
            controls.copy_from_slice(&self.step.controls[layout.control(node)]);
            let moved = &mut self.step.slack[layout.inequality(node)];
            mul(&model.inequality_jacobian, step, moved);
        }
        let slacks = self.step.slack.iter_mut().zip(&self.rhs.slack);
        let here = self.inverse_slack.iter().zip(&iterate.z);
        for (out, ((step, residual), (inverse, z))) in self.step.z.iter_mut().zip(slacks.zip(here))
        {
            *step += residual;
            *out = (problem.mu - z * *step) * inverse - z;
        }
    }
}
