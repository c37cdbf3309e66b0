//! The cost of an order: its legs and the couplings of consecutive legs.

use crate::tour::order::PairTable;
use crate::tour::order::triple_bounds::{GapEstimates, TripleBounds};

/// Relative difference of the two directions of a leg that is attributed to rounding.
const ROUNDING: f64 = 1e-9;

/// The cost of an order as a sum over legs and over consecutive triples of places.
///
/// Places are numbered as in [`PairTable`]: targets `0..n`, the start `n`, the end `n + 1`. All
/// costs are finite, and couplings are not negative.
pub(in crate::tour::order) trait OrderCost: Sync {
    /// Number of targets.
    fn targets(&self) -> usize;

    /// Cost of a leg, s.
    fn leg(&self, from: usize, to: usize) -> f64;

    /// Cost of the coupling of the legs before and after `via`, s.
    fn coupling(&self, _from: usize, _via: usize, _to: usize) -> f64 {
        0.0
    }

    /// Whether every coupling between targets costs the same in both directions.
    fn couplings_are_symmetric(&self) -> bool {
        true
    }
}

/// The pair bounds with the known coupling gaps of triples: an estimate of an order's duration.
impl OrderCost for TripleBounds {
    fn targets(&self) -> usize {
        self.table().targets()
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.table().estimate(from, to)
    }

    fn coupling(&self, from: usize, via: usize, to: usize) -> f64 {
        self.coupling_gap(from, via, to)
    }

    fn couplings_are_symmetric(&self) -> bool {
        self.is_symmetric()
    }
}

/// Pair bounds with couplings that nobody has asked for.
pub(super) struct EstimatedCost<'a> {
    pub(super) table: &'a PairTable,
    pub(super) gaps: GapEstimates,
}

impl OrderCost for EstimatedCost<'_> {
    fn targets(&self) -> usize {
        self.table.targets()
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.table.estimate(from, to)
    }

    fn coupling(&self, from: usize, via: usize, to: usize) -> f64 {
        self.gaps.gap(from, via, to)
    }

    fn couplings_are_symmetric(&self) -> bool {
        false
    }
}

impl OrderCost for PairTable {
    fn targets(&self) -> usize {
        PairTable::targets(self)
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.estimate(from, to)
    }
}

/// The pair bounds alone. Searches are drawn to legs whose bounds can still be raised.
pub(in crate::tour::order) struct LeastLegs<'a>(pub(in crate::tour::order) &'a PairTable);

impl OrderCost for LeastLegs<'_> {
    fn targets(&self) -> usize {
        self.0.targets()
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.0.bound(from, to)
    }
}

/// Cost of the path from a place through some targets and to the end, s. A coupling at the first
/// place is not part of it.
pub(super) fn length<C: OrderCost>(cost: &C, from: usize, order: &[usize]) -> f64 {
    let mut sum = 0.0;
    let mut before = None;
    let mut at = from;
    for &to in order.iter().chain([&(cost.targets() + 1)]) {
        sum += cost.leg(at, to);
        sum += before.map_or(0.0, |before| cost.coupling(before, at, to));
        before = Some(at);
        at = to;
    }
    sum
}

/// The reduced legs among some targets, from the place before them and to the end: made as nearly
/// symmetric as possible by entry offsets.
///
/// Every target is entered exactly once, so an offset subtracted from all legs into it changes the
/// cost of all orders by the same amount. The offsets are those of the spanning tree relaxation:
/// the dwell at a target, which is part of every leg into it, drops out entirely.
#[derive(Debug)]
pub(super) struct ReducedLegs {
    places: usize,
    costs: Vec<f64>,
    symmetric: bool,
}

impl ReducedLegs {
    /// The reduced legs of a cost.
    pub(super) fn new<C: OrderCost>(cost: &C, from: usize, order: &[usize]) -> Self {
        let places = cost.targets() + 2;
        let end = places - 1;
        let mut legs = Self {
            places,
            costs: vec![0.0; places * places],
            symmetric: true,
        };
        let mut entry_offsets = vec![0.0; places];
        for &a in order {
            let skews = order
                .iter()
                .filter(|&&b| b != a)
                .map(|&b| cost.leg(b, a) - cost.leg(a, b));
            entry_offsets[a] = skews.sum::<f64>() / order.len() as f64;
        }
        for &to in order {
            // The reverse of an outer leg does not occur; it is given the same cost.
            legs.set_both(from, to, cost.leg(from, to) - entry_offsets[to]);
            legs.set_both(to, end, cost.leg(to, end));
            for &other in order.iter().filter(|&&other| other != to) {
                legs.costs[other * places + to] = cost.leg(other, to) - entry_offsets[to];
            }
        }
        legs.set_both(from, end, cost.leg(from, end));
        legs.make_symmetric(order);
        legs
    }

    fn set_both(&mut self, from: usize, to: usize, cost: f64) {
        self.costs[from * self.places + to] = cost;
        self.costs[to * self.places + from] = cost;
    }

    /// Makes the legs exactly symmetric if they are symmetric up to rounding.
    fn make_symmetric(&mut self, order: &[usize]) {
        let pairs = || {
            let after = |(place, &a)| order[place + 1..].iter().map(move |&b| (a, b));
            order.iter().enumerate().flat_map(after)
        };
        let scale = self
            .costs
            .iter()
            .fold(0.0_f64, |largest, leg| largest.max(leg.abs()));
        self.symmetric =
            pairs().all(|(a, b)| (self.leg(a, b) - self.leg(b, a)).abs() <= ROUNDING * scale);
        if self.symmetric {
            for (a, b) in pairs() {
                self.set_both(a, b, self.leg(a, b));
            }
        }
    }

    /// Reduced cost of a leg, s.
    pub(super) fn leg(&self, from: usize, to: usize) -> f64 {
        self.costs[from * self.places + to]
    }

    /// Distance of two places: the lesser of their two reduced legs, s.
    pub(super) fn edge(&self, a: usize, b: usize) -> f64 {
        self.leg(a, b).min(self.leg(b, a))
    }

    /// Whether every leg between targets costs the same in both directions.
    pub(super) fn are_symmetric(&self) -> bool {
        self.symmetric
    }
}
