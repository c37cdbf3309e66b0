//! Solves a scenario for a prescribed order of its targets.

use super::additive_tours::LegTimes;
use super::clock::not_planned;
use super::legs::LegSolver;
use super::places::Places;
use super::plan_builder::PlanBuilder;
use super::tour_bound::route_bound;
use super::tours::Tours;
use super::unsolved::unsolved;
use super::{Run, feasibility_problems, limited};
use crate::model::plan::Outcome;
use crate::model::scenario::Scenario;
use crate::run::progress::Continued;
use crate::tour::order::{Place, SolvedOrder, TourEvaluation, TourModel};
use std::time::Instant;

/// Where the lower bound on the tours in a prescribed order comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundFrom {
    /// The certified bounds of its legs. No leg is solved for it, and the plan has no rest-to-rest
    /// legs for comparison.
    Certificates,
    /// Its legs solved one by one with free ends. This bound is tighter and doubles the work.
    Legs,
}

/// Why a list of indices is refused as an order of a scenario's targets.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OrderError {
    /// The list is not a permutation of the targets' indices.
    #[error("an order lists the indices of all {targets} targets, each of them once")]
    NotAnOrder {
        /// Number of targets.
        targets: usize,
    },
    /// The scenario's positions and precedences do not admit it.
    #[error("the order breaks a position or precedence that the scenario demands")]
    NotAdmitted,
}

/// Solves the minimum-time tour of the targets in a prescribed order: torques, bound and
/// verification, without a search.
///
/// `order` lists indices into [`Scenario::targets`]; the work is linear in their number. The flight
/// equals that of [`super::solve`] for the same order. The bound holds for this order only, so the
/// plan is never called optimal.
///
/// # Errors
///
/// When `order` does not name every target exactly once, or breaks
/// [`Scenario::order_rules`].
pub fn solve_order(
    scenario: &Scenario,
    order: &[usize],
    bound: BoundFrom,
    run: Run<'_>,
) -> Result<Outcome, OrderError> {
    let targets = scenario.targets().len();
    let mut named = order.to_vec();
    named.sort_unstable();
    if !named.into_iter().eq(0..targets) {
        return Err(OrderError::NotAnOrder { targets });
    }
    if !scenario.order_rules().admits(order) {
        return Err(OrderError::NotAdmitted);
    }
    Ok(solve_admitted(scenario, order, bound, run))
}

fn solve_admitted(scenario: &Scenario, order: &[usize], bound: BoundFrom, run: Run<'_>) -> Outcome {
    let begin = Instant::now();
    let problems = feasibility_problems(scenario);
    if !problems.is_empty() {
        return Outcome::Infeasible(problems);
    }
    if scenario.has_clock() {
        return Outcome::Failed(vec![not_planned()]);
    }
    let observer = Continued::new(run.observer);
    let run = Run {
        observer: &observer,
        ..run
    };
    let stop = limited(scenario, run.stop);
    let places = Places::of(scenario);
    let route = places.route(order, true);
    let solver = LegSolver::new(&places, run, &stop);
    let pairs = legs_of(&places, &route);
    let tours = Tours::new(&places, &solver, &stop);
    tours.certified.raise(&pairs);
    let certified = route_bound(&places, &tours.certified, &route);
    solver.report_bounds(None, certified);
    if bound == BoundFrom::Legs {
        tours.solve_free_legs(&pairs);
    }
    match tours.tour(order) {
        TourEvaluation::Solved(duration_s) | TourEvaluation::Flyable(duration_s) => {
            let order = order.to_vec();
            let solved = SolvedOrder { order, duration_s };
            let bounds = route.windows(2).map(|leg| tours.pair_bound(leg[0], leg[1]));
            // The bound of a leg whose solve failed is not a number, for which the maximum gives 0.
            let lower_bound_s = bounds.map(|bound| bound.max(0.0)).sum();
            let mut builder = PlanBuilder::new(&tours, run, begin);
            builder.set_certified_bound(certified);
            if bound == BoundFrom::Legs {
                builder.compare_with_rest(&solved);
            }
            builder.fixed_order_outcome(&solved, lower_bound_s)
        }
        TourEvaluation::Stopped => Outcome::StoppedEmpty,
        TourEvaluation::Unresolved => unsolved(&tours),
    }
}

/// The legs between neighbours of a route, and those between places that become neighbours because
/// a place covered by its neighbour is no waypoint.
fn legs_of(places: &Places<'_>, route: &[Place]) -> Vec<(Place, Place)> {
    let mut legs = Vec::new();
    for (i, from) in route.iter().enumerate() {
        for (j, to) in route.iter().enumerate().skip(i + 1) {
            legs.push((*from, *to));
            let next = route.get(j + 1);
            let joined = next.is_some_and(|next| places.are_one_stop(*to, *next));
            if !joined && !places.are_one_stop(*from, *to) {
                break;
            }
        }
    }
    legs
}
