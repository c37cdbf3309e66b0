//! Motions with legs that take longer than from rest to rest: local minima of their programs.

use super::tours::Tours;
use crate::leg::multiphase::{LegSolution, solve_through};
use crate::leg::profile::Profile;
use crate::tour::order::Place;
use std::sync::atomic::Ordering;

/// Ratio of a leg's time in a motion to the time with the conditions of its own ends from which it is
/// compared with the leg from rest to rest, and by how much the legs of a motion may exceed those, as a
/// share of its time: a short leg may pay for what others gain.
const SUSPICIOUS: f64 = 1.015;
const NEEDLESS: f64 = 6e-3;

impl Tours<'_> {
    /// A faster motion from one whose legs take longer than from rest to rest; `None` where there is none.
    pub(super) fn without_needless_time(
        &self,
        route: &[Place],
        motion: &LegSolution,
    ) -> Option<LegSolution> {
        let (guess, intervals) = self.with_stopping_legs(route, motion)?;
        let waypoints = self.signed_waypoints(route, &guess, &intervals);
        self.solves.fetch_add(1, Ordering::Relaxed);
        let dynamics = &self.places.dynamics;
        let stop = || self.stop.reason();
        let solution = solve_through(dynamics, &waypoints, &intervals, &guess, &stop);
        solution.improves(motion).then_some(solution)
    }

    /// A motion through places that all admit rest, with legs from rest to rest in place of those that
    /// take longer, and the intervals of its legs; `None` where that makes little difference. A motion
    /// in which it makes more is hardly ever the fastest.
    fn with_stopping_legs(
        &self,
        route: &[Place],
        motion: &LegSolution,
    ) -> Option<(Profile, Vec<usize>)> {
        let admits_rest = |place: &Place| self.places.admits_rest(*place);
        if motion.duration().is_none() || self.stop.is_set() || !route.iter().all(admits_rest) {
            return None;
        }
        let (mut guess, mut intervals) = (Profile::empty(), Vec::new());
        let mut node = 0;
        let mut excess_s = 0.0;
        for (leg, count) in route.windows(2).zip(&motion.intervals) {
            let flown = motion.profile.part(node..node + count);
            node += count;
            let flown_s = flown.duration();
            let stopping = self
                .is_suspicious([leg[0], leg[1]], flown_s)
                .then(|| self.legs.stopping_leg(leg[0], leg[1]))
                .filter(|leg| leg.duration().is_some_and(|time_s| time_s < flown_s));
            if let Some(stopping) = stopping {
                excess_s += flown_s - stopping.profile.duration();
                guess.append(&stopping.profile);
                intervals.push(stopping.intervals.iter().sum());
            } else {
                guess.append(&flown);
                intervals.push(*count);
            }
        }
        (excess_s > NEEDLESS * motion.profile.duration()).then_some((guess, intervals))
    }

    /// Whether a leg takes so long that it may take longer than from rest to rest.
    fn is_suspicious(&self, [from, to]: [Place; 2], flown_s: f64) -> bool {
        let ends = [from, to].map(|place| self.places.waypoint(place));
        if ends.iter().any(|end| end.roll.is_some()) {
            return false;
        }
        let eigenaxis = self.places.slew(&ends[0], &ends[1]).eigenaxis();
        let is_slow = eigenaxis.flyable && flown_s > eigenaxis.course.duration();
        let alone = || {
            let known = self
                .known_free_leg(from, to)
                .filter(|_| self.places.needs_all_legs());
            known.and_then(|known| known.leg.solution.least_duration())
        };
        is_slow || alone().is_some_and(|alone_s| flown_s > SUSPICIOUS * alone_s)
    }
}
