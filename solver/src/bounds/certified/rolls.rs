//! Bounds on legs at whose ends only an axis is pointed: the least bound over all admissible rolls.
//!
//! Within a box of rates `p` a roll by `d` about a body axis `b` takes `d max_i |b_i| / p_i` at a constant
//! rate, and least times obey the triangle inequality. So the least time of the turn between two rolls,
//! less that of the rolls by half the widths of a cell around them, is a lower bound for all rolls in the
//! cell ([`GivenAway`]). The cell with the least bound is halved again and again (branch and bound); the
//! result holds whenever that ends.

use super::BoundAround;
use crate::bounds::kinematic::strongest::GivenAway;
use crate::model::waypoint::Waypoint;
use nalgebra::Matrix3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

/// Cells into which an arc of rolls is divided at first.
const FIRST_CELLS: u32 = 6;
/// Cells divided for each free end.
const DIVISIONS: usize = 160;
/// Half width of a cell, rad, below which it is not divided.
const NARROW: f64 = 2e-3;

/// The least bound, s, over the rolls of both ends; `around` is given two ends with the half widths of a
/// cell around their rolls. `None` where nothing is proved.
///
/// Of the first cells the strongest bound is sought; the parts of a cell have that of the same box.
pub(super) fn least_over_rolls(
    ends: [&Waypoint; 2],
    around: impl Fn([&Waypoint; 2], [f64; 2]) -> Option<BoundAround>,
) -> Option<f64> {
    let rolled = |middles: [f64; 2]| [0, 1].map(|end| ends[end].rolled(middles[end]));
    let [first, second] = ends.map(cells);
    let (mut bounds, mut open) = (Vec::new(), BinaryHeap::new());
    for (begin, begin_half) in &first {
        for (arrival, arrival_half) in &second {
            let (middles, halves) = ([*begin, *arrival], [*begin_half, *arrival_half]);
            let bound = around(rolled(middles).each_ref(), halves)?;
            open.push(Cell {
                middles,
                halves,
                bound_s: bound.bound_s,
                within: bounds.len(),
            });
            bounds.push(bound);
        }
    }
    let free = ends.iter().filter(|end| end.roll.is_some()).count();
    for _ in 0..DIVISIONS * free {
        let Some(cell) = open.pop() else { break };
        let wider = usize::from(cell.halves[1] > cell.halves[0]);
        if cell.halves[wider] <= NARROW {
            open.push(cell);
            break;
        }
        let mut halves = cell.halves;
        halves[wider] *= 0.5;
        for side in [-1.0, 1.0] {
            let mut middles = cell.middles;
            middles[wider] += side * halves[wider];
            let part = bounds[cell.within].between(rolled(middles).each_ref(), halves)?;
            open.push(Cell {
                middles,
                halves,
                bound_s: cell.bound_s.max(part),
                ..cell
            });
        }
    }
    open.peek().map(|least| least.bound_s)
}

/// What is given away in the axes of a frame, given as columns, for the cell around the rolls of two ends.
pub(super) fn given_away(ends: [&Waypoint; 2], halves: [f64; 2], axes: &Matrix3<f64>) -> GivenAway {
    let turns = [0, 1].map(|end| {
        let axis = ends[end]
            .roll
            .as_ref()
            .map(|roll| axes.tr_mul(&roll.axis).abs());
        axis.unwrap_or_default() * halves[end]
    });
    GivenAway { turns }
}

/// Middles and half widths of the first cells of an end.
fn cells(end: &Waypoint) -> Vec<(f64, f64)> {
    let Some(free) = &end.roll else {
        return vec![(0.0, 0.0)];
    };
    let cut = |[least, greatest]: [f64; 2]| {
        let half = 0.5 * (greatest - least) / f64::from(FIRST_CELLS);
        let middle = move |i: u32| least + half * f64::from(2 * i + 1);
        (0..FIRST_CELLS).map(move |i| (middle(i), half))
    };
    match free.arcs.as_slice() {
        [] => cut([-PI, PI]).collect(),
        arcs => arcs.iter().copied().flat_map(cut).collect(),
    }
}

/// Rolls of both ends with a bound, s, that holds for all of them; the least one is first in a heap.
struct Cell {
    middles: [f64; 2],
    halves: [f64; 2],
    bound_s: f64,
    /// The first cell in which it lies.
    within: usize,
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
