//! An order that moves change, with the change of cost of a move.

use super::cost::{OrderCost, ReducedLegs};
use super::joints::{Joints, NOWHERE};
use std::ops::RangeInclusive;

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

    /// The segments in their new order.
    fn segments(self) -> impl Iterator<Item = SegmentEnds> {
        let turned = |piece: SegmentEnds, turn| if turn { (piece.1, piece.0) } else { piece };
        let (one, other) = match self {
            Self::Reverse(first, last) => ((last, first), None),
            Self::Exchange {
                first,
                middle,
                last,
                reverse_first,
                reverse_second,
            } => (
                turned((middle + 1, last), reverse_second),
                Some(turned((first, middle), reverse_first)),
            ),
        };
        std::iter::once(one).chain(other)
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
    /// Coupling at each position, s.
    couplings: Vec<f64>,
    /// Whether reversing a segment changes the cost of its inside.
    directed: bool,
    /// For each position the excess cost in reverse of the leg to it and of its coupling, s; empty unless
    /// directed. Legs and couplings at the outer places are never reversed and have none.
    skews: Vec<[f64; 2]>,
    /// Sums of the skews up to each position, s.
    skew_sums: Vec<[f64; 2]>,
}

impl<'a, C: OrderCost> OrderPath<'a, C> {
    /// The path from a place through some targets and to the end.
    pub(super) fn new(cost: &'a C, from: usize, order: &[usize]) -> Self {
        let legs = ReducedLegs::new(cost, from, order);
        let end = cost.targets() + 1;
        let places = [&[from], order, &[end]].concat();
        let directed = !(legs.are_symmetric() && cost.couplings_are_symmetric());
        let skews = vec![[0.0; 2]; if directed { places.len() } else { 0 }];
        let mut path = Self {
            cost,
            legs,
            positions: vec![NOWHERE; end + 1],
            couplings: vec![0.0; places.len()],
            directed,
            skew_sums: skews.clone(),
            skews,
            places,
        };
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

    fn coupling(&self, [from, via, to]: [usize; 3]) -> f64 {
        if from == NOWHERE || to == NOWHERE {
            0.0
        } else {
            self.cost.coupling(from, via, to)
        }
    }

    /// Cost of the leg after a position, s.
    fn leg_after(&self, position: usize) -> f64 {
        self.legs
            .leg(self.places[position], self.places[position + 1])
    }

    /// Cost of the joint after a position: the leg and the couplings at both its ends, s.
    pub(super) fn joint(&self, position: usize) -> f64 {
        self.leg_after(position) + self.couplings[position] + self.couplings[position + 1]
    }

    /// Change of the cost by a move, s.
    pub(super) fn change(&self, step: Move) -> f64 {
        let joints = self.joints(step);
        let couplings = joints.couplings().map(|c| self.coupling(c));
        self.change_without_couplings(step) + couplings.sum::<f64>()
    }

    /// The same if it is below a limit. Most moves are not, already without the couplings that they add,
    /// and these take longest to look up.
    pub(super) fn change_below(&self, limit: f64, step: Move) -> Option<f64> {
        let mut change = self.change_without_couplings(step);
        if change >= limit {
            return None;
        }
        for coupling in self.joints(step).couplings() {
            change += self.coupling(coupling);
            if change >= limit {
                return None;
            }
        }
        Some(change)
    }

    /// Change of the cost by a move but for the couplings at its new joints, s.
    fn change_without_couplings(&self, step: Move) -> f64 {
        let removed = match step {
            Move::Reverse(first, last) => self.joints_after([first - 1, last]),
            Move::Exchange {
                first,
                middle,
                last,
                ..
            } => self.joints_after([first - 1, middle, last]),
        };
        let (first, last) = step.range().into_inner();
        let mut at = self.places[first - 1];
        let mut added = 0.0;
        for (enter, leave) in step.segments() {
            added += self.legs.leg(at, self.places[enter]);
            if leave < enter {
                added += self.reversal_change((leave, enter));
            }
            at = self.places[leave];
        }
        added + self.legs.leg(at, self.places[last + 1]) - removed
    }

    /// Cost of the joints after some ascending positions, s: their legs, and the couplings at their ends.
    fn joints_after<const N: usize>(&self, positions: [usize; N]) -> f64 {
        let mut sum = 0.0;
        let mut counted = 0;
        for position in positions {
            sum += self.leg_after(position);
            for end in position.max(counted)..=position + 1 {
                sum += self.couplings[end];
            }
            counted = position + 2;
        }
        sum
    }

    /// The joints of a move. The couplings inside its segments are not part of them.
    fn joints(&self, step: Move) -> Joints {
        let (first, last) = step.range().into_inner();
        let before = self.place(first.wrapping_sub(2));
        let mut joints = Joints::from(before, self.places[first - 1]);
        for (enter, leave) in step.segments() {
            joints.go_to(self.places[enter]);
            if enter != leave {
                // The couplings at the two ends of a segment belong to its joints.
                let forth = enter < leave;
                let second = if forth { enter + 1 } else { enter - 1 };
                let penultimate = if forth { leave - 1 } else { leave + 1 };
                joints.add_coupling(self.places[second]);
                joints.go_on(self.places[penultimate], self.places[leave]);
            }
        }
        joints.go_to(self.places[last + 1]);
        joints.add_coupling(self.place(last + 2));
        joints
    }

    /// Change of the cost inside a segment when it is reversed, s.
    fn reversal_change(&self, (first, last): SegmentEnds) -> f64 {
        if !self.directed || first == last {
            return 0.0;
        }
        let sum = |position: usize| self.skew_sums[position];
        sum(last)[0] - sum(first)[0] + sum(last - 1)[1] - sum(first)[1]
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

    /// Updates what depends on the places at a range of positions.
    fn update(&mut self, range: RangeInclusive<usize>) {
        for position in range.clone() {
            self.positions[self.places[position]] = position;
        }
        let end = self.places.len() - 1;
        let touched = range.start().saturating_sub(1)..=end.min(range.end() + 1);
        for position in touched.clone() {
            let before = self.place(position.wrapping_sub(1));
            let (at, after) = (self.places[position], self.place(position + 1));
            self.couplings[position] = self.coupling([before, at, after]);
            if self.directed && (2..end).contains(&position) {
                let leg = self.legs.leg(at, before) - self.legs.leg(before, at);
                let coupling = if position + 1 < end {
                    self.coupling([after, at, before]) - self.couplings[position]
                } else {
                    0.0
                };
                self.skews[position] = [leg, coupling];
            }
        }
        if self.directed {
            for position in (*touched.start()).max(1)..end {
                let [leg, coupling] = self.skew_sums[position - 1];
                let skew = self.skews[position];
                self.skew_sums[position] = [leg + skew[0], coupling + skew[1]];
            }
        }
    }
}
