//! Starting guesses of a leg, and how many of them are solved.

use super::LegProblem;
use super::arrival::Arrival;
use super::bowed::{Bow, apart};
use super::eigenaxis::{EigenaxisSlew, Perturbation};
use super::resolution::{DETOUR, Resolution};
use crate::leg::multiphase::{LegSolution, StagedSolve};
use crate::leg::profile::Profile;
use crate::model::waypoint::Waypoint;
use crate::run::stop::StopReason;

/// Guesses that are tried: the second one only where a lower bound does not settle the first.
const MAX_GUESSES: usize = 2;
/// The long way round is tried where its eigenaxis slew takes at most this multiple of the short
/// way's time. Stored momentum favours one side: some legs are faster the long way round although
/// that eigenaxis slew takes longer.
const MAX_LONG_WAY_RATIO: f64 = 1.5;
/// Ratio of the intervals that a solution needs to those that it has above which it is solved
/// again.
const MIN_REFINEMENT: f64 = 1.1;

/// Relative gap to a lower bound at which no other guess is tried: well below the distance between
/// local minima (2.4 % on the legs of experiment C).
const MAX_GAP: f64 = 0.005;
/// The same with momentum, where the bound is less sharp.
const MAX_GAP_WITH_MOMENTUM: f64 = 0.03;

/// Turn of a motion, rad, below which it is hardly ever a local minimum: turns so small nearly commute, and those that
/// do add up like vectors. Of 1,054 such legs without momentum, with all kinds of conditions at their ends, a second
/// guess shortens one by more than 0.1 % (0.2 %); of 1,600 with momentum nine, by at most 0.33 %. Motions far from the
/// eigenaxis shorten none.
const SMALL_TURN: f64 = 0.3;

/// Relative gap to a lower bound above which motions far from the eigenaxis are explored: where the
/// best two guesses of 800 general slews were more than 0.5 % too slow, seventeen times, it was larger
/// nearly always. With momentum, bounds leave more of all legs: where the best guesses of 920 slews with wheels
/// near their limits were more than 0.5 % too slow, eighteen times, it was larger but for one.
const EXPLORED_GAP: f64 = 0.07;
const EXPLORED_GAP_WITH_MOMENTUM: f64 = 0.15;
/// Relative gap to a lower bound above which the best two of them are solved.
const WIDE_GAP: f64 = 0.4;
/// Intervals of the rough motions that tell where a minimum may be.
pub(super) const ROUGH_INTERVALS: usize = 8;
/// A motion along a bowed way begins so many times as long as the best one.
const SLOWER: f64 = 1.2;
/// Excess of a rough motion over the best duration up to which it is solved, and how far it must be
/// from the best motion: a rough motion is some 2 % slower than what becomes of it, with spare wheels 5 %.
const PROMISING: f64 = 1.05;
const ELSEWHERE: f64 = 0.1;
/// Relative gain of a bowed motion above which it is solved once more from where it ended: of eleven such
/// legs in 992 the second solve shortens seven, by up to 0.37 %.
const LEAP: f64 = 1e-3;

/// The best solution so far, and how many programs it took.
pub(super) struct Starts<'a> {
    leg: &'a LegProblem<'a>,
    /// A lower bound of the duration, s.
    bound: Option<f64>,
    stop: &'a dyn Fn() -> Option<StopReason>,
    best: Option<LegSolution>,
    solves: u64,
}

impl<'a> Starts<'a> {
    pub(super) fn new(
        leg: &'a LegProblem<'a>,
        bound: Option<f64>,
        stop: &'a dyn Fn() -> Option<StopReason>,
    ) -> Self {
        Self {
            leg,
            bound,
            stop,
            best: None,
            solves: 0,
        }
    }

    /// The best solution from all guesses that are worth their time, and how many programs it took.
    pub(super) fn best(mut self) -> (LegSolution, u64) {
        let has_momentum = self.leg.dynamics.has_momentum();
        for guess in guesses(self.leg) {
            self.solve(self.leg, &guess);
            if self.are_enough() || (self.turns_little() && !has_momentum) {
                break;
            }
        }
        let explored = if has_momentum {
            EXPLORED_GAP_WITH_MOMENTUM
        } else {
            EXPLORED_GAP
        };
        if !self.are_within(explored) && !self.turns_little() {
            self.explore();
        }
        self.refine();
        if !self.are_enough() {
            self.try_long_way_round();
        }
        let best = self.best.expect("there is always the eigenaxis guess");
        (best, self.solves)
    }

    /// Solves from a guess; whether there is a solution.
    fn solve(&mut self, leg: &LegProblem<'_>, guess: &Profile) -> bool {
        let solution = leg.solve_from(guess, self.stop);
        let converged = solution.duration().is_some();
        self.solves += 1;
        let best = self.best.as_ref();
        if best.is_none_or(|best| solution.improves(best)) {
            self.best = Some(solution);
        }
        converged
    }

    /// Whether the best duration is so close to the bound that no other guess is worth its time, or
    /// the solve is stopped.
    fn are_enough(&self) -> bool {
        self.are_within(if self.leg.dynamics.has_momentum() {
            MAX_GAP_WITH_MOMENTUM
        } else {
            MAX_GAP
        })
    }

    /// Whether the best duration is within a gap of the bound, or the solve is stopped.
    fn are_within(&self, gap: f64) -> bool {
        let duration = self.best.as_ref().and_then(LegSolution::duration);
        let both = self.bound.zip(duration);
        both.is_some_and(|(bound, duration)| duration <= (1.0 + gap) * bound)
            || (self.stop)().is_some()
    }

    /// Whether the best motion turns so little that others are hardly faster.
    fn turns_little(&self) -> bool {
        let turned = self.best.as_ref().and_then(turned);
        turned.is_some_and(|turned| turned < SMALL_TURN)
    }

    /// Solves roughly for motions along bowed ways, and then from the fastest of those that lead elsewhere than
    /// the best so far, where they may become faster; from all of them while there is no solution.
    fn explore(&mut self) {
        let known = self.best.as_ref().and_then(LegSolution::duration);
        let lasting = SLOWER * known.unwrap_or_else(|| self.leg.eigenaxis().course.duration());
        // Momentum turns in body axes: few intervals go ways that more of them cannot.
        let rough_intervals = if self.leg.dynamics.has_momentum() {
            self.leg.intervals() * 2 / 3
        } else {
            ROUGH_INTERVALS
        };
        let ways = Bow::around(self.leg).into_iter();
        let rough = ways.filter_map(|way| {
            let guess = way.motion(self.leg, rough_intervals, lasting);
            Some((self.rough_elsewhere(&guess)?, way))
        });
        let mut rough: Vec<_> = rough.collect();
        rough.sort_by(|((one, _), _), ((other, _), _)| one.total_cmp(other));
        let most = if self.are_within(WIDE_GAP) { 1 } else { 2 };
        let mut tried: Vec<Profile> = Vec::new();
        for ((rough, motion), way) in rough {
            let known = self.best.as_ref().and_then(LegSolution::duration);
            let is_enough = |known| tried.len() >= most || rough > PROMISING * known;
            if known.is_some_and(is_enough) || (self.stop)().is_some() {
                return;
            }
            if tried.iter().all(|other| apart(&motion, other) > ELSEWHERE) {
                let lasting = SLOWER * known.unwrap_or(rough);
                let guess = way.motion(self.leg, self.leg.intervals(), lasting);
                if self.follow(&guess, known) {
                    tried.push(motion);
                }
            }
        }
    }

    /// Solves from a guess, and once more from where that ends if it is clearly faster than what is known, s: a
    /// bow is far from what becomes of it, and there may be a better minimum beside the first. Whether the guess
    /// leads to a solution.
    fn follow(&mut self, guess: &Profile, known: Option<f64>) -> bool {
        let converged = self.solve(self.leg, guess);
        let leaps = |found| known.is_none_or(|known| found < (1.0 - LEAP) * known);
        let best = self.best.as_ref();
        let found = best.filter(|best| best.duration().is_some_and(leaps));
        if let Some(found) = found.map(|best| best.profile.clone())
            && (self.stop)().is_none()
        {
            self.solve(self.leg, &found);
        }
        converged
    }

    /// The duration, s, and the rough motion from a guess; `None` where there is none, or it leads where the best
    /// motion is.
    fn rough_elsewhere(&self, guess: &Profile) -> Option<(f64, Profile)> {
        let (waypoints, intervals) = (self.leg.waypoints(guess), [guess.intervals()]);
        let rough = StagedSolve::rough(self.leg.dynamics, &waypoints, &intervals, guess, self.stop);
        let duration = rough.duration()?;
        let best = self.best.as_ref().filter(|best| best.duration().is_some());
        best.is_none_or(|best| apart(rough.motion(), &best.profile) > ELSEWHERE)
            .then(|| (duration, rough.motion().clone()))
    }

    /// Solves once more with the intervals that the best solution needs, where it has clearly fewer
    /// because it turns farther than expected.
    fn refine(&mut self) {
        let finer = self.best.as_ref().and_then(|best| finer(self.leg, best));
        if let Some(finer) = finer
            && (self.stop)().is_none()
            && let Some(guess) = guesses(&finer).next()
        {
            self.solve(&finer, &guess);
        }
    }

    /// Solves for the other quaternion sign of the end, where momentum may make that way the faster
    /// one.
    fn try_long_way_round(&mut self) {
        if let Some(there) = long_way_round(self.leg) {
            let long = LegProblem {
                to: &there,
                arrival: Arrival::Quaternion,
                ..*self.leg
            };
            self.solve(&long, &long.perturbed_eigenaxis(Perturbation::Far));
        }
    }
}

/// The first guesses, the most promising one first.
fn guesses<'s>(leg: &'s LegProblem<'_>) -> impl Iterator<Item = Profile> + use<'s> {
    let sides = [Perturbation::Far, Perturbation::Near].into_iter();
    leg.extremal()
        .into_iter()
        .chain(sides.map(|side| leg.perturbed_eigenaxis(side)))
        .take(MAX_GUESSES)
}

/// The same leg with the intervals that a solution needs, if those are clearly more than it has.
fn finer<'a>(leg: &LegProblem<'a>, solution: &LegSolution) -> Option<LegProblem<'a>> {
    let needed = leg
        .resolution
        .intervals_of(leg.dynamics, turned(solution)? / DETOUR);
    let given = solution.profile.intervals();
    (needed as f64 > MIN_REFINEMENT * given as f64).then(|| LegProblem {
        resolution: Resolution {
            intervals: leg.resolution.intervals + needed - given,
            ..leg.resolution
        },
        ..*leg
    })
}

/// The angles by which a solution turns between its nodes, rad, together; `None` where there is no solution.
fn turned(solution: &LegSolution) -> Option<f64> {
    solution.duration()?;
    let attitudes = solution.profile.attitudes.windows(2);
    Some(attitudes.map(|q| q[0].signed_turn_to(&q[1]).norm()).sum())
}

/// The end with the quaternion sign to which the body turns by more than half a turn, where that way may be the
/// faster one.
fn long_way_round(leg: &LegProblem<'_>) -> Option<Waypoint> {
    if !leg.may_go_the_long_way() {
        return None;
    }
    let short = leg.arrival.signed(&leg.to.attitude, &leg.from.attitude);
    let there = Waypoint {
        attitude: short.negated(),
        ..leg.to.clone()
    };
    let duration = |target| {
        let slew = EigenaxisSlew::fastest(leg.dynamics, &leg.from.attitude, target, leg.null);
        slew.course.duration()
    };
    (duration(&there.attitude) <= MAX_LONG_WAY_RATIO * duration(&short)).then_some(there)
}
