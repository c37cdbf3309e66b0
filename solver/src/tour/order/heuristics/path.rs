//! An order that moves change, with the change of cost of a move.

use super::cost::{OrderCost, ReducedLegs};
use std::ops::RangeInclusive;

/// Stands for the missing place before the first one and after the last one.
const NOWHERE: usize = usize::MAX;

/// A change of the order. Positions count the place before the order as 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Move {
    /// Reverse the places from one position to another.
    Reverse(usize, usize),
    /// Exchange two adjacent segments, each reversed or not.
    Exchange {
        /// First position of the first segment.
        first: usize,
        /// Last position of the first segment.
        middle: usize,
        /// Last position of the second segment.
        last: usize,
        /// Whether the first segment is reversed.
        reverse_first: bool,
        /// Whether the second segment is reversed.
        reverse_second: bool,
    },
}

impl Move {
    /// First and last position of the places that move.
    pub(super) fn range(self) -> RangeInclusive<usize> {
        match self {
            Self::Reverse(first, last) | Self::Exchange { first, last, .. } => first..=last,
        }
    }
}

/// Positions of the first and the last place of a segment, in the direction of travel.
type SegmentEnds = (usize, usize);

/// An order with the places before and after it.
pub(super) struct OrderPath<'a, C> {
    cost: &'a C,
    legs: ReducedLegs,
    places: Vec<usize>,
    /// Position of every place.
    positions: Vec<usize>,
    /// Whether reversing a segment changes the cost of its inside.
    directed: bool,
    /// For each position the excess cost of all legs up to it in reverse, s; empty unless directed.
    leg_skews: Vec<f64>,
    /// For each position the excess cost of all couplings up to it in reverse, s; empty unless
    /// directed.
    coupling_skews: Vec<f64>,
}

/// A running sum of costs along some segments.
struct Walk {
    before: usize,
    at: usize,
    sum: f64,
}

impl<'a, C: OrderCost> OrderPath<'a, C> {
    /// The path from a place through some targets and to the end.
    pub(super) fn new(cost: &'a C, from: usize, order: &[usize]) -> Self {
        let legs = ReducedLegs::new(cost, from, order);
        let end = cost.targets() + 1;
        let mut path = Self {
            directed: !(legs.are_symmetric() && cost.couplings_are_symmetric()),
            cost,
            legs,
            places: [&[from], order, &[end]].concat(),
            positions: vec![NOWHERE; end + 1],
            leg_skews: Vec::new(),
            coupling_skews: Vec::new(),
        };
        if path.directed {
            path.leg_skews = vec![0.0; path.places.len()];
            path.coupling_skews = vec![0.0; path.places.len()];
        }
        path.update(0..=path.places.len() - 1);
        path
    }

    /// The targets in order.
    pub(super) fn order(&self) -> &[usize] {
        &self.places[1..self.places.len() - 1]
    }

    /// The order with its two outer places.
    pub(super) fn places(&self) -> &[usize] {
        &self.places
    }

    /// Position of a place.
    pub(super) fn position(&self, place: usize) -> usize {
        self.positions[place]
    }

    /// The reduced legs.
    pub(super) fn legs(&self) -> &ReducedLegs {
        &self.legs
    }

    /// Cost of the order, s.
    pub(super) fn length(&self) -> f64 {
        super::cost::length(self.cost, self.places[0], self.order())
    }

    fn place(&self, position: usize) -> usize {
        self.places.get(position).copied().unwrap_or(NOWHERE)
    }

    fn coupling(&self, from: usize, via: usize, to: usize) -> f64 {
        if from == NOWHERE || to == NOWHERE {
            0.0
        } else {
            self.cost.coupling(from, via, to)
        }
    }

    /// Coupling at a position, s.
    fn coupling_at(&self, position: usize) -> f64 {
        let before = self.place(position.wrapping_sub(1));
        self.coupling(before, self.places[position], self.place(position + 1))
    }

    /// Cost of the joint after a position: the leg and the couplings at both its ends, s.
    pub(super) fn joint(&self, position: usize) -> f64 {
        self.legs
            .leg(self.places[position], self.places[position + 1])
            + self.coupling_at(position)
            + self.coupling_at(position + 1)
    }

    /// Change of the cost by a move, s.
    pub(super) fn change(&self, step: Move) -> f64 {
        match step {
            Move::Reverse(first, last) => {
                let range = (first, last);
                self.joint_costs(range, [(last, first)]) - self.joint_costs(range, [range])
                    + self.reversal_change((first, last))
            }
            Move::Exchange {
                first,
                middle,
                last,
                reverse_first,
                reverse_second,
            } => {
                let range = (first, last);
                let pieces = [(first, middle), (middle + 1, last)];
                let turned =
                    |piece: SegmentEnds, turn| if turn { (piece.1, piece.0) } else { piece };
                let inside = |piece, turn| {
                    if turn {
                        self.reversal_change(piece)
                    } else {
                        0.0
                    }
                };
                let after = [
                    turned(pieces[1], reverse_second),
                    turned(pieces[0], reverse_first),
                ];
                self.joint_costs(range, after) - self.joint_costs(range, pieces)
                    + inside(pieces[0], reverse_first)
                    + inside(pieces[1], reverse_second)
            }
        }
    }

    /// Cost of the joints when these segments replace the places at a range of positions, s. The
    /// legs and couplings inside the segments are not part of it.
    fn joint_costs<const N: usize>(&self, range: (usize, usize), pieces: [SegmentEnds; N]) -> f64 {
        let mut walk = Walk {
            before: self.place(range.0.wrapping_sub(2)),
            at: self.places[range.0 - 1],
            sum: 0.0,
        };
        for (enter, leave) in pieces {
            self.step(&mut walk, self.places[enter]);
            if enter != leave {
                // The couplings at the two ends of a segment belong to its joints.
                let forth = enter < leave;
                let second = if forth { enter + 1 } else { enter - 1 };
                let penultimate = if forth { leave - 1 } else { leave + 1 };
                walk.sum += self.coupling(walk.before, walk.at, self.places[second]);
                walk.before = self.places[penultimate];
                walk.at = self.places[leave];
            }
        }
        self.step(&mut walk, self.places[range.1 + 1]);
        walk.sum + self.coupling(walk.before, walk.at, self.place(range.1 + 2))
    }

    fn step(&self, walk: &mut Walk, to: usize) {
        walk.sum += self.legs.leg(walk.at, to) + self.coupling(walk.before, walk.at, to);
        walk.before = walk.at;
        walk.at = to;
    }

    /// Change of the cost inside a segment when it is reversed, s.
    fn reversal_change(&self, (first, last): SegmentEnds) -> f64 {
        if !self.directed || first == last {
            return 0.0;
        }
        self.leg_skews[last] - self.leg_skews[first] + self.coupling_skews[last - 1]
            - self.coupling_skews[first]
    }

    /// Makes a move.
    pub(super) fn apply(&mut self, step: Move) {
        match step {
            Move::Reverse(first, last) => self.places[first..=last].reverse(),
            Move::Exchange {
                first,
                middle,
                last,
                reverse_first,
                reverse_second,
            } => {
                if reverse_first {
                    self.places[first..=middle].reverse();
                }
                if reverse_second {
                    self.places[middle + 1..=last].reverse();
                }
                self.places[first..=last].rotate_left(middle + 1 - first);
            }
        }
        self.update(step.range());
    }

    /// Calls a test with the order as it would be after a move, and leaves the order unchanged.
    pub(super) fn preview(&mut self, step: Move, test: impl FnOnce(&[usize]) -> bool) -> bool {
        let before = self.places[step.range()].to_vec();
        self.apply(step);
        let passed = test(self.order());
        self.restore(*step.range().start(), &before);
        passed
    }

    /// Sets the places from a position on; they must be a permutation of the places there.
    pub(super) fn restore(&mut self, first: usize, places: &[usize]) {
        if !places.is_empty() {
            self.places[first..first + places.len()].copy_from_slice(places);
            self.update(first..=first + places.len() - 1);
        }
    }

    /// Updates the positions and sums that depend on the places at a range of positions.
    fn update(&mut self, range: RangeInclusive<usize>) {
        for position in range.clone() {
            self.positions[self.places[position]] = position;
        }
        if self.directed {
            self.sum_skews(*range.start());
        }
    }

    /// Sums the skews from a position on. Legs and couplings at the outer places are never reversed
    /// and have none.
    fn sum_skews(&mut self, first: usize) {
        let last_target = self.places.len() - 2;
        for position in first.max(2) - 1..=last_target {
            let at = self.places[position];
            let before = self.places[position - 1];
            let (mut leg, mut coupling) = (0.0, 0.0);
            if position > 1 {
                leg = self.legs.leg(at, before) - self.legs.leg(before, at);
            }
            if position > 1 && position < last_target {
                let after = self.places[position + 1];
                coupling =
                    self.cost.coupling(after, at, before) - self.cost.coupling(before, at, after);
            }
            self.leg_skews[position] = self.leg_skews[position - 1] + leg;
            self.coupling_skews[position] = self.coupling_skews[position - 1] + coupling;
        }
    }
}
