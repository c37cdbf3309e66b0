//! One leg between two waypoints: guesses, solves, the best solution.

pub(crate) mod around_cones;
pub(crate) mod arrival;
mod bowed;
mod centred;
pub(crate) mod eigenaxis;
pub(crate) mod extremal;
mod resolution;
pub(crate) mod rolls;
mod starts;
mod steered;
#[cfg(test)]
mod tests;
pub(crate) mod zero_length;

use crate::leg::multiphase::{LegSolution, polish, solve_through};
use crate::leg::profile::Profile;
use crate::model::dynamics::Dynamics;
use crate::model::scenario::RateCondition;
use crate::model::waypoint::{Waypoint, WheelCondition};
use crate::nlp::NlpStatus;
use crate::run::stop::StopReason;
use arrival::Arrival;
use eigenaxis::{EigenaxisSlew, Perturbation};
use extremal::KinematicExtremals;
use nalgebra::{DVector, Vector3};
pub(crate) use resolution::Resolution;
use starts::Starts;
use steered::steered;
use zero_length::zero_length;

/// Relative excess over the duration of the eigenaxis slew above which that slew replaces a
/// solution.
const EIGENAXIS_TOLERANCE: f64 = 1e-6;
/// Relative difference below which wheel momenta are the same.
const SAME_MOMENTUM: f64 = 1e-9;

/// A leg between two waypoints.
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
    /// Kinematic extremals of its spacecraft, for guesses.
    pub(crate) extremals: &'a KinematicExtremals,
    /// How finely it is solved.
    pub(crate) resolution: Resolution,
}

/// The best solution of a leg, and how many programs it took.
#[derive(Debug, Clone)]
pub(crate) struct LegOutcome {
    /// The best converged solution, or one whose status says why there is none.
    pub(crate) solution: LegSolution,
    /// NLPs solved.
    pub(crate) solves: u64,
}

/// Solves a leg from one guess after the other, until its duration is so close to a lower bound, s,
/// that another guess is not worth its time.
pub(crate) fn solve(
    leg: &LegProblem<'_>,
    bound: Option<f64>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegOutcome {
    if leg.from.roll.is_some() || leg.to.roll.is_some() {
        return rolls::solve_from_rolls(leg, bound, stop);
    }
    solve_from_attitudes(leg, bound, stop)
}

/// Solves a leg from guesses between the attitudes of its waypoints.
fn solve_from_attitudes(
    leg: &LegProblem<'_>,
    bound: Option<f64>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegOutcome {
    if !leg.dynamics.cones.is_empty() {
        return around_cones::solve_with_cones(leg, bound, stop);
    }
    if let Some(solution) = zero_length(leg) {
        return LegOutcome {
            solution,
            solves: 0,
        };
    }
    let (mut solution, mut solves) = Starts::new(leg, bound, stop).best();
    if stop().is_none()
        && let Some(better) = leg.no_slower_than_eigenaxis(&solution, stop)
    {
        solution = better;
        solves += 1;
    }
    if solution.duration().is_none()
        && matches!(stop(), None | Some(StopReason::TimeLimit))
        && let Some(constructed) = leg.constructed()
    {
        solution = constructed;
        if solution.profile.intervals() > 0 {
            let improved = leg.solve_with(&solution.intervals, &solution.profile, stop);
            solves += 1;
            if improved.improves(&solution) {
                solution = improved;
            }
        }
    }
    if leg.resolution.polished {
        let waypoints = leg.waypoints(&solution.profile);
        let intervals = solution.intervals.clone();
        solution = polish(leg.dynamics, &waypoints, &intervals, solution, stop);
    }
    LegOutcome { solution, solves }
}

impl LegProblem<'_> {
    /// Intervals of the leg.
    pub(crate) fn intervals(&self) -> usize {
        let turn = self.arrival.turn(&self.from.attitude, &self.to.attitude);
        self.resolution.intervals_of(self.dynamics, turn)
    }

    /// Whether a turn by more than half a turn counts as arrived and may be the faster one: stored momentum
    /// favours one way round.
    fn may_go_the_long_way(&self) -> bool {
        self.arrival == Arrival::Rotation && self.dynamics.has_momentum()
    }

    /// A leg of the same spacecraft between other waypoints.
    pub(crate) fn between<'e>(&'e self, from: &'e Waypoint, to: &'e Waypoint) -> LegProblem<'e> {
        LegProblem { from, to, ..*self }
    }

    /// A solution constructed without a program: slowly about the eigenaxis. `None` where the
    /// wheels cannot hold the momentum along the way.
    pub(crate) fn constructed(&self) -> Option<LegSolution> {
        steered(self)
    }

    /// Solves from a guess of the leg's own intervals.
    pub(crate) fn solve_from(
        &self,
        guess: &Profile,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> LegSolution {
        self.solve_with(&[self.intervals()], guess, stop)
    }

    /// Solves from a guess of so many intervals.
    fn solve_with(
        &self,
        intervals: &[usize],
        guess: &Profile,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> LegSolution {
        let waypoints = self.waypoints(guess);
        solve_through(self.dynamics, &waypoints, intervals, guess, stop)
    }

    /// A solution that takes no longer than the eigenaxis slew, where that keeps all limits and the
    /// present solution is slower: solved from the eigenaxis slew, or that slew itself.
    fn no_slower_than_eigenaxis(
        &self,
        present: &LegSolution,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> Option<LegSolution> {
        let eigenaxis = self.eigenaxis();
        let allowed = eigenaxis.course.duration() * (1.0 + EIGENAXIS_TOLERANCE);
        let fast = |found: &LegSolution| found.duration().is_some_and(|time| time <= allowed);
        if fast(present) || !eigenaxis.flyable || !self.begins_and_ends_at_rest() {
            return None;
        }
        let exact = eigenaxis.exact(self.dynamics, self.intervals());
        let solved = self.solve_from(&exact, stop);
        if fast(&solved) || self.dynamics.has_momentum() {
            // With momentum the torque of the eigenaxis slew is not piecewise constant.
            return solved.improves(present).then_some(solved);
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

    /// Both ends, the second with the quaternion sign at which a motion arrives.
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

    /// A guess from the eigenaxis slew, perturbed to one side.
    pub(crate) fn perturbed_eigenaxis(&self, side: Perturbation) -> Profile {
        self.perturbed_eigenaxis_of(self.intervals(), side)
    }

    /// The same with so many intervals.
    fn perturbed_eigenaxis_of(&self, intervals: usize, side: Perturbation) -> Profile {
        let slew = self.eigenaxis().lasting(self.least_duration());
        slew.guess(self.dynamics, intervals, side)
    }

    /// Least duration of a guess, s: long enough to change the rates and momenta of one end into
    /// those of the other, and above zero in any case.
    fn least_duration(&self) -> f64 {
        let change = self.from.change_time(self.to, self.dynamics);
        change.max(self.dynamics.least_duration())
    }

    /// The eigenaxis slew of the leg, the short way round unless the quaternion sign decides.
    pub(crate) fn eigenaxis(&self) -> EigenaxisSlew {
        let from = &self.from.attitude;
        let target = self.arrival.signed(&self.to.attitude, from);
        EigenaxisSlew::fastest(self.dynamics, from, &target, self.null)
    }
}
