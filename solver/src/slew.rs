//! One slew of one spacecraft, with a choice of objective and of commands.
//!
//! A [`Slew`] leads from a state to a state. Its [`Objective`] is the duration (the paper's problem),
//! duration and effort (OLRAC), the energy of the motors in a given duration, or the duration at a
//! given energy (the energy thesis). Its [`TorqueCommand`] says which torques can be commanded:
//! constant on intervals of any length, constant on equal intervals, held constantly or linearly on
//! the samples of a clock (BIROS), or continuous. [`solve`] minimises the objective and integrates the
//! solution with the [checker](crate::checker), which shares no code with the optimiser.
//!
//! With [`WheelAllocation::PseudoInverse`] the wheels' torques are `A^+ A u`, both in the program and
//! in the integration.
//!
//! Every combination is one nonlinear program (`program`) with other variables (`shape`) and other
//! weights (`cost_weights`).
//!
//! # Cones
//!
//! A slew with cones is solved without them first. Where that motion enters one, the program of every
//! objective and command gets the rows of `leg::transcription`, and its guesses are those of
//! the legs of tours. Where a clear motion needs more intervals than a command has, there is none.
//!
//! # Drives
//!
//! Torques are those that change the wheels' momenta. Where the wheel's inner loop compensates
//! friction, the torque limits are the motor's, so that the program keeps `u + v W + c sign(W)` within
//! them. Where nothing compensates it, the plan commands the motor and feedback has to compensate.
//!
//! A wheel with a speed law is not commanded. Relative to the body it is a locked wheel, whose speed is
//! a known function of time (`vehicle`).
//!
//! # Energy
//!
//! The motor's power is `P = (R / k^2) M^2 + M W` with its torque `M`. The *proxy* is the integral of
//! `P`, which counts what braking would return. The *bill* is the energy drawn from the supply: the
//! integral of `max(P, 0)` over the motor's efficiency, plus the energy of its electronics (equation
//! 1.16 of the energy thesis). Within an interval the program lets positive and negative power of a
//! wheel cancel, so that it underestimates the bill by an error of second order in the interval's
//! length. Every [`SlewOutcome`] has both integrals over the propagated motion, accurate to rounding.
//! The bill has many local minima, some per cent apart. It is minimised from the optimum of the proxy
//! and from the usual guesses, and the bills of the propagated solutions are compared.

mod around_cones;
mod attempts;
mod choices;
mod continuous;
mod cost_weights;
pub mod evidence;
mod flow;
mod found_solution;
mod jet;
mod min_time_at_energy;
mod motion;
mod outcome;
mod program;
mod program_choice;
mod propagation;
mod sampled;
mod shape;
mod solving;
mod spec;
mod starts;
mod sweep;
mod terms;
#[cfg(test)]
mod tests;
mod validated;
mod vehicle;

pub use outcome::SlewOutcome;
pub use propagation::{MotorEnergies, PropagatedSlew, TorquePiece};
pub use spec::{
    DEFAULT_INTERVALS, EnergyMeasure, FinalWheels, MAX_POINTS, Objective, SampleHold,
    SlewOptionsSpec, SlewSpec, Sweep, TorqueCommand, WheelAllocation,
};
pub use validated::{Slew, ValidatedSlew};

use crate::model::problem::Problem;
use crate::run::stop::StopSignal;
use motion::SlewMotion;

/// Solves a slew.
#[must_use]
pub fn solve(slew: &Slew, stop: &StopSignal) -> SlewOutcome {
    solve_from(slew, None, stop)
}

/// Solves the same slew for every value of a sweep, each from the solution before it. The swept value
/// of the slew's own objective is not used.
///
/// # Errors
///
/// All problems with the values at once; pointers have the index in the sweep.
pub fn trade_curve(
    slew: &Slew,
    sweep: &Sweep,
    stop: &StopSignal,
) -> Result<Vec<SlewOutcome>, Vec<Problem>> {
    let points = sweep.points(slew)?;
    let mut outcomes: Vec<SlewOutcome> = Vec::new();
    for point in points {
        let before = outcomes.last().filter(|before| before.solved);
        let outcome = solve_from(&point, before.map(|before| &before.solution.motion), stop);
        outcomes.push(outcome);
        if stop.is_set() {
            break;
        }
    }
    Ok(outcomes)
}

/// Solves from the motion of a neighbouring slew, and from the usual guesses where there is none or the
/// solve from it does not converge.
fn solve_from(slew: &Slew, neighbour: Option<&SlewMotion>, stop: &StopSignal) -> SlewOutcome {
    let reason = &|| stop.reason();
    around_cones::solve(slew, stop, |slew| {
        let found = match slew.command() {
            TorqueCommand::Sampled { period_s, hold } => {
                sampled::solve(slew, period_s, hold, neighbour, reason)
            }
            _ => continuous::solve(slew, neighbour, reason),
        };
        SlewOutcome::of(slew, found)
    })
}
