//! Lagrangian bounds: the coupling of legs is relaxed with costates as multipliers.
//!
//! # Costates decouple legs
//!
//! Legs couple because a leg begins in the state in which the leg before it ends. Give every leg
//! its own copies `a, b` of the states at its ends, and demand for each target `j` between the
//! places `i` and `k` that the copies agree, `b(i, j) = a(j, k)`. With a multiplier `p(i, j, k)`
//! for this constraint the legs of a tour `.. h, i, j, k ..` are independent,
//!
//! `T >= sum over its legs of c(h, i, j, k)`,
//!
//! `c(h, i, j, k) = min over a, b of t(a -> b) - p(h, i, j) . a + p(i, j, k) . b`,
//!
//! for any multipliers (Lagrangian duality): where the copies agree the terms cancel. The bound of
//! a tour is sharp when its multipliers are the costates of its solution and the leg durations are
//! convex in the states at their ends, which is nearly the case: on the best tours of random
//! schedules the bound is within 0.1 %, where the bounds of five places in a row leave 2 to 3 %.
//!
//! A multiplier may depend on the three places `i, j, k`, since both legs know them. One value that
//! is shared by many tours is not the best one for each of them.
//!
//! # All tours at once
//!
//! The least sum over all orders is a shortest path through states `(h, i, j, R)`, where `R` is the
//! set of remaining targets ([`LagrangianPaths`]): exact for any multipliers.
//!
//! # Dual ascent
//!
//! Initially all multipliers are zero, and a leg costs its duration with free ends. Then, in
//! rounds, the tours of the orders with the smallest bounds are solved, and each multiplier along
//! them is set to the mean of the costates of all solutions so far. This is an ascent of the
//! Lagrangian dual with steps `1/m`. Legs are solved again only where a multiplier has changed.

mod paths;
mod rounded;

pub use paths::LagrangianPaths;

use super::completion::MAX_EXACT_TARGETS;
use super::{Evaluation, PairTable, PassageCostate, TourModel};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use std::collections::{BTreeMap, BTreeSet};

/// Number of targets up to which Lagrangian bounds are computed. The table of paths has some
/// `n^3 2^n / 8` entries of two bytes: 53 MiB for sixteen targets, and less than half of it for
/// each target less.
pub const MAX_LAGRANGIAN_TARGETS: usize = 16;
// With start, end and the number for no neighbour, a row fits the rows of the table of subsets.
const _: () = assert!(MAX_LAGRANGIAN_TARGETS + 3 <= MAX_EXACT_TARGETS);

/// The mean of the costates of some solutions.
#[derive(Debug, Clone)]
struct MeanCostate {
    costate: PassageCostate,
    /// Number of solutions.
    count: f64,
}

/// The Lagrangian cost of every leg between its neighbours, s.
///
/// Places are numbered as in [`PairTable`]. One more number stands for no neighbour; the multiplier
/// there is zero.
#[derive(Debug, Clone)]
pub struct LagrangianLegs {
    table: PairTable,
    has_end: bool,
    /// Whether every leg costs the same in reverse, between the same neighbours and with start and
    /// end exchanged.
    symmetric: bool,
    costates: BTreeMap<[usize; 3], MeanCostate>,
    /// For the first three of four places, a row of costs by the last one.
    costs: Vec<[f64; MAX_EXACT_TARGETS]>,
}

impl LagrangianLegs {
    /// The costs with all multipliers zero.
    #[must_use]
    pub fn new(model: &dyn TourModel, table: &PairTable) -> Self {
        let numbers = table.targets() + 3;
        let mut legs = Self {
            table: table.clone(),
            has_end: model.has_end(),
            symmetric: model.is_symmetric(),
            costates: BTreeMap::new(),
            costs: Vec::with_capacity(numbers.pow(3)),
        };
        for _ in 0..numbers {
            for (from, to) in (0..numbers).flat_map(|from| (0..numbers).map(move |to| (from, to))) {
                let is_leg = from.max(to) < legs.no_neighbour();
                let bound = if is_leg { table.bound(from, to) } else { 0.0 };
                legs.costs.push([bound; MAX_EXACT_TARGETS]);
            }
        }
        legs
    }

    /// The number that stands for no neighbour.
    fn no_neighbour(&self) -> usize {
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

    /// Cost of the legs whose neighbours are known once the last target is reached, s: the leg to
    /// it and, with a prescribed end, the leg to the end.
    fn ending(&self, [before, from, last]: [usize; 3]) -> f64 {
        if self.has_end {
            let end = self.table.end();
            self.cost([before, from, last, end]) + self.cost([from, last, end, self.no_neighbour()])
        } else {
            self.cost([before, from, last, self.no_neighbour()])
        }
    }

    /// Updates the multipliers along some orders by the costates of their tours, and solves the
    /// legs that change. Returns `false`, with nothing changed, when the solve is stopped meanwhile
    /// or no tour has costates.
    pub fn update_costates(
        &mut self,
        orders: &[Vec<usize>],
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) -> bool {
        let mut costates = self.costates.clone();
        let mut moved = BTreeSet::new();
        for order in orders {
            let Some(of_tour) = model.costates(order) else {
                continue;
            };
            let path = self.path_of(order);
            for (triple, costate) in path.windows(3).zip(of_tour) {
                let triple = self.either_way([triple[0], triple[1], triple[2]]);
                let mean = costates
                    .entry(triple)
                    .or_insert_with(|| MeanCostate::new(&costate));
                mean.add(&costate);
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
        let costs = pool.map(&legs, |&leg| self.solve(leg, &costates, model, stop));
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
        self.costates = costates;
        true
    }

    /// Cost of a leg for given multipliers, s; `None` when the solve is stopped. The cost of a leg
    /// that does not resolve is minus infinity, which is always a valid bound.
    fn solve(
        &self,
        [before, from, to, after]: [usize; 4],
        costates: &BTreeMap<[usize; 3], MeanCostate>,
        model: &dyn TourModel,
        stop: &StopSignal,
    ) -> Option<f64> {
        if stop.is_set() {
            return None;
        }
        let costate = |triple: [usize; 3]| {
            let known = costates.get(&self.either_way(triple));
            known.map(|mean| mean.costate.as_slice())
        };
        let at_ends = [costate([before, from, to]), costate([from, to, after])];
        let cost = if at_ends == [None; 2] {
            Evaluation::Value(self.table.bound(from, to))
        } else {
            model.lagrangian_leg([from, to].map(|place| self.table.place(place)), at_ends)
        };
        match cost {
            Evaluation::Value(cost) => Some(cost),
            Evaluation::Unresolved => Some(f64::NEG_INFINITY),
            Evaluation::Stopped => None,
        }
    }

    /// The legs before and after the middle of a triple, with every possible other neighbour.
    fn legs_at(&self, [i, j, k]: [usize; 3]) -> impl Iterator<Item = [usize; 4]> + use<> {
        let (start, end, no_neighbour) =
            (self.table.start(), self.table.end(), self.no_neighbour());
        let fits = move |place: &usize| ![i, j, k].contains(place);
        let before = (0..=no_neighbour).filter(move |&h| {
            if i == start {
                h == no_neighbour
            } else {
                h != end
            }
        });
        let after = (0..=no_neighbour).filter(move |&l| {
            if k == end {
                l == no_neighbour
            } else {
                l != start
            }
        });
        let before = before.filter(fits).map(move |h| [h, i, j, k]);
        before.chain(after.filter(fits).map(move |l| [i, j, k, l]))
    }

    /// The start, the targets of an order, and the end where there is one.
    fn path_of(&self, order: &[usize]) -> Vec<usize> {
        let mut path = vec![self.table.start()];
        path.extend(order);
        path.extend(self.has_end.then_some(self.table.end()));
        path
    }

    /// The same places in reverse, with start and end exchanged.
    fn backwards<const N: usize>(&self, mut path: [usize; N]) -> [usize; N] {
        let (start, end) = (self.table.start(), self.table.end());
        path.reverse();
        path.map(|place| match place {
            place if place == start => end,
            place if place == end => start,
            place => place,
        })
    }

    /// The key of a path: in a symmetric model the lesser of it and its reverse.
    fn either_way<const N: usize>(&self, path: [usize; N]) -> [usize; N] {
        if self.symmetric {
            path.min(self.backwards(path))
        } else {
            path
        }
    }
}

impl MeanCostate {
    /// The mean of no costates yet.
    fn new(costate: &PassageCostate) -> Self {
        Self {
            costate: vec![0.0; costate.len()],
            count: 0.0,
        }
    }

    fn add(&mut self, costate: &PassageCostate) {
        self.count += 1.0;
        for (mean, costate) in self.costate.iter_mut().zip(costate) {
            *mean += (costate - *mean) / self.count;
        }
    }
}
