//! Torques held on the samples of a clock, in the three steps of BIROS.
//!
//! First the minimum in continuous time is solved. Its duration is then rounded up to the clock, and
//! the slew is solved with torques linear between samples; from that motion it is solved with torques
//! constant between samples. Where no motion is found in that number of samples, one sample is added.
//! Once the duration is fixed, a slew in minimum time minimises effort.

use super::attempts::solve_program;
use super::choices::MAX_INTERVALS;
use super::continuous;
use super::cost_weights::CostWeights;
use super::found_solution::FoundSolution;
use super::motion::SlewMotion;
use super::program_choice::ProgramChoice;
use super::propagation::{self, effort};
use super::shape::{IntervalLengths, TorqueCourse};
use super::spec::{Objective, SampleHold};
use super::validated::Slew;
use crate::run::stop::StopReason;

/// Samples allowed beyond those of the continuous minimum.
const MAX_EXTRA: usize = 12;
/// Excess of a duration over a whole number of samples, in samples, that counts as rounding.
const ROUNDING: f64 = 1e-6;

/// Solves a sampled slew.
pub(super) fn solve(
    slew: &Slew,
    period: f64,
    hold: SampleHold,
    neighbour: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> FoundSolution {
    let mut continuous = continuous::solve(slew, neighbour, stop);
    if !continuous.solved.converged() || stop().is_some() {
        return continuous;
    }
    let clock = SampleClock {
        slew,
        period,
        hold,
        stop,
    };
    let shortest = continuous.solved.motion.duration() / period;
    let least = whole((shortest - ROUNDING).ceil()).max(2);
    if least + MAX_EXTRA > MAX_INTERVALS {
        continuous.refusal = Some(format!(
            "a minimum of {:.6e} s would take more than {MAX_INTERVALS} samples of {period} s",
            continuous.solved.motion.duration()
        ));
        return continuous;
    }
    let mut best: Option<FoundSolution> = None;
    let mut last = None;
    for samples in clock.candidates(least) {
        let found = clock.hold(samples, &continuous.solved.motion);
        if clock.is_answer(&found) {
            if best
                .as_ref()
                .is_none_or(|best| clock.value(&found) < clock.value(best))
            {
                best = Some(found);
            }
            if samples >= least {
                break;
            }
        } else {
            last = Some(found);
        }
        if stop().is_some() {
            break;
        }
    }
    let mut found = best.or(last).unwrap_or(continuous);
    found.continuous_time = Some(shortest * period);
    found
}

/// A whole number as a count, cut off just above the greatest number of intervals.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to a range that fits"
)]
fn whole(number: f64) -> usize {
    number.clamp(0.0, (MAX_INTERVALS + 1) as f64) as usize
}

/// A slew whose torques are held on the samples of a clock.
struct SampleClock<'a> {
    slew: &'a Slew,
    period: f64,
    hold: SampleHold,
    stop: &'a dyn Fn() -> Option<StopReason>,
}

impl SampleClock<'_> {
    /// Numbers of samples to try; `least` is that of the continuous minimum.
    fn candidates(&self, least: usize) -> Vec<usize> {
        match self.slew.objective() {
            Objective::Energy { duration_s, .. } => {
                vec![whole((duration_s / self.period).round())]
            }
            // The optimum duration lies between two numbers of samples: try the smaller one too.
            Objective::TimeAndEffort { .. } => {
                (least.saturating_sub(1).max(2)..=least + MAX_EXTRA).collect()
            }
            _ => (least..=least + MAX_EXTRA).collect(),
        }
    }

    /// The cost of a program with a fixed duration, s.
    fn cost_weights(&self, duration: f64) -> CostWeights {
        match self.slew.objective() {
            Objective::MinimumTime => CostWeights {
                time: 0.0,
                effort: 1.0,
                duration: Some(duration),
                ..CostWeights::TIME
            },
            Objective::TimeAndEffort { weight } => CostWeights {
                effort: weight,
                duration: Some(duration),
                ..CostWeights::TIME
            },
            Objective::Energy { measure, .. } | Objective::MinimumTimeAtEnergy { measure, .. } => {
                CostWeights::energy_in(duration, measure)
            }
        }
    }

    /// The optimum in a number of samples: with linear torques, and from there with constant ones.
    fn hold(&self, samples: usize, guess: &SlewMotion) -> FoundSolution {
        let duration = samples as f64 * self.period;
        let cost_weights = self.cost_weights(duration);
        let solve = |course: TorqueCourse, guess: &SlewMotion| {
            let lengths = IntervalLengths::Given(vec![self.period; samples]);
            let choice = ProgramChoice {
                shape: self.slew.shape(course, lengths, &cost_weights),
                guess_duration: Some(duration),
                intervals: samples,
                cost_weights,
            };
            solve_program(self.slew, &choice, Some(guess), self.stop)
        };
        let linear = solve(TorqueCourse::Ramps, guess);
        if self.hold == SampleHold::Linear {
            return linear;
        }
        // Constant torques may jump at samples and so need less time than continuous linear ones: they
        // can have a solution where the latter have none.
        let guess = if linear.solved.converged() {
            &linear.solved.motion
        } else {
            guess
        };
        solve(TorqueCourse::Steps, guess).after(&linear)
    }

    /// Whether a solution answers the slew.
    fn is_answer(&self, found: &FoundSolution) -> bool {
        found.solved.converged()
            && match self.slew.objective() {
                Objective::MinimumTimeAtEnergy { energy_j, .. } => {
                    let propagated = propagation::propagate(self.slew, &found.solved.motion);
                    propagated.energies.bill_j <= energy_j
                }
                _ => true,
            }
    }

    /// The objective of a solution among those of different durations.
    fn value(&self, found: &FoundSolution) -> f64 {
        let motion = &found.solved.motion;
        match self.slew.objective() {
            Objective::TimeAndEffort { weight } => motion.duration() + weight * effort(motion),
            _ => motion.duration(),
        }
    }
}
