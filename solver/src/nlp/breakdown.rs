//! Where the numbers of a solve broke down.

use super::interior_point::InteriorPoint;
use super::model::{LinkModel, LinkValues};
use super::settings::{Breakdown, NlpStatus, Quantity};

impl InteriorPoint {
    /// The first value that is not finite.
    pub(super) fn broken_value(&self) -> Option<NlpStatus> {
        let quantities = self.models.iter().map(|model| broken(&model.values));
        first(quantities)
    }

    /// Why no regularisation made the system convex.
    pub(super) fn broken_system(&self) -> NlpStatus {
        let derivatives = self
            .models
            .iter()
            .map(|model| (!has_finite_derivatives(model)).then_some(Quantity::Derivative));
        first(derivatives).unwrap_or(NlpStatus::NumericalError(Breakdown {
            stage: self.failed_stage,
            quantity: Quantity::Curvature,
        }))
    }

    /// The stage that wanted to move most when no step made progress.
    pub(super) fn broken_step(&self) -> NlpStatus {
        let (mut stage, mut longest) = (0, 0.0);
        for node in 0..=self.layout.intervals {
            let states = &self.step.states[self.layout.state(node)];
            let controls = &self.step.controls[self.layout.control(node)];
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
}

fn first(quantities: impl Iterator<Item = Option<Quantity>>) -> Option<NlpStatus> {
    quantities.enumerate().find_map(|(stage, quantity)| {
        let quantity = quantity?;
        Some(NlpStatus::NumericalError(Breakdown { stage, quantity }))
    })
}

fn broken(values: &LinkValues) -> Option<Quantity> {
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
