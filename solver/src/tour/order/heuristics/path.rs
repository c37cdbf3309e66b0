//! An order under change: what a move would cost, and the move itself.

use super::cost::{Legs, OrderCost};
use std::ops::RangeInclusive;

/// Stands for the place before the first and after the last.
const NOWHERE: usize = usize::MAX;

/// A change of the order. Positions count the place before the order as 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Move {
    /// Turn round what lies between two positions.
    Reverse(usize, usize),
    /// Exchange two adjacent segments, each turned round or not.
    Exchange {
        /// First position of the first segment.
        first: usize,
        /// Last position of the first segment.
        middle: usize,
        /// Last position of the second segment.
        last: usize,
        /// Whether the first segment is turned.
        turn_first: bool,
        /// Whether the second segment is turned.
        turn_second: bool,
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
type Piece = (usize, usize);

/// An order with the places before and after it.
pub(super) struct Path<'a, C> {
    cost: &'a C,
    legs: Legs,
    places: Vec<usize>,
    /// Position of every place.
    positions: Vec<usize>,
    /// Whether turning a segment round changes the cost of its inside.
    directed: bool,
    /// For each position what all legs up to it cost more backwards, s; empty unless directed.
    leg_skews: Vec<f64>,
    /// For each position what all bends up to it cost more backwards, s; empty unless directed.
    bend_skews: Vec<f64>,
}

/// The sum along some pieces.
struct Walk {
    before: usize,
    at: usize,
    sum: f64,
}

impl<'a, C: OrderCost> Path<'a, C> {
    /// The way from a place through some targets and to the end.
    pub(super) fn new(cost: &'a C, from: usize, order: &[usize]) -> Self {
        let legs = Legs::new(cost, from, order);
        let end = cost.targets() + 1;
        let mut path = Self {
            directed: !(legs.are_symmetric() && cost.bends_alike_both_ways()),
            cost,
            legs,
            places: [&[from], order, &[end]].concat(),
            positions: vec![NOWHERE; end + 1],
            leg_skews: Vec::new(),
            bend_skews: Vec::new(),
        };
        if path.directed {
            path.leg_skews = vec![0.0; path.places.len()];
            path.bend_skews = vec![0.0; path.places.len()];
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

    /// The charged legs.
    pub(super) fn legs(&self) -> &Legs {
        &self.legs
    }

    /// Cost of the order, s.
    pub(super) fn length(&self) -> f64 {
        super::cost::length(self.cost, self.places[0], self.order())
    }

    fn place(&self, position: usize) -> usize {
        self.places.get(position).copied().unwrap_or(NOWHERE)
    }

    fn bend(&self, from: usize, via: usize, to: usize) -> f64 {
        if from == NOWHERE || to == NOWHERE {
            0.0
        } else {
            self.cost.bend(from, via, to)
        }
    }

    /// Bend at a position, s.
    fn bend_at(&self, position: usize) -> f64 {
        let before = self.place(position.wrapping_sub(1));
        self.bend(before, self.places[position], self.place(position + 1))
    }

    /// Cost of the joint after a position: the leg and the bends at both its ends, s.
    pub(super) fn joint(&self, position: usize) -> f64 {
        self.legs
            .leg(self.places[position], self.places[position + 1])
            + self.bend_at(position)
            + self.bend_at(position + 1)
    }

    /// What a move adds to the cost, s.
    pub(super) fn change(&self, step: Move) -> f64 {
        match step {
            Move::Reverse(first, last) => {
                let range = (first, last);
                self.toll(range, [(last, first)]) - self.toll(range, [range])
                    + self.turning((first, last))
            }
            Move::Exchange {
                first,
                middle,
                last,
                turn_first,
                turn_second,
            } => {
                let range = (first, last);
                let pieces = [(first, middle), (middle + 1, last)];
                let turned = |piece: Piece, turn| if turn { (piece.1, piece.0) } else { piece };
                let inside = |piece, turn| if turn { self.turning(piece) } else { 0.0 };
                let after = [
                    turned(pieces[1], turn_second),
                    turned(pieces[0], turn_first),
                ];
                self.toll(range, after) - self.toll(range, pieces)
                    + inside(pieces[0], turn_first)
                    + inside(pieces[1], turn_second)
            }
        }
    }

    /// Cost of travelling the pieces in place of what lies at a range of positions, their insides
    /// excepted, s.
    fn toll<const N: usize>(&self, range: (usize, usize), pieces: [Piece; N]) -> f64 {
        let mut walk = Walk {
            before: self.place(range.0.wrapping_sub(2)),
            at: self.places[range.0 - 1],
            sum: 0.0,
        };
        for (enter, leave) in pieces {
            self.step(&mut walk, self.places[enter]);
            if enter != leave {
                // The bends at the two ends of a piece belong to its joints.
                let forth = enter < leave;
                let second = if forth { enter + 1 } else { enter - 1 };
                let penultimate = if forth { leave - 1 } else { leave + 1 };
                walk.sum += self.bend(walk.before, walk.at, self.places[second]);
                walk.before = self.places[penultimate];
                walk.at = self.places[leave];
            }
        }
        self.step(&mut walk, self.places[range.1 + 1]);
        walk.sum + self.bend(walk.before, walk.at, self.place(range.1 + 2))
    }

    fn step(&self, walk: &mut Walk, to: usize) {
        walk.sum += self.legs.leg(walk.at, to) + self.bend(walk.before, walk.at, to);
        walk.before = walk.at;
        walk.at = to;
    }

    /// What turning a segment round adds to its inside, s.
    fn turning(&self, (first, last): Piece) -> f64 {
        if !self.directed || first == last {
            return 0.0;
        }
        self.leg_skews[last] - self.leg_skews[first] + self.bend_skews[last - 1]
            - self.bend_skews[first]
    }

    /// Makes a move.
    pub(super) fn apply(&mut self, step: Move) {
        match step {
            Move::Reverse(first, last) => self.places[first..=last].reverse(),
            Move::Exchange {
                first,
                middle,
                last,
                turn_first,
                turn_second,
            } => {
                if turn_first {
                    self.places[first..=middle].reverse();
                }
                if turn_second {
                    self.places[middle + 1..=last].reverse();
                }
                self.places[first..=last].rotate_left(middle + 1 - first);
            }
        }
        self.update(step.range());
    }

    /// Shows the order as it would be after a move.
    pub(super) fn preview(&mut self, step: Move, look: impl FnOnce(&[usize]) -> bool) -> bool {
        let before = self.places[step.range()].to_vec();
        self.apply(step);
        let seen = look(self.order());
        self.restore(*step.range().start(), &before);
        seen
    }

    /// Puts places back to the positions from one on; together they must be those that are there.
    pub(super) fn restore(&mut self, first: usize, places: &[usize]) {
        if !places.is_empty() {
            self.places[first..first + places.len()].copy_from_slice(places);
            self.update(first..=first + places.len() - 1);
        }
    }

    /// Brings up to date what follows from the places at a range of positions.
    fn update(&mut self, range: RangeInclusive<usize>) {
        for position in range.clone() {
            self.positions[self.places[position]] = position;
        }
        if self.directed {
            self.sum_skews(*range.start());
        }
    }

    /// Sums the skews from a position on. What touches the outer places is never turned and has
    /// none.
    fn sum_skews(&mut self, first: usize) {
        let last_target = self.places.len() - 2;
        for position in first.max(2) - 1..=last_target {
            let at = self.places[position];
            let before = self.places[position - 1];
            let (mut leg, mut bend) = (0.0, 0.0);
            if position > 1 {
                leg = self.legs.leg(at, before) - self.legs.leg(before, at);
            }
            if position > 1 && position < last_target {
                let after = self.places[position + 1];
                bend = self.cost.bend(after, at, before) - self.cost.bend(before, at, after);
            }
            self.leg_skews[position] = self.leg_skews[position - 1] + leg;
            self.bend_skews[position] = self.bend_skews[position - 1] + bend;
        }
    }
}
