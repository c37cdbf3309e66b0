//! The slews along a sweep.

use super::choices;
use super::spec::{Objective, Sweep};
use super::validated::Slew;
use crate::model::findings::Findings;
use crate::model::problem::{Code, Problem};

impl Sweep {
    /// The objective with a value in place of its own; `None` where it has nothing like it.
    fn objective_at(&self, objective: Objective, value: f64) -> Option<Objective> {
        match (self, objective) {
            (Self::Durations(_), Objective::Energy { measure, .. }) => Some(Objective::Energy {
                duration_s: value,
                measure,
            }),
            (Self::Weights(_), Objective::TimeAndEffort { .. }) => {
                Some(Objective::TimeAndEffort { weight: value })
            }
            (Self::Energies(_), Objective::MinimumTimeAtEnergy { measure, .. }) => {
                Some(Objective::MinimumTimeAtEnergy {
                    energy_j: value,
                    measure,
                })
            }
            _ => None,
        }
    }

    /// The same slew at every value.
    ///
    /// # Errors
    ///
    /// Problems with the values, all of them at once.
    pub(super) fn points(&self, slew: &Slew) -> Result<Vec<Slew>, Vec<Problem>> {
        let mut findings = Findings::default();
        let field = self.name();
        let points: Vec<_> = self
            .values()
            .iter()
            .enumerate()
            .map(|(i, value)| {
                let pointer = format!("/sweep/{field}/{i}");
                let value = findings.positive(&pointer, *value)?;
                let Some(objective) = self.objective_at(slew.objective(), value) else {
                    findings.refuse(
                        "/sweep",
                        Code::ConflictingFields,
                        format!("the objective has no {field} to sweep"),
                        "sweep durations of energy, weights of effort, or energies of time",
                    );
                    return None;
                };
                choices::check_multiple(&objective, &slew.command(), &pointer, &mut findings)
                    .then(|| slew.with_objective(objective))
            })
            .collect();
        let points = points.into_iter().collect();
        findings.conclude(points).map(|(points, _)| points)
    }
}
