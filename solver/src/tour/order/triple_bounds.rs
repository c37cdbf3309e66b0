//! A bound from triples and fives: what legs cost together beyond the sum of their pair bounds.
//!
//! # Triples bound tours
//!
//! Let `t_0 .. t_n` be the times that the legs of a tour take, `t_0` out of the start, `t_n` into the
//! end, and let target `j` lie between the legs `a` and `b`. With pair bounds `d` and the model's
//! bound of the path `(pred j, j, succ j)`, `t_a + t_b >= d_a + d_b + X_j`, where the coupling_gap
//! `X_j >= 0` is 0 when the triple is unknown. Summed over the targets, every leg counts twice but
//! for the outer two, so adding those and halving,
//!
//! `T = 1/2 (t_0 + sum over j of (t_a + t_b) + t_n) >= sum of d over the legs + 1/2 sum over j of X_j`.
//!
//! # Fives see more
//!
//! If every target delays its own two legs by `X_j`, half of that is lost above. Let target `j` have
//! two places `h, i` before it and two, `k, l`, after it, and let `Z_j >= 0` be what the model's bound
//! of the path `(h, i, j, k, l)` exceeds `X_i + X_k` and the four pair bounds by, 0 when unknown or
//! when `i` or `k` is no target. Then
//!
//! `T >= sum of d over the legs + 1/2 sum over j of X_j + 1/4 sum over j of Z_j`.
//!
//! For in the sum above a quarter of the two legs around `i` and a quarter of the two around `k` may
//! be exchanged for a quarter of the path, which has the same four legs and exceeds them by `Z_j`.
//! Half of the legs around each target is there, and is asked for by its two neighbours only.
//!
//! Both hold for what is left of a tour after a prefix, with the last place of the prefix in place
//! of the start.
//!
//! # The relaxation
//!
//! TripleBounds at entry are taken off and directions forgotten as in
//! [`SpanningTrees`]: an edge `e` is the lesser of its two charged legs, and
//! a tour costs at least its triple_bounds, its edges and what passing each of its targets costs:
//! `1/2 (X_j + what the two legs exceed their edges by) + 1/4 Z_j`, in the direction in which this is
//! less. (A leg between targets is passed at both of its ends, each of which takes half of what it
//! exceeds its edge by; a leg from the start or into the end is its own edge.)
//!
//! Now every target `j` takes over a share `r_j(i)` of the edge to each place `i`, whatever its sign,
//! and pays it itself when it has `i` for a neighbour: every tour still pays the same. To tell apart
//! what lies beyond a neighbour there are outer multipliers `s_i(h)`: taken off the edge from target `i` to
//! place `h`, and paid by the other neighbour of `i` if that is a target, else by `i` itself: by
//! exactly one target again.
//!
//! Then let every target choose for itself the cheapest two neighbours and places beyond them, and
//! let the edges, less what is taken off, be chosen as a least tree with two outer edges. Both
//! choices were free to be those of the tour, so their sum is a bound for any multipliers (Lagrangian
//! decomposition, Guignard and Kim 1987). Multipliers `-p_j` that are the same for all `i` are node prices:
//! there the ascent begins, at the bound of Held and Karp.

mod ascent;
mod choice;
mod coupling_gaps;
mod multipliers;
mod ranking;
mod subsets;
mod undirected_legs;

pub use ascent::{AscentEffort, AscentWork};
pub use subsets::TripleBoundSubsets;

use super::completion::least_tree::{cheapest, least_tree};
use super::completion::{LegCosts, SpanningTrees};
use super::{PairTable, TourModel};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use choice::Part;
use coupling_gaps::{CouplingGaps, ShortPath};
use multipliers::Multipliers;
use ranking::Ranking;
use std::collections::BTreeSet;
use undirected_legs::UndirectedLegs;

/// Bounds from triples, for places numbered as in [`PairTable`].
#[derive(Debug)]
pub struct TripleBounds {
    legs: UndirectedLegs,
    coupling_gaps: CouplingGaps,
    multipliers: Multipliers,
    /// Places around each target by the least that they cost it as neighbours.
    near: Ranking,
    /// Places around each target by the outer multipliers of the edges to them.
    far: Ranking,
    root_s: f64,
    symmetric: bool,
}

impl TripleBounds {
    /// Multipliers to begin with, which know no triple yet; `None` where no target couples its legs, so
    /// that triples tell nothing.
    #[must_use]
    pub fn new(model: &dyn TourModel, table: &PairTable, trees: &SpanningTrees) -> Option<Self> {
        let targets = table.targets();
        if !(0..targets).any(|via| model.couples(via)) {
            return None;
        }
        let mut triple_bounds = Self {
            legs: UndirectedLegs::new(table, trees.entry_offsets()),
            coupling_gaps: CouplingGaps::new(model),
            multipliers: Multipliers::of_potentials(trees.potentials()),
            near: Ranking::new(targets),
            far: Ranking::new(targets),
            root_s: 0.0,
            symmetric: model.is_symmetric(),
        };
        triple_bounds.settle();
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
        let tree = least_tree(remaining.len(), |a, b| {
            self.cost(remaining[a], remaining[b])
        });
        let edges: f64 = tree.iter().map(|edge| edge.weight).sum();
        (self.passing(&part) + first + edges + last).max(0.0)
    }

    /// Asks the model for the triples of some orders that are not known.
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
        self.coupling_gaps.ask(&unknown, table, model, pool, stop);
    }

    /// What passing a target between two others adds to the two legs, s, as far as it is known.
    /// Summed over an order, unlike in a bound, all of it counts: a leg may be delayed by the one before
    /// and the one after it independently.
    pub(super) fn coupling_gap(&self, from: usize, via: usize, to: usize) -> f64 {
        self.coupling_gaps.triple(from, via, to)
    }

    /// Whether every triple takes as long backwards.
    pub(super) fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// The pair bounds.
    pub(super) fn table(&self) -> &PairTable {
        self.legs.table()
    }

    /// Bounds all tours by the multipliers as they are.
    fn settle(&mut self) {
        self.rank();
        let all: Vec<usize> = (0..self.targets()).collect();
        self.root_s = self.root_s.max(self.bound(self.legs.table().start(), &all));
    }

    /// What the targets of a part cost at the least, with their multipliers and triple_bounds, s.
    fn passing(&self, part: &Part<'_>) -> f64 {
        let cost = |&via: &usize| self.legs.entry_offset(via) + self.choice(part, via).cost;
        part.targets.iter().map(cost).sum()
    }

    /// The first leg of a part less what the target takes over, s.
    fn first(&self, entry: usize, to: usize) -> f64 {
        self.legs.reduced(entry, to) - self.multipliers.taken(to, entry)
    }
}

/// Edges between targets, and into the end, less what the targets take over.
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
