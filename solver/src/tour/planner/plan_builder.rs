//! From the orders that a search finds to plans: torques assembled, verified by the checker, and
//! compared with the certified bounds.

mod bounds;
#[cfg(test)]
mod tests;

use super::Run;
use super::assemble::{Piece, assemble};
use super::clock::SolvedChain;
use super::guesses::constructed;
use super::history::{History, search_work};
use super::scheduled::ClockFacts;
use super::tables::SolvedTable;
use super::tours::Tours;
use crate::checker::{CheckReport, verify_with_claims};
use crate::leg::multiphase::LegSolution;
use crate::model::plan::{
    Alternative, Flight, Leg, LowerBoundKind, NlpSolves, Optimality, Outcome, Plan, Rolls,
    Statistics, Wait,
};
use crate::model::problem::{Code, Problem};
use crate::run::progress::{Progress, Stage};
use crate::tour::legs::LegKind;
use crate::tour::order::{
    Incumbent, Place, SearchObserver, SearchResult, SearchStatistics, SolvedOrder,
};
use bounds::search_warnings;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Makes plans of orders, during a search and at its end.
pub(super) struct PlanBuilder<'a> {
    tours: &'a Tours<'a>,
    /// Certified lower bound on all tours, s.
    certified: Option<f64>,
    run: Run<'a>,
    begin: Instant,
    /// The order whose flight was verified last, with that flight: a stopped search need not
    /// assemble it again.
    last: Mutex<Option<(Vec<usize>, VerifiedFlight)>>,
    /// A tour constructed without solving a program, used if the search finds none.
    constructed: Option<(SolvedOrder, VerifiedFlight)>,
    /// The rest-to-rest legs of the final order.
    rest: Option<SolvedTable>,
    history: History,
    /// What is known of the present order, where the scenario has a clock.
    clock: Mutex<Option<ClockFacts>>,
}

/// A flight that has passed its verification.
#[derive(Clone)]
struct VerifiedFlight {
    flight: Flight,
    legs: Vec<Leg>,
    waits: Vec<Wait>,
    report: CheckReport,
}

impl<'a> PlanBuilder<'a> {
    /// A builder for the plans of a solve that began at this instant.
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
            clock: Mutex::default(),
        }
    }

    /// Sets what is known of the order of the next plans.
    pub(super) fn set_clock(&self, facts: ClockFacts) {
        *self.clock() = Some(facts);
        // The same order may be flown at other times.
        self.drop_flight();
    }

    fn clock(&self) -> MutexGuard<'_, Option<ClockFacts>> {
        self.clock.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the certified lower bound on all tours, s.
    pub(super) fn set_certified_bound(&mut self, certified: Option<f64>) {
        self.certified = certified;
    }

    /// Constructs a flight of an order, leg by leg, and reports it; there is none when a leg cannot
    /// be constructed or the flight fails its verification.
    pub(super) fn construct(&mut self, order: Vec<usize>) {
        let route = self.tours.places.route(&order, true);
        let segments = constructed(self.tours.places, &route);
        let Some(flight) = segments.and_then(|segments| self.verify_flight(&route, &segments).ok())
        else {
            return;
        };
        let best = SolvedOrder {
            duration_s: flight.flight.total_time_s,
            order,
        };
        self.keep_flight(&best.order, &flight);
        self.announce(&best);
        self.drop_flight();
        self.constructed = Some((best, flight));
    }

    /// Whether [`PlanBuilder::construct`] has succeeded.
    pub(super) fn has_constructed(&self) -> bool {
        self.constructed.is_some()
    }

    /// The plan of the constructed flight, for a search that ends without an order.
    pub(super) fn constructed_outcome(&self, statistics: SearchStatistics) -> Option<Outcome> {
        let (best, flight) = self.constructed.as_ref()?;
        self.keep_flight(&best.order, flight);
        let only = Incumbent {
            best,
            alternatives: &[],
            lower_bound_s: 0.0,
            statistics,
        };
        let kind = LowerBoundKind::NlpRelaxation;
        Some(outcome(self.plan(&only, Optimality::Feasible, kind)))
    }

    /// Reports a first tour, before there is a bound on others.
    pub(super) fn announce(&self, first: &SolvedOrder) {
        self.improved(&Incumbent {
            best: first,
            alternatives: &[],
            lower_bound_s: 0.0,
            statistics: SearchStatistics::default(),
        });
    }

    /// Solves the rest-to-rest legs of the final order without cones, with which its plan compares
    /// the tour's legs; skipped when the solve is to stop.
    pub(super) fn compare_with_rest(&mut self, order: &SolvedOrder) {
        if self.tours.stop.is_set() {
            return;
        }
        let route = self.tours.places.route(&order.order, true);
        let pairs: Vec<_> = route.windows(2).map(|leg| (leg[0], leg[1])).collect();
        self.rest = Some(
            self.tours
                .legs
                .table_without_cones(LegKind::RestToRest, &pairs),
        );
    }

    /// The plan of the best order at the end of a search.
    pub(super) fn outcome(&self, best: &SolvedOrder, found: &SearchResult) -> Outcome {
        self.run.observer.progress(Progress {
            stage: Stage::Verify,
            done: 0,
            total: None,
            incumbent_s: Some(best.duration_s),
            lower_bound_s: Some(self.best_bound(found.lower_bound_s)),
            value: None,
            value_bound: None,
        });
        let gap = self.tours.places.scenario.options().relative_gap;
        let needed_s = best.duration_s * (1.0 - gap);
        // Verification may find that the flight contradicts a bound. Its failure is reported below.
        let _ = self.verified(&best.order);
        let trusted = self.tours.legs.bounds_are_trusted();
        let certified = self
            .certified_bound()
            .is_some_and(|bound| bound >= needed_s);
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

    /// The plan of a prescribed order, with the sum of its legs' bounds as the lower bound.
    pub(super) fn fixed_order_outcome(&self, order: &SolvedOrder, lower_bound_s: f64) -> Outcome {
        let only = Incumbent {
            best: order,
            alternatives: &[],
            lower_bound_s,
            statistics: SearchStatistics::default(),
        };
        outcome(self.plan(&only, Optimality::Feasible, LowerBoundKind::PairTable))
    }

    /// The plan of a schedule at the end of its search.
    pub(super) fn scheduled_outcome(&self, last: &Incumbent<'_>, proved: bool) -> Outcome {
        let optimality = if proved {
            Optimality::Optimal
        } else {
            Optimality::Feasible
        };
        outcome(self.plan(last, optimality, LowerBoundKind::NlpRelaxation))
    }

    /// The verified flight of an order.
    fn verified(&self, order: &[usize]) -> Result<VerifiedFlight, Problem> {
        if let Some((known, flight)) = self.last_flight().as_ref()
            && known == order
        {
            return Ok(flight.clone());
        }
        let route = self.tours.places.route(order, true);
        let chains = self.clock().as_ref().and_then(|facts| facts.chains.clone());
        let flight = if let Some(chains) = chains {
            let pieces: Vec<Piece<'_>> = chains.iter().map(SolvedChain::piece).collect();
            self.verify_pieces(&route, &pieces)?
        } else {
            // The segments are cached since their evaluation: nothing is solved here.
            self.verify_flight(&route, &self.tours.solve_route(&route))?
        };
        self.keep_flight(order, &flight);
        Ok(flight)
    }

    fn last_flight(&self) -> MutexGuard<'_, Option<(Vec<usize>, VerifiedFlight)>> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn keep_flight(&self, order: &[usize], flight: &VerifiedFlight) {
        *self.last_flight() = Some((order.to_vec(), flight.clone()));
    }

    /// Forgets the flight of an order that is flown otherwise from now on.
    pub(super) fn drop_flight(&self) {
        *self.last_flight() = None;
    }

    /// Assembles the flight of solved segments and verifies it.
    fn verify_flight(
        &self,
        route: &[Place],
        segments: &[Arc<LegSolution>],
    ) -> Result<VerifiedFlight, Problem> {
        let places = self.tours.places.split(route);
        let pieces = places.iter().zip(segments).map(|(places, motion)| Piece {
            places,
            delay: 0.0,
            motion,
        });
        self.verify_pieces(route, &pieces.collect::<Vec<_>>())
    }

    /// The same for the pieces of a flight.
    fn verify_pieces(
        &self,
        route: &[Place],
        pieces: &[Piece<'_>],
    ) -> Result<VerifiedFlight, Problem> {
        let (flight, legs, waits) = assemble(self.tours, pieces);
        let claims = self.clock().as_ref().map(|facts| facts.claims(&waits));
        let claims = claims.unwrap_or_default();
        let report = verify_with_claims(self.tours.places.scenario, &flight, &claims);
        if !report.verification.passed {
            let message = report.verification.failures.join("; ");
            let hint =
                "report the scenario: a plan that fails verification is a defect of the solver";
            return Err(Problem::new("", Code::VerificationFailed, message, hint));
        }
        let verified = VerifiedFlight {
            flight,
            legs,
            waits,
            report,
        };
        self.check_bounds(route, &verified);
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
            waits,
            report,
        } = self.verified(&order.best.order)?;
        let total = flight.total_time_s;
        let (bound, lower_bound_kind) = if self.tours.legs.bounds_are_trusted() {
            self.bound(order.lower_bound_s, kind, total)
        } else {
            // The search's bound rests on the contradicted bounds too.
            (0.0, kind)
        };
        let route = self.tours.places.route(&order.best.order, true);
        self.annotate_legs(&mut legs, &route);
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
            certified_lower_bound_s: self.certified_bound(),
            alternatives: order
                .alternatives
                .iter()
                .map(|other| Alternative {
                    sequence: other.order.iter().map(name).collect(),
                    total_time_s: other.duration_s,
                })
                .collect(),
            legs,
            rolls: Rolls::of(scenario, &flight, &report.states),
            schedule: self.clock().clone().map(|facts| facts.schedule(waits)),
            flight,
            states: report.states,
            margins: report.margins,
            verification: report.verification,
            statistics: Statistics {
                history,
                ..self.statistics(&order.statistics)
            },
            warnings: self
                .contradiction_warning()
                .into_iter()
                .chain(search_warnings(order, optimality))
                .chain(report.keep_out)
                .collect(),
        })
    }
}

impl PlanBuilder<'_> {
    /// The work so far; the history is left empty.
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

    /// Adds to the legs of a route their certified bounds and their rest-to-rest durations.
    fn annotate_legs(&self, legs: &mut [Leg], route: &[Place]) {
        for (leg, pair) in legs.iter_mut().zip(route.windows(2)) {
            let rest = self.rest.as_ref();
            let proved = self.tours.certified.bound(pair[0], pair[1]);
            leg.certified_lower_bound_s = proved.filter(|_| self.tours.legs.bounds_are_trusted());
            leg.rest_to_rest_duration_s = rest.and_then(|table| table.duration(pair[0], pair[1]));
        }
    }
}

impl SearchObserver for PlanBuilder<'_> {
    fn progress(&self, progress: Progress) {
        self.run.observer.progress(Progress {
            lower_bound_s: progress.lower_bound_s.map(|bound| self.best_bound(bound)),
            ..progress
        });
    }

    fn improved(&self, incumbent: &Incumbent<'_>) {
        // A plan that fails verification is not reported here; if it stays the best, the search
        // ends with that failure.
        let kind = LowerBoundKind::NlpRelaxation;
        if let Ok(plan) = self.plan(incumbent, Optimality::Feasible, kind) {
            self.history.replace(&plan.statistics.history);
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
