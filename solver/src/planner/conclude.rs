//! From the best orders of a search to plans: flown once more for their torques, and verified.

use super::Run;
use super::assemble::assemble;
use super::legs::LegSolver;
use super::tours::Tours;
use crate::checker;
use crate::plan::{Alternative, LowerBoundKind, Optimality, Outcome, Plan, Statistics};
use crate::problem::{Code, Problem};
use crate::progress::{Progress, Stage};
use crate::sequence::{FlownOrder, Incumbent, SearchObserver, SearchResult, SearchStatistics};
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Makes plans of orders, while a search goes on and at its end.
pub(super) struct Conclusions<'a> {
    tours: &'a Tours<'a>,
    run: Run<'a>,
    begin: Instant,
    /// The work that was done before the search.
    tables: Statistics,
}

impl<'a> Conclusions<'a> {
    /// Plans of tours over tables that have been solved.
    pub(super) fn new(
        tours: &'a Tours<'a>,
        tables: &LegSolver<'_>,
        run: Run<'a>,
        begin: Instant,
    ) -> Self {
        Self {
            tours,
            run,
            begin,
            tables: Statistics {
                wall_time_s: 0.0,
                nodes_explored: 0,
                nlp_solves: tables.nlp_solves,
                legs_solved: tables.solved,
                legs_from_cache: tables.from_store,
                threads: run.pool.threads(),
            },
        }
    }

    /// The plan of the best order of a search that has ended.
    pub(super) fn outcome(&self, best: &FlownOrder, found: &SearchResult) -> Outcome {
        self.run.observer.progress(Progress {
            stage: Stage::Verify,
            done: 0,
            total: None,
            incumbent_s: Some(best.duration_s),
            lower_bound_s: Some(found.lower_bound_s),
        });
        let gap = self.tours.places.scenario.options().relative_gap;
        let optimality = if found.best_is_proven(gap) {
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

    /// Puts an order together and verifies it.
    fn plan(
        &self,
        order: &Incumbent<'_>,
        optimality: Optimality,
        lower_bound_kind: LowerBoundKind,
    ) -> Result<Plan, Problem> {
        let scenario = self.tours.places.scenario;
        let route = self.tours.places.route(&order.best.order, true);
        // Every segment is remembered from its evaluation: nothing is solved here.
        let (flight, legs) = assemble(self.tours, &route, &self.tours.fly_route(&route));
        let report = checker::verify(scenario, &flight);
        if !report.verification.passed {
            let message = report.verification.failures.join("; ");
            let hint = "report the scenario: a plan that does not fly is a defect of the solver";
            return Err(Problem::new("", Code::VerificationFailed, message, hint));
        }
        let total = flight.total_time_s;
        let bound = order.lower_bound_s.min(total);
        let name = |i: &usize| scenario.targets()[*i].id.clone();
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
                wall_time_s: self.begin.elapsed().as_secs_f64(),
                nodes_explored: order.statistics.nodes_explored,
                nlp_solves: self.tables.nlp_solves + self.tours.solves.load(Ordering::Relaxed),
                ..self.tables.clone()
            },
            warnings: doubts(order).into_iter().chain(report.keep_out).collect(),
        })
    }
}

impl SearchObserver for Conclusions<'_> {
    fn progress(&self, progress: Progress) {
        self.run.observer.progress(progress);
    }

    fn improved(&self, incumbent: &Incumbent<'_>) {
        // One that does not fly is kept back; the end of the search tells if it stays the best.
        let kind = LowerBoundKind::NlpRelaxation;
        if let Ok(plan) = self.plan(incumbent, Optimality::Feasible, kind) {
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
fn doubts(order: &Incumbent<'_>) -> Option<Problem> {
    let count = order.statistics.bounds_contradicted;
    (count > 0).then(|| {
        let message = format!("{count} orders were flown faster than a lower bound had allowed");
        let hint = "take the bound as an estimate: a relaxed problem ended in a local minimum";
        Problem::new("", Code::BoundContradicted, message, hint)
    })
}
