//! Triple bounds: lower bounds on tours from triples and fives of places in a row, whose legs take
//! longer together than the sum of their pair bounds.
//!
//! # Triples bound tours
//!
//! Let `t_0 .. t_n` be the durations of the legs of a tour, `t_0` out of the start and `t_n` into
//! the end, and let target `j` lie between the legs `a` and `b`. With pair bounds `d` and the
//! model's bound of the path `(pred j, j, succ j)`, `t_a + t_b >= d_a + d_b + X_j` with the
//! *coupling gap* `X_j >= 0`, which is 0 when the triple is unknown. In the sum over all targets
//! every leg counts twice except the first and the last one. Adding these and halving gives
//!
//! `T = 1/2 (t_0 + sum over j of (t_a + t_b) + t_n) >= sum of d over the legs + 1/2 sum over j of X_j`.
//!
//! # Fives are tighter
//!
//! If each target delays its own two legs by `X_j`, this bound loses half of the delay. Let target
//! `j` have the two places `h, i` before it and `k, l` after it, and let `Z_j >= 0` be the excess
//! of the model's bound of the path `(h, i, j, k, l)` over `X_i + X_k` and the four pair bounds; it
//! is 0 when it is unknown or when `i` or `k` is no target. Then
//!
//! `T >= sum of d over the legs + 1/2 sum over j of X_j + 1/4 sum over j of Z_j`.
//!
//! For in the sum above, a quarter of the two legs around `i` and a quarter of the two around `k`
//! may be replaced by a quarter of the path, which has the same four legs and exceeds them by
//! `Z_j`. Half of the legs around each target is available, and only its two neighbours use it, a
//! quarter each.
//!
//! Both bounds hold for the part of a tour after a prefix, with the last place of the prefix in
//! place of the start.
//!
//! # The relaxation
//!
//! Entry offsets are subtracted and legs made undirected as in [`SpanningTrees`]: an edge `e` is
//! the lesser of its two reduced legs. A tour costs at least its entry offsets, its edges and the
//! cost of passing each of its targets: `1/2 (X_j + slacks of its two legs) + 1/4 Z_j`, in the
//! direction in which this is less. The slack of a leg is its excess over its edge. (A leg between
//! targets is passed at both of its ends, and half of its slack counts at each; a leg from the
//! start or into the end is its own edge.)
//!
//! Now let an inner multiplier `r_j(i)`, of either sign, be subtracted from the edge between target
//! `j` and place `i` and added to the cost of `j` if `i` is its neighbour: the cost of every tour
//! is unchanged. To distinguish the places beyond a neighbour there are outer multipliers `s_i(h)`:
//! subtracted from the edge from target `i` to place `h`, and added to the cost of the other
//! neighbour of `i` if that is a target, else to that of `i` itself; to exactly one target in
//! either case.
//!
//! What neighbouring targets choose has to agree, too: with joint multipliers `w_i(j, h)`, added to the cost
//! of `j` if target `i` is its neighbour and `h` lies beyond `i`, and subtracted from the cost of `i` if
//! target `j` and `h` are its neighbours. Without them `j` passes `i` on the way from an `h` that `i` does
//! not choose beside `j`, and its `Z_j` is the excess over an `X_i` that nobody pays.
//!
//! Then let every target choose its cheapest two neighbours and places beyond them independently,
//! and let the edges, less the multipliers, be chosen as a minimum spanning tree with two outer
//! edges. The tour is feasible for both choices, so the sum of their minima is a lower bound for
//! any multipliers (Lagrangian decomposition, Guignard and Kim 1987). Multipliers `r_j(i) = -p_j`
//! for all `i` are node potentials: the ascent begins there, at the bound of Held and Karp.

mod ascent;
mod choice;
mod coupling_gaps;
mod edge_rows;
mod gap_estimates;
mod multipliers;
mod ranking;
mod subsets;
mod undirected_legs;

pub use ascent::{AscentEffort, AscentWork};
pub(crate) use gap_estimates::FreeEnds;
pub(in crate::tour::order) use gap_estimates::GapEstimates;
pub use subsets::TripleBoundSubsets;

use super::completion::least_tree::{Edge, cheapest, least_tree};
use super::completion::{LegCosts, SpanningTrees};
use super::{PairTable, TourModel};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use choice::Part;
use coupling_gaps::{CouplingGaps, ShortPath};
use edge_rows::EdgeRows;
use multipliers::Multipliers;
use ranking::Ranking;
use std::collections::BTreeSet;
use undirected_legs::UndirectedLegs;

/// Triple bounds, for places numbered as in [`PairTable`].
#[derive(Debug)]
pub struct TripleBounds {
    legs: UndirectedLegs,
    coupling_gaps: CouplingGaps,
    multipliers: Multipliers,
    /// Places around each target by their least possible cost as neighbours.
    near: Ranking,
    /// Places around each target by the target's outer multipliers for them.
    far: Ranking,
    /// Edges between targets less the multipliers.
    edge_rows: EdgeRows,
    /// Best lower bound of all tours so far, s.
    root_s: f64,
    /// Whether many targets have had an ascent.
    raised: bool,
    symmetric: bool,
}

impl TripleBounds {
    /// The bounds with initial multipliers and no triple known; `None` where no target couples its
    /// legs, so that triples add nothing.
    #[must_use]
    pub fn new(model: &dyn TourModel, table: &PairTable, trees: &SpanningTrees) -> Option<Self> {
        if !model.has_couplings() {
            return None;
        }
        let mut triple_bounds = Self {
            legs: UndirectedLegs::new(table, trees.entry_offsets()),
            coupling_gaps: CouplingGaps::new(model, table),
            multipliers: Multipliers::of_potentials(trees.potentials()),
            near: Ranking::default(),
            far: Ranking::default(),
            edge_rows: EdgeRows::default(),
            root_s: 0.0,
            raised: false,
            symmetric: model.is_symmetric(),
        };
        triple_bounds.update_root_bound();
        Some(triple_bounds)
    }

    /// Lower bound, s, of all tours.
    #[must_use]
    pub fn root_bound(&self) -> f64 {
        self.root_s
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    #[must_use]
    pub fn bound(&self, from: usize, remaining: &[usize]) -> f64 {
        if remaining.is_empty() {
            return self.legs.table().bound(from, self.end());
        }
        let part = Part::new(from, self.end(), remaining);
        let first = cheapest(remaining, |to| self.first(from, to)).1;
        let last = cheapest(remaining, |last| self.cost(last, self.end())).1;
        let edges: f64 = self.tree(remaining).iter().map(|edge| edge.weight).sum();
        (self.passing(&part) + first + edges + last).max(0.0)
    }

    /// Asks the model for the unknown triples of some orders.
    pub fn ask_along(
        &mut self,
        orders: &[Vec<usize>],
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) {
        let table = self.legs.table();
        let mut unknown = BTreeSet::new();
        for order in orders {
            let mut path = vec![table.start()];
            path.extend(order);
            path.push(table.end());
            let triples = path.windows(3).map(ShortPath::new);
            unknown.extend(triples.filter(|triple| self.coupling_gaps.is_open(triple)));
        }
        let unknown: Vec<ShortPath> = unknown.into_iter().collect();
        self.ask(&unknown, model, pool, stop);
    }

    /// Learns from the tour of an order how long its legs take together, for estimates.
    pub fn learn(&mut self, order: &[usize], model: &dyn TourModel) {
        let Some(times) = model.leg_times(order) else {
            return;
        };
        let table = self.legs.table();
        let mut path = vec![table.start()];
        path.extend(order);
        path.extend(model.has_end().then_some(table.end()));
        let legs = path.windows(2).zip(times);
        let excesses: Vec<f64> = legs
            .map(|(leg, time_s)| time_s - table.estimate(leg[0], leg[1]))
            .collect();
        self.coupling_gaps.learn(&path, &excesses);
    }

    /// Asks the model for the gaps of paths. The bounds of their legs, over which the gaps are
    /// counted, are raised first.
    fn ask(
        &mut self,
        paths: &[ShortPath],
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) {
        let legs = paths.iter().flat_map(ShortPath::legs);
        let open = legs.filter(|&[from, to]| self.table().can_raise(from, to));
        let open: BTreeSet<[usize; 2]> = open.collect();
        let open: Vec<_> = open.into_iter().collect();
        if !open.is_empty() {
            self.legs.raise(model, &open);
        }
        let table = self.legs.table();
        for leg in open {
            self.coupling_gaps.update(model, table, leg);
        }
        self.coupling_gaps.ask(paths, table, model, pool, stop);
    }

    /// Coupling gap of a target between two places, s, known or estimated. An estimate of an order's
    /// duration adds the whole gap, where a bound adds half: the legs before and after a leg may
    /// delay it independently.
    pub(super) fn coupling_gap(&self, from: usize, via: usize, to: usize) -> f64 {
        self.coupling_gaps.estimate(from, via, to)
    }

    /// Whether every triple has the same gap as its reverse.
    pub(super) fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// The pair bounds.
    pub(super) fn table(&self) -> &PairTable {
        self.legs.table()
    }

    /// Updates the rankings, the edges and the bound of all tours to the current multipliers.
    fn update_root_bound(&mut self) {
        self.apply_multipliers(None);
        let all: Vec<usize> = (0..self.targets()).collect();
        self.root_s = self.root_s.max(self.bound(self.legs.table().start(), &all));
    }

    /// The minimum spanning tree of some targets; its edges join positions in their list.
    fn tree(&self, targets: &[usize]) -> Vec<Edge> {
        let fill = |target: usize, weights: &mut [f64]| {
            let edges = &self.edge_rows;
            edges.fill(&self.legs, &self.multipliers, target, weights);
        };
        if targets.iter().copied().eq(0..self.targets()) {
            return least_tree(targets.len(), fill);
        }
        let mut row = vec![0.0; self.targets()];
        least_tree(targets.len(), |at, weights| {
            fill(targets[at], &mut row);
            for (weight, &other) in weights.iter_mut().zip(targets) {
                *weight = row[other];
            }
        })
    }

    /// Sum over the targets of a part of their entry offsets and the costs of their cheapest
    /// choices, s.
    fn passing(&self, part: &Part<'_>) -> f64 {
        let cost = |&via: &usize| self.legs.entry_offset(via) + self.choice(part, via).cost;
        part.targets.iter().map(cost).sum()
    }

    /// The reduced first leg of a part less its target's multipliers, s.
    fn first(&self, entry: usize, to: usize) -> f64 {
        self.legs.reduced(entry, to) - self.multipliers.taken(to, entry)
    }
}

/// Edges between targets, and into the end, less the multipliers.
impl LegCosts for TripleBounds {
    fn targets(&self) -> usize {
        self.legs.table().targets()
    }

    fn cost(&self, from: usize, to: usize) -> f64 {
        let taken = |target: usize, place: usize| {
            if target < self.targets() {
                self.multipliers.taken(target, place)
            } else {
                0.0
            }
        };
        self.legs.edge(from, to) - taken(from, to) - taken(to, from)
    }
}
