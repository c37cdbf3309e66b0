//! Best-first search of the extremals that reach a turn.

use super::RatePolytope;
use super::cells::Target;
use super::dwells;
use super::pairs::LevelPair;
use nalgebra::{Unit, UnitQuaternion, Vector3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Width, rad, below which cells are not split.
const NARROW: f64 = 1e-11;
/// Number of cells after which a search ends with what it has proved. Ordinary ones take hundreds; the smaller
/// a turn the more, as its cells must be as small.
const MAX_CELLS: usize = 10_000;

/// A part of a great circle in which an extremal may last `least`.
struct Cell {
    least: f64,
    pair: usize,
    range: [f64; 2],
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The cell with the least bound is the greatest, and so the first of a heap.
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        other.least.total_cmp(&self.least)
    }
}

/// The least time of a turn, normalised, enclosed.
pub(super) struct Enclosure {
    pub(super) lower: f64,
    pub(super) upper: f64,
}

/// The least time of a turn by a positive angle less than a half turn and a bit, to a relative tolerance.
pub(super) fn search(
    polytope: &RatePolytope,
    turn: UnitQuaternion<f64>,
    axis: &Unit<Vector3<f64>>,
    tolerance: f64,
) -> Enclosure {
    let curves = &polytope.curves;
    let gauge = |vector: &Vector3<f64>| polytope.gauge(vector);
    let mut target = Target {
        curves,
        turn,
        back: turn.inverse().to_rotation_matrix().into_inner(),
        upper: gauge(&turn.scaled_axis()),
    };
    let mut pairs: Vec<LevelPair> = Vec::new();
    let mut ranges = Vec::new();
    let mut unfollowed = f64::INFINITY;
    let count = curves.circles.len();
    for vertices in (0..count).flat_map(|first| (0..count).map(move |last| [first, last])) {
        let Some(parts) = LevelPair::parts(curves, vertices, &turn, axis) else {
            continue;
        };
        for (t, level) in parts.saddles {
            let at = parts.pair.at(t, curves, &target.back);
            let dwelling = dwells::follow(&target, &at, level, gauge);
            target.upper = dwelling.least.unwrap_or(target.upper);
            unfollowed = unfollowed.min(dwelling.unfollowed);
        }
        ranges.extend(parts.ranges.into_iter().map(|range| (pairs.len(), range)));
        pairs.push(parts.pair);
    }
    let mut cells: BinaryHeap<Cell> = BinaryHeap::new();
    let mut evaluated = ranges.len();
    for (pair, range) in ranges {
        let least = target.least_time(&pairs[pair], range);
        cells.extend(least.map(|least| Cell { least, pair, range }));
    }
    // Every motion that is faster than the best one known is an extremal of one of the cells.
    while let Some(cell) = cells.pop() {
        if cell.least >= target.upper.min(unfollowed) {
            break;
        }
        if let Some(time) = target.attained(&pairs[cell.pair], cell.range, gauge) {
            target.upper = target.upper.min(time);
        }
        let [from, to] = cell.range;
        let is_close = cell.least >= target.upper * (1.0 - tolerance);
        if is_close || to - from < NARROW || evaluated > MAX_CELLS {
            return Enclosure {
                lower: cell.least.min(target.upper).min(unfollowed),
                upper: target.upper,
            };
        }
        let middle = 0.5 * (from + to);
        for range in [[from, middle], [middle, to]] {
            evaluated += 1;
            if let Some(least) = target.least_time(&pairs[cell.pair], range) {
                cells.push(Cell {
                    least: least.max(cell.least),
                    range,
                    ..cell
                });
            }
        }
    }
    Enclosure {
        lower: target.upper.min(unfollowed),
        upper: target.upper,
    }
}
