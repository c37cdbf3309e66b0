//! From a scenario to a verified plan.

mod additive_tours;
mod assemble;
mod bounds_by_form;
mod canonical;
mod certificate;
mod clock;
mod first_tour;
mod fixed_order;
mod flight_times;
mod from_store;
mod guesses;
mod history;
mod imported;
mod lagrangian;
mod leg_time_table;
mod leg_trials;
mod legs;
mod legs_ahead;
mod memory;
mod needless_time;
mod places;
mod plan_builder;
mod proved_legs;
mod scheduled;
mod segment_key;
mod segment_solve;
mod solved_segments;
mod strongest;
mod tables;
#[cfg(test)]
mod tests;
mod torques;
mod tour_bound;
mod tours;
mod turn_estimates;
mod unsolved;
mod verified;

use crate::model::plan::Outcome;
use crate::model::problem::Problem;
use crate::model::scenario::{Scenario, cone_problems};
use crate::run::pool::SolverPool;
use crate::run::progress::{Continued, Observer};
use crate::run::stop::StopSignal;
use crate::tour::legs::{LegKind, LegStore, SegmentStore};
use crate::tour::order::{
    KnownOrders, Place, SearchSettings, SolvedOrder, TourModel, exhaustive, search,
};
use crate::wheels::envelope::momentum_problems;
use additive_tours::LegTimes;
use first_tour::{first_order, first_tour};
use legs::LegSolver;
use places::{Places, places_of};
use plan_builder::PlanBuilder;
use std::collections::{HashMap, HashSet};
use std::time::{Duration, Instant};
use tour_bound::tour_bound;
use tours::Tours;
use unsolved::unsolved;

pub use canonical::cones_of;
pub use certificate::{
    CheckedCertificate, LegCertificate, Objection, Obstacle, PlanCertificate, Verdict,
    verify_certificate,
};
pub use fixed_order::{BoundFrom, OrderError, solve_order};
pub use imported::LegCheck;
pub use leg_time_table::{LegTime, LegTimeTable};
pub use leg_trials::{GuessNode, LegAnswer, LegTrial, LegTrials};
pub use memory::memory_estimate;
pub use strongest::{ProofEffort, StrongestBound, StrongestBounds, strongest_bounds};

/// What a solve needs from its surroundings.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Threads that do the work.
    pub pool: &'a SolverPool,
    /// Polled while solving; ends the work when it is set.
    pub stop: &'a StopSignal,
    /// Receives progress, incumbents and contradictions.
    pub observer: &'a dyn Observer,
    /// Consulted before a leg is solved; receives solved legs.
    pub legs: &'a dyn LegStore,
    /// Consulted before a segment of this scenario's tours is solved; receives solved segments.
    pub segments: &'a dyn SegmentStore,
}

/// One entry of the table of leg times.
#[derive(Debug, Clone, PartialEq)]
pub struct LegRow {
    /// `start` or a target's identifier.
    pub from: String,
    /// A target's identifier or `end`.
    pub to: String,
    /// The boundary conditions.
    pub kind: LegKind,
    /// Minimum time, s, when solved; never of [`LegKind::Certified`].
    pub duration_s: Option<f64>,
    /// Certified lower bound on the duration of any slew under these conditions, s; `None` where no
    /// bound is proved.
    pub certified_lower_bound_s: Option<f64>,
    /// Wall-clock time of the solve with all starts, refinement and verification, s.
    pub solve_time_s: f64,
    /// How the solve ended (`converged`, ...); for [`LegKind::Certified`] whether there is a bound
    /// (`proved`, `none`).
    pub status: String,
    /// Whether the store knew it.
    pub from_store: bool,
}

/// A part of the table: entries `i` with `i % of == index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Zero-based index of the part.
    pub index: usize,
    /// Number of parts.
    pub of: usize,
}

/// Solves a scenario: order, torques, lower bound and verification.
#[must_use]
pub fn solve(scenario: &Scenario, run: Run<'_>) -> Outcome {
    let begin = Instant::now();
    let problems = feasibility_problems(scenario);
    if !problems.is_empty() {
        return Outcome::Infeasible(problems);
    }
    let observer = Continued::new(run.observer);
    let run = Run {
        observer: &observer,
        ..run
    };
    if scenario.has_clock() {
        return clock::solve_schedule(scenario, run);
    }
    let stop = limited(scenario, run.stop);
    let places = Places::of(scenario);
    let solver = LegSolver::new(&places, run, &stop);
    let tours = Tours::new(&places, &solver, &stop);
    let mut builder = PlanBuilder::new(&tours, run, begin);
    solver.report_begin();
    let bound_tours = || tour_bound(&places, &tours.certified, run.pool, &stop);
    let order = first_order(&tours, &stop);
    let few = places.needs_all_legs();
    let coupled = !few && tours.has_couplings();
    // Of very many targets nobody asks for all pairs, which would take more memory than what is known of them.
    let pairs = if few || (!coupled && places.affords_all_bounds()) {
        tour_pairs(&places)
    } else {
        Vec::new()
    };
    if let Some(order) = order.clone()
        && (places.dynamics.has_momentum() || !(few || stop.is_set()))
    {
        // With momentum the program of a first tour may take long or fail; with many targets it takes
        // long.
        builder.construct(order);
    }
    if few {
        tours.certified.raise(&pairs);
        builder.set_certified_bound(bound_tours());
    }
    // The program of a tour of many targets whose legs couple takes longer than to find a better order; without
    // any plan it is solved all the same.
    let is_slow = coupled && builder.has_constructed();
    let mut first = order
        .clone()
        .filter(|_| !is_slow)
        .and_then(|order| first_tour(&tours, order));
    if let Some((first, _)) = &first {
        builder.announce(first);
        solver.report_bounds(Some(first.duration_s), builder.certified_bound());
    }
    if !few {
        tours.certified.raise(&pairs);
        // The trees of very many targets keep one worker busy for longer than the program another one.
        let beside = order.clone().filter(|_| {
            is_slow && places.has_very_many_targets() && !places.dynamics.has_momentum()
        });
        let solve = || beside.and_then(|order| first_tour(&tours, order));
        let (tour, bound_s) = run.pool.join(solve, bound_tours);
        builder.set_certified_bound(bound_s);
        if let Some((tour, _)) = &tour {
            builder.announce(tour);
            solver.report_bounds(Some(tour.duration_s), bound_s);
        }
        first = first.or(tour);
    }
    solver.report_bounds(None, builder.certified_bound());
    if few {
        tours.solve_free_legs(&pairs);
    }
    let first = match first {
        Some((first, _)) if few && tours.reconsider(&first.order) => {
            builder.drop_flight();
            first_tour(&tours, first.order)
        }
        first => first,
    };
    let settings = search_settings(scenario);
    let known = KnownOrders {
        evaluated: first
            .as_ref()
            .map(|(first, tour)| (first.order.as_slice(), *tour)),
        first: order.as_deref(),
    };
    let found = search(&tours, known, &settings, run.pool, &stop, &builder);
    match &found.best {
        Some(best) => {
            builder.compare_with_rest(best);
            builder.outcome(best, &found)
        }
        None => builder
            .constructed_outcome(found.statistics)
            .unwrap_or_else(|| {
                if stop.is_set() {
                    Outcome::StoppedEmpty
                } else {
                    unsolved(&tours)
                }
            }),
    }
}

/// What the options of a scenario ask of the search.
fn search_settings(scenario: &Scenario) -> SearchSettings {
    SearchSettings {
        alternatives: scenario.options().alternatives,
        relative_gap: scenario.options().relative_gap,
        node_limit: scenario.options().node_limit,
        ..SearchSettings::default()
    }
}

/// Solves the tour of every order of the targets and lists the orders, shortest tour first: the
/// reference for the search of [`solve`].
///
/// For a handful of targets only. Orders whose tour does not converge, or that are not reached
/// before the stop signal, are left out.
#[must_use]
pub fn every_order(scenario: &Scenario, run: Run<'_>) -> Vec<SolvedOrder> {
    let stop = limited(scenario, run.stop);
    let places = Places::of(scenario);
    let solver = LegSolver::new(&places, run, &stop);
    let tours = Tours::new(&places, &solver, &stop);
    // With them tours are compared, as in the search.
    tours.solve_free_legs(&tour_pairs(&places));
    // As many alternatives as there are orders; the factorial saturates beyond twenty targets.
    let orders = (1..=scenario.targets().len()).fold(1, usize::saturating_mul);
    exhaustive(&tours, orders, run.pool)
}

/// Solves all legs between start, targets and end; both directions of a pair are listed.
///
/// The flag says whether the table is complete: a stopped solve returns the legs finished so far.
#[must_use]
pub fn leg_table(
    scenario: &Scenario,
    kind: LegKind,
    shard: Shard,
    run: Run<'_>,
) -> (Vec<LegRow>, bool) {
    let pairs: Vec<_> = all_pairs(scenario)
        .into_iter()
        .enumerate()
        .filter(|(i, _)| i % shard.of.max(1) == shard.index)
        .map(|(_, pair)| pair)
        .collect();
    let legs = LegTimeTable::of(scenario, kind, run);
    let times = legs.verified(&pairs);
    let rows = pairs.iter().zip(times).filter_map(|((from, to), time)| {
        let time = time?;
        Some(LegRow {
            from: legs.name(*from),
            to: legs.name(*to),
            kind,
            duration_s: time.duration_s,
            certified_lower_bound_s: time.certified_lower_bound_s,
            solve_time_s: time.solve_time_s,
            status: time.status.into(),
            from_store: time.from_store,
        })
    });
    let rows: Vec<_> = rows.collect();
    let complete = rows.len() == pairs.len();
    (rows, complete)
}

/// Canonical text of the spacecraft of a scenario, which its stored legs have.
#[must_use]
pub fn described_spacecraft(scenario: &Scenario) -> String {
    Places::of(scenario).head.spacecraft().to_owned()
}

/// Problems of a valid scenario that are found without solving it: for example a required rest
/// whose momentum the wheels cannot hold, or a target inside an enforced keep-out cone.
#[must_use]
pub fn feasibility_problems(scenario: &Scenario) -> Vec<Problem> {
    let mut problems = momentum_problems(scenario);
    problems.extend(cone_problems(scenario));
    problems
}

/// The stop signal with the scenario's own time limit added.
fn limited(scenario: &Scenario, stop: &StopSignal) -> StopSignal {
    match scenario.options().time_limit_s {
        Some(limit) => stop.with_time_limit(Duration::from_secs_f64(limit)),
        None => stop.clone(),
    }
}

/// All ordered pairs of different places, in the order of a table's rows.
fn all_pairs(scenario: &Scenario) -> Vec<(Place, Place)> {
    let all = places_of(scenario);
    all.iter()
        .flat_map(|from| all.iter().map(move |to| (*from, *to)))
        .filter(|(from, to)| from != to)
        .collect()
}

/// The ordered pairs of places that can be a leg of a tour.
fn tour_pairs(places: &Places<'_>) -> Vec<(Place, Place)> {
    let all = places.all();
    let alone = places.scenario.targets().is_empty();
    all.iter()
        .flat_map(|from| all.iter().map(move |to| (*from, *to)))
        .filter(|(from, to)| from != to && *from != Place::End && *to != Place::Start)
        .filter(|(from, to)| alone || !(*from == Place::Start && *to == Place::End))
        .collect()
}

/// The legs between places of these names; `None` where no tour has such a leg.
fn named_pairs<'n>(
    places: &Places<'_>,
    pairs: &[(Place, Place)],
    names: impl Iterator<Item = [&'n str; 2]>,
) -> Vec<Option<(Place, Place)>> {
    let named: HashMap<String, Place> = places
        .all()
        .into_iter()
        .map(|place| (places.name(place), place))
        .collect();
    let of_tours: HashSet<(Place, Place)> = pairs.iter().copied().collect();
    let pair = |[from, to]: [&str; 2]| {
        let ends = named.get(from).copied().zip(named.get(to).copied());
        ends.filter(|pair| of_tours.contains(pair))
    };
    names.map(pair).collect()
}
