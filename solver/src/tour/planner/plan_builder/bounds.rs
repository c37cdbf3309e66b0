//! What a plan says of lower bounds: its own, and that a flight has contradicted one.

use super::{PlanBuilder, VerifiedFlight};
use crate::model::plan::{LowerBoundKind, Optimality};
use crate::model::problem::{Code, Problem};
use crate::run::contradiction::{Contradiction, refutes};
use crate::tour::order::{Incumbent, Place};
use crate::tour::planner::unsolved::SLEW_HINT;

/// Relative rounding error of a sum of durations that depends on the order of its terms.
const ROUNDING_OF_SUMS: f64 = 1e-13;
/// Relative rounding of certified bounds, which keep at least six digits.
const ROUNDING: f64 = 1e-6;

impl PlanBuilder<'_> {
    /// The certified lower bound on all tours, s, unless a flight has contradicted a certified
    /// bound.
    pub(in crate::tour::planner) fn certified_bound(&self) -> Option<f64> {
        self.certified
            .filter(|_| self.tours.legs.bounds_are_trusted())
    }

    /// The larger of a bound and the certified one, s.
    pub(super) fn best_bound(&self, bound: f64) -> f64 {
        self.certified_bound()
            .map_or(bound, |certified| certified.max(bound))
    }

    /// The bound of a plan of this duration, s, and its kind. A certified bound is preferred when
    /// it equals the other one up to rounding, or proves alone that the plan is within the
    /// requested gap.
    pub(super) fn bound(
        &self,
        other: f64,
        kind: LowerBoundKind,
        total: f64,
    ) -> (f64, LowerBoundKind) {
        let gap = self.tours.places.scenario.options().relative_gap;
        let enough = (other * (1.0 - ROUNDING)).min(total * (1.0 - gap));
        match self.certified_bound() {
            Some(certified) if certified >= enough => {
                (certified.min(total), LowerBoundKind::Certified)
            }
            _ if other >= total * (1.0 - ROUNDING_OF_SUMS) => (total, kind),
            _ => (other, kind),
        }
    }

    /// Compares a flight with the certified bounds on its legs and on all tours, and reports
    /// contradictions.
    pub(super) fn check_bounds(&self, route: &[Place], verified: &VerifiedFlight) {
        let (tours, places) = (self.tours, &self.tours.places);
        let total = verified.flight.total_time_s;
        let contradicted = |leg, bound_s, flown_s| {
            tours.legs.contradicted(&Contradiction::Tour {
                route: route.iter().map(|place| places.name(*place)).collect(),
                leg,
                bound_s,
                duration_s: flown_s,
            });
        };
        for (leg, pair) in verified.legs.iter().zip(route.windows(2)) {
            let Some(bound_s) = tours.certified.bound(pair[0], pair[1]) else {
                continue;
            };
            if refutes(leg.duration_s, bound_s) {
                let ends = [pair[0], pair[1]].map(|place| places.name(place));
                contradicted(Some(ends), bound_s, leg.duration_s);
            }
        }
        if let Some(bound_s) = self.certified
            && refutes(total, bound_s)
        {
            contradicted(None, bound_s, total);
        }
    }

    /// The warning that a flight has contradicted a certified bound.
    pub(super) fn contradiction_warning(&self) -> Option<Problem> {
        let trusted = self.tours.legs.bounds_are_trusted();
        (!trusted).then(|| {
            let message = "a flight was faster than a certified bound; the plan gives no bound";
            let hint = "report the scenario: a bound that does not hold is a defect of the solver";
            Problem::new("", Code::BoundContradicted, message, hint)
        })
    }
}

/// Warnings that follow from the counts of a search.
pub(super) fn search_warnings(
    order: &Incumbent<'_>,
    optimality: Optimality,
) -> impl Iterator<Item = Problem> + use<> {
    let contradicted = order.statistics.bounds_contradicted;
    let contradicted = (contradicted > 0).then(|| {
        let message =
            format!("the tours of {contradicted} orders are shorter than their lower bounds");
        let hint = "take the bound as an estimate: a relaxed problem ended in a local minimum";
        Problem::new("", Code::BoundContradicted, message, hint)
    });
    let unresolved = order.statistics.tours_unresolved;
    let unresolved = (unresolved > 0 && optimality == Optimality::Feasible).then(|| {
        let message = format!(
            "the programs of {unresolved} orders found no solution; these orders are not ruled out"
        );
        Problem::new("/targets", Code::SlewNotSolved, message, SLEW_HINT)
    });
    contradicted.into_iter().chain(unresolved)
}
