//! Legs between waypoints at which only an axis is pointed: the starting rolls.
//!
//! A program moves a free roll to the nearest minimum; which one that is, depends on the guess. So the
//! durations of eigenaxis slews between rolls on a grid are compared. The local minima of this estimate
//! are starts, fastest first by their kinematic extremals. A rough motion from each shows which of them
//! lead to the same minimum, and which to a slow one.

mod grid;
mod rough;
mod route;

use super::{LegOutcome, LegProblem, solve_from_attitudes};
use crate::model::waypoint::{Waypoint, nearest_rolls};
use crate::run::stop::StopReason;
use grid::Grid;
pub(crate) use rough::promising;
pub(crate) use route::rolled_routes;

/// Number of starts of a leg, and the ratio of their estimates to the least one up to which there are
/// several.
const MAX_STARTS: usize = 4;
const PROMISING: f64 = 1.15;
/// The same with momentum, of which the estimates know nothing.
const MAX_STARTS_WITH_MOMENTUM: usize = 8;
const PROMISING_WITH_MOMENTUM: f64 = 1.6;
/// Starts that are solved after a rough motion from each.
const MAX_REFINED: usize = 3;
/// Relative gap to a lower bound at which no other start is tried.
const MAX_GAP: f64 = 0.001;

/// The best solution of a leg from several starting rolls.
pub(super) fn solve_from_rolls(
    leg: &LegProblem<'_>,
    bound: Option<f64>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegOutcome {
    let mut starts = starts(leg);
    let mut solves = 0;
    if leg.dynamics.cones.is_empty() && starts.len() > 1 {
        solves += starts.len() as u64;
        starts = promising(leg, starts, MAX_REFINED, stop);
    }
    let mut best: Option<LegOutcome> = None;
    let is_settled = |best: &LegOutcome| {
        let duration = best.solution.duration();
        let both = bound.zip(duration);
        stop().is_some() || both.is_some_and(|(bound, found)| found <= (1.0 + MAX_GAP) * bound)
    };
    for ends in &starts {
        if best.as_ref().is_some_and(is_settled) {
            break;
        }
        let rolled = leg.between(&ends[0], &ends[1]);
        let found = if leg.dynamics.cones.is_empty() {
            solve_from_attitudes(&rolled, bound, stop)
        } else {
            solve_around_cones(&rolled, stop)
        };
        solves += found.solves;
        let known = best.as_ref().map(|best| &best.solution);
        if known.is_none_or(|known| found.solution.improves(known)) {
            best = Some(found);
        }
    }
    let best = best.expect("there is always the shortest turn");
    LegOutcome { solves, ..best }
}

/// The solution around cones with the rolls of the attitudes first, then from there with free ones.
fn solve_around_cones(leg: &LegProblem<'_>, stop: &dyn Fn() -> Option<StopReason>) -> LegOutcome {
    let ends = [leg.from, leg.to].map(Waypoint::pinned);
    let mut found = solve_from_attitudes(&leg.between(&ends[0], &ends[1]), None, stop);
    if found.solution.duration().is_some() && stop().is_none() {
        let intervals = found.solution.intervals.clone();
        let freed = leg.solve_with(&intervals, &found.solution.profile, stop);
        found.solves += 1;
        if freed.improves(&found.solution) {
            found.solution = freed;
        }
    }
    found
}

/// The ends of a leg, described from the rolls of its starts, the fastest first.
fn starts(leg: &LegProblem<'_>) -> Vec<Vec<Waypoint>> {
    let grids = [leg.from, leg.to].map(Grid::of);
    let table = grids[0].durations_to(&grids[1], leg.dynamics);
    let mut minima = Vec::new();
    for (i, row) in table.iter().enumerate() {
        for (j, own) in row.iter().enumerate() {
            let mut around = grids[0].around(i);
            let is_least = around.all(|a| grids[1].around(j).all(|b| *own <= table[a][b]));
            if is_least {
                let ends = [&grids[0].waypoints[i], &grids[1].waypoints[j]];
                let turn = ends[0].attitude.turn_to(&ends[1].attitude);
                let extremal = leg.extremals.duration_s(&turn).unwrap_or(*own);
                minima.push((extremal, ends));
            }
        }
    }
    minima.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let (most, count) = if leg.dynamics.has_momentum() {
        (PROMISING_WITH_MOMENTUM, MAX_STARTS_WITH_MOMENTUM)
    } else {
        (PROMISING, MAX_STARTS)
    };
    let most = most * minima.first().map_or(0.0, |(least, _)| *least);
    let promising = minima.iter().take_while(|(estimate, _)| *estimate <= most);
    let promising = promising.take(count);
    let mut starts = vec![nearest_rolls(leg.from, leg.to).into()];
    starts.extend(promising.map(|(_, ends)| ends.map(Waypoint::clone).into()));
    starts
}
