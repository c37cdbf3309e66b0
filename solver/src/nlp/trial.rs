//! The point that a step leads to, and what it is worth.

use super::barrier::BarrierProblem;
use super::chain::{Chain, LinkValues, values_of};
use super::iterate::{Iterate, Layout};
use super::merit::Merit;
use super::riccati::Step;

/// A point at some length along a step, with its values.
pub(super) struct Trial {
    /// Primal variables and slacks; multipliers are not tried.
    point: Iterate,
    values: Vec<LinkValues>,
    /// The step of the states at that length.
    scaled_states: Vec<f64>,
}

impl Trial {
    /// Storage for the points of a chain.
    pub(super) fn of<C: Chain>(chain: &C, layout: &Layout) -> Self {
        Self {
            point: Iterate {
                points: vec![0.0; layout.all_points()],
                controls: vec![0.0; layout.all_controls()],
                slack: vec![0.0; layout.all_inequalities()],
                ..Iterate::default()
            },
            values: values_of(chain),
            scaled_states: vec![0.0; layout.all_states()],
        }
    }

    /// Values at the last point that was evaluated.
    pub(super) fn values(&self) -> &[LinkValues] {
        &self.values
    }

    /// Evaluates the values at an iterate itself.
    pub(super) fn evaluate<C: Chain>(&mut self, chain: &C, layout: &Layout, iterate: &Iterate) {
        for (node, values) in self.values.iter_mut().enumerate() {
            chain.values(&iterate.link(layout, node), values);
        }
    }

    /// Moves to `alpha` along a step and measures the point; `None` when a value is not finite.
    pub(super) fn measure<C: Chain>(
        &mut self,
        chain: &C,
        problem: &BarrierProblem,
        iterate: &Iterate,
        (step, alpha): (&Step, f64),
    ) -> Option<Merit> {
        let layout = &problem.layout;
        for (out, step) in self.scaled_states.iter_mut().zip(&step.states) {
            *out = alpha * step;
        }
        for node in 0..=layout.intervals {
            let range = layout.point(node);
            chain.retract(
                &iterate.points[range.clone()],
                &self.scaled_states[layout.state(node)],
                &mut self.point.points[range],
            );
        }
        let (controls, slack) = (&mut self.point.controls, &mut self.point.slack);
        advance(&iterate.controls, &step.controls, alpha, controls);
        advance(&iterate.slack, &step.slack, alpha, slack);
        for (node, values) in self.values.iter_mut().enumerate() {
            chain.values(&self.point.link(layout, node), values);
            if !values.is_finite() {
                return None;
            }
        }
        Some(problem.merit_of(&self.values, &self.point.slack))
    }

    /// Index and error of all slacks of a node: values of the inequalities minus the slacks.
    pub(super) fn slack_errors(
        &self,
        layout: &Layout,
        node: usize,
    ) -> impl Iterator<Item = (usize, f64)> {
        let values = self.values[node].inequality.iter();
        let rows = layout.inequality(node).zip(values);
        rows.map(|(index, value)| (index, value - self.point.slack[index]))
    }

    /// Makes the point the current iterate; multipliers stay.
    pub(super) fn take(&mut self, iterate: &mut Iterate) {
        std::mem::swap(&mut iterate.points, &mut self.point.points);
        std::mem::swap(&mut iterate.controls, &mut self.point.controls);
        std::mem::swap(&mut iterate.slack, &mut self.point.slack);
    }
}

fn advance(from: &[f64], step: &[f64], alpha: f64, to: &mut [f64]) {
    for ((out, value), step) in to.iter_mut().zip(from).zip(step) {
        *out = value + alpha * step;
    }
}
