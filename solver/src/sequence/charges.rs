//! A bound from triples: what two legs cost beyond the sum of their pair bounds.
//!
//! # Triples bound tours
//!
//! Let `t_0 .. t_n` be the times that the legs of a tour take, `t_0` out of the start, `t_n` into the
//! end, and let target `j` lie between the legs `a` and `b`. With the pair bounds `d` and the triple
//! bounds `q`, `t_a + t_b >= q(pred j, j, succ j) = d(pred j, j) + d(j, succ j) + X_j`, where the
//! excess `X_j >= 0` is 0 when the triple is unknown. Summed over the targets, every leg counts
//! twice but for the outer two, so adding those and halving,
//!
//! `T = 1/2 (t_0 + sum over j of (t_a + t_b) + t_n) >= sum of d over the legs + 1/2 sum over j of X_j`.
//!
//! The same holds for what is left of a tour after a prefix, with the last place of the prefix in
//! place of the start.
//!
//! # The relaxation
//!
//! Charges at entry are taken off and directions forgotten as in
//! [`SpanningTrees`]: an edge `e` is the lesser of its two charged legs, and
//! a tour costs at least its charges, its edges and what passing each of its targets costs:
//! `1/2 (X_j + what the two legs exceed their edges by)`, in the direction in which this is less.
//! (A leg between targets is passed at both of its ends, each of which takes half of what it
//! exceeds its edge by; a leg from the start or into the end is its own edge.)
//!
//! Now every target `j` takes over a share `r_j(i)` of the edge to each place `i`, whatever its sign,
//! and pays it itself when it has `i` for a neighbour: every tour still pays the same. Then let
//! every target choose the cheapest two neighbours for itself, and let the edges, less the shares
//! taken over at both ends, be chosen as a least tree with two outer edges. Both choices were free
//! to be those of the tour, so their sum is a bound for any shares (Lagrangian decomposition,
//! Guignard and Kim 1987). Shares `-p_j` that are the same for all `i` are node prices: there the
//! ascent begins, at the bound of Held and Karp.

mod ascent;
mod legs;
mod neighbours;
mod subsets;
mod triples;

pub use ascent::{Effort, Raised};
pub use subsets::ChargedSubsets;

use super::remainder::least_tree::{cheapest, least_tree};
use super::remainder::{LegCosts, SpanningTrees};
use super::{PairTable, TourModel};
use legs::Legs;
use neighbours::{Choice, Neighbours};
use triples::Triples;

/// Bounds from triples, for places numbered as in [`PairTable`].
#[derive(Debug)]
pub struct Charges {
    legs: Legs,
    triples: Triples,
    /// Row `j`, one for each target: what it takes over of the edge to each place, s.
    shares: Vec<f64>,
    neighbours: Neighbours,
    root_s: f64,
}

/// The part of a tour that a bound is of.
struct Part<'a> {
    /// Where it comes from.
    entry: usize,
    /// The targets on it.
    targets: &'a [usize],
    /// Whether a place lies on it.
    admitted: Vec<bool>,
}

impl Charges {
    /// Shares to begin with, which know no triple yet; `None` where no target couples its legs, so
    /// that triples tell nothing.
    #[must_use]
    pub fn new(model: &dyn TourModel, table: &PairTable, trees: &SpanningTrees) -> Option<Self> {
        let targets = table.targets();
        if !(0..targets).any(|via| model.couples(via)) {
            return None;
        }
        let prices = trees.prices().iter();
        let mut charges = Self {
            legs: Legs::new(table, trees.charges()),
            triples: Triples::new(model),
            shares: prices
                .flat_map(|price| std::iter::repeat_n(-price, targets + 2))
                .collect(),
            neighbours: Neighbours::new(targets),
            root_s: 0.0,
        };
        charges.settle();
        Some(charges)
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
        let part = self.part(from, remaining);
        let first = cheapest(remaining, |to| self.first(from, to)).1;
        let last = cheapest(remaining, |last| self.cost(last, self.end())).1;
        let tree = least_tree(remaining.len(), |a, b| {
            self.cost(remaining[a], remaining[b])
        });
        let edges: f64 = tree.iter().map(|edge| edge.weight).sum();
        (self.passing(&part) + first + edges + last).max(0.0)
    }

    /// Duration, s, that an order may have by what is known of its pairs and triples: unlike in a
    /// bound, all triples count in full, as they do where a leg is delayed by the one before and
    /// the one after it independently.
    #[must_use]
    pub fn estimate(&self, order: &[usize]) -> f64 {
        let table = self.legs.table();
        let mut path = vec![table.start()];
        path.extend(order);
        path.push(table.end());
        let legs = path.windows(2).map(|leg| table.bound(leg[0], leg[1]));
        let excesses = path
            .windows(3)
            .map(|triple| self.triples.excess(triple[0], triple[1], triple[2]));
        legs.chain(excesses).sum()
    }

    /// Sorts the neighbours by the shares, and bounds all tours.
    fn settle(&mut self) {
        let places = self.targets() + 2;
        for (via, shares) in self.shares.chunks_exact(places).enumerate() {
            self.neighbours.sort(via, shares);
        }
        let all: Vec<usize> = (0..self.targets()).collect();
        self.root_s = self.root_s.max(self.bound(self.legs.table().start(), &all));
    }

    fn part<'a>(&self, entry: usize, targets: &'a [usize]) -> Part<'a> {
        let mut admitted = vec![false; self.targets() + 2];
        for &place in targets.iter().chain([&entry, &self.end()]) {
            admitted[place] = true;
        }
        Part {
            entry,
            targets,
            admitted,
        }
    }

    /// What the targets of a part cost at the least, with their shares and charges, s.
    fn passing(&self, part: &Part<'_>) -> f64 {
        let cost = |&via: &usize| self.legs.charge(via) + self.choice(part, via).cost;
        part.targets.iter().map(cost).sum()
    }

    /// The neighbours that a target of a part chooses for itself.
    fn choice(&self, part: &Part<'_>, via: usize) -> Choice {
        let outer = |place| place == part.entry || place == self.end();
        self.neighbours.cheapest(
            via,
            self.shares_of(via),
            |place| part.admitted[place],
            |[a, b]| {
                // Only a lone target lies between where the part comes from and the end.
                if outer(a) && outer(b) && part.targets.len() > 1 {
                    return f64::INFINITY;
                }
                self.legs.passing(&self.triples, part.entry, via, [a, b])
            },
        )
    }

    fn shares_of(&self, via: usize) -> &[f64] {
        let places = self.targets() + 2;
        &self.shares[via * places..][..places]
    }

    /// The first leg of a part less what the target takes over, s.
    fn first(&self, entry: usize, to: usize) -> f64 {
        self.legs.charged(entry, to) - self.shares_of(to)[entry]
    }
}

/// Edges between targets, and into the end, less what the targets take over.
impl LegCosts for Charges {
    fn targets(&self) -> usize {
        self.legs.table().targets()
    }

    fn cost(&self, from: usize, to: usize) -> f64 {
        let taken = |via: usize, place: usize| {
            if via < self.targets() {
                self.shares_of(via)[place]
            } else {
                0.0
            }
        };
        self.legs.edge(from, to) - taken(from, to) - taken(to, from)
    }
}
