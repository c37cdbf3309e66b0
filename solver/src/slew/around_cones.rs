//! Slews with cones: solved without them first, and around them where that motion enters one.

use super::outcome::SlewOutcome;
use super::validated::Slew;
use crate::leg::no_way::{NoWay, WayProblem, no_way};
use crate::run::stop::StopSignal;

/// Solves a slew, perhaps with cones, by a solver of slews whose cones are those of its programs.
pub(super) fn solve(
    slew: &Slew,
    stop: &StopSignal,
    solve_program: impl Fn(&Slew) -> SlewOutcome,
) -> SlewOutcome {
    if slew.vehicle().dynamics.cones.is_empty() {
        return solve_program(slew);
    }
    let free = solve_program(&slew.without_cones());
    if free.solved || stop.is_set() {
        return free;
    }
    let parted = parted(slew);
    if let Some(parted) = &parted
        && parted.is_proved
    {
        return free.without_way(parted);
    }
    let mut around = solve_program(slew);
    around.starts += free.starts;
    around.iterations += free.iterations;
    match parted.filter(|_| !around.solved && !stop.is_set()) {
        Some(parted) => around.without_way(&parted),
        None => around,
    }
}

/// What is said where the cones leave no way from start to end.
fn parted(slew: &Slew) -> Option<NoWay> {
    let between = WayProblem {
        cones: &slew.vehicle().dynamics.cones,
        ends: slew.ends().each_ref(),
        arrival: slew.arrival(),
    };
    no_way(&between, ["the start", "the end"], "/end")
}
