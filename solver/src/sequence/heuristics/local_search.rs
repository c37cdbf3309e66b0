//! 2-opt and Or-opt over the pair table, first improvement, for tables that need not be symmetric.

use crate::sequence::PairTable;
use crate::stop::StopSignal;

/// A move must shorten the order by this share of its length, lest rounding makes it go in circles.
const LEAST_GAIN: f64 = 1e-9;
/// Longest segment that Or-opt moves, the length that the literature settled on.
const LONGEST_SEGMENT: usize = 3;
/// Improving moves per target at most; local search needs a few, and must not run for ever.
const MOVES_PER_TARGET: usize = 50;

/// An order with start and end attached and the lengths of all its beginnings both ways, so that
/// any segment is measured in constant time.
struct Path<'a> {
    table: &'a PairTable,
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

/// Shortens the way from a place through some targets to the end until no move helps or the solve
/// is stopped.
pub(super) fn improve(
    table: &PairTable,
    from: usize,
    order: Vec<usize>,
    stop: &StopSignal,
) -> Vec<usize> {
    let limit = MOVES_PER_TARGET * order.len();
    let mut path = Path::new(table, from, order);
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
    fn new(table: &'a PairTable, from: usize, order: Vec<usize>) -> Self {
        let mut places = order;
        places.insert(0, from);
        places.push(table.end());
        let mut path = Self {
            table,
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
                if self.helps(change) {
                    return Some(Move::Reverse(first, last));
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
                    if self.helps(opening + kept) {
                        return Some(Move::Shift(first, last, after, false));
                    }
                    let turned = self.leg(after, last) + self.leg(first, after + 1);
                    if self.helps(opening + turned + self.turning(first, last)) {
                        return Some(Move::Shift(first, last, after, true));
                    }
                }
            }
        }
        None
    }

    fn apply(&mut self, step: &Move) {
        match *step {
            Move::Reverse(first, last) => self.places[first..=last].reverse(),
            Move::Shift(first, last, after, turned) => {
                let mut segment: Vec<usize> = self.places.drain(first..=last).collect();
                if turned {
                    segment.reverse();
                }
                let gap = if after < first {
                    after + 1
                } else {
                    after + 1 - segment.len()
                };
                self.places.splice(gap..gap, segment);
            }
        }
        self.measure();
    }
}
