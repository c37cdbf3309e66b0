//! The shortest time in which the optimum of the smooth proxy is billed no more than a given energy
//! (the energy thesis's EEERT): a root of the bill as a function of the time.

use super::attempts::solve_program;
use super::cost_weights::CostWeights;
use super::found_solution::FoundSolution;
use super::motion::SlewMotion;
use super::program_choice::ProgramChoice;
use super::propagation;
use super::shape::IntervalLengths;
use super::spec::EnergyMeasure;
use super::starts;
use super::validated::Slew;
use crate::run::stop::StopReason;

/// Relative error of the bill that ends the search.
const ACCURACY: f64 = 1e-5;
/// Durations tried, and the factor between them before the root is bracketed.
const MAX_TRIALS: usize = 40;
const GROWTH: f64 = 1.25;

/// A duration with the optimum in it.
struct DurationTrial {
    duration: f64,
    /// Logarithm of the bill over the allowed energy.
    excess: f64,
    found: FoundSolution,
}

/// Solves for the time.
pub(super) fn solve(
    slew: &Slew,
    energy: f64,
    neighbour: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> FoundSolution {
    let guess = neighbour.cloned().or_else(|| {
        let guesses = starts::of(slew, CostWeights::TIME, stop);
        guesses.into_iter().next()
    });
    let shortest = guess.as_ref().map_or(1.0, SlewMotion::duration);
    let (mut starts, mut iterations) = (0, 0);
    let mut attempt = |duration: f64, guess: Option<&SlewMotion>| {
        let found = in_time(slew, duration, guess, stop);
        starts += found.starts;
        iterations += found.iterations;
        let bill = propagation::propagate(slew, &found.solved.motion)
            .energies
            .bill_j;
        let excess = if found.solved.converged() {
            (bill / energy).ln()
        } else {
            f64::INFINITY
        };
        DurationTrial {
            duration,
            excess,
            found,
        }
    };
    let mut high = attempt(shortest * GROWTH, None);
    let mut low: Option<DurationTrial> = None;
    for _ in 0..MAX_TRIALS {
        if stop().is_some() || high.excess.abs() <= ACCURACY {
            break;
        }
        let known = |trial: &DurationTrial| {
            Some(trial.found.solved.motion.clone()).filter(|_| trial.excess.is_finite())
        };
        match &mut low {
            // Too short still: go on.
            _ if high.excess > 0.0 => {
                let next = attempt(high.duration * GROWTH, known(&high).as_ref());
                low = Some(std::mem::replace(&mut high, next));
            }
            // Long enough at once: look for one that is too short.
            None => {
                let next = attempt(high.duration / GROWTH, known(&high).as_ref());
                if next.excess > 0.0 {
                    low = Some(next);
                } else {
                    high = next;
                }
            }
            Some(low) => {
                let next = attempt(between(low, &high), known(&high).as_ref());
                if next.excess > ACCURACY {
                    *low = next;
                } else {
                    high = next;
                }
            }
        }
    }
    FoundSolution {
        starts,
        iterations,
        ..high.found
    }
}

/// A duration at which the bill should be right: the bill is about a power of the time.
fn between(low: &DurationTrial, high: &DurationTrial) -> f64 {
    let share = if low.excess.is_finite() {
        (low.excess / (low.excess - high.excess)).clamp(0.1, 0.98)
    } else {
        0.5
    };
    let (from, to) = (low.duration.ln(), high.duration.ln());
    (from + (to - from) * share).exp()
}

/// The optimum of the proxy in a time.
fn in_time(
    slew: &Slew,
    duration: f64,
    guess: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> FoundSolution {
    let mut choice = ProgramChoice::of(slew);
    choice.cost_weights = CostWeights::energy_in(duration, EnergyMeasure::Proxy);
    choice.guess_duration = Some(duration);
    let lengths = match choice.shape.lengths {
        IntervalLengths::Free => IntervalLengths::Free,
        _ => IntervalLengths::Given(vec![duration / choice.intervals as f64; choice.intervals]),
    };
    choice.shape = slew.shape(choice.shape.course, lengths, &choice.cost_weights);
    solve_program(slew, &choice, guess, stop)
}
