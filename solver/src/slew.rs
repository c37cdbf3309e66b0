//! One slew of one spacecraft, with a choice of what is minimised and of how it is commanded.
//!
//! A [`Slew`] leads from a state to a state. Its [`Objective`] is the time (the paper's
//! problem), time with effort (OLRAC), the energy of the motors at a given time, or the time at a
//! given energy (the energy thesis). Its [`TorqueCommand`] says which torques can be commanded: constant
//! on intervals of any length, on equal ones, on the samples of a clock held constant or linearly
//! (BIROS), or continuous. [`solve`] minimises, and flies what it has found with the integrator of
//! the [checker](crate::checker), which shares nothing with the optimiser.
//!
//! With [`WheelAllocation::PseudoInverse`] the wheels' torques are `A^+ A u`, in the program as in flight.
//!
//! All of it is one nonlinear program (`program`) with other variables (`shape`) and other
//! weights (`cost_weights`).
//!
//! # Drives
//!
//! Torques are those that change the wheels' momenta. Where an inner loop makes up for friction the
//! limits are the motor's, so the program keeps `u + v W + c sign(W)` within them. Where nothing does,
//! the plan commands the motor and leaves friction to the feedback.
//!
//! A wheel with a speed law is not commanded. Relative to the body it is locked at a speed that is a
//! known function of time (`flow`).
//!
//! # Energy
//!
//! Power is `P = (R / k^2) M^2 + M W` with the motor torque `M`. The *proxy* is the integral of `P`,
//! which counts what braking would return; the *bill* is that of `max(P, 0)`, over the motor's
//! efficiency and with what its electronics take (the thesis's equation 1.16). Within an interval
//! the program lets one wheel's power of both signs cancel, so that its own bill is low by what
//! shrinks with the square of the interval; every [`SlewOutcome`] has both integrals of the propagated
//! motion, to rounding. The bill has many local minima, some per cent apart: it is minimised from the
//! optimum of the proxy and from the usual guesses, and the propagated uses_bill are compared.

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
    EnergyMeasure, FinalWheels, Objective, SampleHold, SlewSpec, TorqueCommand, WheelAllocation,
};
pub use sweep::Sweep;
pub use validated::{Slew, ValidatedSlew};

use crate::run::stop::StopSignal;
use motion::SlewMotion;

/// Solves a slew.
#[must_use]
pub fn solve(slew: &Slew, stop: &StopSignal) -> SlewOutcome {
    solve_from(slew, None, stop)
}

/// Solves the same slew along a sweep, each from the solution before it; the objective's own
/// value of what is swept is not used.
///
/// # Errors
///
/// Problems with the values, all of them at once; the pointers count along the sweep.
pub fn trade_curve(
    slew: &Slew,
    sweep: &Sweep,
    stop: &StopSignal,
) -> Result<Vec<SlewOutcome>, Vec<crate::model::problem::Problem>> {
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

/// Solves from the motion of a neighbour, and from the usual guesses when there is none or it leads
/// nowhere.
fn solve_from(slew: &Slew, neighbour: Option<&SlewMotion>, stop: &StopSignal) -> SlewOutcome {
    let stop = &|| stop.reason();
    let found = match slew.command() {
        TorqueCommand::Sampled { period_s, hold } => {
            sampled::solve(slew, period_s, hold, neighbour, stop)
        }
        _ => continuous::solve(slew, neighbour, stop),
    };
    SlewOutcome::of(slew, found)
}
