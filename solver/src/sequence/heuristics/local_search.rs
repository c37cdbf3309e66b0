//! 2-opt and Or-opt over the pair table, first improvement, for tables that need not be symmetric.

use crate::sequence::PairTable;
use crate::stop::StopSignal;

/// A move must shorten the order by this share of its length, lest rounding makes it go in circles.
const LEAST_GAIN: f64 = 1e-9;
/// Longest segment that Or-opt moves, the length that the literature settled on.
const LONGEST_SEGMENT: usize = 3;
/// Improving moves per target at most; local search needs a few, and must not run for ever.
const MOVES_PER_TARGET: usize = 50;

/// The way through the targets of an order with start and end attached and the lengths of all its beginnings both ways, so that
/// any segment is measured in constant time.
struct Path<'a> {
    table: &'a PairTable,
    /// What was visited before the first place.
    visited: &'a [usize],
    places: Vec<usize>,
    /// Length from the first place to each, s.
    forth: Vec<f64>,
    /// Length of the way back from each to the first, s.
    back: Vec<f64>,
}

/// What a move does to the places.
enum Move {
    /// Reverse the places from the first to the last of these positions.
    Reverse(usize, usize),
    /// Move the segment between the two positions to just after the third, reversed or not.
    Shift(usize, usize, usize, bool),
}

/// Shortens the way from the end of a prefix through the remaining targets to the end until no move
/// helps or the solve is stopped. Moves that break the rules are refused.
pub(super) fn improve(
    table: &PairTable,
    prefix: &[usize],
    order: Vec<usize>,
    stop: &StopSignal,
) -> Vec<usize> {
    let limit = MOVES_PER_TARGET * order.len();
    let mut path = Path::new(table, prefix, order);
    for _ in 0..limit {
        if stop.is_set() {
            break;
        }
        let Some(step) = path.reversal().or_else(|| path.shift()) else {
            break;
        };
        path.apply(&step);
    }
    path.into_order()
}

impl<'a> Path<'a> {
    fn new(table: &'a PairTable, prefix: &'a [usize], order: Vec<usize>) -> Self {
        let mut places = order;
        places.insert(0, table.last_place(prefix));
        places.push(table.end());
        let mut path = Self {
            table,
            visited: prefix,
            places,
            forth: Vec::new(),
            back: Vec::new(),
        };
        path.measure();
        path
    }

    fn into_order(mut self) -> Vec<usize> {
        self.places.pop();
        self.places.remove(0);
        self.places
    }

    fn measure(&mut self) {
        let (mut forth, mut back) = (0.0, 0.0);
        self.forth = vec![0.0];
        self.back = vec![0.0];
        for leg in self.places.windows(2) {
            forth += self.table.bound(leg[0], leg[1]);
            back += self.table.bound(leg[1], leg[0]);
            self.forth.push(forth);
            self.back.push(back);
        }
    }

    /// Leg between the places at two positions, s.
    fn leg(&self, from: usize, to: usize) -> f64 {
        self.table.bound(self.places[from], self.places[to])
    }

    /// What turning a segment round adds to its inside, s.
    fn turning(&self, first: usize, last: usize) -> f64 {
        (self.back[last] - self.back[first]) - (self.forth[last] - self.forth[first])
    }

    fn helps(&self, change: f64) -> bool {
        change < -LEAST_GAIN * self.forth[self.forth.len() - 1]
    }

    /// The first reversal that helps.
    fn reversal(&self) -> Option<Move> {
        let end = self.places.len() - 1;
        for first in 1..end {
            for last in first + 1..end {
                let change = self.leg(first - 1, last) + self.leg(first, last + 1)
                    - self.leg(first - 1, first)
                    - self.leg(last, last + 1)
                    + self.turning(first, last);
                let step = Move::Reverse(first, last);
                if self.helps(change) && self.admits(&step) {
                    return Some(step);
                }
            }
        }
        None
    }

    /// The first shift of a short segment that helps.
    fn shift(&self) -> Option<Move> {
        let end = self.places.len() - 1;
        for first in 1..end {
            for last in first..(first + LONGEST_SEGMENT).min(end) {
                let closing = self.leg(first - 1, last + 1)
                    - self.leg(first - 1, first)
                    - self.leg(last, last + 1);
                for after in (0..first - 1).chain(last + 1..end) {
                    let opening = closing - self.leg(after, after + 1);
                    let kept = self.leg(after, first) + self.leg(last, after + 1);
                    let step = Move::Shift(first, last, after, false);
                    if self.helps(opening + kept) && self.admits(&step) {
                        return Some(step);
                    }
                    let turned = self.leg(after, last) + self.leg(first, after + 1);
                    let step = Move::Shift(first, last, after, true);
                    let change = opening + turned + self.turning(first, last);
                    if self.helps(change) && self.admits(&step) {
                        return Some(step);
                    }
                }
            }
        }
        None
    }

    /// Whether the order keeps the rules after a move.
    fn admits(&self, step: &Move) -> bool {
        let rules = self.table.rules();
        let moved = || {
            let mut places = self.places.clone();
            step.apply(&mut places);
            [self.visited, &places[1..places.len() - 1]].concat()
        };
        rules.is_free() || rules.admits(&moved())
    }

    fn apply(&mut self, step: &Move) {
        step.apply(&mut self.places);
        self.measure();
    }
}

impl Move {
    fn apply(&self, places: &mut Vec<usize>) {
        match *self {
            Self::Reverse(first, last) => places[first..=last].reverse(),
            Self::Shift(first, last, after, turned) => {
                let mut segment: Vec<usize> = places.drain(first..=last).collect();
                if turned {
                    segment.reverse();
                }
                let gap = if after < first {
                    after + 1
                } else {
                    after + 1 - segment.len()
                };
                places.splice(gap..gap, segment);
            }
        }
    }
}
