//! Legs from rest to rest that are parts of a motion through several places.

use super::{LegSolver, solve};
use crate::leg::multiphase::LegSolution;
use crate::model::waypoint::Waypoint;
use crate::tour::legs::LegKind;
use crate::tour::order::Place;
use crate::tour::planner::canonical::CanonicalLeg;
use crate::tour::planner::tables::TabulatedLeg;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

impl LegSolver<'_> {
    /// The leg between two places from rest to rest; a start or an end that moves keeps its own
    /// conditions.
    pub(in crate::tour::planner) fn stopping_leg(&self, from: Place, to: Place) -> LegSolution {
        let places = self.places;
        if [from, to].iter().all(|place| places.admits_rest(*place)) {
            return self.leg(LegKind::RestToRest, from, to);
        }
        let [begin, end] = [from, to].map(|place| {
            if places.admits_rest(place) {
                places.at_rest(place)
            } else {
                places.waypoint(place)
            }
        });
        // Of neither kind, so that no table has it: known here, and not stored.
        let leg = CanonicalLeg::around_cones(places, &begin, &end);
        self.known(from, &leg).unwrap_or_else(|| {
            let solved = Arc::new(solve(places, &leg, None, self.stop));
            self.keep(&leg, &solved, false);
            self.placed(from, solved, leg.mirrored)
        })
    }

    /// The leg from rest to rest around cones between two attitudes, not kept.
    pub(in crate::tour::planner) fn rest_to_rest_between(
        &self,
        ends: [&Waypoint; 2],
    ) -> LegSolution {
        let [from, to] = ends.map(|end| self.places.stopped(&end.pinned()));
        let leg = CanonicalLeg::around_cones(self.places, &from, &to);
        let solved = solve(self.places, &leg, None, self.stop);
        self.nlp_solves.fetch_add(solved.solves, Relaxed);
        let leg = TabulatedLeg {
            mirrored: leg.mirrored,
            leg: Arc::new(solved),
        };
        leg.beginning_at(&from.attitude)
    }
}
