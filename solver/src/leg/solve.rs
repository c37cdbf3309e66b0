//! One slew between two waypoints: guesses, solves, the best of them.

pub(crate) mod arrival;
mod centred;
pub(crate) mod eigenaxis;
pub(crate) mod extremal;
mod resolution;
mod starts;
mod steered;
#[cfg(test)]
mod tests;
pub(crate) mod zero_length;

use crate::leg::multiphase::{LegSolution, fly, polish};
use crate::leg::profile::Profile;
use crate::model::dynamics::Dynamics;
use crate::model::scenario::RateCondition;
use crate::model::waypoint::{Waypoint, WheelCondition};
use crate::nlp::{Interruption, NlpStatus};
use arrival::Arrival;
use eigenaxis::{EigenaxisSlew, Perturbation};
use extremal::KinematicExtremals;
use nalgebra::{DVector, Vector3};
pub(crate) use resolution::Resolution;
use starts::Starts;
use steered::steered;
use zero_length::zero_length;

/// How much longer than the slew about the eigenaxis a flight may take before that is preferred.
const EIGENAXIS_TOLERANCE: f64 = 1e-6;
/// Relative difference below which wheel momenta are the same.
const SAME_MOMENTUM: f64 = 1e-9;

/// A slew between two waypoints.
#[derive(Clone, Copy)]
pub(crate) struct LegProblem<'a> {
    /// The spacecraft with its momentum.
    pub(crate) dynamics: &'a Dynamics,
    /// Where it begins.
    pub(crate) from: &'a Waypoint,
    /// Where it ends; the quaternion sign is free with [`Arrival::Rotation`].
    pub(crate) to: &'a Waypoint,
    /// Which signs count as arrived.
    pub(crate) arrival: Arrival,
    /// Null-space momentum of the wheels in the guesses, N m s.
    pub(crate) null: &'a DVector<f64>,
    /// Guesses for its spacecraft.
    pub(crate) extremals: &'a KinematicExtremals,
    /// How finely it is solved.
    pub(crate) resolution: Resolution,
}

/// The best solution of a slew.
#[derive(Debug, Clone)]
pub(crate) struct LegOutcome {
    /// The best converged flight, or one that tells why there is none.
    pub(crate) flown: LegSolution,
    /// NLPs solved.
    pub(crate) solves: u64,
}

/// Solves a slew from one guess after the other, until its duration is so close to a bound from
/// below, s, that no other is worth its time.
pub(crate) fn solve(
    slew: &LegProblem<'_>,
    bound: Option<f64>,
    stop: &dyn Fn() -> Option<Interruption>,
) -> LegOutcome {
    if let Some(flown) = zero_length(slew) {
        return LegOutcome { flown, solves: 0 };
    }
    let (mut flown, mut solves) = Starts::new(slew, bound, stop).best();
    if stop().is_none()
        && let Some(better) = slew.eigenaxis_at_worst(&flown, stop)
    {
        flown = better;
        solves += 1;
    }
    if flown.duration().is_none()
        && stop() != Some(Interruption::Cancelled)
        && let Some(constructed) = slew.constructed()
    {
        flown = constructed;
        if flown.profile.intervals() > 0 {
            let improved = slew.fly_in(&flown.intervals, &flown.profile, stop);
            solves += 1;
            if improved.improves(&flown) {
                flown = improved;
            }
        }
    }
    if slew.resolution.polished {
        let waypoints = slew.waypoints(&flown.profile);
        let intervals = flown.intervals.clone();
        flown = polish(slew.dynamics, &waypoints, &intervals, flown, stop);
    }
    LegOutcome { flown, solves }
}

impl LegProblem<'_> {
    /// Intervals of the slew.
    pub(crate) fn intervals(&self) -> usize {
        let turn = self.arrival.turn(&self.from.attitude, &self.to.attitude);
        self.resolution.intervals_of(self.dynamics, turn)
    }

    /// A flight that no program has made shorter: slowly about the eigenaxis. `None` where the wheels
    /// cannot hold the momentum along the way.
    pub(crate) fn constructed(&self) -> Option<LegSolution> {
        steered(self)
    }

    /// Flies from a guess.
    fn fly(&self, guess: &Profile, stop: &dyn Fn() -> Option<Interruption>) -> LegSolution {
        self.fly_in(&[self.intervals()], guess, stop)
    }

    /// Flies from a guess of so many intervals.
    fn fly_in(
        &self,
        intervals: &[usize],
        guess: &Profile,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> LegSolution {
        let waypoints = self.waypoints(guess);
        fly(self.dynamics, &waypoints, intervals, guess, stop)
    }

    /// A flight that takes no longer than the slew about the eigenaxis, where that can be flown and
    /// another flight is slower than it: from the exact slew, or the slew itself.
    fn eigenaxis_at_worst(
        &self,
        flown: &LegSolution,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> Option<LegSolution> {
        let eigenaxis = self.eigenaxis();
        let allowed = eigenaxis.course.duration() * (1.0 + EIGENAXIS_TOLERANCE);
        let fast = |flown: &LegSolution| flown.duration().is_some_and(|time| time <= allowed);
        if fast(flown) || !eigenaxis.flyable || !self.begins_and_ends_at_rest() {
            return None;
        }
        let exact = eigenaxis.exact(self.dynamics, self.intervals());
        let solved = self.fly(&exact, stop);
        if fast(&solved) || self.dynamics.has_momentum() {
            // With momentum its torque is not piecewise constant.
            return solved.improves(flown).then_some(solved);
        }
        Some(LegSolution {
            status: NlpStatus::Converged,
            profile: exact,
            intervals: vec![self.intervals()],
            iterations: solved.iterations,
            infeasibility: 0.0,
            costates: Vec::new(),
        })
    }

    /// Whether the conditions of both ends admit rest with the null-space momentum of the guesses.
    pub(crate) fn begins_and_ends_at_rest(&self) -> bool {
        [self.from, self.to].iter().all(|end| {
            let still = end.rate.iter().all(|rate| match rate {
                RateCondition::Free => true,
                RateCondition::Fixed(value) => *value == 0.0,
                RateCondition::Within(low, high) => *low <= 0.0 && *high >= 0.0,
            });
            let rest = self
                .dynamics
                .wheels_at(&end.attitude, &Vector3::zeros(), self.null);
            still
                && match &end.wheels {
                    WheelCondition::Free => true,
                    WheelCondition::NullSpace(null) => null == self.null,
                    WheelCondition::Fixed(held) => {
                        (held - &rest).amax() <= SAME_MOMENTUM * rest.amax()
                    }
                }
        })
    }

    /// Both ends, the second with the sign at which a motion arrives.
    fn waypoints(&self, motion: &Profile) -> [Waypoint; 2] {
        let mut to = self.to.clone();
        if let Some(last) = motion.attitudes.last() {
            to.attitude = self.arrival.signed(&to.attitude, last);
        }
        [self.from.clone(), to]
    }

    /// A guess from the kinematic extremal, where rates are limited.
    pub(crate) fn extremal(&self) -> Option<Profile> {
        self.extremals.guess(self)
    }

    /// A guess from the slew about the eigenaxis, perturbed_eigenaxis to one side.
    pub(crate) fn perturbed_eigenaxis(&self, side: Perturbation) -> Profile {
        let intervals = self.intervals();
        let slew = self.eigenaxis().lasting(self.least_duration());
        slew.guess(self.dynamics, intervals, side)
    }

    /// No guess is shorter, s: what the ends ask for beside the turn takes its time, and even where
    /// nothing is asked for a guess has to take some.
    fn least_duration(&self) -> f64 {
        let change = self.from.change_time(self.to, self.dynamics);
        change.max(self.dynamics.least_duration())
    }

    /// The slew about the eigenaxis, the short way round unless the sign says otherwise.
    pub(crate) fn eigenaxis(&self) -> EigenaxisSlew {
        let from = &self.from.attitude;
        let target = self.arrival.signed(&self.to.attitude, from);
        EigenaxisSlew::fastest(self.dynamics, from, &target, self.null)
    }
}
