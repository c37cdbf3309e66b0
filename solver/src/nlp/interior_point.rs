//! The barrier method: a loop of Newton steps on a shrinking barrier parameter.

use super::chain::Chain;
use super::filter::{Acceptance, Filter, Merit};
use super::iterate::{Iterate, Layout};
use super::model::{LinkModel, LinkValues, models_of, values_of};
use super::riccati::{Riccati, RightHandSide, Step};
use super::settings::{NlpReport, NlpStatus, Settings};

/// Largest fraction of the way to the boundary of slacks and multipliers that a step may go.
const TO_BOUNDARY: f64 = 0.99;
/// Barrier problems are solved to this multiple of the barrier parameter.
const BARRIER_ACCURACY: f64 = 10.0;
/// Linear and superlinear decrease of the barrier parameter.
const BARRIER_FACTOR: f64 = 0.2;
const BARRIER_POWER: f64 = 1.5;
/// Bounds of the ratio between `z` and `mu / s`.
const KAPPA_SIGMA: f64 = 1e10;
/// First regularisation tried on a non-convex system, its growth, and where to give up.
const DELTA_FIRST: f64 = 1e-4;
const DELTA_MIN: f64 = 1e-8;
const DELTA_MAX: f64 = 1e12;
/// Halvings of the step length before restoration.
const MAX_BACKTRACKS: usize = 24;

/// The interior point with all its storage.
pub(crate) struct InteriorPoint {
    pub(super) settings: Settings,
    pub(super) layout: Layout,
    pub(super) models: Vec<LinkModel>,
    pub(super) trial_values: Vec<LinkValues>,
    pub(super) riccati: Riccati,
    pub(super) rhs: RightHandSide,
    pub(super) step: Step,
    pub(super) slack_step: Vec<f64>,
    pub(super) z_step: Vec<f64>,
    pub(super) sigma: Vec<f64>,
    pub(super) trial: Iterate,
    pub(super) filter: Filter,
    pub(super) mu: f64,
    pub(super) iterations: usize,
    last_delta: f64,
}

impl InteriorPoint {
    /// Allocates everything a chain needs.
    pub(crate) fn new<C: Chain>(chain: &C, settings: Settings) -> Self {
        let layout = Layout::of(chain);
        let states = (layout.intervals + 1) * layout.states;
        let controls = layout.intervals * layout.controls;
        let links = layout.intervals * layout.states;
        let (rows, equalities) = (layout.all_inequalities(), layout.all_equalities());
        Self {
            settings,
            models: models_of(chain),
            trial_values: values_of(chain),
            riccati: Riccati::new(&layout),
            rhs: RightHandSide {
                states: vec![0.0; states],
                controls: vec![0.0; controls],
                gap: vec![0.0; links],
                equality: vec![0.0; equalities],
            },
            step: Step {
                states: vec![0.0; states],
                controls: vec![0.0; controls],
                lambda: vec![0.0; links],
                nu: vec![0.0; equalities],
            },
            slack_step: vec![0.0; rows],
            z_step: vec![0.0; rows],
            sigma: vec![0.0; rows],
            trial: Iterate {
                points: vec![0.0; layout.all_points()],
                controls: vec![0.0; controls],
                slack: vec![0.0; rows],
                ..Iterate::default()
            },
            filter: Filter::default(),
            mu: settings.initial_barrier,
            iterations: 0,
            last_delta: 0.0,
            layout,
        }
    }

    /// Solves from an iterate, which is left at the best point reached.
    ///
    /// Multipliers and slacks of the right length are taken over as a warm start.
    pub(crate) fn solve<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &mut Iterate,
        stop: &dyn Fn() -> bool,
    ) -> NlpReport {
        self.initialise(chain, iterate);
        loop {
            self.evaluate(chain, iterate);
            if !self.models.iter().all(|model| model.values.is_finite()) {
                return self.report(NlpStatus::NumericalError);
            }
            if self.error(iterate, 0.0) <= self.settings.tolerance {
                return self.report(NlpStatus::Converged);
            }
            self.shrink_barrier(iterate);
            if stop() {
                return self.report(NlpStatus::Stopped);
            }
            if self.iterations >= self.settings.max_iterations {
                return self.report(NlpStatus::IterationLimit);
            }
            self.iterations += 1;
            if !self.newton_step(iterate) {
                return self.report(NlpStatus::NumericalError);
            }
            if !self.line_search(chain, iterate)
                && let Err(status) = self.restore(chain, iterate, stop)
            {
                return self.report(status);
            }
        }
    }

    fn initialise<C: Chain>(&mut self, chain: &C, iterate: &mut Iterate) {
        self.iterations = 0;
        self.last_delta = 0.0;
        self.mu = self.settings.initial_barrier;
        let rows = self.layout.all_inequalities();
        let warm = iterate.slack.len() == rows;
        if !warm {
            iterate.lambda = vec![0.0; self.rhs.gap.len()];
            iterate.nu = vec![0.0; self.rhs.equality.len()];
            iterate.slack = vec![0.0; rows];
            iterate.z = vec![0.0; rows];
        }
        self.values_at(chain, iterate);
        if !warm {
            self.open_slacks(iterate);
        }
        let theta = self.merit_of_values(&iterate.slack).theta;
        self.filter.reset(theta);
    }

    /// Slacks at their inequalities where these are comfortably positive, multipliers to match.
    fn open_slacks(&self, iterate: &mut Iterate) {
        for (node, values) in self.trial_values.iter().enumerate() {
            let range = self.layout.inequality(node);
            for (slack, g) in iterate.slack[range].iter_mut().zip(&values.inequality) {
                *slack = g.max(self.settings.initial_slack);
            }
        }
        for (z, slack) in iterate.z.iter_mut().zip(&iterate.slack) {
            *z = self.mu / slack;
        }
    }

    /// Evaluates values only, into the trial storage.
    pub(super) fn values_at<C: Chain>(&mut self, chain: &C, iterate: &Iterate) {
        for (node, values) in self.trial_values.iter_mut().enumerate() {
            chain.values(&iterate.link(&self.layout, node), values);
        }
    }

    pub(super) fn evaluate<C: Chain>(&mut self, chain: &C, iterate: &Iterate) {
        for (node, model) in self.models.iter_mut().enumerate() {
            model.clear();
            let duals = iterate.multipliers(&self.layout, node);
            chain.derivatives(&iterate.link(&self.layout, node), &duals, model);
        }
    }

    /// Infeasibility and barrier cost of the trial values with given slacks.
    pub(super) fn merit_of_values(&self, slack: &[f64]) -> Merit {
        merit(&self.layout, self.mu, slack, self.trial_values.iter())
    }

    /// Infeasibility and barrier cost of the current models with given slacks.
    pub(super) fn merit_of_models(&self, slack: &[f64]) -> Merit {
        merit(
            &self.layout,
            self.mu,
            slack,
            self.models.iter().map(|model| &model.values),
        )
    }

    /// Lowers the barrier as long as its problem is already solved well enough.
    fn shrink_barrier(&mut self, iterate: &Iterate) {
        let floor = self.settings.tolerance / 10.0;
        while self.mu > floor && self.error(iterate, self.mu) <= BARRIER_ACCURACY * self.mu {
            self.mu = (BARRIER_FACTOR * self.mu)
                .min(self.mu.powf(BARRIER_POWER))
                .max(floor);
            let theta = self.merit_of_models(&iterate.slack).theta;
            self.filter.reset(theta);
        }
    }

    /// Computes the Newton step; false when no regularisation makes the system convex.
    fn newton_step(&mut self, iterate: &Iterate) -> bool {
        for ((sigma, z), s) in self.sigma.iter_mut().zip(&iterate.z).zip(&iterate.slack) {
            *sigma = z / s;
        }
        let mut delta = 0.0;
        while !self.riccati.factor(&self.models, &self.sigma, delta, true) {
            delta = if delta > 0.0 {
                delta * 8.0
            } else if self.last_delta > 0.0 {
                (self.last_delta / 3.0).max(DELTA_MIN)
            } else {
                DELTA_FIRST
            };
            if delta > DELTA_MAX {
                return false;
            }
        }
        if delta > 0.0 {
            self.last_delta = delta;
        }
        self.fill_right_hand_side(iterate, 1.0);
        self.step.nu.copy_from_slice(&iterate.nu);
        self.riccati.solve(&self.models, &self.rhs, &mut self.step);
        self.inequality_steps(iterate);
        true
    }

    /// Gradient of the condensed system; `cost_weight` is zero in restoration.
    pub(super) fn fill_right_hand_side(&mut self, iterate: &Iterate, cost_weight: f64) {
        let n = self.layout.states;
        let mut linear = [0.0; 64];
        for (node, model) in self.models.iter().enumerate() {
            let linear = &mut linear[..model.vars];
            for (out, value) in linear.iter_mut().zip(&model.gradient) {
                *out = cost_weight * value;
            }
            let range = self.layout.inequality(node);
            for (i, index) in range.enumerate() {
                let error = model.values.inequality[i] - iterate.slack[index];
                let weight = self.mu / iterate.slack[index] - self.sigma[index] * error;
                super::dense::axpy(-weight, model.inequality_row(i), linear);
            }
            self.rhs.states[self.layout.state(node)].copy_from_slice(&linear[..n]);
            self.rhs.controls[self.layout.control(node)].copy_from_slice(&linear[n..]);
            self.rhs.gap[self.layout.link(node)].copy_from_slice(&model.values.gap);
            self.rhs.equality[self.layout.equality(node)].copy_from_slice(&model.values.equality);
        }
    }

    /// Steps of slacks and their multipliers that belong to the primal step.
    pub(super) fn inequality_steps(&mut self, iterate: &Iterate) {
        let n = self.layout.states;
        for (node, model) in self.models.iter().enumerate() {
            let state = &self.step.states[self.layout.state(node)];
            let control = &self.step.controls[self.layout.control(node)];
            for (i, index) in self.layout.inequality(node).enumerate() {
                let row = model.inequality_row(i);
                let moved =
                    super::dense::dot(&row[..n], state) + super::dense::dot(&row[n..], control);
                let (s, z) = (iterate.slack[index], iterate.z[index]);
                let slack_step = moved + model.values.inequality[i] - s;
                self.slack_step[index] = slack_step;
                self.z_step[index] = (self.mu - z * slack_step) / s - z;
            }
        }
    }

    /// Goes along the step until the filter accepts; false when it never does.
    fn line_search<C: Chain>(&mut self, chain: &C, iterate: &mut Iterate) -> bool {
        let longest = to_boundary(&iterate.slack, &self.slack_step, self.fraction());
        let current = self.merit_of_models(&iterate.slack);
        let slope = self.slope(iterate);
        let mut alpha = longest;
        for _ in 0..MAX_BACKTRACKS {
            let trial = self.trial_merit(chain, iterate, alpha);
            let verdict = trial.and_then(|trial| self.filter.judge(current, trial, slope, alpha));
            if let Some(acceptance) = verdict {
                if acceptance == Acceptance::Progress {
                    self.filter.add(current);
                }
                self.accept(iterate, alpha);
                return true;
            }
            alpha *= 0.5;
        }
        false
    }

    fn fraction(&self) -> f64 {
        TO_BOUNDARY.max(1.0 - self.mu)
    }

    /// Derivative of the barrier cost along the step.
    fn slope(&self, iterate: &Iterate) -> f64 {
        let n = self.layout.states;
        let mut slope = 0.0;
        for (node, model) in self.models.iter().enumerate() {
            slope += super::dense::dot(
                &model.gradient[..n],
                &self.step.states[self.layout.state(node)],
            );
            slope += super::dense::dot(
                &model.gradient[n..],
                &self.step.controls[self.layout.control(node)],
            );
        }
        let barrier: f64 = self
            .slack_step
            .iter()
            .zip(&iterate.slack)
            .map(|(ds, s)| ds / s)
            .sum();
        slope - self.mu * barrier
    }

    /// Moves the trial point along the step and measures it; `None` when it is not finite.
    pub(super) fn trial_merit<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &Iterate,
        alpha: f64,
    ) -> Option<Merit> {
        let mut move_by = [0.0; 64];
        let move_by = &mut move_by[..self.layout.states];
        for node in 0..=self.layout.intervals {
            let step = &self.step.states[self.layout.state(node)];
            for (out, value) in move_by.iter_mut().zip(step) {
                *out = alpha * value;
            }
            let range = self.layout.point(node);
            chain.retract(
                &iterate.points[range.clone()],
                move_by,
                &mut self.trial.points[range],
            );
        }
        advance(
            &iterate.controls,
            &self.step.controls,
            alpha,
            &mut self.trial.controls,
        );
        advance(
            &iterate.slack,
            &self.slack_step,
            alpha,
            &mut self.trial.slack,
        );
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
        std::mem::swap(&mut iterate.points, &mut self.trial.points);
        std::mem::swap(&mut iterate.controls, &mut self.trial.controls);
        std::mem::swap(&mut iterate.slack, &mut self.trial.slack);
        toward(&mut iterate.lambda, &self.step.lambda, alpha);
        toward(&mut iterate.nu, &self.step.nu, alpha);
        let dual = to_boundary(&iterate.z, &self.z_step, self.fraction());
        for ((z, step), s) in iterate.z.iter_mut().zip(&self.z_step).zip(&iterate.slack) {
            let central = self.mu / s;
            *z = (*z + dual * step).clamp(central / KAPPA_SIGMA, central * KAPPA_SIGMA);
        }
    }

    fn report(&self, status: NlpStatus) -> NlpReport {
        let values = || self.models.iter().map(|model| &model.values);
        let below_zero = values()
            .flat_map(|v| &v.inequality)
            .fold(0.0_f64, |worst, g| worst.max(-g));
        NlpReport {
            status,
            iterations: self.iterations,
            infeasibility: values().fold(below_zero, |worst, v| worst.max(v.defect_max())),
        }
    }
}

fn merit<'a>(
    layout: &Layout,
    mu: f64,
    slack: &[f64],
    values: impl Iterator<Item = &'a LinkValues>,
) -> Merit {
    let mut total = Merit {
        theta: 0.0,
        phi: 0.0,
    };
    for (node, values) in values.enumerate() {
        total.theta += values.defect_norm();
        total.phi += values.cost;
        for (g, s) in values
            .inequality
            .iter()
            .zip(&slack[layout.inequality(node)])
        {
            total.theta += (g - s).abs();
            total.phi -= mu * s.ln();
        }
    }
    total
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
