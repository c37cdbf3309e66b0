//! Dynamic programming over subsets (Held and Karp 1962, Bellman 1962), backwards from the end.
//!
//! `rest(i, {}) = d(i, end)` and `rest(i, R) = min over j in R of d(i, j) + rest(j, R - j)`, where
//! `j` is any target that the rules admit once all but `R` have been visited; infinite where there
//! is none.

use super::{LegCosts, MAX_EXACT_TARGETS};
use crate::model::order_rules::OrderRules;
use crate::run::stop::StopSignal;

/// Sets between two polls of the stop signal: about a millisecond.
const SETS_PER_POLL: usize = 1 << 12;

/// `rest(i, R)` for every target and every set of others, s.
#[derive(Debug)]
pub struct SubsetTable {
    targets: usize,
    /// Entry `from * 2^targets + set`, sets as bit masks; unused where the set holds `from`. With
    /// this layout the table is filled sequentially in memory.
    rest: Vec<f64>,
    admitted: Admitted,
}

/// The rules on sets as bit masks.
#[derive(Debug)]
pub(in crate::tour::order) struct Admitted {
    /// For each position of the order, the targets that may take it.
    at: Vec<usize>,
    /// Every target with predecessors, and the set of these.
    before: Vec<(usize, usize)>,
}

impl Admitted {
    pub(in crate::tour::order) fn of(rules: &OrderRules, targets: usize) -> Self {
        let at = |place| mask((0..targets).filter(|&target| rules.admits_at(place, target)));
        let before = |target| (target, mask(rules.predecessors(target).iter().copied()));
        Self {
            at: (0..targets).map(at).collect(),
            before: (0..targets)
                .map(before)
                .filter(|(_, before)| *before != 0)
                .collect(),
        }
    }

    /// The targets of a set that may come next when exactly the targets outside it have been
    /// visited.
    pub(in crate::tour::order) fn next(&self, set: usize) -> usize {
        let place = self.at.len() - set.count_ones() as usize;
        let here = self.at.get(place).map_or(0, |targets| targets & set);
        let waiting = self.before.iter().filter(|(_, before)| before & set != 0);
        waiting.fold(here, |open, (target, _)| open & !(1 << target))
    }
}

impl SubsetTable {
    /// Fills the table for the orders that some rules admit: `n^2 2^n` steps; `None` when stopped.
    #[must_use]
    pub fn new(costs: &impl LegCosts, rules: &OrderRules, stop: &StopSignal) -> Option<Self> {
        let targets = costs.targets();
        let admitted = Admitted::of(rules, targets);
        // In parts, so that the stop signal is polled: allocating a large table takes as long as
        // filling it.
        let mut rest = Vec::with_capacity(targets << targets);
        for _ in 0..targets {
            if stop.is_set() {
                return None;
            }
            rest.resize(rest.len() + (1 << targets), f64::INFINITY);
        }
        let legs: Vec<[f64; MAX_EXACT_TARGETS]> = (0..targets)
            .map(|from| row(targets, |to| costs.cost(from, to)))
            .collect();
        let place = |from: usize, set: usize| (from << targets) + set;
        for from in 0..targets {
            rest[place(from, 0)] = costs.cost(from, costs.end());
        }
        // A set is greater, as a number, than its subsets.
        for set in 1..1_usize << targets {
            if set % SETS_PER_POLL == 0 && stop.is_set() {
                return None;
            }
            let mut after = [f64::INFINITY; MAX_EXACT_TARGETS];
            for to in members(admitted.next(set)) {
                after[to] = rest[place(to, set & !(1 << to))];
            }
            for from in (0..targets).filter(|from| set & (1 << from) == 0) {
                rest[place(from, set)] = least_sum(&legs[from], &after);
            }
        }
        Some(Self {
            targets,
            rest,
            admitted,
        })
    }

    fn after(&self, from: usize, set: usize) -> f64 {
        self.rest[(from << self.targets) + set]
    }

    /// `rest(from, set)` out of the entries of smaller sets.
    fn shortest(&self, costs: &impl LegCosts, from: usize, set: usize) -> f64 {
        if set == 0 {
            return costs.cost(from, costs.end());
        }
        self.next(set, |to| costs.cost(from, to))
            .map_or(f64::INFINITY, |(_, rest)| rest)
    }

    /// The best next target, the smallest index among equals, and the time it leads to.
    fn next(&self, set: usize, leg: impl Fn(usize) -> f64) -> Option<(usize, f64)> {
        members(self.admitted.next(set))
            .map(|to| (to, leg(to) + self.after(to, set & !(1 << to))))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Length of the shortest path from a place through the remaining targets and to the end, s;
    /// infinite when the rules admit none.
    #[must_use]
    pub fn bound(&self, costs: &impl LegCosts, from: usize, remaining: &[usize]) -> f64 {
        let set = mask(remaining.iter().copied());
        if from < self.targets {
            self.after(from, set)
        } else {
            self.shortest(costs, from, set)
        }
    }

    /// Length of the shortest path through the remaining targets, of which there is at least one,
    /// and to the end, s, when the leg into the first of them has the cost `first`.
    #[must_use]
    pub fn entered(&self, remaining: &[usize], first: impl Fn(usize) -> f64) -> Option<f64> {
        let set = mask(remaining.iter().copied());
        self.next(set, first).map(|(_, rest)| rest)
    }

    /// The order of the remaining targets, of which there is at least one, on a shortest path from
    /// a place.
    #[must_use]
    pub fn shortest_order(
        &self,
        costs: &impl LegCosts,
        from: usize,
        remaining: &[usize],
    ) -> Vec<usize> {
        let mut from = from;
        let mut set = mask(remaining.iter().copied());
        let mut order = Vec::with_capacity(remaining.len());
        while let Some((to, _)) = self.next(set, |to| costs.cost(from, to)) {
            order.push(to);
            set &= !(1 << to);
            from = to;
        }
        order
    }
}

/// A row with an entry for every target, and infinity beyond the last.
fn row(targets: usize, entry: impl Fn(usize) -> f64) -> [f64; MAX_EXACT_TARGETS] {
    let mut row = [f64::INFINITY; MAX_EXACT_TARGETS];
    for (to, slot) in row.iter_mut().enumerate().take(targets) {
        *slot = entry(to);
    }
    row
}

/// The least sum of two entries at the same position. Four lanes at a time halve the time for the
/// whole table.
pub(in crate::tour::order) fn least_sum(
    a: &[f64; MAX_EXACT_TARGETS],
    b: &[f64; MAX_EXACT_TARGETS],
) -> f64 {
    let mut least = [f64::INFINITY; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for lane in 0..4 {
            let sum = a[lane] + b[lane];
            if sum < least[lane] {
                least[lane] = sum;
            }
        }
    }
    least.into_iter().fold(f64::INFINITY, f64::min)
}

/// The targets of a set, in increasing order.
pub(in crate::tour::order) fn members(set: usize) -> impl Iterator<Item = usize> {
    let mut left = set;
    std::iter::from_fn(move || {
        let first = (left != 0).then(|| left.trailing_zeros() as usize)?;
        left &= left - 1;
        Some(first)
    })
}

/// The set of some targets.
pub(in crate::tour::order) fn mask(targets: impl Iterator<Item = usize>) -> usize {
    targets.fold(0, |set, target| set | 1 << target)
}
