//! Chains: motions through places between two at which the body may wait, with times of passages.

use crate::leg::multiphase::{LegSolution, solve_clocked};
use crate::leg::profile::Profile;
use crate::leg::solve::around_cones::is_clear;
use crate::leg::transcription::PassageTimes;
use crate::model::scenario::Window;
use crate::nlp::NlpStatus;
use crate::tour::order::Place;
use crate::tour::planner::assemble::Piece;
use crate::tour::planner::places::Places;
use crate::tour::planner::segment_key::SegmentKind;
use crate::tour::planner::tours::Tours;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Share of a time by which passages may miss a window, for rounding; below the checker's tolerance.
const SLACK: f64 = 1e-10;
/// Angle at which a bound of time is kept by the program, as a share of the time: passages at a bound
/// lie inside it by what the program is accurate to.
const INSIDE: f64 = 2e-8;

/// A visit that a chain has to make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Visit {
    pub(super) place: Place,
    /// The window in which it lies; `None` at any time.
    pub(super) window: Option<Window>,
}

/// A chain that has been solved.
#[derive(Debug, Clone)]
pub(in crate::tour::planner) struct SolvedChain {
    /// The places from the one that is left to the last one reached.
    pub(super) route: Vec<Place>,
    /// Wait in the first place, s.
    pub(super) delay: f64,
    /// The motion.
    pub(super) motion: Arc<LegSolution>,
    /// When the visit of every place but the first begins, s.
    pub(super) begins: Vec<f64>,
    /// Whether no motion reaches the last place earlier.
    pub(super) is_least: bool,
}

impl SolvedChain {
    /// The chain as a part of a flight.
    pub(in crate::tour::planner) fn piece(&self) -> Piece<'_> {
        Piece {
            places: &self.route,
            delay: self.delay,
            motion: &self.motion,
        }
    }
}

/// Why there is no motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoChain {
    /// None is in time, which is proved as far as solutions of programs are global.
    TooLate,
    /// None was found.
    Unresolved,
    /// The solve was interrupted.
    Stopped,
}

/// Whether the body may wait in a place: its visit is at rest and leaves nothing free.
pub(super) fn may_wait(places: &Places<'_>, place: Place) -> bool {
    let rests = match place {
        Place::Start => places.scenario.start().rate.amax() == 0.0,
        Place::Target(index) => places.scenario.targets()[index].rests(),
        Place::End => false,
    };
    rests && places.waypoint(place).is_fixed(&places.dynamics)
}

/// Solves the chain from a place that is left at a time through visits, the last of which is passed with
/// its own conditions only. It reaches the last one as early as the windows admit.
pub(super) fn solve_chain(
    tours: &Tours<'_>,
    (from, departure): (Place, f64),
    visits: &[Visit],
) -> Result<SolvedChain, NoChain> {
    let mut route = vec![from];
    route.extend(visits.iter().map(|visit| visit.place));
    let free = tours.segment(&route, SegmentKind::Piece);
    if free.status.is_interrupted() {
        return Err(NoChain::Stopped);
    }
    free.duration().ok_or(NoChain::Unresolved)?;
    let chain = Chain {
        tours,
        departure,
        visits,
        waits: may_wait(tours.places, from),
        route,
    };
    chain.solve(&free)
}

struct Chain<'a> {
    tours: &'a Tours<'a>,
    departure: f64,
    visits: &'a [Visit],
    waits: bool,
    route: Vec<Place>,
}

impl Chain<'_> {
    fn solve(self, free: &Arc<LegSolution>) -> Result<SolvedChain, NoChain> {
        let earliest = self.begins(free, self.departure);
        let is_least = free.status == NlpStatus::Converged;
        let last = earliest.len() - 1;
        if is_least && self.lateness(last, earliest[last]) > 0.0 {
            return Err(NoChain::TooLate);
        }
        if self.keeps_windows(&earliest) {
            return Ok(self.solved((0.0, Arc::clone(free)), earliest, is_least));
        }
        self.clocked(free).or_else(|reason| match reason {
            NoChain::Stopped => Err(reason),
            _ => self.delayed(free, &earliest).ok_or(reason),
        })
    }

    fn solved(
        &self,
        (delay, motion): (f64, Arc<LegSolution>),
        begins: Vec<f64>,
        is_least: bool,
    ) -> SolvedChain {
        SolvedChain {
            route: self.route.clone(),
            delay,
            motion,
            begins,
            is_least,
        }
    }

    /// When the visits of a motion that begins at a time begin, s. At the last place, if the body may
    /// wait there, it waits for the window.
    fn begins(&self, motion: &LegSolution, begin: f64) -> Vec<f64> {
        let mut clock = begin;
        let mut node = 0;
        let mut begins: Vec<f64> = Vec::with_capacity(self.visits.len());
        for (visit, count) in self.visits.iter().zip(&motion.intervals) {
            clock += motion.profile.lengths[node..node + count]
                .iter()
                .sum::<f64>();
            node += count;
            begins.push(clock);
            clock += self.tours.places.service_time(visit.place);
        }
        if let (Some(last), Some(begin)) = (self.visits.last(), begins.last_mut())
            && may_wait(self.tours.places, last.place)
        {
            *begin = begin.max(last.window.map_or(0.0, |window| window.from));
        }
        begins
    }

    /// By how much a visit that begins at a time is too late for its window, s.
    fn lateness(&self, visit: usize, begin: f64) -> f64 {
        let Visit { place, window } = self.visits[visit];
        let service = self.tours.places.service_time(place);
        let to = window.map_or(f64::INFINITY, |window| window.to);
        begin * (1.0 - SLACK) + service - to
    }

    fn earliness(&self, visit: usize, begin: f64) -> f64 {
        let from = self.visits[visit].window.map_or(0.0, |window| window.from);
        from - begin * (1.0 + SLACK)
    }

    fn keeps_windows(&self, begins: &[f64]) -> bool {
        let mut all = begins.iter().enumerate();
        all.all(|(i, begin)| self.lateness(i, *begin) <= 0.0 && self.earliness(i, *begin) <= 0.0)
    }

    /// The same motion after a wait, if that keeps the windows.
    fn delayed(&self, free: &Arc<LegSolution>, earliest: &[f64]) -> Option<SolvedChain> {
        let early = earliest.iter().enumerate();
        let delay = early
            .map(|(i, begin)| self.earliness(i, *begin))
            .fold(0.0, f64::max);
        let delay = delay * (1.0 + SLACK);
        let begins = self.begins(free, self.departure + delay);
        (self.waits && self.keeps_windows(&begins))
            .then(|| self.solved((delay, Arc::clone(free)), begins, false))
    }

    /// The motion of the program that keeps bounds of time, from the free motion or, where that does not
    /// converge, from one that is slow enough.
    ///
    /// The last place has no latest time there: where the earliest is too late, that is the proof, which a
    /// program without solutions would not give.
    fn clocked(&self, free: &LegSolution) -> Result<SolvedChain, NoChain> {
        let first = self.clocked_from(free, &free.profile);
        match first {
            Err(NoChain::Unresolved) => self.clocked_from(free, &self.stretched(free)),
            decided => decided,
        }
    }

    fn clocked_from(&self, free: &LegSolution, guess: &Profile) -> Result<SolvedChain, NoChain> {
        let (tours, stop) = (self.tours, || self.tours.stop.reason());
        let waypoints = tours.signed_waypoints(&self.route, &free.profile, &free.intervals);
        let clear = tours.places.with_cones.cones.is_empty();
        let dynamics = if clear {
            &tours.places.dynamics
        } else {
            &tours.places.with_cones
        };
        tours.solves.fetch_add(1, Ordering::Relaxed);
        let guess = (&free.intervals[..], guess);
        let solution = solve_clocked(dynamics, &waypoints, guess, &self.times(), &stop);
        let motion = solution.motion;
        if motion.status.is_interrupted() {
            return Err(NoChain::Stopped);
        }
        if motion.duration().is_none() || !(clear || is_clear(dynamics, &motion.profile)) {
            return Err(NoChain::Unresolved);
        }
        let delay = (solution.begin - self.departure).max(0.0);
        let begins = self.begins(&motion, self.departure + delay);
        let last = begins.len() - 1;
        let is_least = motion.status == NlpStatus::Converged;
        if is_least && self.lateness(last, begins[last] * (1.0 - 2.0 * INSIDE)) > 0.0 {
            return Err(NoChain::TooLate);
        }
        if !self.keeps_windows(&begins) {
            return Err(NoChain::Unresolved);
        }
        Ok(self.solved((delay, Arc::new(motion)), begins, is_least))
    }

    /// The free motion with legs that are longer where it arrives before a window.
    fn stretched(&self, free: &LegSolution) -> Profile {
        let mut guess = free.profile.clone();
        let mut clock = self.departure;
        let mut node = 0;
        for (visit, count) in self.visits.iter().zip(&free.intervals) {
            let lengths = &mut guess.lengths[node..node + count];
            node += count;
            let time: f64 = lengths.iter().sum();
            let from = visit.window.map_or(0.0, |window| window.from);
            if time > 0.0 && clock + time < from {
                let factor = (from - clock) / time;
                for length in lengths {
                    *length *= factor;
                }
            }
            clock = (clock + time).max(from) + self.tours.places.service_time(visit.place);
        }
        guess
    }

    /// The bounds of time of the program, whose clock stands still during services.
    fn times(&self) -> PassageTimes {
        let mut served = 0.0;
        let last = self.visits.len() - 1;
        let bounds = self.visits.iter().enumerate().map(|(i, visit)| {
            let service = self.tours.places.service_time(visit.place);
            let window = visit
                .window
                .map_or([0.0, f64::INFINITY], |w| [w.from, w.to - service]);
            let waits = i == last && may_wait(self.tours.places, visit.place);
            let from = if waits { 0.0 } else { window[0] };
            // Late by less than the accuracy of the program is inside.
            let inside = INSIDE * window[1].min(window[0].abs() + 1.0);
            let to = if i == last {
                f64::INFINITY
            } else {
                window[1] - inside
            };
            let bounds = [from + INSIDE * from - served, to - served];
            served += service;
            bounds
        });
        PassageTimes {
            bounds: bounds.collect(),
            start: self.departure,
            may_wait: self.waits,
        }
    }
}
