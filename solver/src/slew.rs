//! One slew of one spacecraft, with a choice of what is minimised and of how it is commanded.
//!
//! A [`Slew`] leads from a state to a state. Its [`Objective`] is the time (the paper's
//! problem), time with effort (OLRAC), the energy of the motors at a given time, or the time at a
//! given energy (the energy thesis). Its [`Command`] says which torques can be commanded: constant
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
//! shrinks with the square of the interval; every [`SlewOutcome`] has both integrals of the flown
//! motion, to rounding. The bill has many local minima, some per cent apart: it is minimised from the
//! optimum of the proxy and from the usual guesses, and the flown bills are compared.

mod attempts;
mod choices;
mod cost_weights;
pub mod evidence;
mod flow;
mod jet;
mod min_time_at_energy;
mod motion;
mod program;
mod propagated;
mod request;
mod sampled;
mod shape;
mod solving;
mod spec;
mod starts;
mod terms;
#[cfg(test)]
mod tests;

pub use propagated::{Energies, Piece, PropagatedSlew};
pub use request::{
    Command, DEFAULT_INTERVALS, FinalWheels, Hold, MAX_POINTS, Measure, Objective, SlewOptionsSpec,
    SlewSpec, Sweep, WheelAllocation,
};
pub use spec::{Slew, Validated};

use crate::nlp::{Interruption, NlpStatus};
use crate::run::stop::{StopReason, StopSignal};
use attempts::direct;
use cost_weights::CostWeights;
use motion::SlewMotion;
use shape::{Course, Lengths, Shape};
use solving::Solved;

/// Rounds in which a budget is corrected, and the share of it that may be left.
const BUDGET_ROUNDS: usize = 8;
const BUDGET_ACCURACY: f64 = 1e-5;
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
    pub flown: PropagatedSlew,
    /// Guesses tried.
    pub starts: usize,
    /// Interior-point iterations, all programs together.
    pub iterations: usize,
    /// Of a sampled slew the minimum in continuous time, s.
    pub continuous_time_s: Option<f64>,
    /// The program's solution, from which a neighbour can begin.
    solution: Solved,
}

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
    let points = slew.along(sweep)?;
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
    let stop = &|| interruption(stop);
    let found = match slew.command() {
        Command::Sampled { period_s, hold } => {
            sampled::solve(slew, (period_s, hold), neighbour, stop)
        }
        _ => in_continuous_time(slew, neighbour, stop),
    };
    found.conclude(slew)
}

/// Solves without a clock.
fn in_continuous_time(
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

fn interruption(stop: &StopSignal) -> Option<Interruption> {
    stop.reason().map(|reason| match reason {
        StopReason::TimeLimit => Interruption::TimeLimit,
        StopReason::Requested | StopReason::Cancelled => Interruption::Cancelled,
    })
}

/// A solution with the way to it.
struct Found {
    solved: Solved,
    starts: usize,
    iterations: usize,
    continuous_time: Option<f64>,
    /// Why this is no answer, although it is a solution.
    refusal: Option<String>,
}

/// A program that one solve answers.
struct Plain {
    cost_weights: CostWeights,
    shape: Shape,
    intervals: usize,
    /// The duration of the guesses, s, where it is known.
    lasting: Option<f64>,
}

impl Plain {
    /// The program of a slew in continuous time.
    fn of(slew: &Slew) -> Self {
        let cost_weights = slew.cost_weights();
        let (course, own, intervals) = match slew.command() {
            Command::Free { intervals } => {
                let needed = slew.intervals_of_fastest();
                (Course::Steps, true, intervals.max(needed))
            }
            Command::Uniform { intervals } => (Course::Steps, false, intervals),
            Command::Smooth { intervals } => (Course::Ramps, false, intervals),
            // In continuous time, as free as can be.
            Command::Sampled { .. } => (Course::Steps, true, slew.usual_intervals()),
        };
        let lengths = match (own, cost_weights.duration) {
            (true, _) => Lengths::Own,
            (false, None) => Lengths::Shared,
            (false, Some(duration)) => Lengths::Given(vec![duration / intervals as f64; intervals]),
        };
        Self {
            shape: slew.shape(course, lengths, &cost_weights),
            lasting: cost_weights.duration,
            cost_weights,
            intervals,
        }
    }

    /// The same program with the smooth proxy instead of the bill, which has many local minima.
    fn proxy(&self, slew: &Slew) -> Option<Self> {
        let billed = self.cost_weights.bills() && self.cost_weights.budget.is_none();
        let cost_weights = CostWeights {
            measure: Measure::Proxy,
            ..self.cost_weights
        };
        billed.then(|| self.with(slew, cost_weights))
    }

    /// The same program where effort counts too, this share of what time counts for on a motion.
    fn with_effort(&self, slew: &Slew, share: f64, motion: &SlewMotion) -> Self {
        let cost_weights = CostWeights {
            effort: share * motion.duration() / propagated::effort(motion),
            ..self.cost_weights
        };
        self.with(slew, cost_weights)
    }

    /// The same program with other cost_weights.
    fn with(&self, slew: &Slew, cost_weights: CostWeights) -> Self {
        Self {
            shape: slew.shape(self.shape.course, self.shape.lengths.clone(), &cost_weights),
            cost_weights,
            intervals: self.intervals,
            lasting: self.lasting,
        }
    }

    /// A guess on the nodes of the program.
    fn meshed(&self, guess: &SlewMotion, slew: &Slew) -> SlewMotion {
        let dynamics = &slew.vehicle().dynamics;
        let lasting = self.lasting.unwrap_or_else(|| guess.duration());
        let guess = guess.lasting(lasting, dynamics);
        match &self.shape.lengths {
            Lengths::Given(lengths) => guess.on_mesh(lengths),
            // What only time counts for switches, and the guess knows when; what is smooth does not.
            Lengths::Own
                if self.cost_weights.hurries() && self.intervals >= guess.lengths.len() =>
            {
                guess.on_finer_mesh(self.intervals)
            }
            _ => guess.on_equal_mesh(self.intervals),
        }
    }
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

impl Found {
    /// The same, which took another solution first.
    fn after(self, before: &Self) -> Self {
        Self {
            starts: before.starts + self.starts,
            iterations: before.iterations + self.iterations,
            ..self
        }
    }

    /// Flies the solution and adds it all up.
    fn conclude(self, slew: &Slew) -> SlewOutcome {
        let motion = &self.solved.motion;
        let mut flown = propagated::fly(slew, motion);
        flown.failures.extend(self.refusal);
        if let Objective::MinimumTimeAtEnergy { energy_j, .. } = slew.objective() {
            let bill = flown.energies.bill_j;
            if bill.is_nan() || bill > energy_j * (1.0 + BUDGET_TOLERANCE) {
                let sentence =
                    format!("the bill is {bill:.6} J, more than the {energy_j} J allowed");
                flown.failures.push(sentence);
            }
        }
        let effort = propagated::effort(motion);
        let time_s = motion.duration();
        let objective = match slew.objective() {
            Objective::MinimumTime | Objective::MinimumTimeAtEnergy { .. } => time_s,
            Objective::TimeAndEffort { weight } => time_s + weight * effort,
            Objective::Energy { measure, .. } => flown.energies.by(measure),
        };
        let converged = self.solved.status == NlpStatus::Converged;
        SlewOutcome {
            status: self.solved.status.to_string(),
            solved: converged && flown.failures.is_empty(),
            objective,
            time_s,
            effort,
            flown,
            starts: self.starts,
            iterations: self.iterations,
            continuous_time_s: self.continuous_time,
            solution: self.solved,
        }
    }
}
