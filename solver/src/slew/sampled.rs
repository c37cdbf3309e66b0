//! Commands held on the samples of a clock, in BIROS's three steps.
//!
//! First the minimum in continuous time; then its duration is rounded up to the clock, and torque
//! held linearly; then it is held constant, from the motion before. Where no motion is found in so
//! many samples, one more is allowed. In its fixed time a slew for time alone takes the least
//! effort.

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
/// Share of a sample by which a duration may exceed a multiple of it as rounding.
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

/// A whole number as a count; more than any program has intervals counts as one too many.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to a range that fits"
)]
fn whole(number: f64) -> usize {
    number.clamp(0.0, (MAX_INTERVALS + 1) as f64) as usize
}

/// A slew on a clock.
struct SampleClock<'a> {
    slew: &'a Slew,
    period: f64,
    hold: SampleHold,
    stop: &'a dyn Fn() -> Option<StopReason>,
}

impl SampleClock<'_> {
    /// Numbers of samples to try, given the least that the continuous minimum admits.
    fn candidates(&self, least: usize) -> Vec<usize> {
        match self.slew.objective() {
            Objective::Energy { duration_s, .. } => {
                vec![whole((duration_s / self.period).round())]
            }
            // Time weighs against effort, so that the shorter side of the optimum counts too.
            Objective::TimeAndEffort { .. } => {
                (least.saturating_sub(1).max(2)..=least + MAX_EXTRA).collect()
            }
            _ => (least..=least + MAX_EXTRA).collect(),
        }
    }

    /// What is minimised once the number of samples is fixed.
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

    /// The optimum in so many samples: held linearly, and from there held constant.
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
        // Torque that may jump needs less time than one that may not: no motion of the second kind
        // says nothing about the first.
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

    fn value(&self, found: &FoundSolution) -> f64 {
        let motion = &found.solved.motion;
        match self.slew.objective() {
            Objective::TimeAndEffort { weight } => motion.duration() + weight * effort(motion),
            _ => motion.duration(),
        }
    }
}
