//! Slews without a clock.

use super::attempts::direct;
use super::cost_weights::CostWeights;
use super::motion::SlewMotion;
use super::program_choice::Plain;
use super::search_result::Found;
use super::spec::{Measure, Objective};
use super::validated::Slew;
use super::{min_time_at_energy, propagated};
use crate::nlp::Interruption;

/// Rounds in which a budget is corrected, and the share of it that may be left.
const BUDGET_ROUNDS: usize = 8;
const BUDGET_ACCURACY: f64 = 1e-5;

/// Solves without a clock.
pub(super) fn solve(
    slew: &Slew,
    neighbour: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<Interruption>,
) -> Found {
    let plain = Plain::of(slew);
    let Objective::MinimumTimeAtEnergy { energy_j, measure } = slew.objective() else {
        return direct(slew, &plain, neighbour, stop);
    };
    let fastest = plain.with(slew, CostWeights::TIME);
    let fastest = direct(slew, &fastest, None, stop);
    let bill = propagated::fly(slew, &fastest.solved.motion)
        .energies
        .bill_j;
    if fastest.solved.converged() && bill <= energy_j {
        // The energy does not bind: multipliers of a program that keeps within it would vanish.
        return fastest;
    }
    let found = match measure {
        Measure::Proxy => min_time_at_energy::solve(slew, energy_j, neighbour, stop),
        Measure::Bill => billed(slew, energy_j, neighbour, stop),
    };
    found.after(&fastest)
}

/// Solves for the time with a bill: the program's own bill is a little low, so that its budget is
/// lowered until the flight's keeps within the energy.
fn billed(
    slew: &Slew,
    energy: f64,
    neighbour: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<Interruption>,
) -> Found {
    let mut plain = Plain::of(slew);
    let mut found = direct(slew, &plain, neighbour, stop);
    for _ in 0..BUDGET_ROUNDS {
        let bill = propagated::fly(slew, &found.solved.motion).energies.bill_j;
        let Some(budget) = plain.cost_weights.budget else {
            break;
        };
        let kept = bill <= energy && bill >= energy * (1.0 - BUDGET_ACCURACY);
        if kept || !found.solved.converged() || stop().is_some() {
            break;
        }
        plain.cost_weights.budget = Some(budget * energy / bill * (1.0 - 0.5 * BUDGET_ACCURACY));
        let guess = found.solved.motion.clone();
        let next = direct(slew, &plain, Some(&guess), stop);
        found = next.after(&found);
    }
    found
}
