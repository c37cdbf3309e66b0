//! A bound from prices: what legs cost when each pays its neighbours for the state they meet in.
//!
//! # Prices decouple legs
//!
//! Slews couple because a target is left in the state in which it was reached. Give every leg its
//! own copies `a, b` of the states at its ends, and demand of each target `j` between the places `i`
//! and `k` that the copies agree, `b(i, j) = a(j, k)`. With a multiplier `p(i, j, k)` of this demand
//! the legs of a tour `.. h, i, j, k ..` fall apart,
//!
//! `T >= sum over its legs of c(h, i, j, k)`,
//!
//! `c(h, i, j, k) = min over a, b of t(a -> b) - p(h, i, j) . a + p(i, j, k) . b`,
//!
//! for any prices whatever (Lagrangian duality): where the copies agree the prices cancel. The bound
//! of a tour is sharp when its prices are the costates of its flight and legs are convex in the states
//! at their ends, which they nearly are: on the best tours of random schedules it is within 0.1 %,
//! where five places in a row, averaged, leave 2 to 3 %.
//!
//! A price may depend on the three places it stands between, since both legs know them. One that suits
//! many tours is not the best for any of them.
//!
//! # All tours at once
//!
//! The least sum over all orders is a shortest path through states `(h, i, j, R)`, with `R` what
//! remains ([`LagrangianPaths`]): exact, whatever the prices.
//!
//! # Learning prices
//!
//! At first there are none, and a leg costs what it takes with free ends. Then, in rounds, the orders
//! that are shortest by the prices of the moment are flown, and the prices along them move to the
//! costates of their flights: to the mean, when there have been several. This is an ascent of the
//! Lagrangian dual with steps `1/m`. Legs are solved only where prices have moved.

mod paths;

pub use paths::LagrangianPaths;

use super::completion::MAX_EXACT_TARGETS;
use super::{Evaluation, PairTable, PassageCostate, Place, TourModel};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use std::collections::{BTreeMap, BTreeSet};

/// Up to so many targets legs are lagrangian: the table of paths has some `n^3 2^n / 8` entries of four
/// bytes, 160 MB for sixteen targets and half of it for every target less.
pub const MAX_LAGRANGIAN_TARGETS: usize = 16;
// With the numbers of start, end and nobody a row is no longer than that of a table of subsets.
const _: () = assert!(MAX_LAGRANGIAN_TARGETS + 3 <= MAX_EXACT_TARGETS);

/// A price with the number of flights that it is the mean of.
#[derive(Debug, Clone)]
struct Mean {
    price: PassageCostate,
    flights: f64,
}

/// What every leg costs between its neighbours, s.
///
/// Places are numbered as in [`PairTable`]; one more number stands for no neighbour, which pays and
/// is paid nothing.
#[derive(Debug, Clone)]
pub struct LagrangianLegs {
    table: PairTable,
    has_end: bool,
    /// Whether every leg costs the same backwards, between the same neighbours and with start and end
    /// exchanged.
    symmetric: bool,
    prices: BTreeMap<[usize; 3], Mean>,
    /// Rows of the last of four places, by the first three.
    costs: Vec<[f64; MAX_EXACT_TARGETS]>,
}

impl LagrangianLegs {
    /// No prices yet.
    #[must_use]
    pub fn new(model: &dyn TourModel, table: &PairTable) -> Self {
        let numbers = table.targets() + 3;
        let mut legs = Self {
            table: table.clone(),
            has_end: model.has_end(),
            symmetric: model.is_symmetric(),
            prices: BTreeMap::new(),
            costs: Vec::with_capacity(numbers.pow(3)),
        };
        for _ in 0..numbers {
            for (from, to) in (0..numbers).flat_map(|from| (0..numbers).map(move |to| (from, to))) {
                let is_leg = from.max(to) < legs.nobody();
                let bound = if is_leg { table.bound(from, to) } else { 0.0 };
                legs.costs.push([bound; MAX_EXACT_TARGETS]);
            }
        }
        legs
    }

    /// The number of no neighbour.
    fn nobody(&self) -> usize {
        self.table.targets() + 2
    }

    /// Cost of the leg from the second place to the third, between the first and the last, s.
    fn cost(&self, [before, from, to, after]: [usize; 4]) -> f64 {
        self.row([before, from, to])[after]
    }

    /// Costs of a leg by the place after it, s.
    fn row(&self, path: [usize; 3]) -> &[f64; MAX_EXACT_TARGETS] {
        &self.costs[self.index(path)]
    }

    fn index(&self, path: [usize; 3]) -> usize {
        let numbers = self.table.targets() + 3;
        path.into_iter()
            .fold(0, |index, place| index * numbers + place)
    }

    /// Cost of all that comes once the last target has been reached: the last two legs, s.
    fn ending(&self, [before, from, last]: [usize; 3]) -> f64 {
        if self.has_end {
            let end = self.table.end();
            self.cost([before, from, last, end]) + self.cost([from, last, end, self.nobody()])
        } else {
            self.cost([before, from, last, self.nobody()])
        }
    }

    /// Moves the prices along flown orders towards those of their flights, and solves the legs that
    /// this concerns. All or nothing: `false`, and nothing has changed, when the solve is stopped
    /// meanwhile or no flight tells prices.
    pub fn learn(
        &mut self,
        orders: &[Vec<usize>],
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) -> bool {
        let mut prices = self.prices.clone();
        let mut moved = BTreeSet::new();
        for order in orders {
            let Some(flight) = model.costates(order) else {
                continue;
            };
            let path = self.path_of(order);
            for (triple, price) in path.windows(3).zip(flight) {
                let triple = self.either_way([triple[0], triple[1], triple[2]]);
                let mean = prices.entry(triple).or_insert_with(|| Mean::new(&price));
                mean.take_in(&price);
                moved.insert(triple);
            }
        }
        if moved.is_empty() {
            return false;
        }
        let legs: BTreeSet<[usize; 4]> = moved
            .iter()
            .flat_map(|&triple| self.legs_at(triple))
            .map(|leg| self.either_way(leg))
            .collect();
        let legs: Vec<[usize; 4]> = legs.into_iter().collect();
        let costs = pool.map(&legs, |&leg| self.solve(leg, &prices, model, stop));
        let Some(costs): Option<Vec<f64>> = costs.into_iter().collect() else {
            return false;
        };
        for (leg, cost) in legs.into_iter().zip(costs) {
            for leg in [leg, self.backwards(leg)]
                .into_iter()
                .take(1 + usize::from(self.symmetric))
            {
                let [before, from, to, after] = leg;
                let row = self.index([before, from, to]);
                self.costs[row][after] = cost;
            }
        }
        self.prices = prices;
        true
    }

    /// Cost of a leg by some prices; `None` when the solve is stopped. One that does not resolve
    /// costs nothing that could be relied on.
    fn solve(
        &self,
        [before, from, to, after]: [usize; 4],
        prices: &BTreeMap<[usize; 3], Mean>,
        model: &dyn TourModel,
        stop: &StopSignal,
    ) -> Option<f64> {
        if stop.is_set() {
            return None;
        }
        let price = |triple: [usize; 3]| {
            let known = prices.get(&self.either_way(triple));
            known.map(|mean| mean.price.as_slice())
        };
        let at_ends = [price([before, from, to]), price([from, to, after])];
        let cost = if at_ends == [None; 2] {
            Evaluation::Value(self.table.bound(from, to))
        } else {
            model.lagrangian_leg([from, to].map(|place| self.place(place)), at_ends)
        };
        match cost {
            Evaluation::Value(cost) => Some(cost),
            Evaluation::Unresolved => Some(f64::NEG_INFINITY),
            Evaluation::Stopped => None,
        }
    }

    /// The legs before and after the middle of a triple, with every other neighbour.
    fn legs_at(&self, [i, j, k]: [usize; 3]) -> impl Iterator<Item = [usize; 4]> + use<> {
        let (start, end, nobody) = (self.table.start(), self.table.end(), self.nobody());
        let fits = move |place: &usize| ![i, j, k].contains(place);
        let before = (0..=nobody).filter(move |&h| if i == start { h == nobody } else { h != end });
        let after = (0..=nobody).filter(move |&l| if k == end { l == nobody } else { l != start });
        let before = before.filter(fits).map(move |h| [h, i, j, k]);
        before.chain(after.filter(fits).map(move |l| [i, j, k, l]))
    }

    /// Start, targets in this order, and the end where there is one.
    fn path_of(&self, order: &[usize]) -> Vec<usize> {
        let mut path = vec![self.table.start()];
        path.extend(order);
        path.extend(self.has_end.then_some(self.table.end()));
        path
    }

    /// The same places from behind, with start and end exchanged.
    fn backwards<const N: usize>(&self, mut path: [usize; N]) -> [usize; N] {
        let (start, end) = (self.table.start(), self.table.end());
        path.reverse();
        path.map(|place| match place {
            place if place == start => end,
            place if place == end => start,
            place => place,
        })
    }

    /// What a path and its reverse have in common, where that is as good.
    fn either_way<const N: usize>(&self, path: [usize; N]) -> [usize; N] {
        if self.symmetric {
            path.min(self.backwards(path))
        } else {
            path
        }
    }

    fn place(&self, number: usize) -> Place {
        if number < self.table.targets() {
            Place::Target(number)
        } else if number == self.table.start() {
            Place::Start
        } else {
            Place::End
        }
    }
}

impl Mean {
    /// The mean of nothing.
    fn new(price: &PassageCostate) -> Self {
        Self {
            price: vec![0.0; price.len()],
            flights: 0.0,
        }
    }

    fn take_in(&mut self, price: &PassageCostate) {
        self.flights += 1.0;
        for (mean, price) in self.price.iter_mut().zip(price) {
            *mean += (price - *mean) / self.flights;
        }
    }
}
