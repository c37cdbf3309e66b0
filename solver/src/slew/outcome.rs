//! The outcome of a solve.

use super::found_solution::FoundSolution;
use super::propagation::{self, PropagatedSlew};
use super::solving::ProgramSolution;
use super::spec::Objective;
use super::validated::Slew;
use crate::leg::no_way::NoWay;
use crate::model::problem::Problem;
use crate::nlp::NlpStatus;

/// Relative excess over the allowed energy that is not a failure.
const BUDGET_TOLERANCE: f64 = 1e-4;

/// The outcome of a solve: the propagated solution, and how it was found.
#[derive(Debug, Clone)]
pub struct SlewOutcome {
    /// Status of the last program: `converged`, or why it did not converge; where cones leave no way,
    /// `no_clear_path`, and `infeasible` where that is proved.
    pub status: String,
    /// What was searched for a way around the cones, where none was found.
    pub reasons: Vec<Problem>,
    /// Whether it is proved that no way leads around the cones, so that there is no such slew.
    pub proved_infeasible: bool,
    /// Whether a local minimum was found, and its propagation keeps all limits and reaches the end.
    pub solved: bool,
    /// The value of the objective, in its own unit: s, or J.
    pub objective: f64,
    /// Duration, s.
    pub time_s: f64,
    /// Integral of the squared torques, (N m)² s.
    pub effort: f64,
    /// The solution as the checker's integration finds it.
    pub propagated: PropagatedSlew,
    /// Number of guesses tried.
    pub starts: usize,
    /// Number of interior-point iterations of all programs together.
    pub iterations: usize,
    /// Duration, s, of the minimum in continuous time; only of a sampled slew.
    pub continuous_time_s: Option<f64>,
    /// The program's solution: the guess of the next point of a sweep, and what evidence is taken from.
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
            reasons: Vec::new(),
            proved_infeasible: false,
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

    /// The outcome of the same solve where cones leave no way.
    pub(super) fn without_way(self, parted: &NoWay) -> Self {
        Self {
            status: parted.status().to_owned(),
            reasons: vec![parted.problem.clone()],
            proved_infeasible: parted.is_proved,
            ..self
        }
    }
}
