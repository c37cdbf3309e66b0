//! The spanning tree relaxation with node potentials (Held and Karp 1970), for paths.
//!
//! A path from `l` through the set `R` to the end is an edge out of `l`, a path through `R` and an
//! edge into the end. Three steps lead to a bound on its length:
//!
//! 1. *Entry offsets.* Every target of `R` is entered exactly once, so an offset `v_j` may be
//!    subtracted from every leg into `j` and added to the bound once. The offsets make the reduced
//!    legs as nearly symmetric as possible; a dwell at `j`, which is part of every leg into `j`,
//!    drops out entirely.
//! 2. *Trees.* Legs are made undirected: an edge of `R` weighs the lesser of its two reduced legs.
//!    The path through `R` is a spanning tree of `R`, and the minimum spanning tree is no heavier.
//! 3. *Potentials.* Every target of `R` lies on exactly two legs, so a potential `p_j` may be added
//!    to every leg at `j` and `2 p_j` subtracted from the bound. Any potentials are valid; good
//!    ones, found once for all targets by subgradient ascent, bring the tree near to a path.

use super::least_tree::{cheapest, least_tree};
use crate::tour::order::PairTable;

/// Ratio of each step of an ascent to the one before.
const STEP_DECAY: f64 = 0.97;
/// From zero potentials. The last step is a tenth of a percent of the first.
const FULL_ASCENT: Ascent = Ascent {
    first_step: 0.5,
    steps: 230,
};

/// An ascent in the potentials.
#[derive(Debug, Clone, Copy)]
pub(in crate::tour::order) struct Ascent {
    /// First step, relative to the mean leg of the tree.
    pub(in crate::tour::order) first_step: f64,
    /// Number of steps.
    pub(in crate::tour::order) steps: usize,
}

/// Entry offsets and potentials of every target, s.
#[derive(Debug)]
pub struct SpanningTrees {
    entry_offsets: Vec<f64>,
    potentials: Vec<f64>,
    /// The lesser of the two reduced legs between every two targets, by rows.
    edges: Vec<f64>,
    /// Bound on the path from the start through all targets, s.
    bound_s: f64,
}

/// A minimum spanning tree with its two outer edges.
struct OuterTree {
    /// Bound on the path, s.
    bound: f64,
    /// Number of edges at each of the remaining targets.
    degrees: Vec<u32>,
    /// The edges, from one place to another, the outer ones first.
    edges: Vec<[usize; 2]>,
}

impl SpanningTrees {
    /// Computes entry offsets and potentials for paths from the start through all targets.
    #[must_use]
    pub fn new(table: &PairTable) -> Self {
        let potentials = vec![0.0; table.targets()];
        Self::ascended(table, potentials, FULL_ASCENT, |_| ())
    }

    /// The same from known potentials; `visit` is called with the edges of every tree, between places
    /// numbered as in the table.
    pub(in crate::tour::order) fn ascended(
        table: &PairTable,
        potentials: Vec<f64>,
        ascent: Ascent,
        mut visit: impl FnMut(&[[usize; 2]]),
    ) -> Self {
        let targets = table.targets();
        let entry_offsets = entry_offsets(table);
        let mut trees = Self {
            edges: undirected(table, &entry_offsets),
            entry_offsets,
            potentials,
            bound_s: 0.0,
        };
        let all: Vec<usize> = (0..targets).collect();
        let tree = trees.outer_tree(table, table.start(), &all);
        visit(&tree.edges);
        let mut best = (tree.bound, trees.potentials.clone());
        let mut step = ascent.first_step * tree.bound.abs() / (targets + 1) as f64;
        let mut degrees = tree.degrees;
        for _ in 0..ascent.steps {
            for (potential, &degree) in trees.potentials.iter_mut().zip(&degrees) {
                *potential += step * (f64::from(degree) - 2.0);
            }
            let tree = trees.outer_tree(table, table.start(), &all);
            visit(&tree.edges);
            if tree.bound > best.0 {
                best = (tree.bound, trees.potentials.clone());
            }
            degrees = tree.degrees;
            step *= STEP_DECAY;
        }
        (trees.bound_s, trees.potentials) = best;
        trees
    }

    /// Offsets subtracted from the legs into each target, s.
    pub(in crate::tour::order) fn entry_offsets(&self) -> &[f64] {
        &self.entry_offsets
    }

    /// Potentials added to the legs at each target, s.
    pub(in crate::tour::order) fn potentials(&self) -> &[f64] {
        &self.potentials
    }

    /// Lower bound, s, of the path from the start through all targets and to the end.
    pub(in crate::tour::order) fn whole_s(&self) -> f64 {
        self.bound_s
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    #[must_use]
    pub fn bound(&self, table: &PairTable, from: usize, remaining: &[usize]) -> f64 {
        if remaining.is_empty() {
            return table.bound(from, table.end());
        }
        self.outer_tree(table, from, remaining).bound.max(0.0)
    }

    /// The minimum spanning tree of the remaining targets, of which there is at least one.
    fn outer_tree(&self, table: &PairTable, from: usize, remaining: &[usize]) -> OuterTree {
        let count = remaining.len();
        let mut degrees = vec![0; count];
        let mut edges = Vec::with_capacity(count + 1);
        let mut bound: f64 = remaining
            .iter()
            .map(|&target| self.entry_offsets[target] - 2.0 * self.potentials[target])
            .sum();
        let first = cheapest(remaining, |to| {
            table.bound(from, to) - self.entry_offsets[to] + self.potentials[to]
        });
        let last = cheapest(remaining, |last| {
            table.bound(last, table.end()) + self.potentials[last]
        });
        for (place, (position, weight)) in [(from, first), (table.end(), last)] {
            degrees[position] += 1;
            bound += weight;
            edges.push([remaining[position], place]);
        }
        let whole = remaining.iter().copied().eq(0..self.potentials.len());
        let others = (!whole).then_some(remaining);
        let fill = |a: usize, weights: &mut [f64]| self.fill(remaining[a], others, weights);
        for edge in least_tree(count, fill) {
            bound += edge.weight;
            degrees[edge.ends[0]] += 1;
            degrees[edge.ends[1]] += 1;
            edges.push(edge.ends.map(|position| remaining[position]));
        }
        OuterTree {
            bound,
            degrees,
            edges,
        }
    }

    /// Weights of the edges between a target and some others, or all in their order, s.
    fn fill(&self, target: usize, others: Option<&[usize]>, weights: &mut [f64]) {
        let targets = self.entry_offsets.len();
        let row = &self.edges[target * targets..][..targets];
        let here = self.potentials[target];
        if let Some(others) = others {
            for (weight, &other) in weights.iter_mut().zip(others) {
                *weight = row[other] + here + self.potentials[other];
            }
        } else {
            let known = row.iter().zip(&self.potentials);
            for (weight, (edge, there)) in weights.iter_mut().zip(known) {
                *weight = edge + here + there;
            }
        }
    }
}

/// The lesser of the two reduced legs between every two targets, by rows, s.
fn undirected(table: &PairTable, entry_offsets: &[f64]) -> Vec<f64> {
    let leg = |from: usize, to: usize| table.bound(from, to) - entry_offsets[to];
    let targets = entry_offsets.len();
    (0..targets * targets)
        .map(|place| (place / targets, place % targets))
        .map(|(a, b)| leg(a, b).min(leg(b, a)))
        .collect()
}

/// The entry offsets that make the table most nearly symmetric in the least-squares sense, s.
fn entry_offsets(table: &PairTable) -> Vec<f64> {
    let targets = table.targets();
    (0..targets)
        .map(|to| {
            let skew: f64 = (0..targets)
                .map(|from| table.bound(from, to) - table.bound(to, from))
                .sum();
            skew / targets as f64
        })
        .collect()
}
