//! Durations of tours and lower bounds on them, for the order search.
//!
//! A waypoint that leaves nothing free separates the legs before and after it. So a tour falls into
//! segments between such waypoints, each a multi-phase problem of its own. Segments recur in many
//! orders and are cached. The initial guess of a beginning is the solution of the same beginning
//! without its last place. The result depends on the places alone: a solution that the cache has
//! dropped is solved again in the same way.

use super::additive_tours::LegTimes;
use super::from_store::{segment_from_store, stored_segment};
use super::legs::LegSolver;
use super::places::Places;
use super::proved_legs::ProvedLegs;
use super::segment_key::{SegmentKey, SegmentKind};
use super::solved_segments::SolvedSegments;
use super::tables::{SolvedTable, Table, TabulatedLeg};
use super::turn_estimates::TurnEstimates;
use crate::leg::multiphase::LegSolution;
use crate::model::order_rules::OrderRules;
use crate::nlp::NlpStatus;
use crate::run::stop::StopSignal;
use crate::tour::legs::LegKind;
use crate::tour::order::{Evaluation, PassageCostate, Place, TourEvaluation, TourModel};
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, PoisonError, RwLock};

/// The tours of a scenario, evaluated by solving their segments.
pub(super) struct Tours<'a> {
    pub(super) places: &'a Places<'a>,
    pub(super) legs: &'a LegSolver<'a>,
    /// Certified bounds of the legs, each end with its own conditions only.
    pub(super) certified: ProvedLegs<'a>,
    /// Legs solved with only the conditions of their own ends: their durations are lower bounds.
    free: RwLock<SolvedTable>,
    /// Estimates of the legs that are not solved.
    estimates: TurnEstimates<'a>,
    /// Whether every order takes as long as its reverse.
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
            certified: ProvedLegs::new(
                places,
                Box::new(|pairs| legs.certified_legs(LegKind::LowerBound, pairs)),
            ),
            free: RwLock::new(Table::new(places, std::iter::empty())),
            estimates: TurnEstimates::of(places),
            symmetric: places.are_symmetric(),
            stop,
            solves: AtomicU64::new(0),
            segments: SolvedSegments::default(),
        }
    }

    /// Solves legs with only the conditions of their own ends.
    pub(super) fn solve_free_legs(&self, pairs: &[(Place, Place)]) {
        self.legs.offer(LegKind::LowerBound, pairs);
        let solved = self.legs.solved_legs(LegKind::LowerBound, pairs);
        let mut free = self.free.write().unwrap_or_else(PoisonError::into_inner);
        for (leg, entry) in pairs.iter().zip(solved) {
            free.set(*leg, entry);
        }
    }

    /// Takes from the store what it has of the legs of an order that are segments of their own.
    pub(super) fn load_legs(&self, order: &[usize]) {
        let route = self.places.route(order, true);
        let segments = self.places.split(&route);
        let legs = segments.iter().filter_map(|segment| match segment {
            [from, to] => Some((*from, *to)),
            _ => None,
        });
        let legs: Vec<_> = legs.collect();
        self.legs.load_all(LegKind::LowerBound, &legs);
    }

    /// A leg that was solved with only the conditions of its own ends.
    pub(super) fn known_free_leg(&self, from: Place, to: Place) -> Option<TabulatedLeg> {
        // A panic under the lock leaves the table consistent.
        let free = self.free.read().unwrap_or_else(PoisonError::into_inner);
        free.get(from, to).cloned()
    }

    /// Lower bound on the time of a leg, s, in any tour.
    pub(super) fn leg_bound(&self, from: Place, to: Place) -> f64 {
        let solved = self.known_free_leg(from, to);
        let solved = solved.and_then(|leg| leg.leg.solution.least_duration());
        let proved = self.certified.leg_s(from, to);
        solved.map_or(proved, |solved| solved.max(proved))
    }

    /// Number of intervals of every leg of a route.
    pub(super) fn intervals(&self, route: &[Place]) -> Vec<usize> {
        let waypoints = self.places.waypoints(route);
        let legs = waypoints
            .windows(2)
            .map(|ends| self.places.slew(&ends[0], &ends[1]).intervals());
        legs.collect()
    }

    /// The solutions of a whole route's segments. The list ends early, with the failed solution,
    /// when a segment did not converge or the solve was stopped.
    ///
    /// In a symmetric scenario only one of an order and its reverse is solved; the other is that
    /// solution reversed in time.
    pub(super) fn solve_route(&self, route: &[Place]) -> Vec<Arc<LegSolution>> {
        let Some(reverse) = self.preferred_reverse(route) else {
            return self.solve_segments(route, SegmentKind::Tour);
        };
        let mut solutions = self.solve_segments(&reverse, SegmentKind::Tour);
        if solutions.iter().all(|segment| segment.duration().is_some()) {
            solutions.reverse();
            for segment in &mut solutions {
                *segment = Arc::new(segment.reversed());
            }
        }
        solutions
    }

    /// The reverse of a route in a symmetric scenario, when it comes first lexicographically: then
    /// it is the one of the two that is solved.
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

    /// Solves the segments of a tour again that take needless time, now that their legs are known: it was
    /// solved before them. Whether there was one.
    pub(super) fn reconsider(&self, order: &[usize]) -> bool {
        let route = self.places.route(order, true);
        let route = self.preferred_reverse(&route).unwrap_or(route);
        let mut faster = false;
        for places in self.places.split(&route) {
            let segment = SegmentKey::new(places, SegmentKind::Piece);
            let known = self.segments.get(&segment);
            if let Some(better) = known.and_then(|known| self.faster(&segment, &known)) {
                faster = true;
                self.segments.put(segment, &Arc::new(better));
            }
        }
        faster
    }

    /// A faster solution of a segment that was solved before its legs were known; `None` where there is
    /// none.
    fn faster(&self, segment: &SegmentKey, known: &LegSolution) -> Option<LegSolution> {
        let one_stop = |leg: &[Place]| self.places.are_one_stop(leg[0], leg[1]);
        let route = &segment.route;
        let has_pauses = route.windows(2).any(one_stop);
        (segment.kind == SegmentKind::Piece && route.len() > 2 && !has_pauses)
            .then(|| self.without_needless_time(route, known))?
    }

    fn solve_segments(&self, route: &[Place], kind: SegmentKind) -> Vec<Arc<LegSolution>> {
        let mut solutions = Vec::new();
        let segments = self.places.split(route);
        let last = segments.len().saturating_sub(1);
        for (i, segment) in segments.into_iter().enumerate() {
            let kind = match kind {
                SegmentKind::Beginning if i < last => SegmentKind::Piece,
                _ => kind,
            };
            let solution = self.segment(segment, kind);
            let converged = solution.duration().is_some();
            solutions.push(solution);
            if !converged {
                break;
            }
        }
        solutions
    }

    /// The solution of a segment. A segment of a whole tour has the solution of the piece with the
    /// same route, if that converges.
    pub(super) fn segment(&self, route: &[Place], kind: SegmentKind) -> Arc<LegSolution> {
        if let [from, to] = route {
            return Arc::new(self.free_leg(*from, *to));
        }
        let segment = SegmentKey::new(route, kind);
        if let Some(solution) = self.segments.get(&segment) {
            return solution;
        }
        if kind == SegmentKind::Tour {
            let piece = self.segment(route, SegmentKind::Piece);
            if piece.duration().is_some() || piece.status.is_interrupted() {
                return piece;
            }
        }
        let solution = Arc::new(self.stored_or_solved(&segment));
        if solution.duration().is_some() {
            self.segments.put(segment, &solution);
        }
        solution
    }

    /// The solution that the store holds from an earlier solve of the scenario, or else a new one.
    fn stored_or_solved(&self, segment: &SegmentKey) -> LegSolution {
        let (store, name) = (self.legs.segments(), segment.name());
        let intervals = self.intervals(&segment.route);
        let known = store.get(&name);
        let known = known.and_then(|known| segment_from_store(known, intervals.clone()));
        let known = known.map(|known| self.faster(segment, &known).unwrap_or(known));
        known.unwrap_or_else(|| {
            let fresh = self.solve_segment(segment);
            // A store entry has no numbers of intervals. A stopped solve may have skipped guesses.
            let has_default_intervals = fresh.intervals == intervals;
            let converged = fresh.status == NlpStatus::Converged;
            if converged && has_default_intervals && !self.stop.is_set() {
                store.put(&name, stored_segment(&fresh));
            }
            fresh
        })
    }

    /// The leg with free ends between two places: from the table, if it is known, or solved now.
    pub(super) fn free_leg(&self, from: Place, to: Place) -> LegSolution {
        let known = self.known_free_leg(from, to);
        let whole = known.and_then(|leg| leg.whole_beginning_at(&self.places.attitude(from)));
        whole.unwrap_or_else(|| self.legs.leg(LegKind::LowerBound, from, to))
    }

    /// Solves a segment.
    ///
    /// Where one of two neighbours covers the other, only the covering one is a waypoint of the
    /// program: a motion that passes it satisfies both. A program with both would have a leg of
    /// zero length, whose constraints are degenerate. The covered places are inserted into the
    /// solution as pauses of zero duration.
    fn solve_segment(&self, segment: &SegmentKey) -> LegSolution {
        let route = &segment.route;
        let mut distinct: Vec<Place> = Vec::new();
        // The legs of the route that lead to the distinct places, and those between covered places.
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
        let mut solution = match distinct[..] {
            [place] => self.free_leg(place, place),
            [from, to] => self.free_leg(from, to),
            _ => self.solve_distinct(&distinct, segment.kind),
        };
        if solution.duration().is_some() {
            // If all places are one, the solved leg itself is the first pause.
            let first = usize::from(distinct.len() == 1);
            for leg in &pauses[first..] {
                let intervals = self.places.resolution.intervals;
                let node = solution.intervals[..*leg].iter().sum();
                solution.profile.pause_at(node, intervals);
                solution.intervals.insert(*leg, intervals);
            }
        }
        solution
    }

    /// Whether the time-reversed solution of a leg solves the leg between its ends exchanged.
    fn is_reversible(&self, leg: &[Place]) -> bool {
        let ends = [leg[0], leg[1]].map(|place| self.places.waypoint(place));
        self.places.reversible(ends.each_ref())
    }

    /// Duration of a route's solved segments with settle and dwell times, s, or how a solve failed.
    fn duration(&self, route: &[Place], segments: &[Arc<LegSolution>]) -> Result<f64, NlpStatus> {
        let mut total: f64 = route
            .iter()
            .map(|place| self.places.service_time(*place))
            .sum();
        for solution in segments {
            total += solution.duration().ok_or(solution.status)?;
        }
        Ok(total)
    }

    /// The duration as a lower bound; a constructed flight is no minimum and gives none.
    fn evaluation(&self, route: &[Place], segments: &[Arc<LegSolution>]) -> Evaluation {
        if are_constructed(segments) {
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
        self.leg_bound(from, to) + self.places.service_time(to)
    }

    fn is_open(&self, from: Place, to: Place) -> bool {
        self.known_free_leg(from, to).is_none()
    }

    /// Proves the bounds of legs that have none, and solves the others.
    fn raise_pair_bounds(&self, pairs: &[(Place, Place)]) {
        let unproved = |pair: &&(Place, Place)| self.certified.is_open(pair.0, pair.1);
        let (unproved, proved): (Vec<_>, Vec<_>) = pairs.iter().partition(unproved);
        self.certified.raise(&unproved);
        self.solve_free_legs(&proved);
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        let route = self.places.route(prefix, false);
        self.evaluation(&route, &self.solve_segments(&route, SegmentKind::Beginning))
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        let legs = || path.windows(2);
        // A leg between places that cover each other takes no time and couples with no other.
        if legs().any(|leg| self.places.are_one_stop(leg[0], leg[1])) {
            return Evaluation::Value(legs().map(|leg| self.pair_bound(leg[0], leg[1])).sum());
        }
        // A reversible path and its reverse share one entry of the cache.
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

    /// The rates at the ends of the leg on its own, relative to the reachable accelerations.
    fn free_ends(&self, from: Place, to: Place) -> [[f64; 3]; 2] {
        let (dynamics, begin) = (&self.places.dynamics, self.places.attitude(from));
        let solved = self.known_free_leg(from, to);
        let rates = solved.and_then(|leg| leg.rates_at_ends(dynamics, &begin));
        rates.map_or_else(
            || self.estimates.free_ends(from, to),
            |rates| rates.map(|rate| self.estimates.time_to_reach(&rate).into()),
        )
    }

    fn couples(&self, via: usize) -> bool {
        let waypoint = self.places.waypoint(Place::Target(via));
        !waypoint.is_fixed(&self.places.dynamics)
    }

    fn leg_times(&self, order: &[usize]) -> Option<Vec<f64>> {
        self.flight_leg_times(order)
    }

    fn costates(&self, order: &[usize]) -> Option<Vec<PassageCostate>> {
        self.flight_costates(order)
    }

    fn lagrangian_leg(&self, leg: [Place; 2], costates: [Option<&[f64]>; 2]) -> Evaluation {
        self.solve_lagrangian_leg(leg, costates)
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        let route = self.places.route(order, true);
        let segments = self.solve_route(&route);
        match self.duration(&route, &segments) {
            Ok(duration) if are_constructed(&segments) => TourEvaluation::Flyable(duration),
            Ok(duration) => TourEvaluation::Solved(duration),
            Err(status) if status.is_interrupted() => TourEvaluation::Stopped,
            Err(_) => TourEvaluation::Unresolved,
        }
    }
}

/// Whether a part of a flight was constructed, not solved for the least duration.
fn are_constructed(segments: &[Arc<LegSolution>]) -> bool {
    let mut segments = segments.iter();
    segments.any(|solution| solution.status == NlpStatus::Constructed)
}

#[cfg(test)]
mod tests;
