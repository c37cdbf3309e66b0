//! Solves the program of a segment, from one initial guess after the other.

use super::guesses::{InitialGuess, extended, joined};
use super::segment_key::{MAX_SHORT_LEGS, SegmentKind};
use super::tours::Tours;
use crate::leg::multiphase::{LegSolution, polish, solve_extended, solve_rolling, solve_through};
use crate::leg::profile::Profile;
use crate::leg::solve::around_cones::is_clear;
use crate::leg::solve::rolls::promising;
use crate::model::waypoint::Waypoint;
use crate::nlp::NlpStatus;
use crate::tour::order::Place;
use std::sync::atomic::Ordering;

/// Initial guesses of a piece, in the order in which they are tried.
const PIECE_GUESSES: [InitialGuess; 2] = [InitialGuess::Eigenaxes, InitialGuess::Extremals];
/// Initial guesses of a beginning of more than [`MAX_SHORT_LEGS`] legs.
const BEGINNING_GUESSES: [InitialGuess; 3] = [
    InitialGuess::Shorter,
    InitialGuess::Eigenaxes,
    InitialGuess::Extremals,
];
/// The same where every place on the way is passed at rest, so that nothing but the momenta of a fourth
/// wheel is free there: legs from rest to rest are a motion that the program can only improve, while
/// from others it may end above them.
const STOPPING_PIECE_GUESSES: [InitialGuess; 3] = [
    InitialGuess::AtRest,
    InitialGuess::Eigenaxes,
    InitialGuess::Extremals,
];
const STOPPING_BEGINNING_GUESSES: [InitialGuess; 3] = [
    InitialGuess::Shorter,
    InitialGuess::AtRest,
    InitialGuess::Eigenaxes,
];
/// Initial guess of a whole tour whose solution as a piece has failed.
const TOUR_GUESSES: [InitialGuess; 1] = [InitialGuess::AtRest];
/// Where rolls are free: starts with different rolls that are compared by rough motions, and how many of
/// them are solved. Of short segments of few targets, of longer ones, and among many targets.
const ROLLED_STARTS_OF_SHORT: [usize; 2] = [16, 3];
const ROLLED_STARTS: [usize; 2] = [8, 2];
const ROLLED_STARTS_AMONG_MANY: [usize; 2] = [4, 1];

impl Tours<'_> {
    /// The best solution from several initial guesses: a chain of legs has local minima that none
    /// of its legs has.
    pub(super) fn solve_distinct(&self, route: &[Place], kind: SegmentKind) -> LegSolution {
        let short = route.len() - 1 <= MAX_SHORT_LEGS;
        let thorough = short && self.places.needs_all_legs();
        let long_beginning = kind == SegmentKind::Beginning && !short;
        let guesses = self.initial_guesses(route, kind, long_beginning);
        // Longer segments start from short ones and would inherit a local minimum. Among many targets
        // one guess serves: of 960 pieces of two and four legs one ends 1e-3 above the better of both.
        let min_guesses = if thorough { guesses.len() } else { 1 };
        let starts = match guesses[0] {
            InitialGuess::AtRest => vec![self.places.waypoints(route)],
            _ => self.starts(route, short),
        };
        let needed = starts.len() * min_guesses;
        let with = |guess| starts.iter().map(move |waypoints| (guess, waypoints));
        let all = guesses.iter().flat_map(|guess| with(*guess));
        let mut best = LegSolution::nowhere();
        for (tried, (guess, waypoints)) in all.enumerate() {
            let settled = best.status == NlpStatus::Converged && tried >= needed;
            if settled || best.status.is_interrupted() {
                break;
            }
            let solution = self.solve_from((route, waypoints), guess);
            if tried == 0 || solution.improves(&best) || solution.status.is_interrupted() {
                best = solution;
            }
        }
        // A longer beginning has the minimum of the shorter one that it extends.
        if !long_beginning {
            best = self.without_needless_time(route, &best).unwrap_or(best);
        }
        let with_cones = &self.places.with_cones;
        let mut dynamics = &self.places.dynamics;
        if !is_clear(with_cones, &best.profile) && !best.status.is_interrupted() {
            best = self.solve_from((route, &starts[0]), InitialGuess::AroundCones);
            dynamics = with_cones;
        }
        if self.places.resolution.polished {
            let intervals = best.intervals.clone();
            let waypoints = self.signed_waypoints(route, &best.profile, &intervals);
            best = polish(dynamics, &waypoints, &intervals, best, &|| {
                self.stop.reason()
            });
        }
        best
    }

    /// The initial guesses of a segment, in the order in which they are tried.
    fn initial_guesses(
        &self,
        route: &[Place],
        kind: SegmentKind,
        long_beginning: bool,
    ) -> &'static [InitialGuess] {
        if kind == SegmentKind::Tour {
            return &TOUR_GUESSES;
        }
        match (long_beginning, self.stops_along(route)) {
            (true, true) => &STOPPING_BEGINNING_GUESSES,
            (true, false) => &BEGINNING_GUESSES,
            (false, true) => &STOPPING_PIECE_GUESSES,
            (false, false) => &PIECE_GUESSES,
        }
    }

    /// Whether all places on the way must be passed at rest, with given rolls.
    fn stops_along(&self, route: &[Place]) -> bool {
        let stops = |place: &Place| match place {
            Place::Target(index) => self.places.scenario.targets()[*index].rests(),
            Place::Start | Place::End => true,
        };
        let has_roll = |place: &Place| self.places.waypoint(*place).roll.is_some();
        let on_the_way = route.get(1..route.len() - 1).unwrap_or_default();
        on_the_way.iter().all(stops) && !route.iter().any(has_roll)
    }

    /// The waypoints of a route, described from the rolls of its starts.
    fn starts(&self, route: &[Place], short: bool) -> Vec<Vec<Waypoint>> {
        let [compared, kept] = match (short, self.places.needs_all_legs()) {
            (true, true) => ROLLED_STARTS_OF_SHORT,
            (false, true) => ROLLED_STARTS,
            (_, false) => ROLLED_STARTS_AMONG_MANY,
        };
        let starts = self.places.waypoint_starts(route, compared);
        if starts.len() == 1 {
            return starts;
        }
        let (from, to) = (starts[0][0].clone(), starts[0][1].clone());
        let leg = self.places.slew(&from, &to);
        self.solves
            .fetch_add(starts.len() as u64, Ordering::Relaxed);
        promising(&leg, starts, kept, &|| self.stop.reason())
    }

    fn solve_from(
        &self,
        (route, rolled): (&[Place], &[Waypoint]),
        kind: InitialGuess,
    ) -> LegSolution {
        let Some((guess, intervals)) = self.guess((route, rolled), kind) else {
            return LegSolution::nowhere();
        };
        self.solves.fetch_add(1, Ordering::Relaxed);
        let dynamics = match kind {
            InitialGuess::AroundCones | InitialGuess::AtRest => &self.places.with_cones,
            _ => &self.places.dynamics,
        };
        let waypoints = self.signed_waypoints(route, &guess, &intervals);
        let solve = match kind {
            InitialGuess::Shorter => solve_extended,
            InitialGuess::Eigenaxes => solve_rolling,
            InitialGuess::Extremals | InitialGuess::AroundCones | InitialGuess::AtRest => {
                solve_through
            }
        };
        let solution = solve(dynamics, &waypoints, &intervals, &guess, &|| {
            self.stop.reason()
        });
        let failed = solution.duration().is_none() && !solution.status.is_interrupted();
        if kind == InitialGuess::AtRest
            && failed
            && route.iter().all(|place| self.places.admits_rest(*place))
        {
            return LegSolution {
                status: NlpStatus::Constructed,
                profile: guess,
                intervals,
                costates: Vec::new(),
                ..solution
            };
        }
        solution
    }

    /// The initial guess of a route and the number of intervals of each of its legs; `None` where
    /// there is none.
    fn guess(
        &self,
        (route, rolled): (&[Place], &[Waypoint]),
        kind: InitialGuess,
    ) -> Option<(Profile, Vec<usize>)> {
        match (kind, route) {
            (InitialGuess::Shorter, [before @ .., _]) => {
                let shorter = self.segment(before, SegmentKind::Beginning);
                extended(self.legs, &shorter, &route[before.len() - 1..])
            }
            _ => joined(self.legs, (route, rolled), kind),
        }
    }

    /// The waypoints of a route. Their quaternions have the signs with which a motion, which has
    /// these numbers of intervals on its legs, passes them.
    pub(super) fn signed_waypoints(
        &self,
        route: &[Place],
        motion: &Profile,
        intervals: &[usize],
    ) -> Vec<Waypoint> {
        let signed = |(i, place): (usize, &Place)| {
            let mut waypoint = self.places.waypoint(*place);
            if (i > 0 || waypoint.roll.is_some())
                && let Some(there) = motion.attitudes.get(intervals[..i].iter().sum::<usize>())
            {
                waypoint = waypoint.rolled_towards(there);
                waypoint.attitude = self.places.arrival.signed(&waypoint.attitude, there);
            }
            waypoint
        };
        route.iter().enumerate().map(signed).collect()
    }
}
