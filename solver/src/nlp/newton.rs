//! The Newton step of the barrier problem, inequalities condensed.

use super::dense::{axpy, dot};
use super::interior_point::InteriorPoint;
use super::iterate::Iterate;
use super::settings::Interruption;

impl InteriorPoint {
    /// Computes the Newton step; false when no regularisation makes the system convex, or stopped.
    pub(super) fn newton_step(
        &mut self,
        iterate: &Iterate,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> bool {
        for ((sigma, z), s) in self.sigma.iter_mut().zip(&iterate.z).zip(&iterate.slack) {
            *sigma = z / s;
        }
        let mut delta = self.regularisation.first();
        while let Err(stage) = self.system.factor(&self.models, &self.sigma, delta, true) {
            self.failed_stage = stage;
            match self.regularisation.next(delta) {
                Some(next) if stop().is_none() => delta = next,
                _ => return false,
            }
        }
        self.regularisation.succeeded(delta);
        self.fill_residuals(iterate);
        self.solve_system(iterate);
        true
    }

    /// Solves the factorised system for the residuals on the right-hand side.
    pub(super) fn solve_system(&mut self, iterate: &Iterate) {
        self.fill_gradient(iterate, 1.0);
        self.step.nu.copy_from_slice(&iterate.nu);
        self.system.solve(&self.models, &self.rhs, &mut self.step);
        self.inequality_steps(iterate);
    }

    /// Residuals of links, equalities and slacks at the current point.
    pub(super) fn fill_residuals(&mut self, iterate: &Iterate) {
        for (node, model) in self.models.iter().enumerate() {
            let rows = self.layout.inequality(node);
            self.rhs.gap[self.layout.link(node)].copy_from_slice(&model.values.gap);
            self.rhs.equality[self.layout.equality(node)].copy_from_slice(&model.values.equality);
            let slack = iterate.slack[rows.clone()].iter();
            let values = model.values.inequality.iter().zip(slack);
            for (out, (g, s)) in self.rhs.slack[rows].iter_mut().zip(values) {
                *out = g - s;
            }
        }
    }

    /// Gradient of the condensed system; `cost_weight` is zero in restoration.
    pub(super) fn fill_gradient(&mut self, iterate: &Iterate, cost_weight: f64) {
        let n = self.layout.states;
        for (node, model) in self.models.iter().enumerate() {
            let states = &mut self.rhs.states[self.layout.state(node)];
            let controls = &mut self.rhs.controls[self.layout.control(node)];
            let (by_state, by_control) = model.gradient.split_at(n);
            for (out, value) in states.iter_mut().zip(by_state) {
                *out = cost_weight * value;
            }
            for (out, value) in controls.iter_mut().zip(by_control) {
                *out = cost_weight * value;
            }
            for (i, index) in self.layout.inequality(node).enumerate() {
                let pull =
                    self.mu / iterate.slack[index] - self.sigma[index] * self.rhs.slack[index];
                let (by_state, by_control) = model.inequality_row(i).split_at(n);
                axpy(-pull, by_state, states);
                axpy(-pull, by_control, controls);
            }
        }
    }

    /// Steps of slacks and their multipliers that belong to the primal step.
    pub(super) fn inequality_steps(&mut self, iterate: &Iterate) {
        let n = self.layout.states;
        for (node, model) in self.models.iter().enumerate() {
            let state = &self.step.states[self.layout.state(node)];
            let control = &self.step.controls[self.layout.control(node)];
            for (i, index) in self.layout.inequality(node).enumerate() {
                let (by_state, by_control) = model.inequality_row(i).split_at(n);
                let moved = dot(by_state, state) + dot(by_control, control);
                let (s, z) = (iterate.slack[index], iterate.z[index]);
                let slack_step = moved + self.rhs.slack[index];
                self.slack_step[index] = slack_step;
                self.z_step[index] = (self.mu - z * slack_step) / s - z;
            }
        }
    }
}
