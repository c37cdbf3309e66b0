//! Schedules: tours with windows, values and a latest end.
//!
//! Where every target is visited at rest, the legs do not couple: a table of their times is all that
//! the choice of targets and their order needs, and to arrive early means to wait at rest. Of few
//! targets all legs are solved first. Of many, legs count with their lower bounds, and those of the best
//! schedule are solved until none of them is a bound: then it is the best of all. A leg whose program does not
//! converge keeps its bound; the best schedule that can be flown is then compared with the best one on bounds.
//!
//! Where a rest leaves the roll or the momenta of a fourth wheel free, legs hardly couple: schedules are
//! looked for in which every target is visited in one attitude, with the momenta of the start, and compared
//! with bounds on all others.
//!
//! Where rates are free at targets, legs couple, and there is nowhere to wait: motions pass
//! their targets within bounds of time, and a branch and bound solves their programs. It begins with
//! bounds on what legs in a row lose together.

mod additive;
mod chains;
mod coupled;
mod coupled_times;
mod explanation;
mod problem;
mod skipped;
mod with_programs;

use super::additive_tours::LegTimes;
use super::legs::LegSolver;
use super::places::Places;
use super::plan_builder::PlanBuilder;
use super::scheduled::ClockFacts;
use super::tours::Tours;
use super::unsolved::unsolved;
use super::{Run, limited, tour_pairs};
use crate::model::plan::{Optimality, Outcome};
use crate::model::problem::{Code, Problem};
use crate::model::scenario::{Scenario, Target};
use crate::run::progress::{Progress, Stage};
use crate::run::stop::StopSignal;
use crate::tour::order::{
    Incumbent, Place, SearchObserver, SearchStatistics, SolvedOrder, TourModel,
};
use crate::tour::schedule::{
    MAX_LABELS, SearchLimits, TimedOrder, TimedProblem, TimedResult, labels_in_time, search,
};
pub(super) use chains::SolvedChain;
use explanation::conflict;
use problem::{MAX_COUPLED, MAX_WHEELS, is_plannable, leaves_nothing_free, timed_problem};
use skipped::{Inclusions, untried};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Time, s, of a leg for which no solution was found.
const NO_LEG_S: f64 = f64::INFINITY;
/// Labels of a search on bounds, among few targets.
const LABELS_OF_BOUNDS: u64 = 400_000;
/// Relative difference of ends that counts as none.
const SAME_END: f64 = 1e-7;

/// What is said of a scenario whose clock cannot be planned.
pub(super) fn not_planned() -> Problem {
    let message = format!(
        "windows, values and a latest end are planned for targets that are visited at rest, or else for \
         at most {MAX_COUPLED} targets and {MAX_WHEELS} enabled wheels"
    );
    let hint = "leave targets out, have them visited at rest, or leave windows, values and latest_end_s \
                out and compare the times of the plan with them";
    Problem::new("", Code::ClockNotPlanned, message, hint)
}

/// Solves a scenario with windows, values or a latest end, in which nothing is impossible by itself.
pub(super) fn solve_schedule(scenario: &Scenario, run: Run<'_>) -> Outcome {
    let begin = Instant::now();
    let places = Places::of(scenario);
    let stop = limited(scenario, run.stop);
    let solver = LegSolver::new(&places, run, &stop);
    let tours = Tours::new(&places, &solver, &stop);
    solver.report_begin();
    let planning = || Planning::new(&tours, run, begin);
    if leaves_nothing_free(&places) {
        return planning().with_legs_alone();
    }
    let at_rest = scenario.targets().iter().all(Target::rests);
    let stopping = at_rest.then(|| {
        let relaxed = planning().relaxed();
        let places = Places::stopping(scenario);
        let solver = LegSolver::new(&places, run, &stop);
        let tours = Tours::new(&places, &solver, &stop);
        let planning = Planning {
            relaxed: Some(relaxed),
            ..Planning::new(&tours, run, begin)
        };
        planning.with_legs_alone()
    });
    match stopping {
        Some(outcome) if is_final(&outcome) || stop.is_set() || !is_plannable(&places) => outcome,
        Some(outcome) => better(outcome, planning().with_programs()),
        None if is_plannable(&places) => planning().with_programs(),
        None => Outcome::Failed(vec![not_planned()]),
    }
}

/// Whether nothing more is to be found out.
fn is_final(outcome: &Outcome) -> bool {
    match outcome {
        Outcome::Planned(plan) => plan.optimality == Optimality::Optimal,
        Outcome::Infeasible(_) => true,
        Outcome::Failed(_) | Outcome::StoppedEmpty => false,
    }
}

/// The better one of two answers to the same question.
fn better(one: Outcome, other: Outcome) -> Outcome {
    let rank = |outcome: &Outcome| match outcome {
        Outcome::Planned(plan) => {
            let value = plan
                .schedule
                .as_ref()
                .map_or(0.0, |schedule| schedule.value);
            Some((value, -plan.total_time_s))
        }
        _ => None,
    };
    match (rank(&one), rank(&other)) {
        (Some(first), Some(second)) if first > second => one,
        (Some(_), None) => one,
        _ => other,
    }
}

/// A bound on the ends of schedules, s, with which one that ends at some time, s, is as good as the best.
fn enough_s(places: &Places<'_>, end_s: f64) -> f64 {
    let gap = places.scenario.options().relative_gap;
    end_s * (1.0 - gap.max(SAME_END))
}

struct Planning<'a> {
    problem: TimedProblem,
    limits: SearchLimits,
    tours: &'a Tours<'a>,
    builder: PlanBuilder<'a>,
    stop: &'a StopSignal,
    run: Run<'a>,
    /// The best schedule reported.
    told: Mutex<Option<TimedOrder>>,
    /// The bounds that hold, where the schedules looked for are not all that there are.
    relaxed: Option<TimedResult>,
}

impl<'a> Planning<'a> {
    fn new(tours: &'a Tours<'a>, run: Run<'a>, begin: Instant) -> Self {
        let scenario = tours.places.scenario;
        Self {
            problem: timed_problem(scenario),
            limits: SearchLimits {
                labels_of_a_run: labels_in_time(MAX_LABELS, scenario.targets().len()),
                labels: scenario.options().node_limit,
                seed: scenario.options().seed,
                ..SearchLimits::default()
            },
            builder: PlanBuilder::new(tours, run, begin),
            tours,
            stop: tours.stop,
            run,
            told: Mutex::default(),
            relaxed: None,
        }
    }
}

impl Planning<'_> {
    /// Reports the bounds, and a schedule if it is better than those before.
    fn tell(&self, now: &TimedResult, chains: Option<&[SolvedChain]>) {
        let now = &self.with_bounds_that_hold(now.clone());
        let Some(best) = &now.best else {
            return self.report(Stage::Search, now);
        };
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        let better = told.as_ref().is_none_or(|known| {
            let by_value = best.value.total_cmp(&known.value);
            by_value
                .then_with(|| known.end_s.total_cmp(&best.end_s))
                .is_gt()
        });
        if !better {
            return;
        }
        *told = Some(best.clone());
        self.report(Stage::Search, now);
        self.builder.set_clock(ClockFacts {
            value: best.value,
            value_bound: now.value_bound,
            skipped: untried(self.tours.places.scenario, &best.order),
            chains: chains.map(<[SolvedChain]>::to_vec),
        });
        self.builder.improved(&incumbent(&solved(best), now));
    }

    /// The order of the best schedule reported; empty without one.
    fn told_order(&self) -> Vec<usize> {
        let told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        told.as_ref()
            .map_or_else(Vec::new, |best| best.order.clone())
    }

    fn report(&self, stage: Stage, now: &TimedResult) {
        let best = now.best.as_ref();
        self.run.observer.progress(Progress {
            stage,
            done: now.labels,
            total: None,
            incumbent_s: best.map(|best| best.end_s),
            lower_bound_s: Some(now.end_bound_s).filter(|bound| *bound > 0.0),
            value: best.map(|best| best.value),
            value_bound: Some(now.value_bound),
        });
    }

    /// The plan of the best schedule, or why there is none.
    fn conclude(&mut self, found: &TimedResult, chains: Option<&[SolvedChain]>) -> Outcome {
        let times = |from, to| self.time_s(from, to);
        let found = &self.with_bounds_that_hold(found.clone());
        let Some(best) = &found.best else {
            return if self.stop.is_set() {
                Outcome::StoppedEmpty
            } else if found.complete {
                Outcome::Infeasible(conflict(self.tours.places, &self.problem, &times))
            } else {
                unsolved(self.tours)
            };
        };
        self.report(Stage::Verify, found);
        let inclusions = Inclusions {
            problem: &self.problem,
            times: &times,
            limits: self.limits,
            stop: self.stop,
            is_flown: &|order| chains.is_none() && self.is_flown(order),
        };
        let facts = ClockFacts {
            value: best.value,
            value_bound: found.value_bound,
            skipped: inclusions.of(self.tours.places.scenario, best, found.complete),
            chains: chains.map(<[SolvedChain]>::to_vec),
        };
        let order = solved(best);
        self.builder.compare_with_rest(&order);
        self.builder.set_clock(facts);
        self.builder
            .scheduled_outcome(&incumbent(&order, found), found.complete)
    }

    /// What was found, with the bounds on all schedules in place of those on the schedules looked for.
    fn with_bounds_that_hold(&self, mut found: TimedResult) -> TimedResult {
        let Some(relaxed) = &self.relaxed else {
            return found;
        };
        let known = found
            .best
            .as_ref()
            .map_or((0.0, 0.0), |best| (best.value, best.end_s));
        found.value_bound = relaxed.value_bound.max(known.0);
        let most = relaxed.best.as_ref().map_or(0.0, |best| best.value);
        let about_time = relaxed.complete && most <= known.0;
        found.end_bound_s = if about_time {
            relaxed.end_bound_s.min(known.1)
        } else {
            0.0
        };
        let enough = |best: &TimedOrder| enough_s(self.tours.places, best.end_s);
        found.complete = match &found.best {
            Some(best) => about_time && found.end_bound_s >= enough(best),
            None => relaxed.complete && relaxed.best.is_none(),
        };
        found
    }

    /// The search on lower bounds of the times of legs.
    fn relaxed(&self) -> TimedResult {
        if self.tours.places.needs_all_legs() {
            self.solve_all_legs();
        }
        let times = |from, to| self.time_s(from, to);
        let limits = self.limits_on_bounds();
        search(
            &self.problem,
            &times,
            limits,
            &|| self.stop.is_set(),
            &mut |_| (),
        )
    }

    /// The limits of a search on bounds, after which legs are solved.
    fn limits_on_bounds(&self) -> SearchLimits {
        let some = labels_in_time(LABELS_OF_BOUNDS, self.problem.targets.len());
        SearchLimits {
            labels: Some(self.limits.labels.unwrap_or(some)),
            ..self.limits
        }
    }

    /// Lower bound on the time of a leg, s: its time where its program has converged, else the certified one.
    fn time_s(&self, from: Place, to: Place) -> f64 {
        self.tours.leg_bound(from, to)
    }

    /// Time of a leg as it is flown, s, once its solution has been looked for. A leg without one is not flown,
    /// which proves nothing of schedules with it.
    fn flown_s(&self, from: Place, to: Place) -> Option<f64> {
        let leg = self.tours.known_free_leg(from, to)?.leg;
        Some(leg.solution.duration().unwrap_or(NO_LEG_S))
    }

    /// Whether no leg of an order is longer as it is flown than in the search on bounds.
    fn is_flown(&self, order: &[usize]) -> bool {
        let route = self.tours.places.route(order, true);
        route.windows(2).all(|leg| {
            let known = self.tours.known_free_leg(leg[0], leg[1]);
            known.is_none_or(|known| known.leg.solution.least_duration().is_some())
        })
    }

    /// Solves all legs between places, each with the conditions of its own ends only.
    fn solve_all_legs(&self) {
        let mut pairs = tour_pairs(self.tours.places);
        if self.tours.has_end() {
            // All targets may be left out.
            pairs.push((Place::Start, Place::End));
        }
        self.tours.certified.raise(&pairs);
        self.tours.solve_free_legs(&pairs);
    }
}

fn solved(best: &TimedOrder) -> SolvedOrder {
    SolvedOrder {
        order: best.order.clone(),
        duration_s: best.end_s,
    }
}

fn incumbent<'a>(best: &'a SolvedOrder, now: &TimedResult) -> Incumbent<'a> {
    Incumbent {
        best,
        alternatives: &[],
        lower_bound_s: now.end_bound_s,
        statistics: SearchStatistics {
            nodes_explored: now.labels,
            ..SearchStatistics::default()
        },
    }
}
