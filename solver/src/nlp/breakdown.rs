//! Where the numbers of a solve broke down.

use super::chain::{LinkModel, LinkValues};
use super::iterate::Layout;
use super::riccati::Step;
use super::status::{Breakdown, NlpStatus, Quantity};
use std::ops::ControlFlow;

/// Breaks at the first value that is not finite.
pub(super) fn check_values(models: &[LinkModel]) -> ControlFlow<NlpStatus> {
    let quantities = models.iter().map(|model| broken_value(&model.values));
    match first_at_stage(quantities) {
        Some(broken) => ControlFlow::Break(broken),
        None => ControlFlow::Continue(()),
    }
}

/// Why no regularisation made the system convex, which failed last at this stage: a derivative
/// that is not finite, or curvature that stays negative.
pub(super) fn of_system(models: &[LinkModel], failed_stage: usize) -> NlpStatus {
    let derivatives = models
        .iter()
        .map(|model| (!has_finite_derivatives(model)).then_some(Quantity::Derivative));
    first_at_stage(derivatives).unwrap_or(NlpStatus::NumericalError(Breakdown {
        stage: failed_stage,
        quantity: Quantity::Curvature,
    }))
}

/// No part of a step makes progress: the stage with its largest component.
pub(super) fn of_step(layout: &Layout, step: &Step) -> NlpStatus {
    let (mut stage, mut longest) = (0, 0.0);
    for node in 0..=layout.intervals {
        let states = &step.states[layout.state(node)];
        let controls = &step.controls[layout.control(node)];
        for value in states.iter().chain(controls) {
            if value.abs() > longest {
                (stage, longest) = (node, value.abs());
            }
        }
    }
    NlpStatus::NumericalError(Breakdown {
        stage,
        quantity: Quantity::Step,
    })
}

fn first_at_stage(quantities: impl Iterator<Item = Option<Quantity>>) -> Option<NlpStatus> {
    quantities.enumerate().find_map(|(stage, quantity)| {
        let quantity = quantity?;
        Some(NlpStatus::NumericalError(Breakdown { stage, quantity }))
    })
}

fn broken_value(values: &LinkValues) -> Option<Quantity> {
    let finite = |vector: &[f64]| vector.iter().all(|v| v.is_finite());
    if !values.cost.is_finite() {
        Some(Quantity::Cost)
    } else if !finite(&values.gap) {
        Some(Quantity::Gap)
    } else if !finite(&values.equality) {
        Some(Quantity::Equality)
    } else if !finite(&values.inequality) {
        Some(Quantity::Inequality)
    } else {
        None
    }
}

fn has_finite_derivatives(model: &LinkModel) -> bool {
    let mut all = model
        .gradient
        .iter()
        .chain(&model.link_jacobian)
        .chain(&model.equality_jacobian)
        .chain(&model.inequality_jacobian)
        .chain(&model.hessian);
    all.all(|value| value.is_finite())
}
