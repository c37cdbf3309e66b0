//! Bounds on legs at whose ends only an axis is pointed: the least bound over all admissible rolls.
//!
//! Within a box of rates `p` a roll by `d` about a body axis `b` takes `d max_i |b_i| / p_i` at a constant
//! rate, and least times obey the triangle inequality. So the least time of the turn between two rolls,
//! less that of the rolls by half the widths of a cell around them, is a lower bound for all rolls in the
//! cell ([`GivenAway`]). The cell with the least bound is halved again and again (branch and bound); the
//! result holds whenever that ends.

use crate::bounds::kinematic::strongest::GivenAway;
use crate::model::waypoint::Waypoint;
use nalgebra::Matrix3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

/// Cells into which the rolls of an end are divided at first.
const FIRST_CELLS: u32 = 8;
/// Bounds computed for one leg, per free end more than the first one a multiple.
const BUDGET: usize = 64;
const BUDGET_OF_BOTH: usize = 256;
/// Half width of a cell, rad, below which it is not divided.
const NARROW: f64 = 2e-3;

/// The least bound, s, over the rolls of both ends; `bound` is given two ends with the half widths of
/// the cell around their rolls. `None` where nothing is proved.
pub(super) fn least_over_rolls(
    ends: [&Waypoint; 2],
    bound: impl Fn([&Waypoint; 2], [f64; 2]) -> Option<f64>,
) -> Option<f64> {
    let bounded = |middles: [f64; 2], halves: [f64; 2], least: f64| {
        let rolled = [0, 1].map(|end| ends[end].rolled(middles[end]));
        let bound_s = bound(rolled.each_ref(), halves)?.max(least);
        Some(Cell {
            middles,
            halves,
            bound_s,
        })
    };
    let [first, second] = ends.map(cells);
    let mut open = BinaryHeap::new();
    for (begin, begin_half) in &first {
        for (arrival, arrival_half) in &second {
            open.push(bounded(
                [*begin, *arrival],
                [*begin_half, *arrival_half],
                0.0,
            )?);
        }
    }
    let budget = if first.len() > 1 && second.len() > 1 {
        BUDGET_OF_BOTH
    } else {
        BUDGET
    };
    let mut left = budget.saturating_sub(open.len());
    while left >= 2 {
        let Some(cell) = open.peek() else { break };
        let wider = usize::from(cell.halves[1] > cell.halves[0]);
        if cell.halves[wider] <= NARROW {
            break;
        }
        let Some(cell) = open.pop() else { break };
        let mut halves = cell.halves;
        halves[wider] *= 0.5;
        for side in [-1.0, 1.0] {
            let mut middles = cell.middles;
            middles[wider] += side * halves[wider];
            open.push(bounded(middles, halves, cell.bound_s)?);
        }
        left -= 2;
    }
    open.peek().map(|least| least.bound_s)
}

/// What is given away in the axes of a frame, given as columns, for the cell around the rolls of two ends.
pub(super) fn given_away(ends: [&Waypoint; 2], halves: [f64; 2], axes: &Matrix3<f64>) -> GivenAway {
    let turns = [0, 1].map(|end| {
        let axis = ends[end].roll.map(|roll| axes.tr_mul(&roll.axis).abs());
        axis.unwrap_or_default() * halves[end]
    });
    GivenAway { turns }
}

/// Middles and half widths of the first cells of an end.
fn cells(end: &Waypoint) -> Vec<(f64, f64)> {
    let Some(free) = &end.roll else {
        return vec![(0.0, 0.0)];
    };
    let [least, greatest] = free.range.unwrap_or([-PI, PI]);
    let half = 0.5 * (greatest - least) / f64::from(FIRST_CELLS);
    let middle = |i: u32| least + half * f64::from(2 * i + 1);
    (0..FIRST_CELLS).map(|i| (middle(i), half)).collect()
}

/// Rolls of both ends with a bound, s, that holds for all of them; the least one is first in a heap.
struct Cell {
    middles: [f64; 2],
    halves: [f64; 2],
    bound_s: f64,
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound_s.total_cmp(&self.bound_s)
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Eq for Cell {}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
