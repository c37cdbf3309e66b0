//! The orders of smallest Lagrangian bound: dynamic programming over subsets, with the last three
//! places in the state.

use super::LagrangianLegs;
use super::rounded::RoundedDown;
use crate::model::order_rules::OrderRules;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::MAX_EXACT_TARGETS;
use crate::tour::order::completion::subsets::{Admitted, least_sum, mask, members};

/// `rest(h, i, j, R) = min over k in R of c(h, i, j, k) + rest(i, j, k, R - k)`, s: the least sum
/// of all Lagrangian legs from `i` on, when `h, i, j` were visited last and the targets `R` remain.
/// The table holds for the costates with which it was filled.
#[derive(Debug)]
pub struct LagrangianPaths {
    legs: LagrangianLegs,
    admitted: Admitted,
    /// For every nonempty set `R`, an entry for every three different targets `h, i, j` outside it,
    /// a lower bound.
    rest: Vec<RoundedDown>,
    root_s: f64,
}

impl LagrangianPaths {
    /// Memory of the table for so many targets, bytes.
    #[must_use]
    pub fn bytes(targets: usize) -> u64 {
        let targets = targets as u64;
        // Three different targets outside a set: the other targets are in it or not.
        let entries = (targets * targets.saturating_sub(1) * targets.saturating_sub(2)) << targets;
        entries / 8 * RoundedDown::BYTES
    }

    /// An empty table for the orders that some rules admit.
    #[must_use]
    pub fn new(legs: &LagrangianLegs, rules: &OrderRules) -> Self {
        let targets = legs.table.targets();
        Self {
            legs: legs.clone(),
            admitted: Admitted::of(rules, targets),
            rest: (0..1 << targets).map(|_| RoundedDown::default()).collect(),
            root_s: 0.0,
        }
    }

    /// Fills the table: some `n^4 2^n / 16` steps. Returns `false` when the solve is stopped
    /// meanwhile; the table must not be used then.
    #[must_use]
    pub fn fill(&mut self, legs: &LagrangianLegs, pool: &SolverPool, stop: &StopSignal) -> bool {
        self.legs.clone_from(legs);
        let targets = legs.table.targets();
        // A state needs three targets outside the set.
        for size in 1..(targets + 1).saturating_sub(3) {
            let sets: Vec<usize> = (1..1_usize << targets)
                .filter(|set| set.count_ones() as usize == size)
                .collect();
            let filled = pool.map(&sets, |&set| (!stop.is_set()).then(|| self.filled(set)));
            for (set, rest) in sets.into_iter().zip(filled) {
                let Some(rest) = rest else { return false };
                self.rest[set] = rest;
            }
        }
        self.root_s = self.beginning(&[], (1 << targets) - 1);
        true
    }

    /// Lower bound, s, of all tours.
    #[must_use]
    pub fn root_bound(&self) -> f64 {
        self.root_s
    }

    /// Lower bound, s, of the path from a place, left in any state, through the remaining targets
    /// and to the end.
    #[must_use]
    pub fn bound(&self, from: usize, remaining: &[usize]) -> f64 {
        self.entered(from, mask(remaining.iter().copied()))
    }

    /// Lower bound, s, of all tours that begin with a prefix.
    #[must_use]
    pub fn whole(&self, prefix: &[usize], remaining: &[usize]) -> f64 {
        self.beginning(prefix, mask(remaining.iter().copied()))
    }

    /// For each first target the order of smallest bound, best first. In a symmetric model only one
    /// of an order and its reverse is listed.
    #[must_use]
    pub fn orders(&self, count: usize) -> Vec<Vec<usize>> {
        let all = (1 << self.legs.table.targets()) - 1;
        let mut firsts: Vec<(usize, f64)> = members(self.admitted.next(all))
            .map(|first| (first, self.beginning(&[first], all & !(1 << first))))
            .filter(|(_, whole)| whole.is_finite())
            .collect();
        firsts.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut orders: Vec<Vec<usize>> = Vec::new();
        for (first, _) in firsts {
            let order = self.completed(first);
            let backwards: Vec<usize> = order.iter().rev().copied().collect();
            let known =
                orders.contains(&order) || self.legs.symmetric && orders.contains(&backwards);
            if !known {
                orders.push(order);
            }
            if orders.len() == count {
                break;
            }
        }
        orders
    }

    /// The order of smallest bound that begins with a target.
    fn completed(&self, first: usize) -> Vec<usize> {
        let mut order = vec![first];
        let mut left = ((1 << self.legs.table.targets()) - 1) & !(1 << first);
        while left != 0 {
            let whole = |next: usize| {
                let prefix = [&order[..], &[next]].concat();
                self.beginning(&prefix, left & !(1 << next))
            };
            let next = members(self.admitted.next(left))
                .map(|next| (next, whole(next)))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((next, _)) = next else { break };
            order.push(next);
            left &= !(1 << next);
        }
        order
    }

    /// The least sum of all legs over the orders that begin with a prefix; `left` is the set of the
    /// other targets.
    fn beginning(&self, prefix: &[usize], left: usize) -> f64 {
        let (start, no_neighbour) = (self.legs.table.start(), self.legs.no_neighbour());
        let path = [&[no_neighbour, start], prefix].concat();
        if let [_, _, first] = path[..]
            && left != 0
        {
            return self.second(start, first, left);
        }
        let Some(&[h, i, j]) = path.last_chunk() else {
            return self.entered(start, left);
        };
        let fixed = path
            .windows(4)
            .map(|leg| self.legs.cost([leg[0], leg[1], leg[2], leg[3]]));
        fixed.sum::<f64>() + self.after([h, i, j], left)
    }

    /// The least sum of the legs from a place, left in any state, through some targets.
    fn entered(&self, from: usize, left: usize) -> f64 {
        if left == 0 {
            return self.legs.table.bound(from, self.legs.table.end());
        }
        let no_neighbour = self.legs.no_neighbour();
        members(self.admitted.next(left))
            .map(|first| match left & !(1 << first) {
                0 => self.legs.ending([no_neighbour, from, first]),
                others => self.second(from, first, others),
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// The least sum of the legs from a place, left in any state, to a target and through some
    /// others.
    fn second(&self, from: usize, first: usize, left: usize) -> f64 {
        let no_neighbour = self.legs.no_neighbour();
        members(self.admitted.next(left))
            .map(|second| {
                let leg = self.legs.cost([no_neighbour, from, first, second]);
                leg + self.after([from, first, second], left & !(1 << second))
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// `rest`; where `h` is the start, computed from the entries of smaller sets.
    fn after(&self, [h, i, j]: [usize; 3], left: usize) -> f64 {
        if left == 0 {
            return self.legs.ending([h, i, j]);
        }
        if h < self.legs.table.targets() {
            return self.rest[left].get(self.state([h, i, j], left));
        }
        members(self.admitted.next(left))
            .map(|k| self.legs.cost([h, i, j, k]) + self.after([i, j, k], left & !(1 << k)))
            .fold(f64::INFINITY, f64::min)
    }

    /// Index of the entry of three different targets outside a set: each is counted among those
    /// that neither the set nor the triple has had before.
    fn state(&self, [h, i, j]: [usize; 3], set: usize) -> usize {
        let others = self.legs.table.targets() - set.count_ones() as usize;
        let rank = |target: usize, taken: usize| {
            target - (taken & ((1 << target) - 1)).count_ones() as usize
        };
        let first = rank(h, set);
        let second = rank(i, set | 1 << h);
        let third = rank(j, set | 1 << h | 1 << i);
        (first * (others - 1) + second) * (others - 2) + third
    }

    /// The entries of a set, from those of smaller sets.
    fn filled(&self, set: usize) -> RoundedDown {
        let targets = self.legs.table.targets();
        let next = self.admitted.next(set);
        let others: Vec<usize> = members(!set & ((1 << targets) - 1)).collect();
        let count = others.len() * (others.len() - 1) * (others.len() - 2);
        let mut rest = vec![f64::INFINITY; count];
        for &i in &others {
            for &j in others.iter().filter(|&&j| j != i) {
                let mut after = [f64::INFINITY; MAX_EXACT_TARGETS];
                for k in members(next) {
                    after[k] = self.after([i, j, k], set & !(1 << k));
                }
                for &h in others.iter().filter(|&&h| h != i && h != j) {
                    rest[self.state([h, i, j], set)] = least_sum(self.legs.row([h, i, j]), &after);
                }
            }
        }
        RoundedDown::new(&rest)
    }
}
