//! From the best orders of a search to plans: flown once more for their torques, and verified.

use super::Run;
use super::assemble::assemble;
use super::tables::LegTable;
use super::tours::Tours;
use super::work::{History, search_work};
use crate::checker;
use crate::leg::multiphase::LegSolution;
use crate::model::plan::{
    Alternative, Flight, Leg, LowerBoundKind, NlpSolves, Optimality, Outcome, Plan, Statistics,
};
use crate::model::problem::{Code, Problem};
use crate::run::contradiction::{Contradiction, slack};
use crate::run::progress::{Progress, Stage};
use crate::tour::legs::LegKind;
use crate::tour::order::{
    FlownOrder, Incumbent, Place, SearchObserver, SearchResult, SearchStatistics,
};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// What the order of additions does to a duration.
const ROUNDING_OF_SUMS: f64 = 1e-13;
/// Certified bounds are rounded down to six digits at least.
const ROUNDING: f64 = 1e-6;

/// Makes plans of orders, while a search goes on and at its end.
pub(super) struct PlanBuilder<'a> {
    tours: &'a Tours<'a>,
    /// No tour takes less, s, proved.
    certified: Option<f64>,
    run: Run<'a>,
    begin: Instant,
    /// The order whose flight was verified last, with that flight: a search that is stopped has its
    /// plan at once.
    last: Mutex<Option<(Vec<usize>, VerifiedFlight)>>,
    /// A tour that was flown without a program, for want of a better one.
    constructed: Option<(FlownOrder, VerifiedFlight)>,
    /// The legs of the final order from rest to rest.
    rest: Option<LegTable>,
    history: History,
}

/// A flight that has passed its verification.
#[derive(Clone)]
struct VerifiedFlight {
    flight: Flight,
    legs: Vec<Leg>,
    report: checker::CheckReport,
}

impl<'a> PlanBuilder<'a> {
    /// Plans of tours.
    pub(super) fn new(tours: &'a Tours<'a>, run: Run<'a>, begin: Instant) -> Self {
        Self {
            tours,
            certified: None,
            run,
            begin,
            last: Mutex::default(),
            constructed: None,
            rest: None,
            history: History::since(begin),
        }
    }

    /// Takes in a proved bound on all tours, s.
    pub(super) fn prove(&mut self, certified: Option<f64>) {
        self.certified = certified;
    }

    /// That bound, when there is one and no flight has contradicted any.
    pub(super) fn proved(&self) -> Option<f64> {
        self.certified
            .filter(|_| self.tours.legs.bounds_are_trusted())
    }

    /// Constructs a flight of an order, leg by leg, and tells of it; nothing where a leg cannot be
    /// constructed.
    pub(super) fn construct(&mut self, order: Vec<usize>) {
        let route = self.tours.places.route(&order, true);
        let flown = self.tours.constructed(&route);
        let Some(flight) = flown.and_then(|flown| self.checked(&route, &flown).ok()) else {
            return;
        };
        let best = FlownOrder {
            duration_s: flight.flight.total_time_s,
            order,
        };
        self.remember(&best.order, &flight);
        self.announce(&best);
        self.forget();
        self.constructed = Some((best, flight));
    }

    /// The plan of the constructed flight, for a search that has ended with none.
    pub(super) fn constructed(&self, statistics: SearchStatistics) -> Option<Outcome> {
        let (best, flight) = self.constructed.as_ref()?;
        self.remember(&best.order, flight);
        let only = Incumbent {
            best,
            alternatives: &[],
            lower_bound_s: 0.0,
            statistics,
        };
        let kind = LowerBoundKind::NlpRelaxation;
        Some(outcome(self.plan(&only, Optimality::Feasible, kind)))
    }

    /// Tells of a first tour, before anything is known of others.
    pub(super) fn announce(&self, first: &FlownOrder) {
        self.improved(&Incumbent {
            best: first,
            alternatives: &[],
            lower_bound_s: 0.0,
            statistics: SearchStatistics::default(),
        });
    }

    /// Solves the legs of the final order from rest to rest, to be compared with in its plan; not
    /// when the solve is to stop.
    pub(super) fn compare_with_rest(&mut self, order: &FlownOrder) {
        if self.tours.stop.is_set() {
            return;
        }
        let route = self.tours.places.route(&order.order, true);
        let pairs: Vec<_> = route.windows(2).map(|leg| (leg[0], leg[1])).collect();
        self.rest = Some(self.tours.legs.late_table(LegKind::RestToRest, &pairs));
    }

    /// The plan of the best order of a search that has ended.
    pub(super) fn outcome(&self, best: &FlownOrder, found: &SearchResult) -> Outcome {
        self.run.observer.progress(Progress {
            stage: Stage::Verify,
            done: 0,
            total: None,
            incumbent_s: Some(best.duration_s),
            lower_bound_s: Some(self.raised(found.lower_bound_s)),
        });
        let gap = self.tours.places.scenario.options().relative_gap;
        let asked_for = best.duration_s * (1.0 - gap);
        // The flight may contradict a bound.
        let _ = self.verified(&best.order);
        let trusted = self.tours.legs.bounds_are_trusted();
        let certified = self.proved().is_some_and(|bound| bound >= asked_for);
        let optimality = if trusted && (certified || found.best_is_proven(gap)) {
            Optimality::Optimal
        } else {
            Optimality::Feasible
        };
        let last = Incumbent {
            best,
            alternatives: &found.alternatives,
            lower_bound_s: found.lower_bound_s,
            statistics: found.statistics,
        };
        outcome(self.plan(&last, optimality, LowerBoundKind::NlpRelaxation))
    }

    /// The plan of an order that was given and not searched for, with the sum of its legs as bound.
    pub(super) fn given(&self, order: &FlownOrder, lower_bound_s: f64) -> Outcome {
        let only = Incumbent {
            best: order,
            alternatives: &[],
            lower_bound_s,
            statistics: SearchStatistics::default(),
        };
        outcome(self.plan(&only, Optimality::Feasible, LowerBoundKind::PairTable))
    }

    /// The flight of an order, verified.
    fn verified(&self, order: &[usize]) -> Result<VerifiedFlight, Problem> {
        if let Some((known, flight)) = self.last().as_ref()
            && known == order
        {
            return Ok(flight.clone());
        }
        let route = self.tours.places.route(order, true);
        // Every segment is remembered from its evaluation: nothing is solved here.
        let flight = self.checked(&route, &self.tours.fly_route(&route))?;
        self.remember(order, &flight);
        Ok(flight)
    }

    fn last(&self) -> MutexGuard<'_, Option<(Vec<usize>, VerifiedFlight)>> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn remember(&self, order: &[usize], flight: &VerifiedFlight) {
        *self.last() = Some((order.to_vec(), flight.clone()));
    }

    fn forget(&self) {
        *self.last() = None;
    }

    /// The flight of solved segments, when the checker agrees with it.
    fn checked(
        &self,
        route: &[Place],
        flown: &[Arc<LegSolution>],
    ) -> Result<VerifiedFlight, Problem> {
        let (flight, legs) = assemble(self.tours, route, flown);
        let report = checker::verify(self.tours.places.scenario, &flight);
        if !report.verification.passed {
            let message = report.verification.failures.join("; ");
            let hint = "report the scenario: a plan that does not fly is a defect of the solver";
            return Err(Problem::new("", Code::VerificationFailed, message, hint));
        }
        let verified = VerifiedFlight {
            flight,
            legs,
            report,
        };
        self.compare_with_bounds(route, &verified);
        Ok(verified)
    }

    /// The plan of an order.
    fn plan(
        &self,
        order: &Incumbent<'_>,
        optimality: Optimality,
        kind: LowerBoundKind,
    ) -> Result<Plan, Problem> {
        let scenario = self.tours.places.scenario;
        let VerifiedFlight {
            flight,
            mut legs,
            report,
        } = self.verified(&order.best.order)?;
        let total = flight.total_time_s;
        let (bound, lower_bound_kind) = if self.tours.legs.bounds_are_trusted() {
            self.bound(order.lower_bound_s, kind, total)
        } else {
            // Certified bounds have been part of the search's own.
            (0.0, kind)
        };
        let route = self.tours.places.route(&order.best.order, true);
        self.compare(&mut legs, &route);
        let name = |i: &usize| scenario.targets()[*i].id.clone();
        let history = self.history.with(total, bound);
        Ok(Plan {
            optimality,
            total_time_s: total,
            lower_bound_s: bound,
            relative_gap: if total > 0.0 {
                (total - bound) / total
            } else {
                0.0
            },
            lower_bound_kind,
            certified_lower_bound_s: self.proved(),
            alternatives: order
                .alternatives
                .iter()
                .map(|other| Alternative {
                    sequence: other.order.iter().map(name).collect(),
                    total_time_s: other.duration_s,
                })
                .collect(),
            legs,
            flight,
            states: report.states,
            margins: report.margins,
            verification: report.verification,
            statistics: Statistics {
                history,
                ..self.statistics(&order.statistics)
            },
            warnings: self
                .distrust()
                .into_iter()
                .chain(doubts(order, optimality))
                .chain(report.keep_out)
                .collect(),
        })
    }
}

impl PlanBuilder<'_> {
    /// The work so far, without its history.
    fn statistics(&self, search: &SearchStatistics) -> Statistics {
        let [legs_solved, legs_from_cache, legs] = self.tours.legs.work();
        let segments = self.tours.solves.load(Ordering::Relaxed);
        Statistics {
            wall_time_s: self.begin.elapsed().as_secs_f64(),
            nodes_explored: search.nodes_explored,
            nlp_solves: legs + segments,
            nlp_solves_by_kind: NlpSolves { legs, segments },
            search: search_work(search),
            history: Vec::new(),
            legs_solved,
            legs_from_cache,
            threads: self.run.pool.threads(),
        }
    }

    /// Puts beside the legs of a route what is proved of them, and the legs from rest to rest.
    fn compare(&self, legs: &mut [Leg], route: &[Place]) {
        for (leg, pair) in legs.iter_mut().zip(route.windows(2)) {
            let rest = self.rest.as_ref();
            let proved = self.tours.proved(pair[0], pair[1]);
            leg.certified_lower_bound_s = proved.filter(|_| self.tours.legs.bounds_are_trusted());
            leg.rest_to_rest_duration_s = rest.and_then(|table| table.duration(pair[0], pair[1]));
        }
    }

    /// A doubt about bounds that a flight has contradicted.
    fn distrust(&self) -> Option<Problem> {
        let trusted = self.tours.legs.bounds_are_trusted();
        (!trusted).then(|| {
            let message = "a flight was faster than a certified bound, so that no bound is given";
            let hint = "report the scenario: a bound that does not hold is a defect of the solver";
            Problem::new("", Code::BoundContradicted, message, hint)
        })
    }

    /// Compares a flight with the certified bounds of its legs and of all tours.
    fn compare_with_bounds(&self, route: &[Place], flown: &VerifiedFlight) {
        let (tours, places) = (self.tours, &self.tours.places);
        let total = flown.flight.total_time_s;
        let contradicted = |leg, bound_s, flown_s| {
            tours.legs.contradicted(&Contradiction::Tour {
                route: route.iter().map(|place| places.name(*place)).collect(),
                leg,
                bound_s,
                flown_s,
            });
        };
        let mut all_slack = 0.0;
        for (leg, pair) in flown.legs.iter().zip(route.windows(2)) {
            let Some(bound_s) = tours.proved(pair[0], pair[1]) else {
                continue;
            };
            let [from, to] = [pair[0], pair[1]].map(|place| places.waypoint(place).attitude);
            let slack = slack(bound_s, places.arrival.turn(&from, &to));
            all_slack += slack;
            if bound_s - slack > leg.duration_s {
                let ends = [pair[0], pair[1]].map(|place| places.name(place));
                contradicted(Some(ends), bound_s, leg.duration_s);
            }
        }
        if let Some(bound_s) = self.certified
            && bound_s - slack(bound_s, f64::INFINITY) - all_slack > total
        {
            contradicted(None, bound_s, total);
        }
    }

    /// A bound, s, or the certified one where that is larger.
    fn raised(&self, bound: f64) -> f64 {
        self.proved()
            .map_or(bound, |certified| certified.max(bound))
    }

    /// The bound of a plan of this duration, s, and its kind. A certified bound that equals another
    /// one up to rounding, or proves alone that the plan is within the gap asked for, is worth more.
    fn bound(&self, other: f64, kind: LowerBoundKind, total: f64) -> (f64, LowerBoundKind) {
        let gap = self.tours.places.scenario.options().relative_gap;
        let enough = (other * (1.0 - ROUNDING)).min(total * (1.0 - gap));
        match self.proved() {
            Some(certified) if certified >= enough => {
                (certified.min(total), LowerBoundKind::Certified)
            }
            _ if other >= total * (1.0 - ROUNDING_OF_SUMS) => (total, kind),
            _ => (other, kind),
        }
    }
}

impl SearchObserver for PlanBuilder<'_> {
    fn progress(&self, progress: Progress) {
        self.run.observer.progress(Progress {
            lower_bound_s: progress.lower_bound_s.map(|bound| self.raised(bound)),
            ..progress
        });
    }

    fn improved(&self, incumbent: &Incumbent<'_>) {
        // One that does not fly is kept back; the end of the search tells if it stays the best.
        let kind = LowerBoundKind::NlpRelaxation;
        if let Ok(plan) = self.plan(incumbent, Optimality::Feasible, kind) {
            self.history.note(&plan.statistics.history);
            self.run.observer.incumbent(&plan);
        }
    }
}

fn outcome(plan: Result<Plan, Problem>) -> Outcome {
    match plan {
        Ok(plan) => Outcome::Planned(Box::new(plan)),
        Err(problem) => Outcome::Failed(vec![problem]),
    }
}

/// What the search itself casts doubt on.
fn doubts(order: &Incumbent<'_>, optimality: Optimality) -> impl Iterator<Item = Problem> + use<> {
    let contradicted = order.statistics.bounds_contradicted;
    let contradicted = (contradicted > 0).then(|| {
        let message =
            format!("{contradicted} orders were flown faster than a lower bound had allowed");
        let hint = "take the bound as an estimate: a relaxed problem ended in a local minimum";
        Problem::new("", Code::BoundContradicted, message, hint)
    });
    let unresolved = order.statistics.tours_unresolved;
    let unresolved = (unresolved > 0 && optimality == Optimality::Feasible).then(|| {
        let message = format!(
            "for {unresolved} orders no program ended in a solution, so that they are not ruled out"
        );
        Problem::new("/targets", Code::SlewNotSolved, message, super::SLEW_HINT)
    });
    contradicted.into_iter().chain(unresolved)
}

#[cfg(test)]
mod tests;
