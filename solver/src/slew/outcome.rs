//! What a slew's solve answers with.

use super::found_solution::FoundSolution;
use super::propagation::{self, PropagatedSlew};
use super::solving::ProgramSolution;
use super::spec::Objective;
use super::validated::Slew;
use crate::nlp::NlpStatus;

/// Relative excess over an energy that is no failure.
const BUDGET_TOLERANCE: f64 = 1e-4;

/// What came of a slew.
#[derive(Debug, Clone)]
pub struct SlewOutcome {
    /// How the last program ended: `converged`, or why not.
    pub status: String,
    /// Whether a local minimum was found and its flight keeps all limits and arrives.
    pub solved: bool,
    /// The value of the objective, in its own unit: s, or J.
    pub objective: f64,
    /// Duration, s.
    pub time_s: f64,
    /// Integral of the squared torques, (N m)² s.
    pub effort: f64,
    /// The flight as the independent integration found it.
    pub propagated: PropagatedSlew,
    /// Guesses tried.
    pub starts: usize,
    /// Interior-point iterations, all programs together.
    pub iterations: usize,
    /// Of a sampled slew the minimum in continuous time, s.
    pub continuous_time_s: Option<f64>,
    /// The program's solution, from which a neighbour can begin.
    pub(super) solution: ProgramSolution,
}

impl SlewOutcome {
    /// Propagates a solution and sums up.
    pub(super) fn of(slew: &Slew, found: FoundSolution) -> Self {
        let motion = &found.solved.motion;
        let mut propagated = propagation::propagate(slew, motion);
        propagated.failures.extend(found.refusal);
        if let Objective::MinimumTimeAtEnergy { energy_j, .. } = slew.objective() {
            let bill = propagated.energies.bill_j;
            if bill.is_nan() || bill > energy_j * (1.0 + BUDGET_TOLERANCE) {
                let sentence =
                    format!("the bill is {bill:.6} J, more than the {energy_j} J allowed");
                propagated.failures.push(sentence);
            }
        }
        let effort = propagation::effort(motion);
        let time_s = motion.duration();
        let objective = match slew.objective() {
            Objective::MinimumTime | Objective::MinimumTimeAtEnergy { .. } => time_s,
            Objective::TimeAndEffort { weight } => time_s + weight * effort,
            Objective::Energy { measure, .. } => propagated.energies.by(measure),
        };
        let converged = found.solved.status == NlpStatus::Converged;
        Self {
            status: found.solved.status.to_string(),
            solved: converged && propagated.failures.is_empty(),
            objective,
            time_s,
            effort,
            propagated,
            starts: found.starts,
            iterations: found.iterations,
            continuous_time_s: found.continuous_time,
            solution: found.solved,
        }
    }
}
