//! The shortest time in which the optimum of the smooth proxy draws at most a given energy from the
//! supply (EEERT of the energy thesis): a root of the bill as a function of the duration.

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
/// Greatest number of durations tried, and the factor between them until the root is bracketed.
const MAX_TRIALS: usize = 40;
const GROWTH: f64 = 1.25;

/// A duration, s, with the optimum of the proxy in it.
struct DurationTrial {
    duration: f64,
    /// Logarithm of the bill over the allowed energy.
    excess: f64,
    found: FoundSolution,
}

/// Solves for the duration.
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
    let mut search = DurationSearch {
        slew,
        energy,
        stop,
        starts: 0,
        iterations: 0,
    };
    let trial = search.root(shortest);
    FoundSolution {
        starts: search.starts,
        iterations: search.iterations,
        ..trial.found
    }
}

/// A search for the duration whose bill is the energy.
struct DurationSearch<'a> {
    slew: &'a Slew,
    /// J.
    energy: f64,
    stop: &'a dyn Fn() -> Option<StopReason>,
    starts: usize,
    iterations: usize,
}

impl DurationSearch<'_> {
    /// Brackets the root, beginning beside the shortest duration, s, and narrows the bracket.
    fn root(&mut self, shortest: f64) -> DurationTrial {
        let mut high = self.attempt(shortest * GROWTH, None);
        let mut low: Option<DurationTrial> = None;
        for _ in 0..MAX_TRIALS {
            if (self.stop)().is_some() || high.excess.abs() <= ACCURACY {
                break;
            }
            let guess = Some(high.found.solved.motion.clone()).filter(|_| high.excess.is_finite());
            match &mut low {
                // Both ends of the bracket are too short: move on to longer durations.
                _ if high.excess > 0.0 => {
                    let next = self.attempt(high.duration * GROWTH, guess.as_ref());
                    low = Some(std::mem::replace(&mut high, next));
                }
                // No duration was too short yet: look for one.
                None => {
                    let next = self.attempt(high.duration / GROWTH, guess.as_ref());
                    if next.excess > 0.0 {
                        low = Some(next);
                    } else {
                        high = next;
                    }
                }
                Some(low) => {
                    let next = self.attempt(between(low, &high), guess.as_ref());
                    if next.excess > ACCURACY {
                        *low = next;
                    } else {
                        high = next;
                    }
                }
            }
        }
        high
    }

    /// Solves for the optimum of the proxy in a duration, s, and bills it.
    fn attempt(&mut self, duration: f64, guess: Option<&SlewMotion>) -> DurationTrial {
        let found = in_time(self.slew, duration, guess, self.stop);
        self.starts += found.starts;
        self.iterations += found.iterations;
        let bill = propagation::propagate(self.slew, &found.solved.motion)
            .energies
            .bill_j;
        let excess = if found.solved.converged() {
            (bill / self.energy).ln()
        } else {
            f64::INFINITY
        };
        DurationTrial {
            duration,
            excess,
            found,
        }
    }
}

/// A duration between two others, interpolated as if the bill were a power of the duration.
fn between(low: &DurationTrial, high: &DurationTrial) -> f64 {
    let share = if low.excess.is_finite() {
        (low.excess / (low.excess - high.excess)).clamp(0.1, 0.98)
    } else {
        0.5
    };
    let (from, to) = (low.duration.ln(), high.duration.ln());
    (from + (to - from) * share).exp()
}

/// The optimum of the proxy in a duration, s.
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
