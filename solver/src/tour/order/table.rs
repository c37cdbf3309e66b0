//! The table of pair bounds, with the rules of the orders.

use super::{Place, TourModel};
use crate::model::order_rules::OrderRules;
use std::collections::BTreeSet;

/// By how much, relative, a leg is estimated to exceed a bound that can still be raised.
const OPEN_EXCESS: f64 = 0.5;

/// Lower bounds of all legs, s, between places that are numbered: targets `0..n`, then the start,
/// then the end.
///
/// Without a prescribed end, the table has an end that every place reaches in zero time, so that
/// both cases are treated alike.
#[derive(Debug, Clone)]
pub struct PairTable {
    targets: usize,
    has_end: bool,
    bounds: Vec<f64>,
    /// Whether the model can raise a bound.
    open: Vec<bool>,
    rules: OrderRules,
}

impl PairTable {
    /// The table of a model: its bounds for every pair.
    #[must_use]
    pub fn new(model: &dyn TourModel) -> Self {
        let targets = model.target_count();
        let entries = (targets + 2) * (targets + 2);
        let mut table = Self {
            targets,
            has_end: model.has_end(),
            bounds: vec![0.0; entries],
            open: vec![false; entries],
            rules: model.rules().clone(),
        };
        for from in (0..targets).chain([table.start()]) {
            for to in (0..targets).chain([table.end()]) {
                table.update(model, [from, to]);
            }
        }
        table
    }

    /// Takes the bound of a leg from the model, if a tour can have this leg.
    fn update(&mut self, model: &dyn TourModel, leg: [usize; 2]) {
        if !self.is_leg(leg) {
            return;
        }
        let entry = self.entry(leg);
        let [from, to] = leg.map(|number| self.place(number));
        let bound = model.pair_bound(from, to);
        self.bounds[entry] = if bound.is_finite() {
            bound.max(0.0)
        } else {
            0.0
        };
        self.open[entry] = model.is_open(from, to);
    }

    /// Whether a tour can have this leg, and the end is a prescribed one.
    pub(super) fn is_leg(&self, [from, to]: [usize; 2]) -> bool {
        let alone = self.targets == 0;
        let (from_start, to_end) = (from == self.start(), to == self.end());
        from != to
            && from != self.end()
            && to != self.start()
            && (!to_end || self.has_end)
            && (!(from_start && to_end) || alone)
    }

    /// Whether the model can raise the bound of a leg or of its reverse.
    #[must_use]
    pub fn can_raise(&self, from: usize, to: usize) -> bool {
        self.open[self.entry([from, to])] || self.open[self.entry([to, from])]
    }

    /// Whether the model can raise the bound of any leg.
    #[must_use]
    pub fn has_open(&self) -> bool {
        self.open.contains(&true)
    }

    /// Lets the model raise the bounds of these legs and of their reverses where it can.
    pub fn raise(&mut self, model: &dyn TourModel, legs: &[[usize; 2]]) {
        let both = legs.iter().flat_map(|&[from, to]| [[from, to], [to, from]]);
        let open: BTreeSet<[usize; 2]> = both.filter(|&leg| self.open[self.entry(leg)]).collect();
        let place = |number| self.place(number);
        let pairs: Vec<_> = open.iter().map(|&[a, b]| (place(a), place(b))).collect();
        model.raise_pair_bounds(&pairs);
        for leg in open {
            self.update(model, leg);
        }
    }

    /// The same for the legs of these orders; returns whether there were any to raise.
    pub(super) fn raise_along(&mut self, model: &dyn TourModel, orders: &[Vec<usize>]) -> bool {
        let mut legs = Vec::new();
        for order in orders {
            let path = [&[self.start()], order.as_slice(), &[self.end()]].concat();
            let along = path.windows(2).map(|leg| [leg[0], leg[1]]);
            legs.extend(along.filter(|&[from, to]| self.can_raise(from, to)));
        }
        self.raise(model, &legs);
        !legs.is_empty()
    }

    /// The place with a number.
    #[must_use]
    pub fn place(&self, number: usize) -> Place {
        match number.checked_sub(self.targets) {
            None => Place::Target(number),
            Some(0) => Place::Start,
            Some(_) => Place::End,
        }
    }

    fn entry(&self, [from, to]: [usize; 2]) -> usize {
        from * (self.targets + 2) + to
    }

    /// Number of targets.
    #[must_use]
    pub fn targets(&self) -> usize {
        self.targets
    }

    /// Which orders of the targets are admitted.
    #[must_use]
    pub fn rules(&self) -> &OrderRules {
        &self.rules
    }

    /// Number of the start.
    #[must_use]
    pub fn start(&self) -> usize {
        self.targets
    }

    /// Number of the end, prescribed or not.
    #[must_use]
    pub fn end(&self) -> usize {
        self.targets + 1
    }

    /// Lower bound, s, from leaving one place to leaving the other.
    #[must_use]
    pub fn bound(&self, from: usize, to: usize) -> f64 {
        self.bounds[self.entry([from, to])]
    }

    /// Estimated time, s, from leaving one place to leaving the other: longer than a bound that can
    /// still be raised, so that short orders are not drawn to legs of which little is known.
    #[must_use]
    pub fn estimate(&self, from: usize, to: usize) -> f64 {
        let entry = self.entry([from, to]);
        let excess = if self.open[entry] { OPEN_EXCESS } else { 0.0 };
        (1.0 + excess) * self.bounds[entry]
    }

    /// Number of the last place of a prefix: the start, if it has no targets.
    #[must_use]
    pub fn last_place(&self, prefix: &[usize]) -> usize {
        prefix.last().copied().unwrap_or(self.start())
    }
}
