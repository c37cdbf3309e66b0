//! Motions that the program of a segment starts from, or that stand in for its solution.

use super::extent::Extent;
use super::tours::Tours;
use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::leg::solve::eigenaxis::Perturbation;
use crate::nlp::NlpStatus;
use crate::tour::legs::LegKind;
use crate::tour::order::Place;
use std::sync::Arc;

/// What a segment starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Start {
    /// The flight without the last leg.
    Shorter,
    /// Slews about the eigenaxis.
    Eigenaxes,
    /// Extremals of the kinematic problem.
    Extremals,
    /// Legs from rest to rest: where all of it admits rest, that is a flight already.
    AtRest,
}

impl Tours<'_> {
    /// A flight along a route that no program has made shorter; none where a leg cannot be constructed.
    pub(super) fn constructed(&self, route: &[Place]) -> Option<Vec<Arc<LegSolution>>> {
        let segments = self.split(route).into_iter().map(|segment| {
            let mut whole = LegSolution {
                status: NlpStatus::Constructed,
                ..LegSolution::nowhere()
            };
            for pair in segment.windows(2) {
                let [from, to] = [pair[0], pair[1]].map(|place| self.places.waypoint(place));
                let leg = self.places.slew(&from, &to).constructed()?;
                whole.profile.append(&leg.profile);
                whole.intervals.extend(leg.intervals);
            }
            Some(Arc::new(whole))
        });
        segments.collect()
    }

    /// Whether a route may be flown from rest to rest at all of its places.
    pub(super) fn admits_rest(&self, route: &[Place]) -> bool {
        route.windows(2).all(|pair| {
            let (from, to) = (self.places.waypoint(pair[0]), self.places.waypoint(pair[1]));
            self.places.slew(&from, &to).begins_and_ends_at_rest()
        })
    }

    /// A motion to start a segment from: legs joined end to end, and the intervals of each. `None`
    /// where there is none.
    pub(super) fn guess(&self, route: &[Place], start: Start) -> Option<(Profile, Vec<usize>)> {
        if let (Start::Shorter, [before @ .., _]) = (start, route) {
            let shorter = self.segment(before, Extent::Beginning);
            shorter.duration()?;
            let (mut guess, mut intervals) = (shorter.profile.clone(), shorter.intervals.clone());
            let (last, its) = self.guess(&route[before.len() - 1..], Start::Eigenaxes)?;
            guess.append(&last);
            intervals.extend(its);
            return Some((guess, intervals));
        }
        let mut guess = Profile::empty();
        let mut intervals = Vec::new();
        for pair in route.windows(2) {
            let (from, to) = (self.places.waypoint(pair[0]), self.places.waypoint(pair[1]));
            let slew = self.places.slew(&from, &to);
            let perturbed_eigenaxis = || slew.perturbed_eigenaxis(Perturbation::Near);
            let leg = match start {
                Start::Shorter | Start::Eigenaxes => perturbed_eigenaxis(),
                Start::Extremals => slew
                    .extremal()
                    .unwrap_or_else(|| slew.perturbed_eigenaxis(Perturbation::Far)),
                Start::AtRest => {
                    let leg = self.legs.lone(LegKind::RestToRest, pair[0], pair[1]);
                    leg.duration()?;
                    leg.profile
                }
            };
            guess.append(&leg);
            intervals.push(leg.intervals());
        }
        Some((guess, intervals))
    }
}
