//! Starting rolls of motions between waypoints at which only an axis is pointed.
//!
//! A program moves a free roll to the nearest minimum; which one that is, depends on the guess. So the
//! durations of eigenaxis slews between rolls on a grid are compared. For a leg the local minima of this
//! estimate are starts, fastest first by its kinematic extremals; for a longer motion a dynamic program
//! finds the rolls with the least sum.

use super::{LegOutcome, LegProblem, solve_from_attitudes};
use crate::math::bang_coast_bang::BangCoastBang;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use crate::model::dynamics::Dynamics;
use crate::model::roll::FreeRoll;
use crate::model::waypoint::{Waypoint, nearest_rolls};
use crate::run::stop::StopReason;
use std::f64::consts::TAU;

/// Greatest distance of neighbouring rolls of the grid, rad.
const SPACING: f64 = TAU / 24.0;
/// Number of starts of a leg, and the ratio of their estimates to the least one up to which there are
/// several.
const MAX_STARTS: usize = 4;
const PROMISING: f64 = 1.15;
/// The same with momentum, of which the estimates know nothing.
const MAX_STARTS_WITH_MOMENTUM: usize = 8;
const PROMISING_WITH_MOMENTUM: f64 = 1.6;
/// Relative gap to a lower bound at which no other start is tried.
const MAX_GAP: f64 = 0.001;

/// The best solution of a leg from several starting rolls.
pub(super) fn solve_from_rolls(
    leg: &LegProblem<'_>,
    bound: Option<f64>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegOutcome {
    let mut best: Option<LegOutcome> = None;
    let mut solves = 0;
    let is_settled = |best: &LegOutcome| {
        let duration = best.solution.duration();
        let both = bound.zip(duration);
        stop().is_some() || both.is_some_and(|(bound, found)| found <= (1.0 + MAX_GAP) * bound)
    };
    for [from, to] in starts(leg) {
        if best.as_ref().is_some_and(is_settled) {
            break;
        }
        let rolled = LegProblem {
            from: &from,
            to: &to,
            ..*leg
        };
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
    let best = best.expect("a grid has at least one roll");
    LegOutcome { solves, ..best }
}

/// The solution around cones with the rolls of the attitudes first, then from there with free ones.
fn solve_around_cones(leg: &LegProblem<'_>, stop: &dyn Fn() -> Option<StopReason>) -> LegOutcome {
    let ends = [leg.from, leg.to].map(Waypoint::pinned);
    let pinned = LegProblem {
        from: &ends[0],
        to: &ends[1],
        ..*leg
    };
    let mut found = solve_from_attitudes(&pinned, None, stop);
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
fn starts(leg: &LegProblem<'_>) -> Vec<[Waypoint; 2]> {
    let cones = &leg.dynamics.cones;
    let grids = [leg.from, leg.to].map(|end| Grid::of(end).clear_of(cones));
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
    let nearest = nearest_rolls(leg.from, leg.to);
    let mut starts = Vec::new();
    if minima.is_empty() || nearest.iter().all(|end| is_clear(cones, end)) {
        starts.push(nearest);
    }
    starts.extend(promising.map(|(_, ends)| ends.map(Waypoint::clone)));
    starts
}

/// The waypoints of a route, described from rolls at which the slews between them take little time
/// together: the shortest path over the grids of all rolls.
pub(crate) fn rolled_route(dynamics: &Dynamics, route: Vec<Waypoint>) -> Vec<Waypoint> {
    if route.iter().all(|waypoint| waypoint.roll.is_none()) {
        return route;
    }
    let grid = |waypoint| Grid::of(waypoint).clear_of(&dynamics.cones);
    let grids: Vec<Grid> = route.iter().map(grid).collect();
    if grids.iter().any(|grid| grid.waypoints.is_empty()) {
        return route;
    }
    let Some(first) = grids.first() else {
        return route;
    };
    let mut elapsed = vec![0.0; first.waypoints.len()];
    let mut arrivals: Vec<Vec<usize>> = Vec::new();
    for pair in grids.windows(2) {
        let table = pair[0].durations_to(&pair[1], dynamics);
        let best = |to: usize| {
            let from = elapsed
                .iter()
                .zip(&table)
                .map(|(before, row)| before + row[to]);
            let from = from.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b));
            from.expect("a grid has at least one roll")
        };
        let best: Vec<(usize, f64)> = (0..pair[1].waypoints.len()).map(best).collect();
        elapsed = best.iter().map(|(_, elapsed)| *elapsed).collect();
        arrivals.push(best.iter().map(|(from, _)| *from).collect());
    }
    let last = elapsed.iter().enumerate();
    let last = last.min_by(|(_, a), (_, b)| a.total_cmp(b));
    let mut roll = last.map_or(0, |(roll, _)| roll);
    let mut rolled = Vec::with_capacity(grids.len());
    for (i, grid) in grids.iter().enumerate().rev() {
        rolled.push(grid.waypoints[roll].clone());
        if let Some(from) = i.checked_sub(1).map(|before| &arrivals[before]) {
            roll = from[roll];
        }
    }
    rolled.reverse();
    rolled
}

/// A waypoint, described from rolls all over its range; once where the roll is given.
struct Grid {
    waypoints: Vec<Waypoint>,
    /// Whether the last roll is beside the first.
    is_closed: bool,
}

impl Grid {
    fn of(end: &Waypoint) -> Self {
        let range = end.roll.map(|FreeRoll { range, .. }| range);
        let (rolls, is_closed): (Vec<f64>, bool) = match range {
            None => (vec![0.0], false),
            Some(None) => {
                let count = (TAU / SPACING).round();
                let roll = |i: u32| TAU * f64::from(i) / count;
                ((0..count as u32).map(roll).collect(), true)
            }
            Some(Some([least, greatest])) => {
                let parts = ((greatest - least) / SPACING).ceil().max(1.0);
                let roll = |i: u32| least + (greatest - least) * f64::from(i) / parts;
                ((0..=parts as u32).map(roll).collect(), false)
            }
        };
        Self {
            waypoints: rolls.into_iter().map(|roll| end.rolled(roll)).collect(),
            is_closed,
        }
    }

    /// Those that lie in no cone.
    fn clear_of(mut self, cones: &[ForbiddenCone]) -> Self {
        let all = self.waypoints.len();
        if all > 1 {
            self.waypoints.retain(|waypoint| is_clear(cones, waypoint));
        }
        self.is_closed &= self.waypoints.len() == all;
        self
    }

    /// Durations, s, of the slews about the eigenaxis from every roll to every roll of another waypoint.
    fn durations_to(&self, to: &Self, dynamics: &Dynamics) -> Vec<Vec<f64>> {
        let row = |from: &Waypoint| {
            let leg = |to: &Waypoint| eigenaxis_s(dynamics, &from.attitude, &to.attitude);
            to.waypoints.iter().map(leg).collect()
        };
        self.waypoints.iter().map(row).collect()
    }

    /// A roll and its neighbours, by their numbers.
    fn around(&self, at: usize) -> impl Iterator<Item = usize> + '_ {
        let count = self.waypoints.len();
        let beside = [at + count - 1, at + count, at + count + 1].into_iter();
        beside.filter_map(move |at| {
            let inside = (count..2 * count).contains(&at);
            (self.is_closed || inside).then_some(at % count)
        })
    }
}

fn is_clear(cones: &[ForbiddenCone], waypoint: &Waypoint) -> bool {
    cones
        .iter()
        .all(|cone| cone.depth(&waypoint.attitude) <= 0.0)
}

/// Duration, s, of the slew about the eigenaxis from rest to rest without stored momentum.
fn eigenaxis_s(dynamics: &Dynamics, from: &Attitude, to: &Attitude) -> f64 {
    let turn = from.signed_turn_to(&to.nearest_sign(from));
    let angle = turn.norm();
    if angle == 0.0 {
        return 0.0;
    }
    let axis = turn / angle;
    let (acceleration, rate) = (dynamics.axis_acceleration(&axis), dynamics.axis_rate(&axis));
    BangCoastBang::fastest(angle, acceleration, rate).duration()
}

