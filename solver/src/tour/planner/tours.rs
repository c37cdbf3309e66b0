//! What the order search asks of the slews: bounds and durations of tours.
//!
//! A waypoint that leaves nothing free separates the slews before and after it, so a tour falls
//! into segments between such waypoints, each a multi-phase problem of its own. Segments recur in
//! many orders and are remembered. A segment that may go on is flown on from the flight of the same
//! segment without its last place: what it comes to follows from its places alone, whether that
//! flight is still remembered or has to be solved again.

use super::extent::{Extent, SHORT, Segment};
use super::from_store::{segment_from_store, stored_segment};
use super::interruption;
use super::legs::LegSolver;
use super::places::Places;
use super::segments::Segments;
use super::starts::Start;
use super::tables::{CertifiedTable, LegTable};
use crate::leg::multiphase::{LegSolution, polish, solve_extended, solve_rolling, solve_through};
use crate::leg::profile::Profile;
use crate::model::order_rules::OrderRules;
use crate::model::waypoint::Waypoint;
use crate::nlp::NlpStatus;
use crate::run::stop::StopSignal;
use crate::tour::legs::LegKind;
use crate::tour::order::{Evaluation, Place, Price, TourEvaluation, TourModel};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// The starts of a segment, and how many are tried when all goes well: a short segment has local
/// minima that longer ones inherit. A tour is a piece of itself, and is flown from rest to rest where
/// that piece finds no flight.
const STARTS: [Start; 2] = [Start::Eigenaxes, Start::Extremals];
const STARTS_OF_LONGER: [Start; 3] = [Start::Shorter, Start::Eigenaxes, Start::Extremals];
const START_OF_TOURS: [Start; 1] = [Start::AtRest];
const DEFAULT_STARTS_OF_SHORT: usize = 2;

/// Tours over legs.
pub(super) struct Tours<'a> {
    pub(super) places: &'a Places<'a>,
    pub(super) legs: &'a LegSolver<'a>,
    /// Certified bounds of legs with free ends, s, once they are known.
    certified: OnceLock<CertifiedTable>,
    /// Legs with free ends, once they are solved: bounds.
    free: OnceLock<LegTable>,
    /// Whether orders are as good backwards.
    symmetric: bool,
    pub(super) stop: &'a StopSignal,
    pub(super) solves: AtomicU64,
    segments: Segments,
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
            segments: Segments::default(),
        }
    }

    /// Takes in the certified bounds of the legs; those of the first call count.
    pub(super) fn prove(&self, certified: CertifiedTable) {
        self.certified.get_or_init(|| certified);
    }

    /// No slew between two places takes less, s; `None` where nothing is proved.
    pub(super) fn proved(&self, from: Place, to: Place) -> Option<f64> {
        self.certified.get().and_then(|legs| legs.bound(from, to))
    }

    /// Takes in the legs with free ends, which bound all tours better than the certified bounds;
    /// those of the first call count.
    pub(super) fn know(&self, free: LegTable) {
        self.free.get_or_init(|| free);
    }

    /// The legs with free ends, when they are known.
    pub(super) fn free(&self) -> Option<&LegTable> {
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
    pub(super) fn fly_route(&self, route: &[Place]) -> Vec<Arc<LegSolution>> {
        let Some(reverse) = self.better_backwards(route) else {
            return self.fly_segments(route, Extent::Tour);
        };
        let mut flown = self.fly_segments(&reverse, Extent::Tour);
        if flown.iter().all(|segment| segment.duration().is_some()) {
            flown.reverse();
            for segment in &mut flown {
                *segment = Arc::new(segment.reversed());
            }
        }
        flown
    }

    /// The reverse of a route, when that is the one of the two to be flown.
    fn better_backwards(&self, route: &[Place]) -> Option<Vec<Place>> {
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

    fn fly_segments(&self, route: &[Place], extent: Extent) -> Vec<Arc<LegSolution>> {
        let mut flown = Vec::new();
        let segments = self.split(route);
        let last = segments.len().saturating_sub(1);
        for (i, segment) in segments.into_iter().enumerate() {
            let extent = match extent {
                Extent::Beginning if i < last => Extent::Piece,
                _ => extent,
            };
            let solved = self.segment(segment, extent);
            let flies = solved.duration().is_some();
            flown.push(solved);
            if !flies {
                break;
            }
        }
        flown
    }

    /// Cuts a route at every waypoint that leaves nothing free.
    pub(super) fn split<'r>(&self, route: &'r [Place]) -> Vec<&'r [Place]> {
        let mut segments = Vec::new();
        let mut begin = 0;
        for (i, place) in route.iter().enumerate().skip(1) {
            let last = i + 1 == route.len();
            if last || self.places.waypoint(*place).is_fixed(&self.places.dynamics) {
                segments.push(&route[begin..=i]);
                begin = i;
            }
        }
        segments
    }

    /// The flight of a segment: of a whole tour the one that it has as a piece, if there is one.
    pub(super) fn segment(&self, route: &[Place], extent: Extent) -> Arc<LegSolution> {
        if let [from, to] = route {
            return Arc::new(self.free_leg(*from, *to));
        }
        let segment = Segment::new(route, extent);
        if let Some(flown) = self.segments.get(&segment) {
            return flown;
        }
        if extent == Extent::Tour {
            let piece = self.segment(route, Extent::Piece);
            if piece.duration().is_some() || piece.status.is_interrupted() {
                return piece;
            }
        }
        let flown = Arc::new(self.recall_or_solve(&segment));
        if flown.duration().is_some() {
            self.segments.put(segment, &flown);
        }
        flown
    }

    /// A segment that an earlier attempt at the same scenario has solved, or else solved now.
    fn recall_or_solve(&self, segment: &Segment) -> LegSolution {
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
        let known = self.free().and_then(|free| free.get(from, to));
        known.map_or_else(
            || self.legs.lone(LegKind::LowerBound, from, to),
            |leg| leg.from(&self.places.waypoint(from).attitude),
        )
    }

    /// Solves a segment. Of neighbours of which one covers the other only that one is a waypoint of
    /// it: a flight that passes both, one after the other, passes the one already when it passes the
    /// stricter one, and is never shorter than a flight that does so once. A program with both would
    /// have a leg of no length, which no torque can change.
    fn solve_segment(&self, segment: &Segment) -> LegSolution {
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
            _ => self.solve_distinct(&distinct, segment.extent),
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
    fn solve_distinct(&self, route: &[Place], extent: Extent) -> LegSolution {
        let short = route.len() - 1 <= SHORT;
        let usual = if short { DEFAULT_STARTS_OF_SHORT } else { 1 };
        let starts = match extent {
            Extent::Beginning if !short => &STARTS_OF_LONGER[..],
            Extent::Beginning | Extent::Piece => &STARTS,
            Extent::Tour => &START_OF_TOURS,
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

    fn solve_from(&self, route: &[Place], start: Start) -> LegSolution {
        let Some((guess, intervals)) = self.guess(route, start) else {
            return LegSolution::nowhere();
        };
        self.solves.fetch_add(1, Ordering::Relaxed);
        let dynamics = &self.places.dynamics;
        let waypoints = self.program(route, &guess, &intervals);
        let solve = match start {
            Start::Shorter => solve_extended,
            Start::Eigenaxes => solve_rolling,
            Start::Extremals | Start::AtRest => solve_through,
        };
        let flown = solve(dynamics, &waypoints, &intervals, &guess, &|| {
            interruption(self.stop)
        });
        let failed = flown.duration().is_none() && !flown.status.is_interrupted();
        if start == Start::AtRest && failed && self.admits_rest(route) {
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
        let solved = self.free().and_then(|free| free.duration(from, to));
        let proved = self.proved(from, to);
        let known = solved.into_iter().chain(proved).reduce(f64::max);
        known.map_or(f64::NAN, |duration| duration + self.places.service_time(to))
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        let route = self.places.route(prefix, false);
        self.evaluation(&route, &self.fly_segments(&route, Extent::Beginning))
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
        match self.evaluation(&route, &self.fly_segments(&route, Extent::Piece)) {
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

    fn costates(&self, order: &[usize]) -> Option<Vec<Price>> {
        self.prices_of(order)
    }

    fn lagrangian_leg(&self, leg: [Place; 2], prices: [Option<&[f64]>; 2]) -> Evaluation {
        self.price_leg(leg, prices)
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        let route = self.places.route(order, true);
        match self.duration(&route, &self.fly_route(&route)) {
            Ok(duration) => TourEvaluation::LegSolution(duration),
            Err(status) if status.is_interrupted() => TourEvaluation::Stopped,
            Err(_) => TourEvaluation::Unresolved,
        }
    }
}

#[cfg(test)]
mod tests;
