//! The barrier method: a loop of Newton steps on a shrinking barrier parameter.

use super::barrier::BarrierProblem;
use super::breakdown;
use super::chain::Chain;
use super::convergence::Residuals;
use super::filter::Filter;
use super::interruption::Interruptible;
use super::iterate::Iterate;
use super::line_search::LineSearch;
use super::newton::Newton;
use super::restoration::Restoration;
use super::settings::Settings;
use super::status::{NlpReport, NlpStatus};
use super::trial::Trial;
use crate::run::stop::StopReason;
use std::ops::ControlFlow;

/// A barrier problem counts as solved at this multiple of the barrier parameter. Only the last one
/// has to be solved accurately.
const BARRIER_ACCURACY: f64 = 30.0;
/// Linear and superlinear decrease of the barrier parameter.
const BARRIER_FACTOR: f64 = 0.2;
const BARRIER_POWER: f64 = 1.5;

/// The interior point with all its storage.
pub(crate) struct InteriorPoint {
    pub(crate) settings: Settings,
    problem: BarrierProblem,
    newton: Newton,
    trial: Trial,
    filter: Filter,
    iterations: usize,
}

impl InteriorPoint {
    /// Allocates everything a chain needs.
    pub(crate) fn new<C: Chain>(chain: &C, settings: Settings) -> Self {
        let problem = BarrierProblem::of(chain, settings.initial_barrier);
        Self {
            settings,
            newton: Newton::of(&problem.layout),
            trial: Trial::of(chain, &problem.layout),
            // At most two entries per iteration.
            filter: Filter::with_capacity(2 * settings.max_iterations),
            iterations: 0,
            problem,
        }
    }

    /// Solves from an iterate, which is left at the last accepted point.
    ///
    /// Multipliers and slacks of the right length are kept as a warm start. `stop` is asked before
    /// every evaluation and every factorisation.
    pub(crate) fn solve<C: Chain>(
        &mut self,
        chain: &C,
        iterate: &mut Iterate,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> NlpReport {
        let caller = Interruptible { chain, stop };
        self.initialise(chain, iterate);
        loop {
            if let ControlFlow::Break(status) = self.iterate(&caller, iterate) {
                return NlpReport {
                    status,
                    iterations: self.iterations,
                    infeasibility: self.problem.infeasibility(),
                };
            }
        }
    }

    /// One iteration; breaks with the status that ends the solve.
    fn iterate<C: Chain>(
        &mut self,
        caller: &Interruptible<'_, C>,
        iterate: &mut Iterate,
    ) -> ControlFlow<NlpStatus> {
        // The values at the iterate are those of the trial that it was until it was taken.
        self.problem
            .linearise(caller.chain, iterate, self.trial.values());
        breakdown::check_values(&self.problem.models)?;
        let residuals = Residuals::of(&self.problem, iterate);
        if residuals.are_within(&self.settings) {
            return ControlFlow::Break(NlpStatus::Converged);
        }
        self.shrink_barrier(iterate, &residuals);
        caller.check()?;
        self.settings.count(&mut self.iterations)?;
        self.newton.compute(caller, &self.problem, iterate)?;
        let search = LineSearch {
            caller,
            problem: &self.problem,
            newton: &mut self.newton,
            trial: &mut self.trial,
            filter: &mut self.filter,
            iterate,
        };
        if search.run()? {
            return ControlFlow::Continue(());
        }
        let restoration = Restoration {
            caller,
            settings: &self.settings,
            problem: &mut self.problem,
            newton: &mut self.newton,
            trial: &mut self.trial,
            filter: &mut self.filter,
            iterate,
            iterations: &mut self.iterations,
        };
        restoration.run()
    }

    fn initialise<C: Chain>(&mut self, chain: &C, iterate: &mut Iterate) {
        let layout = &self.problem.layout;
        self.iterations = 0;
        self.newton.restart();
        self.problem.mu = self.settings.initial_barrier;
        let (rows, links) = (layout.all_inequalities(), layout.all_links());
        let warm = iterate.slack.len() == rows && iterate.lambda.len() == links;
        if !warm {
            iterate.lambda = vec![0.0; links];
            iterate.nu = vec![0.0; layout.all_equalities()];
            iterate.slack = vec![0.0; rows];
            iterate.z = vec![0.0; rows];
        }
        self.trial.evaluate(chain, layout, iterate);
        if !warm {
            self.open_slacks(iterate);
        }
        let values = self.trial.values();
        let theta = self.problem.merit_of(values, &iterate.slack).theta;
        self.filter.reset(theta);
    }

    /// Sets slacks to their inequalities, or to the smallest initial slack where these are below
    /// it, and their multipliers to `mu / s`.
    fn open_slacks(&self, iterate: &mut Iterate) {
        for (node, values) in self.trial.values().iter().enumerate() {
            let range = self.problem.layout.inequality(node);
            for (slack, g) in iterate.slack[range].iter_mut().zip(&values.inequality) {
                *slack = g.max(self.settings.initial_slack);
            }
        }
        for (z, slack) in iterate.z.iter_mut().zip(&iterate.slack) {
            *z = self.problem.mu / slack;
        }
    }

    /// Lowers the barrier parameter as long as its problem is already solved well enough.
    fn shrink_barrier(&mut self, iterate: &Iterate, residuals: &Residuals) {
        let floor = self.settings.tolerance / 10.0;
        let problem = &mut self.problem;
        while problem.mu > floor
            && residuals.of_barrier(problem.mu) <= BARRIER_ACCURACY * problem.mu
        {
            problem.mu = (BARRIER_FACTOR * problem.mu)
                .min(problem.mu.powf(BARRIER_POWER))
                .max(floor);
            let theta = problem.merit(&iterate.slack).theta;
            self.filter.reset(theta);
        }
    }
}
