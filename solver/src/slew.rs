//! One slew between two waypoints: guesses, solves, the best of them.

pub(crate) mod arrival;
mod centred;
pub(crate) mod eigenaxis;
pub(crate) mod extremal;
pub(crate) mod standstill;
mod steered;
#[cfg(test)]
mod tests;

use crate::dynamics::Dynamics;
use crate::multiphase::{Flown, fly, polish};
use crate::nlp::{Interruption, NlpStatus};
use crate::profile::Profile;
use crate::scenario::RateCondition;
use crate::spec::Accuracy;
use crate::transcription::{Waypoint, WheelCondition};
use arrival::Arrival;
use eigenaxis::{EigenaxisSlew, Side};
use extremal::KinematicExtremals;
use nalgebra::{DVector, Vector3};
use standstill::standstill;
use steered::steered;

/// How finely slews are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Resolution {
    /// Intervals of a leg.
    pub(crate) intervals: usize,
    /// Whether solutions are freed of what draws interval lengths together.
    pub(crate) polished: bool,
}

impl Resolution {
    /// The resolution of an accuracy.
    pub(crate) fn of(accuracy: Accuracy, dynamics: &Dynamics) -> Self {
        let bent = if dynamics.has_momentum() {
            WITH_MOMENTUM
        } else {
            0
        };
        let usual = LEAST_INTERVALS + PER_SPARE_WHEEL * (dynamics.wheel_count() - 3) + bent;
        match accuracy {
            Accuracy::Standard => Self {
                intervals: usual,
                polished: false,
            },
            Accuracy::Tight => Self {
                intervals: 2 * usual,
                polished: true,
            },
        }
    }
}

impl Resolution {
    /// Intervals of a leg that turns by an angle, rad: more where a rate on its limit would stray
    /// from it, under a torque that does not turn with the stored momentum.
    pub(crate) fn intervals_of(&self, dynamics: &Dynamics, turn: f64) -> usize {
        let stray = if self.polished {
            0.5 * MOST_STRAY
        } else {
            MOST_STRAY
        };
        let longest = (8.0 * stray / dynamics.straying()).sqrt();
        self.intervals + parts_of(DETOUR * turn, longest, MOST_ALONG_LIMITS)
    }
}

/// Into how many parts a turn is cut, none longer than this; at most so many.
fn parts_of(turn: f64, longest: f64, most: usize) -> usize {
    if longest == f64::INFINITY {
        return 0;
    }
    let enough = |parts: &usize| *parts as f64 * longest >= turn - SAME_TURN;
    (0..most).find(enough).unwrap_or(most)
}

/// Intervals of a leg with three wheels and without momentum: with more the measured durations of
/// 171 legs gain less than 1e-4.
const LEAST_INTERVALS: usize = 12;
/// Further intervals for every further wheel, which switches at times of its own, and for stored
/// momentum, which turns in the body while the torque of an interval does not. Of 90
/// legs of the random suite with wheels to spare and without momentum, two per wheel leave two 0.11
/// and 0.24 % above the tight durations, four leave none more than 0.03 %.
const PER_SPARE_WHEEL: usize = 4;
const WITH_MOMENTUM: usize = 6;
/// How far a rate on its limit may stray from it on an interval, relative: the program takes it off,
/// so that a third of it is lost at most.
const MOST_STRAY: f64 = 1.5e-2;
/// How much farther than about the eigenaxis the fastest slew turns, about.
const DETOUR: f64 = 1.3;
/// Turn, rad, that rounding may add without adding a part.
const SAME_TURN: f64 = 1e-9;
/// Most intervals for rate limits; with more momentum than these resolve, limits are kept by reserves.
const MOST_ALONG_LIMITS: usize = 240;
/// Guesses that are tried: a second one where a bound does not settle the first.
const STARTS: usize = 2;

/// Excess over a bound from below up to which a duration is not doubted. On the 171 legs of
/// experiment C the certified bound is 0 to 2.1 % below the best known durations, in the median 0.2 %;
/// the local minimum that traps solvers there is 2.4 % above the best.
const UNDOUBTED: f64 = 0.005;
/// The same with momentum, of which the bound knows little.
const UNDOUBTED_WITH_MOMENTUM: f64 = 0.03;
/// How much longer than the slew about the eigenaxis a flight may take before that is preferred.
const EIGENAXIS_TOLERANCE: f64 = 1e-6;
/// Relative difference below which wheel momenta are the same.
const SAME_MOMENTUM: f64 = 1e-9;

/// A slew between two waypoints.
#[derive(Clone, Copy)]
pub(crate) struct SlewProblem<'a> {
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
pub(crate) struct Slew {
    /// The best converged flight, or one that tells why there is none.
    pub(crate) flown: Flown,
    /// NLPs solved.
    pub(crate) solves: u64,
}

/// Solves a slew from one guess after the other, until its duration is so close to a bound from
/// below, s, that no other is worth its time.
pub(crate) fn solve(
    slew: &SlewProblem<'_>,
    bound: Option<f64>,
    stop: &dyn Fn() -> Option<Interruption>,
) -> Slew {
    if let Some(flown) = standstill(slew) {
        return Slew { flown, solves: 0 };
    }
    let extremal = slew.extremal();
    let bowed = [Side::Far, Side::Near].into_iter();
    let bowed = bowed.map(|side| slew.bowed(side));
    let mut best: Option<Flown> = None;
    let mut solves = 0;
    for guess in extremal.into_iter().chain(bowed).take(STARTS) {
        let flown = slew.fly(&guess, stop);
        solves += 1;
        let duration = flown.duration();
        if best.as_ref().is_none_or(|best| flown.improves(best)) {
            best = Some(flown);
        }
        let undoubted = if slew.dynamics.has_momentum() {
            UNDOUBTED_WITH_MOMENTUM
        } else {
            UNDOUBTED
        };
        let settled = bound
            .zip(duration)
            .is_some_and(|(bound, duration)| duration <= (1.0 + undoubted) * bound);
        if settled || stop().is_some() {
            break;
        }
    }
    let mut flown = best.expect("there is always the eigenaxis guess");
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
    Slew { flown, solves }
}

impl SlewProblem<'_> {
    /// Intervals of the slew.
    pub(crate) fn intervals(&self) -> usize {
        let turn = self.arrival.turn(&self.from.attitude, &self.to.attitude);
        self.resolution.intervals_of(self.dynamics, turn)
    }

    /// A flight that no program has made shorter: slowly about the eigenaxis. `None` where the wheels
    /// cannot hold the momentum along the way.
    pub(crate) fn constructed(&self) -> Option<Flown> {
        steered(self)
    }

    /// Flies from a guess.
    fn fly(&self, guess: &Profile, stop: &dyn Fn() -> Option<Interruption>) -> Flown {
        self.fly_in(&[self.intervals()], guess, stop)
    }

    /// Flies from a guess of so many intervals.
    fn fly_in(
        &self,
        intervals: &[usize],
        guess: &Profile,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> Flown {
        let waypoints = self.waypoints(guess);
        fly(self.dynamics, &waypoints, intervals, guess, stop)
    }

    /// A flight that takes no longer than the slew about the eigenaxis, where that can be flown and
    /// another flight is slower than it: from the exact slew, or the slew itself.
    fn eigenaxis_at_worst(
        &self,
        flown: &Flown,
        stop: &dyn Fn() -> Option<Interruption>,
    ) -> Option<Flown> {
        let eigenaxis = self.eigenaxis();
        let allowed = eigenaxis.trapezoid.duration * (1.0 + EIGENAXIS_TOLERANCE);
        let fast = |flown: &Flown| flown.duration().is_some_and(|time| time <= allowed);
        if fast(flown) || !eigenaxis.flyable || !self.begins_and_ends_at_rest() {
            return None;
        }
        let exact = eigenaxis.exact(self.dynamics, self.intervals());
        let solved = self.fly(&exact, stop);
        if fast(&solved) || self.dynamics.has_momentum() {
            // With momentum its torque is not piecewise constant.
            return solved.improves(flown).then_some(solved);
        }
        Some(Flown {
            status: NlpStatus::Converged,
            profile: exact,
            intervals: vec![self.intervals()],
            iterations: solved.iterations,
            infeasibility: 0.0,
            passing_prices: Vec::new(),
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

    /// A guess from the slew about the eigenaxis, bowed to one side.
    pub(crate) fn bowed(&self, side: Side) -> Profile {
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
