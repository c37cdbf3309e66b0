//! A second engine for chains, of another kind, against which the interior point is tested.
//!
//! Sequential quadratic programming: the conditions are linearised at the current point, the
//! Lagrangian is replaced by its second-order model, and the quadratic program that results
//! (assembled without regard to its structure, see [`subproblem`]) is solved by a general solver.
//! A step is shortened until the exact penalty function
//!
//! ```text
//!   f + rho (sum |gap| + sum |e| + sum max(0, -g))
//! ```
//!
//! falls below the largest of its last few values (Nocedal and Wright, Numerical Optimization,
//! 2006, chapter 18, with second-order corrections; the memory is that of Grippo, Lampariello and
//! Lucidi, SIAM J. Numer. Anal. 23, 1986). It shares the problem's interface with the
//! interior point and nothing else: no barrier, no filter, no sweep.

mod null_space;
mod subproblem;
#[cfg(test)]
mod tests;

use crate::nlp::{Chain, Iterate, Layout, LinkModel, LinkValues, models_of, values_of};
use nalgebra::DVector;
use std::collections::VecDeque;
use subproblem::{Linearisation, Stepped};

/// Number of the last points whose penalty functions a new one is compared with.
const MEMORY: usize = 5;
/// Sufficient decrease as a share of the predicted one.
const SUFFICIENT: f64 = 1e-4;
/// Halvings of a step before the model is given more curvature instead.
const MAX_BACKTRACKS: usize = 12;
/// The penalty is this much larger than the largest multiplier.
const ABOVE_MULTIPLIERS: f64 = 1.5;
/// Curvature added after a step that was shortened a lot or refused: the least, its growth and
/// decay.
const DAMPING_FIRST: f64 = 1e-4;
const DAMPING_GROWTH: f64 = 4.0;
const DAMPING_DECAY: f64 = 0.25;
/// Steps shortened to this fraction or less increase the added curvature.
const SHORT: f64 = 0.25;
const DAMPING_MAX: f64 = 1e6;

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// The optimality conditions hold within the tolerance.
    Converged,
    /// The least infeasible linearisation does not reduce the infeasibility: there may be no
    /// feasible point nearby.
    InfeasibleSuspected,
    /// Out of iterations.
    IterationLimit,
    /// No curvature made a step possible.
    Stuck,
}

/// What a solve did.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Report {
    /// How it ended.
    pub(crate) ending: Ending,
    /// Quadratic programs solved.
    pub(crate) iterations: usize,
    /// Cost at the end.
    pub(crate) cost: f64,
    /// Largest error of the optimality conditions at the end, not scaled.
    pub(crate) error: f64,
}

/// The engine with its current models.
pub(crate) struct SequentialQuadratic<'a, C> {
    chain: &'a C,
    layout: Layout,
    models: Vec<LinkModel>,
    values: Vec<LinkValues>,
    damping: f64,
    penalty: f64,
    recent: VecDeque<f64>,
}

impl<'a, C: Chain> SequentialQuadratic<'a, C> {
    /// An engine for a chain.
    pub(crate) fn new(chain: &'a C) -> Self {
        Self {
            layout: Layout::of(chain),
            models: models_of(chain),
            values: values_of(chain),
            damping: 0.0,
            penalty: 1.0,
            recent: VecDeque::new(),
            chain,
        }
    }

    /// Solves from the primal part of an iterate, which is left at the last point.
    pub(crate) fn solve(
        &mut self,
        iterate: &mut Iterate,
        tolerance: f64,
        max_iterations: usize,
    ) -> Report {
        iterate.lambda = vec![0.0; self.layout.intervals * self.layout.states];
        iterate.nu = vec![0.0; self.layout.all_equalities()];
        iterate.z = vec![0.0; self.layout.all_inequalities()];
        let mut iterations = 0;
        loop {
            self.evaluate(iterate);
            let here = Linearisation::of(&self.layout, &self.models, iterate);
            let report = |ending, iterations| Report {
                ending,
                iterations,
                cost: here.cost,
                error: here.error(),
            };
            if here.error() <= tolerance {
                return report(Ending::Converged, iterations);
            }
            if iterations == max_iterations {
                return report(Ending::IterationLimit, iterations);
            }
            iterations += 1;
            let alpha = match here.step(self.damping) {
                Some(step) if step.unreachable(&here) => {
                    return report(Ending::InfeasibleSuspected, iterations);
                }
                Some(step) => self.advance(iterate, &here, &step),
                None => None,
            };
            self.damping = match (alpha, self.damping) {
                (Some(1.0), damping) if damping <= DAMPING_FIRST => 0.0,
                (Some(1.0), damping) => damping * DAMPING_DECAY,
                (Some(alpha), damping) if alpha > SHORT => damping,
                (_, damping) => (damping * DAMPING_GROWTH).max(DAMPING_FIRST),
            };
            if self.damping > DAMPING_MAX {
                return report(Ending::Stuck, iterations);
            }
        }
    }

    fn evaluate(&mut self, iterate: &Iterate) {
        for (node, model) in self.models.iter_mut().enumerate() {
            model.clear();
            let duals = iterate.multipliers(&self.layout, node);
            let link = iterate.link(&self.layout, node);
            self.chain.values(&link, &mut model.values);
            self.chain.derivatives(&link, &duals, model);
        }
    }

    /// Goes along a step as far as the penalty function allows; returns how far, `None` for not at
    /// all.
    fn advance(
        &mut self,
        iterate: &mut Iterate,
        here: &Linearisation,
        step: &Stepped,
    ) -> Option<f64> {
        let wanted = ABOVE_MULTIPLIERS * step.multipliers.amax();
        if wanted > self.penalty {
            self.penalty = 2.0 * wanted;
            self.recent.clear();
        }
        let now = here.cost + self.penalty * here.violation();
        self.recent.push_back(now);
        if self.recent.len() > MEMORY {
            self.recent.pop_front();
        }
        let reference = self.recent.iter().copied().fold(now, f64::max);
        let slope = here.gradient.dot(&step.direction)
            - self.penalty * (here.violation() - here.violation_after(&step.direction));
        let rounding = 100.0 * f64::EPSILON * now.abs().max(1.0);
        let enough = |reached: f64, alpha: f64| {
            reached <= reference + SUFFICIENT * alpha * slope.min(0.0) + rounding
        };
        let full = self.moved(iterate, &step.direction, 1.0);
        if enough(self.penalty_function(&full), 1.0) {
            take(iterate, full, &step.multipliers, 1.0);
            return Some(1.0);
        }
        if let Some(corrected) = here.corrected(step, &self.values, self.damping) {
            let trial = self.moved(iterate, &corrected.direction, 1.0);
            if enough(self.penalty_function(&trial), 1.0) {
                take(iterate, trial, &corrected.multipliers, 1.0);
                return Some(1.0);
            }
        }
        let mut alpha = 0.5;
        for _ in 0..MAX_BACKTRACKS {
            let trial = self.moved(iterate, &step.direction, alpha);
            if enough(self.penalty_function(&trial), alpha) {
                take(iterate, trial, &step.multipliers, alpha);
                return Some(alpha);
            }
            alpha *= 0.5;
        }
        None
    }

    fn moved(&self, iterate: &Iterate, direction: &DVector<f64>, alpha: f64) -> Iterate {
        let mut trial = Iterate::cold(iterate.points.clone(), iterate.controls.clone());
        let (states, stride) = (
            self.layout.states,
            self.layout.states + self.layout.controls,
        );
        for node in 0..=self.layout.intervals {
            let step: Vec<f64> = direction
                .rows(node * stride, states)
                .iter()
                .map(|value| alpha * value)
                .collect();
            let range = self.layout.point(node);
            let moved = &mut trial.points[range.clone()];
            self.chain.retract(&iterate.points[range], &step, moved);
            for (i, index) in self.layout.control(node).enumerate() {
                trial.controls[index] += alpha * direction[node * stride + states + i];
            }
        }
        trial
    }

    fn penalty_function(&mut self, trial: &Iterate) -> f64 {
        let mut total = 0.0;
        for (node, values) in self.values.iter_mut().enumerate() {
            self.chain.values(&trial.link(&self.layout, node), values);
            let below: f64 = values.inequality.iter().map(|g| (-g).max(0.0)).sum();
            total += values.cost + self.penalty * (values.defect_norm() + below);
        }
        // A point with a value that is not finite is never better.
        if total.is_finite() {
            total
        } else {
            f64::INFINITY
        }
    }
}

/// Moves to a trial point that lies at `alpha` along a step.
fn take(iterate: &mut Iterate, trial: Iterate, multipliers: &DVector<f64>, alpha: f64) {
    iterate.points = trial.points;
    iterate.controls = trial.controls;
    let all = iterate
        .lambda
        .iter_mut()
        .chain(&mut iterate.nu)
        .chain(&mut iterate.z);
    for (value, target) in all.zip(multipliers.iter()) {
        *value += alpha * (target - *value);
    }
}
