//! What the order search asks of the slews: bounds and durations of tours.
//!
//! A waypoint that leaves nothing free separates the slews before and after it, so a tour falls
//! into segments between such waypoints, each a multi-phase problem of its own. SolvedSegments recur in
//! many orders and are remembered. A segment that may go on is flown on from the flight of the same
//! segment without its last place: what it comes to follows from its places alone, whether that
//! flight is still remembered or has to be solved again.

use super::from_store::{segment_from_store, stored_segment};
use super::guesses::{InitialGuess, admits_rest, extended, joined};
use super::interruption;
use super::legs::LegSolver;
use super::places::Places;
use super::segment_key::{MAX_SHORT_LEGS, SegmentKey, SegmentKind};
use super::solved_segments::SolvedSegments;
use super::tables::{CertifiedTable, SolvedTable};
use crate::leg::multiphase::{LegSolution, fly, fly_on, fly_rolling, polish};
use crate::leg::profile::Profile;
use crate::model::order_rules::OrderRules;
use crate::model::waypoint::Waypoint;
use crate::nlp::NlpStatus;
use crate::run::stop::StopSignal;
use crate::tour::legs::LegKind;
use crate::tour::order::{Evaluation, PassageCostate, Place, TourEvaluation, TourModel};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// The starts of a segment, and how many are tried when all goes well: a short segment has local
/// minima that longer ones inherit. A tour is a piece of itself, and is flown from rest to rest where
/// that piece finds no flight.
const STARTS: [InitialGuess; 2] = [InitialGuess::Eigenaxes, InitialGuess::Extremals];
const STARTS_OF_LONGER: [InitialGuess; 3] = [
    InitialGuess::Shorter,
    InitialGuess::Eigenaxes,
    InitialGuess::Extremals,
];
const START_OF_TOURS: [InitialGuess; 1] = [InitialGuess::AtRest];
const DEFAULT_STARTS_OF_SHORT: usize = 2;

/// Tours over legs.
pub(super) struct Tours<'a> {
    pub(super) places: &'a Places<'a>,
    pub(super) legs: &'a LegSolver<'a>,
    /// Certified bounds of legs with free ends, s, once they are known.
    certified: OnceLock<CertifiedTable>,
    /// Legs with free ends, once they are solved: bounds.
    free: OnceLock<SolvedTable>,
    /// Whether orders are as good backwards.
    symmetric: bool,
    pub(super) stop: &'a StopSignal,
    pub(super) solves: AtomicU64,
    segments: SolvedSegments,
}

impl<'a> Tours<'a> {
    pub(super) fn new(
        places: &'a Places<'a>,
        legs: &'a LegSolver<'a>,
        stop: &'a StopSignal,
    ) -> Self {
        Self {
            places,
            legs,
            certified: OnceLock::new(),
            free: OnceLock::new(),
            symmetric: places.are_symmetric(),
            stop,
            solves: AtomicU64::new(0),
            segments: SolvedSegments::default(),
        }
    }

    /// Takes in the certified bounds of the legs; those of the first call count.
    pub(super) fn set_certified_bounds(&self, certified: CertifiedTable) {
        self.certified.get_or_init(|| certified);
    }

    /// No slew between two places takes less, s; `None` where nothing is proved.
    pub(super) fn certified_bound(&self, from: Place, to: Place) -> Option<f64> {
        self.certified.get().and_then(|legs| legs.bound(from, to))
    }

    /// Takes in the legs with free ends, which bound all tours better than the certified bounds;
    /// those of the first call count.
    pub(super) fn set_free_legs(&self, free: SolvedTable) {
        self.free.get_or_init(|| free);
    }

    /// The legs with free ends, when they are known.
    pub(super) fn free_legs(&self) -> Option<&SolvedTable> {
        self.free.get()
    }

    /// Intervals of every leg of a route.
    pub(super) fn intervals(&self, route: &[Place]) -> Vec<usize> {
        let legs = route.windows(2).map(|leg| {
            let ends = [leg[0], leg[1]].map(|place| self.places.waypoint(place));
            self.places.slew(&ends[0], &ends[1]).intervals()
        });
        legs.collect()
    }

    /// The segments of a whole route, each solved; shorter than the route when one did not converge
    /// or the solve was stopped.
    ///
    /// Of an order and its reverse, where they are equally good, one is flown, and the other is that
    /// flight backwards.
    pub(super) fn solve_route(&self, route: &[Place]) -> Vec<Arc<LegSolution>> {
        let Some(reverse) = self.preferred_reverse(route) else {
            return self.solve_segments(route, SegmentKind::Tour);
        };
        let mut flown = self.solve_segments(&reverse, SegmentKind::Tour);
        if flown.iter().all(|segment| segment.duration().is_some()) {
            flown.reverse();
            for segment in &mut flown {
                *segment = Arc::new(segment.reversed());
            }
        }
        flown
    }

    /// The reverse of a route, when that is the one of the two to be flown.
    fn preferred_reverse(&self, route: &[Place]) -> Option<Vec<Place>> {
        if !self.symmetric {
            return None;
        }
        let mut reverse = route.to_vec();
        let last = reverse.len().saturating_sub(1);
        reverse.get_mut(1..last)?.reverse();
        let index = |place: &Place| match place {
            Place::Target(index) => *index,
            Place::Start | Place::End => usize::MAX,
        };
        let smaller = reverse.iter().map(index).lt(route.iter().map(index));
        smaller.then_some(reverse)
    }

    fn solve_segments(&self, route: &[Place], kind: SegmentKind) -> Vec<Arc<LegSolution>> {
        let mut flown = Vec::new();
        let segments = self.places.split(route);
        let last = segments.len().saturating_sub(1);
        for (i, segment) in segments.into_iter().enumerate() {
            let kind = match kind {
                SegmentKind::Beginning if i < last => SegmentKind::Piece,
                _ => kind,
            };
            let solved = self.segment(segment, kind);
            let flies = solved.duration().is_some();
            flown.push(solved);
            if !flies {
                break;
            }
        }
        flown
    }

    /// The flight of a segment: of a whole tour the one that it has as a piece, if there is one.
    pub(super) fn segment(&self, route: &[Place], kind: SegmentKind) -> Arc<LegSolution> {
        if let [from, to] = route {
            return Arc::new(self.free_leg(*from, *to));
        }
        let segment = SegmentKey::new(route, kind);
        if let Some(flown) = self.segments.get(&segment) {
            return flown;
        }
        if kind == SegmentKind::Tour {
            let piece = self.segment(route, SegmentKind::Piece);
            if piece.duration().is_some() || piece.status.is_interrupted() {
                return piece;
            }
        }
        let flown = Arc::new(self.stored_or_solved(&segment));
        if flown.duration().is_some() {
            self.segments.put(segment, &flown);
        }
        flown
    }

    /// A segment that an earlier attempt at the same scenario has solved, or else solved now.
    fn stored_or_solved(&self, segment: &SegmentKey) -> LegSolution {
        let (store, name) = (self.legs.segments(), segment.name());
        let intervals = self.intervals(&segment.route);
        let known = store.get(&name);
        let known = known.and_then(|known| segment_from_store(known, intervals.clone()));
        known.unwrap_or_else(|| {
            let fresh = self.solve_segment(segment);
            // When stopped perhaps not all starts have been tried.
            let usual = fresh.intervals == intervals;
            if fresh.status == NlpStatus::Converged && usual && !self.stop.is_set() {
                store.put(&name, stored_segment(&fresh));
            }
            fresh
        })
    }

    /// The leg with free ends between two places: of the table, where there is one already.
    pub(super) fn free_leg(&self, from: Place, to: Place) -> LegSolution {
        let known = self.free_legs().and_then(|free| free.get(from, to));
        known.map_or_else(
            || self.legs.leg(LegKind::LowerBound, from, to),
            |leg| leg.from_attitude(&self.places.waypoint(from).attitude),
        )
    }

    /// Solves a segment. Of neighbours of which one covers the other only that one is a waypoint of
    /// it: a flight that passes both, one after the other, passes the one already when it passes the
    /// stricter one, and is never shorter than a flight that does so once. A program with both would
    /// have a leg of no length, which no torque can change.
    fn solve_segment(&self, segment: &SegmentKey) -> LegSolution {
        let route = &segment.route;
        let mut distinct: Vec<Place> = Vec::new();
        // The legs that lead to them, and those that lead nowhere.
        let mut legs: Vec<Option<usize>> = Vec::new();
        let mut pauses = Vec::new();
        for (i, &next) in route.iter().enumerate() {
            let mut leg = i.checked_sub(1);
            if let Some(&last) = distinct.last()
                && self.places.covers(last, next)
            {
                pauses.extend(leg);
                continue;
            }
            while let Some(&last) = distinct.last()
                && self.places.covers(next, last)
            {
                pauses.extend(leg);
                distinct.pop();
                leg = legs.pop().flatten();
            }
            distinct.push(next);
            legs.push(leg);
        }
        pauses.sort_unstable();
        let mut flown = match distinct[..] {
            [place] => self.free_leg(place, place),
            [from, to] => self.free_leg(from, to),
            _ => self.solve_distinct(&distinct, segment.kind),
        };
        if flown.duration().is_some() {
            // All of them at one place: the leg itself is the first pause.
            let first = usize::from(distinct.len() == 1);
            for leg in &pauses[first..] {
                let intervals = self.places.resolution.intervals;
                let node = flown.intervals[..*leg].iter().sum();
                flown.profile.pause_at(node, intervals);
                flown.intervals.insert(*leg, intervals);
            }
        }
        flown
    }

    /// The best of several starts: a chain of legs has local minima that none of its legs has.
    fn solve_distinct(&self, route: &[Place], kind: SegmentKind) -> LegSolution {
        let short = route.len() - 1 <= MAX_SHORT_LEGS;
        let usual = if short { DEFAULT_STARTS_OF_SHORT } else { 1 };
        let starts = match kind {
            SegmentKind::Beginning if !short => &STARTS_OF_LONGER[..],
            SegmentKind::Beginning | SegmentKind::Piece => &STARTS,
            SegmentKind::Tour => &START_OF_TOURS,
        };
        let mut best = self.solve_from(route, starts[0]);
        for (tried, &start) in starts.iter().enumerate().skip(1) {
            let settled = best.status == NlpStatus::Converged && tried >= usual;
            if settled || best.status.is_interrupted() {
                break;
            }
            let flown = self.solve_from(route, start);
            if flown.improves(&best) || flown.status.is_interrupted() {
                best = flown;
            }
        }
        if self.places.resolution.polished {
            let dynamics = &self.places.dynamics;
            let intervals = best.intervals.clone();
            let waypoints = self.program(route, &best.profile, &intervals);
            best = polish(dynamics, &waypoints, &intervals, best, &|| {
                interruption(self.stop)
            });
        }
        best
    }

    fn solve_from(&self, route: &[Place], start: InitialGuess) -> LegSolution {
        let Some((guess, intervals)) = self.guess(route, start) else {
            return LegSolution::nowhere();
        };
        self.solves.fetch_add(1, Ordering::Relaxed);
        let dynamics = &self.places.dynamics;
        let waypoints = self.program(route, &guess, &intervals);
        let fly = match start {
            InitialGuess::Shorter => fly_on,
            InitialGuess::Eigenaxes => fly_rolling,
            InitialGuess::Extremals | InitialGuess::AtRest => fly,
        };
        let flown = fly(dynamics, &waypoints, &intervals, &guess, &|| {
            interruption(self.stop)
        });
        let failed = flown.duration().is_none() && !flown.status.is_interrupted();
        if start == InitialGuess::AtRest && failed && admits_rest(self.places, route) {
            return LegSolution {
                status: NlpStatus::Constructed,
                profile: guess,
                intervals,
                costates: Vec::new(),
                ..flown
            };
        }
        flown
    }

    /// The initial guess of a route and the number of intervals of each of its legs; `None` where there
    /// is none.
    fn guess(&self, route: &[Place], kind: InitialGuess) -> Option<(Profile, Vec<usize>)> {
        match (kind, route) {
            (InitialGuess::Shorter, [before @ .., _]) => {
                let shorter = self.segment(before, SegmentKind::Beginning);
                extended(self.legs, &shorter, &route[before.len() - 1..])
            }
            _ => joined(self.legs, route, kind),
        }
    }

    /// The waypoints of a route, with the signs at which a motion of so many intervals between them
    /// passes them.
    pub(super) fn program(
        &self,
        route: &[Place],
        motion: &Profile,
        intervals: &[usize],
    ) -> Vec<Waypoint> {
        let signed = |(i, place): (usize, &Place)| {
            let mut waypoint = self.places.waypoint(*place);
            if i > 0
                && let Some(there) = motion.attitudes.get(intervals[..i].iter().sum::<usize>())
            {
                waypoint.attitude = self.places.arrival.signed(&waypoint.attitude, there);
            }
            waypoint
        };
        route.iter().enumerate().map(signed).collect()
    }

    /// Whether a leg flown backwards is the leg between its ends exchanged.
    fn is_reversible(&self, leg: &[Place]) -> bool {
        let ends = [leg[0], leg[1]].map(|place| self.places.waypoint(place));
        self.places.reversible(ends.each_ref())
    }

    /// Duration of the flown segments of a route with settle and dwell, or how a solve failed.
    fn duration(&self, route: &[Place], segments: &[Arc<LegSolution>]) -> Result<f64, NlpStatus> {
        let mut total: f64 = route
            .iter()
            .map(|place| self.places.service_time(*place))
            .sum();
        for flown in segments {
            total += flown.duration().ok_or(flown.status)?;
        }
        Ok(total)
    }

    /// The duration as a bound, which a flight that is no minimum does not give.
    fn evaluation(&self, route: &[Place], segments: &[Arc<LegSolution>]) -> Evaluation {
        if segments
            .iter()
            .any(|flown| flown.status == NlpStatus::Constructed)
        {
            return Evaluation::Unresolved;
        }
        match self.duration(route, segments) {
            Ok(duration) => Evaluation::Value(duration),
            Err(status) if status.is_interrupted() => Evaluation::Stopped,
            Err(_) => Evaluation::Unresolved,
        }
    }
}

impl TourModel for Tours<'_> {
    fn target_count(&self) -> usize {
        self.places.scenario.targets().len()
    }

    fn has_end(&self) -> bool {
        self.places.scenario.end().is_some()
    }

    fn rules(&self) -> &OrderRules {
        self.places.scenario.order_rules()
    }

    fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        let solved = self.free_legs().and_then(|free| free.duration(from, to));
        let proved = self.certified_bound(from, to);
        let known = solved.into_iter().chain(proved).reduce(f64::max);
        known.map_or(f64::NAN, |duration| duration + self.places.service_time(to))
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        let route = self.places.route(prefix, false);
        self.evaluation(&route, &self.solve_segments(&route, SegmentKind::Beginning))
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        let legs = || path.windows(2);
        // Staying is no slew that another could couple with.
        if legs().any(|leg| self.places.are_one_stop(leg[0], leg[1])) {
            return Evaluation::Value(legs().map(|leg| self.pair_bound(leg[0], leg[1])).sum());
        }
        // Backwards it is the same flight: it is remembered under one route.
        let mut route = path.to_vec();
        if let [Place::Target(first), .., Place::Target(last)] = path
            && last < first
            && legs().all(|leg| self.is_reversible(leg))
        {
            route.reverse();
        }
        match self.evaluation(&route, &self.solve_segments(&route, SegmentKind::Piece)) {
            Evaluation::Value(duration) => {
                Evaluation::Value(duration - self.places.service_time(path[0]))
            }
            unknown => unknown,
        }
    }

    fn couples(&self, via: usize) -> bool {
        let waypoint = self.places.waypoint(Place::Target(via));
        !waypoint.is_fixed(&self.places.dynamics)
    }

    fn costates(&self, order: &[usize]) -> Option<Vec<PassageCostate>> {
        self.flight_costates(order)
    }

    fn lagrangian_leg(&self, leg: [Place; 2], prices: [Option<&[f64]>; 2]) -> Evaluation {
        self.solve_lagrangian_leg(leg, prices)
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        let route = self.places.route(order, true);
        match self.duration(&route, &self.solve_route(&route)) {
            Ok(duration) => TourEvaluation::Solved(duration),
            Err(status) if status.is_interrupted() => TourEvaluation::Stopped,
            Err(_) => TourEvaluation::Unresolved,
        }
    }
}

#[cfg(test)]
mod tests;
