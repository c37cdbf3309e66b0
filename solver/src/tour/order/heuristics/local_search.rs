//! 2-opt, Or-opt and exchanges of segments (Croes 1958, Or 1976, Kanellakis and Papadimitriou 1980)
//! with lists of neighbours and don't-look bits (Bentley 1992).
//!
//! A move removes some joints between places and adds as many others. If it shortens the order,
//! then some place gains a joint that costs less than the one it loses. So every improving move is
//! found from one of its places although only the neighbours nearer than the removed joint are
//! tried. A place without an improving move is not searched again until one of its joints changes:
//! until then it is not in the queue `waiting`.

use super::cost::OrderCost;
use super::neighbours::Neighbours;
use super::path::{Move, OrderPath};
use crate::run::stop::StopSignal;
use std::collections::VecDeque;

/// Smallest gain of a move, relative to the length of the order; it excludes cycles due to
/// rounding.
const MIN_GAIN: f64 = 1e-9;
/// Longest segment that Or-opt moves; three is the value of Or (1976).
const MAX_SEGMENT: usize = 3;

/// Whether the rules allow an order.
pub(in crate::tour::order) type Admits<'a> = &'a (dyn Fn(&[usize]) -> bool + Sync);

/// The problem of a heuristic search.
pub(in crate::tour::order) struct OrderTask<'a, C> {
    /// The cost of orders.
    pub(in crate::tour::order) cost: &'a C,
    /// The place before the order.
    pub(in crate::tour::order) from: usize,
    /// The rules for orders, if there are any.
    pub(in crate::tour::order) admits: Option<Admits<'a>>,
}

/// A path on its way to a local minimum.
pub(super) struct LocalSearch<'a, C> {
    pub(super) path: OrderPath<'a, C>,
    neighbours: Neighbours,
    admits: Option<Admits<'a>>,
    waiting: VecDeque<usize>,
    is_waiting: Vec<bool>,
    min_gain: f64,
}

/// The best move so far and its change of the cost, s.
struct BestMove {
    step: Option<Move>,
    change: f64,
}

impl<'a, C: OrderCost> LocalSearch<'a, C> {
    /// Begins at an order that the rules, where there are any, allow.
    pub(super) fn new(task: &OrderTask<'a, C>, order: &[usize]) -> Self {
        let path = OrderPath::new(task.cost, task.from, order);
        Self {
            neighbours: Neighbours::new(path.legs(), path.places()),
            admits: task.admits,
            waiting: path.places().iter().copied().collect(),
            is_waiting: vec![true; task.cost.targets() + 2],
            min_gain: MIN_GAIN * path.length(),
            path,
        }
    }

    /// Makes improving moves until there is none or the search is stopped. Calls `moved` for each
    /// and returns the sum of their changes of the cost, s.
    pub(super) fn descend(&mut self, stop: &StopSignal, mut moved: impl FnMut(Move)) -> f64 {
        let mut sum = 0.0;
        while let Some(place) = self.waiting.pop_front() {
            self.is_waiting[place] = false;
            while let Some((step, change)) = self.best_move_at(place) {
                if stop.is_set() {
                    return sum;
                }
                self.make(step);
                moved(step);
                sum += change;
            }
        }
        sum
    }

    /// Replaces three adjacent segments `a b c` of these lengths, the first of which begins at a
    /// position, by `c b a`. Returns the change of the cost, s; `None`, with nothing changed, if
    /// the rules refuse it.
    ///
    /// Four joints change: the double bridge (Martin, Otto and Felten 1991).
    pub(super) fn bridge(&mut self, first: usize, lengths: [usize; 3]) -> Option<f64> {
        let [a, b, c] = lengths;
        let change = self.swap(first, a, b + c) + self.swap(first, b, c);
        if self.admits.is_none_or(|admits| admits(self.path.order())) {
            return Some(change);
        }
        self.swap(first, c, b);
        self.swap(first, b + c, a);
        None
    }

    /// Exchanges two adjacent segments of these lengths, the first of which begins at a position,
    /// and returns the change of the cost, s.
    fn swap(&mut self, first: usize, length: usize, other: usize) -> f64 {
        let step = Move::Exchange {
            first,
            middle: first + length - 1,
            last: first + length + other - 1,
            reverse_first: false,
            reverse_second: false,
        };
        let change = self.path.change(step);
        self.make(step);
        change
    }

    /// Makes a move and queues the places at its joints.
    fn make(&mut self, step: Move) {
        self.path.apply(step);
        let (first, last) = step.range().into_inner();
        self.wait(first - 1);
        self.wait(first);
        if let Move::Exchange { middle, .. } = step {
            // Where the two segments meet now.
            let meet = first + (last - middle);
            self.wait(meet - 1);
            self.wait(meet);
        }
        self.wait(last);
        self.wait(last + 1);
    }

    fn wait(&mut self, position: usize) {
        let place = self.path.places()[position];
        if !self.is_waiting[place] {
            self.is_waiting[place] = true;
            self.waiting.push_back(place);
        }
    }

    /// The move at a place with the largest gain.
    fn best_move_at(&mut self, place: usize) -> Option<(Move, f64)> {
        let mut choice = BestMove {
            step: None,
            change: -self.min_gain,
        };
        self.reversals(place, &mut choice);
        self.shifts(place, &mut choice);
        self.exchanges(place, &mut choice);
        choice.step.map(|step| (step, choice.change))
    }

    fn consider(&mut self, step: Move, choice: &mut BestMove) {
        let Some(change) = self.path.change_below(choice.change, step) else {
            return;
        };
        let admits = self.admits;
        if admits.is_none_or(|admits| self.path.preview(step, |order| admits(order))) {
            choice.change = change;
            choice.step = Some(step);
        }
    }

    /// 2-opt: replaces the joint after or before a place by one to a near place, and reverses the
    /// places between.
    fn reversals(&mut self, place: usize, choice: &mut BestMove) {
        let here = self.path.position(place);
        let end = self.path.places().len() - 1;
        for after in [true, false] {
            if here == if after { end } else { 0 } {
                continue;
            }
            let removed = self.path.joint(if after { here } else { here - 1 });
            for nth in 0..self.neighbours.of(place).len() {
                let near = self.neighbours.of(place)[nth];
                if self.path.legs().edge(place, near) >= removed {
                    break;
                }
                let there = self.path.position(near);
                let (low, high) = (here.min(there), here.max(there));
                let (first, last) = if after {
                    (low + 1, high)
                } else {
                    (low, high - 1)
                };
                if first < last && first > 0 && last < end {
                    self.consider(Move::Reverse(first, last), choice);
                }
            }
        }
    }

    /// Or-opt: moves a short segment that begins or ends at a place next to a near place.
    fn shifts(&mut self, place: usize, choice: &mut BestMove) {
        let here = self.path.position(place);
        let end = self.path.places().len() - 1;
        for length in 1..=MAX_SEGMENT {
            for begins in [true, false] {
                // A single place is a segment that begins and ends there.
                if here == 0 || here == end || (length == 1 && !begins) {
                    continue;
                }
                let first = if begins {
                    here
                } else {
                    (here + 1).saturating_sub(length)
                };
                let last = first + length - 1;
                if first > 0 && last < end {
                    self.shifts_of(first, last, place, choice);
                }
            }
        }
    }

    fn shifts_of(&mut self, first: usize, last: usize, place: usize, choice: &mut BestMove) {
        let end = self.path.places().len() - 1;
        let removed = self.path.joint(first - 1) + self.path.joint(last)
            - self
                .path
                .legs()
                .leg(self.path.places()[first - 1], self.path.places()[last + 1]);
        for nth in 0..self.neighbours.of(place).len() {
            let near = self.neighbours.of(place)[nth];
            if self.path.legs().edge(place, near) >= removed {
                break;
            }
            let there = self.path.position(near);
            if (first..=last).contains(&there) {
                continue;
            }
            // Into the gap before or after the near place, so that the two places become
            // neighbours.
            for before in [true, false] {
                if there == if before { 0 } else { end } {
                    continue;
                }
                let gap = if before { there } else { there + 1 };
                let turn = (self.path.position(place) == first) == before && first != last;
                if gap < first {
                    self.consider(
                        Move::Exchange {
                            first: gap,
                            middle: first - 1,
                            last,
                            reverse_first: false,
                            reverse_second: turn,
                        },
                        choice,
                    );
                } else if gap > last + 1 {
                    self.consider(
                        Move::Exchange {
                            first,
                            middle: last,
                            last: gap - 1,
                            reverse_first: turn,
                            reverse_second: false,
                        },
                        choice,
                    );
                }
            }
        }
    }

    /// Joins a place to a near one by exchanging two segments of any length without reversing them
    /// (Kanellakis and Papadimitriou 1980).
    ///
    /// With the joints after the positions `i`, `j` and `k` removed, the places there are followed
    /// by the ones that followed those at `j`, `k` and `i`. That is one path again when the three
    /// ascend, cyclically.
    fn exchanges(&mut self, place: usize, choice: &mut BestMove) {
        let i = self.path.position(place);
        let end = self.path.places().len() - 1;
        if i == end {
            return;
        }
        let next = self.path.places()[i + 1];
        let removed = self.path.joint(i);
        for nth in 0..self.neighbours.of(place).len() {
            let near = self.neighbours.of(place)[nth];
            let gain = removed - self.path.legs().edge(place, near);
            if gain <= 0.0 {
                break;
            }
            let there = self.path.position(near);
            if there == 0 || there == i + 1 {
                continue;
            }
            let j = there - 1;
            let gain = gain + self.path.joint(j);
            for nth in 0..self.neighbours.of(next).len() {
                let tail = self.neighbours.of(next)[nth];
                if self.path.legs().edge(tail, next) >= gain {
                    break;
                }
                let k = self.path.position(tail);
                let ascending = [(i, j, k), (j, k, i), (k, i, j)]
                    .into_iter()
                    .find(|(a, b, c)| a < b && b < c);
                if let Some((a, b, c)) = ascending.filter(|&(_, _, c)| c < end) {
                    let step = Move::Exchange {
                        first: a + 1,
                        middle: b,
                        last: c,
                        reverse_first: false,
                        reverse_second: false,
                    };
                    self.consider(step, choice);
                }
            }
        }
    }
}
