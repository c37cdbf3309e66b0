//! Slews in continuous time.

use super::attempts::solve_program;
use super::cost_weights::CostWeights;
use super::found_solution::FoundSolution;
use super::motion::SlewMotion;
use super::program_choice::ProgramChoice;
use super::spec::{EnergyMeasure, Objective};
use super::validated::Slew;
use super::{min_time_at_energy, propagation};
use crate::run::stop::StopReason;

/// Greatest number of corrections of a budget, and the share of it that may stay unused.
const BUDGET_ROUNDS: usize = 8;
const BUDGET_ACCURACY: f64 = 1e-5;

/// Solves a slew; of one on a clock, its minimum in continuous time.
pub(super) fn solve(
    slew: &Slew,
    neighbour: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> FoundSolution {
    let choice = ProgramChoice::of(slew);
    let Objective::MinimumTimeAtEnergy { energy_j, measure } = slew.objective() else {
        return solve_program(slew, &choice, neighbour, stop);
    };
    let fastest = choice.with(slew, CostWeights::TIME);
    let fastest = solve_program(slew, &fastest, None, stop);
    let bill = propagation::propagate(slew, &fastest.solved.motion)
        .energies
        .bill_j;
    if fastest.solved.converged() && bill <= energy_j {
        // The limit on energy is not active: the fastest motion is the answer.
        return fastest;
    }
    let found = match measure {
        EnergyMeasure::Proxy => min_time_at_energy::solve(slew, energy_j, neighbour, stop),
        EnergyMeasure::Bill => billed(slew, energy_j, neighbour, stop),
    };
    found.after(&fastest)
}

/// Minimises the duration under a limit on the bill. The program underestimates the bill, so that its
/// budget is lowered until the bill of the propagated motion is within the limit.
fn billed(
    slew: &Slew,
    energy: f64,
    neighbour: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> FoundSolution {
    let mut choice = ProgramChoice::of(slew);
    let mut found = solve_program(slew, &choice, neighbour, stop);
    for _ in 0..BUDGET_ROUNDS {
        let bill = propagation::propagate(slew, &found.solved.motion)
            .energies
            .bill_j;
        let Some(budget) = choice.cost_weights.budget else {
            break;
        };
        let met = bill <= energy && bill >= energy * (1.0 - BUDGET_ACCURACY);
        if met || !found.solved.converged() || stop().is_some() {
            break;
        }
        choice.cost_weights.budget = Some(budget * energy / bill * (1.0 - 0.5 * BUDGET_ACCURACY));
        let guess = found.solved.motion.clone();
        let next = solve_program(slew, &choice, Some(&guess), stop);
        found = next.after(&found);
    }
    found
}
