//! From a scenario to a verified plan.

mod assemble;
mod canonical;
mod certificate;
mod certified;
mod conclude;
mod extent;
mod first;
mod fixed_order;
mod from_store;
mod imported;
mod lagrangian;
mod legs;
mod memory;
mod places;
mod segments;
mod starts;
mod summed;
mod tables;
mod torques;
mod tours;
mod verified;
mod work;

use crate::model::plan::Outcome;
use crate::model::problem::{Code, Problem};
use crate::model::scenario::Scenario;
use crate::nlp::Interruption;
use crate::run::pool::SolverPool;
use crate::run::progress::Observer;
use crate::run::stop::{StopReason, StopSignal};
use crate::tour::legs::{LegKind, LegStore, SegmentStore};
use crate::tour::order::{FlownOrder, Place, SearchSettings, exhaustive, search};
use crate::wheels::envelope::{OutsideEnvelope, momentum_problems, outside_envelope};
use certified::tour_bound;
use conclude::PlanBuilder;
use first::{first_order, first_tour};
use legs::LegSolver;
use places::Places;
use std::time::{Duration, Instant};
use tables::CertifiedLeg;
use tours::Tours;

pub use certificate::{
    CheckedCertificate, LegCertificate, Objection, Obstacle, PlanCertificate, Verdict, certify_plan,
};
pub use fixed_order::{BoundFrom, OrderError, fly_order};
pub use imported::{ImportedLeg, LegCheck};
pub use memory::memory_estimate;

/// What a solve needs from its surroundings.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Where the work is done.
    pub pool: &'a SolverPool,
    /// Polled for reasons to stop.
    pub stop: &'a StopSignal,
    /// Told about progress.
    pub observer: &'a dyn Observer,
    /// Asked for legs before they are solved, and told about solved ones.
    pub legs: &'a dyn LegStore,
    /// Asked for segments of this scenario's tours before they are solved, and told about solved
    /// ones.
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
    /// No slew under the conditions takes less, s, proved; `None` where nothing is.
    pub certified_lower_bound_s: Option<f64>,
    /// Wall-clock time of the solve with all starts, refinement and verification, s.
    pub solve_time_s: f64,
    /// How the solve ended (`converged`, ...); of [`LegKind::Certified`] whether there is a bound
    /// (`proved`, `none`).
    pub status: String,
}

/// A part of the table: entries `i` with `i % of == index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Zero-based index of the part.
    pub index: usize,
    /// Number of parts.
    pub of: usize,
}

/// Up to so many targets the certified bounds of all legs take less time than a first tour.
const FEW: usize = 40;

/// Solves a scenario: order, torques, bound, verification.
#[must_use]
pub fn solve(scenario: &Scenario, run: Run<'_>) -> Outcome {
    let begin = Instant::now();
    let problems = feasibility_problems(scenario);
    if !problems.is_empty() {
        return Outcome::Infeasible(problems);
    }
    let stop = limited(scenario, run.stop);
    let places = Places::of(scenario);
    let pairs = tour_pairs(&places);
    let solver = LegSolver::new(&places, run, &stop);
    let tours = Tours::new(&places, &solver, &stop);
    let mut conclusions = PlanBuilder::new(&tours, run, begin);
    solver.tell_begin();
    let prove = || {
        let bounds = solver.certified_table(LegKind::LowerBound, &pairs);
        let certified = tour_bound(&places, &bounds, run.pool, &stop);
        tours.prove(bounds);
        certified
    };
    let order = first_order(&tours, &stop);
    if let Some(order) = order.clone()
        && places.dynamics.has_momentum()
    {
        // With momentum a first tour may take its time, or find no end.
        conclusions.construct(order);
    }
    // Whichever is sooner done.
    let few = scenario.targets().len() <= FEW;
    if few {
        conclusions.prove(prove());
    }
    let first = order.and_then(|order| first_tour(&tours, order));
    if let Some(first) = &first {
        conclusions.announce(first);
        solver.tell(Some(first.duration_s), conclusions.proved());
    }
    if !few {
        conclusions.prove(prove());
    }
    solver.tell(None, conclusions.proved());
    tours.know(solver.table(LegKind::LowerBound, &pairs));
    let settings = SearchSettings {
        alternatives: scenario.options().alternatives,
        relative_gap: scenario.options().relative_gap,
        node_limit: scenario.options().node_limit,
        ..SearchSettings::default()
    };
    let known: Vec<_> = first.into_iter().collect();
    let found = search(&tours, &known, &settings, run.pool, &stop, &conclusions);
    match &found.best {
        Some(best) => {
            conclusions.compare_with_rest(best);
            conclusions.outcome(best, &found)
        }
        None => conclusions
            .constructed(found.statistics)
            .unwrap_or_else(|| {
                if stop.is_set() {
                    Outcome::StoppedEmpty
                } else {
                    Outcome::Failed(unsolved(&tours))
                }
            }),
    }
}

/// Flies every order of the targets and lists them, best first: the answer that the search of
/// [`solve`] must find with less work.
///
/// For a handful of targets only. Orders that do not converge, or are not reached before the stop
/// signal, are left out.
#[must_use]
pub fn every_order(scenario: &Scenario, run: Run<'_>) -> Vec<FlownOrder> {
    let stop = limited(scenario, run.stop);
    let places = Places::of(scenario);
    let solver = LegSolver::new(&places, run, &stop);
    let tours = Tours::new(&places, &solver, &stop);
    // As many alternatives as there are orders; of more than twenty targets nobody sees the last.
    let orders = (1..=scenario.targets().len()).fold(1, usize::saturating_mul);
    exhaustive(&tours, orders, run.pool)
}

/// Solves all legs between start, targets and end, both directions listed.
///
/// When stopped early the table holds what was finished and the flag is false.
#[must_use]
pub fn leg_table(
    scenario: &Scenario,
    kind: LegKind,
    shard: Shard,
    run: Run<'_>,
) -> (Vec<LegRow>, bool) {
    let stop = limited(scenario, run.stop);
    let places = Places::of(scenario);
    let pairs: Vec<_> = all_pairs(&places)
        .into_iter()
        .enumerate()
        .filter(|(i, _)| i % shard.of.max(1) == shard.index)
        .map(|(_, pair)| pair)
        .collect();
    let solver = LegSolver::new(&places, run, &stop);
    let rows: Vec<_> = if kind == LegKind::Certified {
        let rows = certified_rows(&solver, &pairs);
        rows.into_iter().flatten().collect()
    } else {
        let table = solver.table(kind, &pairs);
        let row = |(from, to): &(Place, Place)| {
            let leg = &table.get(*from, *to)?.leg;
            Some(LegRow {
                from: places.name(*from),
                to: places.name(*to),
                kind,
                duration_s: leg.flown.duration(),
                certified_lower_bound_s: leg.certified,
                solve_time_s: leg.solve_time,
                status: leg.flown.status.into_str().into(),
            })
        };
        pairs.iter().filter_map(row).collect()
    };
    let complete = rows.len() == pairs.len();
    (rows, complete)
}

/// What is proved of the legs between pairs of places at full rest, without solving any; `None` for
/// those that the stop signal prevents.
///
/// The places must be those of the scenario.
#[must_use]
pub fn certified_legs(
    scenario: &Scenario,
    pairs: &[(Place, Place)],
    run: Run<'_>,
) -> Vec<Option<LegRow>> {
    let stop = limited(scenario, run.stop);
    let places = Places::of(scenario);
    certified_rows(&LegSolver::new(&places, run, &stop), pairs)
}

/// The rows of a table without any program.
fn certified_rows(solver: &LegSolver<'_>, pairs: &[(Place, Place)]) -> Vec<Option<LegRow>> {
    let kind = LegKind::Certified;
    let legs = solver.certified_legs(kind, pairs);
    let places = solver.places();
    let row = |((from, to), leg): (&(Place, Place), CertifiedLeg)| LegRow {
        from: places.name(*from),
        to: places.name(*to),
        kind,
        duration_s: None,
        certified_lower_bound_s: leg.lower_bound,
        solve_time_s: leg.solve_time,
        status: leg.lower_bound.map_or("none", |_| "proved").into(),
    };
    let legs = pairs.iter().zip(legs);
    legs.map(|(pair, leg)| Some(row((pair, leg?)))).collect()
}

/// What can be said against a valid scenario before it is solved: rests that the wheels cannot
/// hold, for example.
#[must_use]
pub fn feasibility_problems(scenario: &Scenario) -> Vec<Problem> {
    momentum_problems(scenario)
}

/// The stop signal with the scenario's own time limit.
fn limited(scenario: &Scenario, stop: &StopSignal) -> StopSignal {
    match scenario.options().time_limit_s {
        Some(limit) => stop.with_time_limit(Duration::from_secs_f64(limit)),
        None => stop.clone(),
    }
}

/// What a stop signal means to a solve under way: whoever wants the best answer so far no longer
/// wants this one.
fn interruption(stop: &StopSignal) -> Option<Interruption> {
    stop.reason().map(|reason| match reason {
        StopReason::TimeLimit => Interruption::TimeLimit,
        StopReason::Requested | StopReason::Cancelled => Interruption::Cancelled,
    })
}

/// All ordered pairs of places, in the order of a table.
fn all_pairs(places: &Places<'_>) -> Vec<(Place, Place)> {
    let all = places.all();
    all.iter()
        .flat_map(|from| all.iter().map(move |to| (*from, *to)))
        .filter(|(from, to)| from != to)
        .collect()
}

/// The ordered pairs that a tour may fly.
fn tour_pairs(places: &Places<'_>) -> Vec<(Place, Place)> {
    let all = places.all();
    let alone = places.scenario.targets().is_empty();
    all.iter()
        .flat_map(|from| all.iter().map(move |to| (*from, *to)))
        .filter(|(from, to)| from != to && *from != Place::End && *to != Place::Start)
        .filter(|(from, to)| alone || !(*from == Place::Start && *to == Place::End))
        .collect()
}

/// Why no order could be flown: the legs that found no solution.
fn unsolved(tours: &Tours<'_>) -> Vec<Problem> {
    let all = tours.places.all();
    let mut problems: Vec<_> = all
        .iter()
        .flat_map(|from| all.iter().map(move |to| (*from, *to)))
        .filter_map(|(from, to)| {
            let leg = &tours.free()?.get(from, to)?.leg;
            leg.flown.duration().is_none().then(|| {
                let reason = outside(tours, from, to).map(|outside| format!("; {outside}"));
                let message = format!(
                    "the slew from {} to {} ended with status {} after {} iterations, its \
                     conditions violated by {:.1e} (scaled){}",
                    tours.places.name(from),
                    tours.places.name(to),
                    leg.flown.status,
                    leg.flown.iterations,
                    leg.flown.infeasibility,
                    reason.unwrap_or_default(),
                );
                Problem::new(pointer_of(to), Code::SlewNotSolved, message, SLEW_HINT)
            })
        })
        .collect();
    if problems.is_empty() {
        let message = "every leg has a solution, but no whole order converged";
        problems.push(Problem::new(
            "/targets",
            Code::SlewNotSolved,
            message,
            SLEW_HINT,
        ));
    }
    problems
}

/// Where on the turn between two places the momentum lies outside the envelope of the wheels.
fn outside(tours: &Tours<'_>, from: Place, to: Place) -> Option<OutsideEnvelope> {
    let places = &tours.places;
    let [from, to] = [from, to].map(|place| places.waypoint(place).attitude);
    let turn = from.signed_turn_to(&places.arrival.signed(&to, &from));
    outside_envelope(places.scenario, &from, turn)
}

const SLEW_HINT: &str =
    "check that the wheels can hold the stored momentum along the way, or relax the conditions";

fn pointer_of(place: Place) -> String {
    match place {
        Place::Start => "/start".into(),
        Place::Target(i) => format!("/targets/{i}"),
        Place::End => "/end".into(),
    }
}
