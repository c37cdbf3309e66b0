//! What the order search asks of the slews: bounds and durations of tours.
//!
//! A waypoint that leaves nothing free separates the slews before and after it, so a tour falls
//! into segments between such waypoints, each a multi-phase problem of its own. Segments recur in
//! many orders and are remembered.

use super::interruption;
use super::places::Places;
use super::tables::{CertifiedTable, LegTable};
use crate::multiphase::{Flown, fly, fly_rolling, polish};
use crate::nlp::NlpStatus;
use crate::profile::Profile;
use crate::sequence::{Evaluation, Place, TourEvaluation, TourModel};
use crate::slew::eigenaxis::Side;
use crate::stop::StopSignal;
use crate::transcription::Waypoint;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What a segment starts from.
#[derive(Debug, Clone, Copy)]
enum Start {
    /// Legs from rest to rest.
    AtRest,
    /// Legs with free ends.
    FreeEnds,
    /// Slews about the eigenaxis.
    Eigenaxis,
}

/// The starts of a segment whose legs are known, and how many are tried when all goes well.
const STARTS: [Start; 3] = [Start::AtRest, Start::FreeEnds, Start::Eigenaxis];
const USUAL_STARTS: usize = 2;

/// Tours over solved tables of legs.
pub(super) struct Tours<'a> {
    pub(super) places: &'a Places<'a>,
    /// Rest-to-rest legs: starting guesses.
    pub(super) rest: &'a LegTable,
    /// Legs with free ends: bounds.
    pub(super) free: &'a LegTable,
    /// Certified bounds of legs with free ends, s.
    pub(super) certified: &'a CertifiedTable,
    pub(super) stop: &'a StopSignal,
    pub(super) solves: AtomicU64,
    segments: Mutex<HashMap<Vec<Place>, Arc<Flown>>>,
}

impl<'a> Tours<'a> {
    pub(super) fn new(
        places: &'a Places<'a>,
        rest: &'a LegTable,
        free: &'a LegTable,
        certified: &'a CertifiedTable,
        stop: &'a StopSignal,
    ) -> Self {
        Self {
            places,
            rest,
            free,
            certified,
            stop,
            solves: AtomicU64::new(0),
            segments: Mutex::default(),
        }
    }

    /// Intervals of every leg.
    pub(super) fn intervals(&self) -> usize {
        self.places.resolution.intervals
    }

    /// The segments of a route, each solved; shorter than the route when one did not converge or
    /// the solve was stopped.
    pub(super) fn fly_route(&self, route: &[Place]) -> Vec<Arc<Flown>> {
        let mut flown = Vec::new();
        for segment in self.split(route) {
            let solved = self.segment(segment);
            let status = solved.status;
            flown.push(solved);
            if status != NlpStatus::Converged {
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

    fn segment(&self, route: &[Place]) -> Arc<Flown> {
        if let [from, to] = route
            && let Some(leg) = self.free.get(*from, *to)
        {
            return Arc::new(leg.flown.clone());
        }
        let known = self
            .segments
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get(route)
            .cloned();
        known.unwrap_or_else(|| {
            let flown = Arc::new(self.solve_segment(route));
            if !flown.status.is_interrupted() {
                let mut segments = self.segments.lock().unwrap_or_else(PoisonError::into_inner);
                segments.insert(route.to_vec(), Arc::clone(&flown));
            }
            flown
        })
    }

    /// Solves a segment; places that coincide are one waypoint of it, since a flight that meets the
    /// same conditions twice is never shorter than one that meets them once.
    fn solve_segment(&self, route: &[Place]) -> Flown {
        let intervals = self.intervals();
        let repeats = |pair: &[Place]| self.places.coincide(pair[0], pair[1]);
        let fresh = route
            .windows(2)
            .filter(|pair| !repeats(pair))
            .map(|pair| pair[1]);
        let distinct: Vec<Place> = std::iter::once(route[0]).chain(fresh).collect();
        let mut flown = self.solve_distinct(&distinct);
        for (leg, pair) in route.windows(2).enumerate() {
            if repeats(pair) {
                flown.profile.pause_at(leg * intervals, intervals);
            }
        }
        flown
    }

    /// The best of several starts: a chain of legs has local minima that none of its legs has.
    fn solve_distinct(&self, route: &[Place]) -> Flown {
        let knows_legs = self.free.get(route[0], route[1]).is_some();
        let starts = if knows_legs {
            &STARTS[..]
        } else {
            &[Start::Eigenaxis]
        };
        let mut best = self.solve_from(route, starts[0]);
        for (tried, &start) in starts.iter().enumerate().skip(1) {
            let settled = best.status == NlpStatus::Converged && tried >= USUAL_STARTS;
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
            let (waypoints, intervals) = self.program(route, &best.profile);
            best = polish(dynamics, &waypoints, &intervals, best, &|| {
                interruption(self.stop)
            });
        }
        best
    }

    /// Solves a segment from legs joined end to end; legs that are not there are guessed by
    /// eigenaxis slews.
    fn solve_from(&self, route: &[Place], start: Start) -> Flown {
        let mut guess = Profile::empty();
        for pair in route.windows(2) {
            let next = self.solved(pair, start).unwrap_or_else(|| {
                let (from, to) = (self.places.waypoint(pair[0]), self.places.waypoint(pair[1]));
                let slew = self.places.slew(&from, &to);
                let intervals = self.intervals();
                slew.eigenaxis().guess(slew.dynamics, intervals, Side::Near)
            });
            guess.append(&next);
        }
        self.solves.fetch_add(1, Ordering::Relaxed);
        let dynamics = &self.places.dynamics;
        let (waypoints, intervals) = self.program(route, &guess);
        let fly = match start {
            Start::AtRest | Start::FreeEnds => fly,
            Start::Eigenaxis => fly_rolling,
        };
        fly(dynamics, &waypoints, &intervals, &guess, &|| {
            interruption(self.stop)
        })
    }

    /// A leg to start from, when it has been solved.
    fn solved(&self, leg: &[Place], start: Start) -> Option<Profile> {
        let table = match start {
            Start::AtRest => self.rest,
            Start::FreeEnds => self.free,
            Start::Eigenaxis => return None,
        };
        let flown = &table.get(leg[0], leg[1])?.flown;
        (flown.status == NlpStatus::Converged).then(|| flown.profile.clone())
    }

    /// The waypoints of a route, with the signs at which a motion passes them, and the intervals
    /// between them.
    fn program(&self, route: &[Place], motion: &Profile) -> (Vec<Waypoint>, Vec<usize>) {
        let signed = |(i, place): (usize, &Place)| {
            let mut waypoint = self.places.waypoint(*place);
            if i > 0
                && let Some(there) = motion.attitudes.get(i * self.intervals())
            {
                waypoint.attitude = self.places.arrival.signed(&waypoint.attitude, there);
            }
            waypoint
        };
        let waypoints = route.iter().enumerate().map(signed).collect();
        (waypoints, vec![self.intervals(); route.len() - 1])
    }

    /// Duration of a route with settle and dwell, or how its solve failed.
    fn duration(&self, route: &[Place]) -> Result<f64, NlpStatus> {
        let mut total: f64 = route
            .iter()
            .map(|place| self.places.service_time(*place))
            .sum();
        for flown in self.fly_route(route) {
            total += flown.duration().ok_or(flown.status)?;
        }
        Ok(total)
    }
}

impl TourModel for Tours<'_> {
    fn target_count(&self) -> usize {
        self.places.scenario.targets().len()
    }

    fn has_end(&self) -> bool {
        self.places.scenario.end().is_some()
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        let solved = self.free.get(from, to).and_then(|leg| leg.flown.duration());
        let certified = self.certified.bound(from, to);
        let known = solved.into_iter().chain(certified).reduce(f64::max);
        known.map_or(f64::NAN, |duration| duration + self.places.service_time(to))
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        match self.duration(&self.places.route(prefix, false)) {
            Ok(duration) => Evaluation::Value(duration),
            Err(status) if status.is_interrupted() => Evaluation::Stopped,
            Err(_) => Evaluation::Unresolved,
        }
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        match self.duration(&self.places.route(order, true)) {
            Ok(duration) => TourEvaluation::Flown(duration),
            Err(status) if status.is_interrupted() => TourEvaluation::Stopped,
            Err(_) => TourEvaluation::Unresolved,
        }
    }
}
