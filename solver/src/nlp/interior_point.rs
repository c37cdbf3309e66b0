//! The barrier method: a loop of Newton steps on a shrinking barrier parameter.

use super::chain::Chain;
use super::convergence::Residuals;
use super::filter::Filter;
use super::iterate::{Iterate, Layout};
use super::model::{LinkModel, LinkValues, models_of, values_of};
use super::regularisation::Regularisation;
use super::riccati::{NewtonSystem, RightHandSide, Step, system_for};
use super::settings::{Interruption, NlpReport, NlpStatus, Settings};

/// Barrier problems are solved to this multiple of the barrier parameter: roughly, since only the last
/// one counts. With 10 instead legs take a tenth more iterations and are no better; with 60 hard programs fail.
const BARRIER_ACCURACY: f64 = 30.0;
/// Linear and superlinear decrease of the barrier parameter.
const BARRIER_FACTOR: f64 = 0.2;
const BARRIER_POWER: f64 = 1.5;
/// The interior point with all its storage.
pub(crate) struct InteriorPoint {
    pub(crate) settings: Settings,
    pub(super) layout: Layout,
    pub(super) models: Vec<LinkModel>,
    pub(super) trial_values: Vec<LinkValues>,
    pub(super) system: Box<dyn NewtonSystem>,
    pub(super) rhs: RightHandSide,
    pub(super) step: Step,
    /// The step before its second-order correction.
    pub(super) uncorrected: Step,
    pub(super) slack_step: Vec<f64>,
    pub(super) z_step: Vec<f64>,
    pub(super) sigma: Vec<f64>,
    pub(super) trial: Iterate,
    pub(super) filter: Filter,
    pub(super) mu: f64,
    pub(super) iterations: usize,
    pub(super) regularisation: Regularisation,
    /// Where the last factorisation that failed did so.
    pub(super) failed_stage: usize,
    /// Of one node's stationarity.
    pub(super) residual: Vec<f64>,
    /// Share of the step to the trial point.
    pub(super) trial_step: Vec<f64>,
}

impl InteriorPoint {
    /// Allocates everything a chain needs.
    pub(crate) fn new<C: Chain>(chain: &C, settings: Settings) -> Self {
        let layout = Layout::of(chain);
        let states = (layout.intervals + 1) * layout.states;
        let controls = layout.intervals * layout.controls;
        let links = layout.intervals * layout.states;
        let (rows, equalities) = (layout.all_inequalities(), layout.all_equalities());
        let step = Step {
            states: vec![0.0; states],
            controls: vec![0.0; controls],
            lambda: vec![0.0; links],
            nu: vec![0.0; equalities],
        };
        Self {
            settings,
            models: models_of(chain),
            trial_values: values_of(chain),
            system: system_for(&layout),
            rhs: RightHandSide {
                states: vec![0.0; states],
                controls: vec![0.0; controls],
                gap: vec![0.0; links],
                equality: vec![0.0; equalities],
                slack: vec![0.0; rows],
            },
            uncorrected: step.clone(),
            step,
            slack_step: vec![0.0; rows],
            z_step: vec![0.0; rows],
            sigma: vec![0.0; rows],
            trial: Iterate {
                points: vec![0.0; layout.all_points()],
                controls: vec![0.0; controls],
                slack: vec![0.0; rows],
                ..Iterate::default()
            },
            // Two entries per iteration at most.
            filter: Filter::with_capacity(2 * settings.max_iterations),
            mu: settings.initial_barrier,
            iterations: 0,
            regularisation: Regularisation::default(),
            failed_stage: 0,
            residual: vec![0.0; layout.states + layout.controls],
            trial_step: vec![0.0; states],
            layout,
        }
    }

    /// Solves from an iterate, which is left at the best point reached.
    ///
    /// Multipliers and slacks of the right length are taken over as a warm start. `stop` is asked
    /// before every evaluation and every factorisation; once it has a reason it must keep it.
    pub(crate) fn solve<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &mut Iterate,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> NlpReport {
        self.initialise(chain, iterate);
        loop {
            self.evaluate(chain, iterate);
            if let Some(broken) = self.broken_value() {
                return self.report(broken);
            }
            let residuals = self.residuals(iterate);
            if self.is_solved(&residuals) {
                return self.report(NlpStatus::Converged);
            }
            self.shrink_barrier(iterate, &residuals);
            if let Some(reason) = stop() {
                return self.report(reason.into());
            }
            if self.iterations >= self.settings.max_iterations {
                return self.report(NlpStatus::IterationLimit);
            }
            self.iterations += 1;
            if !self.newton_step(iterate, stop) {
                let status = stop().map_or_else(|| self.broken_system(), NlpStatus::from);
                return self.report(status);
            }
            if !self.line_search(chain, iterate, stop)
                && let Err(status) = self.restore(chain, iterate, stop)
            {
                return self.report(status);
            }
        }
    }

    fn initialise<C: Chain>(&mut self, chain: &C, iterate: &mut Iterate) {
        self.iterations = 0;
        self.regularisation = Regularisation::default();
        self.mu = self.settings.initial_barrier;
        let rows = self.layout.all_inequalities();
        let warm = iterate.slack.len() == rows && iterate.lambda.len() == self.rhs.gap.len();
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

    /// Evaluates derivatives. The values at an iterate are always known by now: those of the trial
    /// that it was until it was taken.
    pub(super) fn evaluate<C: Chain>(&mut self, chain: &C, iterate: &Iterate) {
        let known = self.models.iter_mut().zip(&self.trial_values);
        for (node, (model, values)) in known.enumerate() {
            model.values.copy_from(values);
            model.clear();
            let duals = iterate.multipliers(&self.layout, node);
            chain.derivatives(&iterate.link(&self.layout, node), &duals, model);
        }
    }

    fn is_solved(&self, residuals: &Residuals) -> bool {
        residuals.optimality(0.0) <= self.settings.tolerance
            && residuals.feasibility <= self.settings.feasibility
    }

    /// Lowers the barrier as long as its problem is already solved well enough.
    fn shrink_barrier(&mut self, iterate: &Iterate, residuals: &Residuals) {
        let floor = self.settings.tolerance / 10.0;
        while self.mu > floor && residuals.of_barrier(self.mu) <= BARRIER_ACCURACY * self.mu {
            self.mu = (BARRIER_FACTOR * self.mu)
                .min(self.mu.powf(BARRIER_POWER))
                .max(floor);
            let theta = self.merit_of_models(&iterate.slack).theta;
            self.filter.reset(theta);
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
