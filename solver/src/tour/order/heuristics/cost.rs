//! What an order costs: its legs, and what consecutive legs cost each other.

use crate::tour::order::PairTable;
use crate::tour::order::triple_bounds::TripleBounds;

/// Relative difference of the two ways of a leg that is rounding.
const ROUNDING: f64 = 1e-9;

/// The cost of an order as a sum over legs and over consecutive triples of places.
///
/// Places are numbered as in [`PairTable`]: targets `0..n`, the start `n`, the end `n + 1`. All
/// costs are finite, and those of bends are not negative.
pub(in crate::tour::order) trait OrderCost: Sync {
    /// Number of targets.
    fn targets(&self) -> usize;

    /// Cost of a leg, s.
    fn leg(&self, from: usize, to: usize) -> f64;

    /// What passing `via` between the two others adds to the two legs, s.
    fn coupling(&self, _from: usize, _via: usize, _to: usize) -> f64 {
        0.0
    }

    /// Whether every coupling between targets costs the same both ways.
    fn couplings_are_symmetric(&self) -> bool {
        true
    }
}

/// The pair bounds with what is known of triples: near to what an order takes.
impl OrderCost for TripleBounds {
    fn targets(&self) -> usize {
        self.table().targets()
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.table().bound(from, to)
    }

    fn coupling(&self, from: usize, via: usize, to: usize) -> f64 {
        self.coupling_gap(from, via, to)
    }

    fn couplings_are_symmetric(&self) -> bool {
        self.is_symmetric()
    }
}

impl OrderCost for PairTable {
    fn targets(&self) -> usize {
        PairTable::targets(self)
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.bound(from, to)
    }
}

/// Cost of the way from a place through some targets and to the end, s. A coupling at the first place
/// is not part of it.
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

/// The legs among some targets, from the place before them and to the end, made as nearly
/// symmetric as can be.
///
/// Every target is entered exactly once, so that a charge taken off all legs into it changes all
/// orders by the same. The entry_offsets are those of the spanning tree relaxation: the dwell at a
/// target, part of every leg into it, drops out whole.
#[derive(Debug)]
pub(super) struct ReducedLegs {
    places: usize,
    costs: Vec<f64>,
    symmetric: bool,
}

impl ReducedLegs {
    /// Reads the legs of a cost.
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
            // The way back along an outer leg is never gone. What it costs is how far apart the two are.
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

    /// Removes asymmetry that is rounding, if there is no other.
    fn make_symmetric(&mut self, order: &[usize]) {
        let pairs = || {
            let after = |(place, &a)| order[place + 1..].iter().map(move |&b| (a, b));
            order.iter().enumerate().flat_map(after)
        };
        let scale = self
            .costs
            .iter()
            .fold(0.0_f64, |most, leg| most.max(leg.abs()));
        self.symmetric =
            pairs().all(|(a, b)| (self.leg(a, b) - self.leg(b, a)).abs() <= ROUNDING * scale);
        if self.symmetric {
            for (a, b) in pairs() {
                self.set_both(a, b, self.leg(a, b));
            }
        }
    }

    /// Charged cost of a leg, s.
    pub(super) fn leg(&self, from: usize, to: usize) -> f64 {
        self.costs[from * self.places + to]
    }

    /// How far apart two places are: the lesser of their two legs, s.
    pub(super) fn edge(&self, a: usize, b: usize) -> f64 {
        self.leg(a, b).min(self.leg(b, a))
    }

    /// Whether every leg between targets costs the same both ways.
    pub(super) fn are_symmetric(&self) -> bool {
        self.symmetric
    }
}
