//! The spanning tree relaxation with node potentials (Held and Karp 1970), for paths.
//!
//! A path from `l` through the set `R` to the end is an edge out of `l`, a path through `R` and an
//! edge into the end. Three steps lead to a bound on its length:
//!
//! 1. *Entry entry_offsets.* Every target of `R` is entered exactly once, so a charge `v_j` may be taken
//!    off every leg into `j` and added to the bound once. It is chosen to make what is left as
//!    symmetric as it can be; a dwell at `j`, which is part of every leg into `j`, drops out whole.
//! 2. *Trees.* Directions are forgotten: an edge of `R` weighs the lesser of its two legs. The path
//!    through `R` is a spanning tree of `R`, and none is lighter than the least one.
//! 3. *Prices.* Every target of `R` lies on exactly two legs, so a potential `p_j` may be added to every
//!    leg at `j` and `2 p_j` be taken off. Any potentials are valid; good ones, found once for the whole
//!    set by subgradient ascent, push the tree towards a path.

use super::least_tree::{cheapest, least_tree};
use crate::tour::order::PairTable;

/// Steps of the ascent; at 0.97 per step the last is a tenth of a percent of the first.
const ASCENT_STEPS: usize = 230;
/// Each step is this much shorter than the one before.
const STEP_DECAY: f64 = 0.97;
/// First step, as a share of the mean leg of the tree.
const FIRST_STEP: f64 = 0.5;

/// TripleBounds and potentials of every target, s.
#[derive(Debug)]
pub struct SpanningTrees {
    entry_offsets: Vec<f64>,
    potentials: Vec<f64>,
    /// The lesser of the two charged legs between every two targets, by rows.
    edges: Vec<f64>,
}

/// A least tree with its two outer edges.
struct OuterTree {
    /// Bound on the path, s.
    bound: f64,
    /// Number of edges at each of the remaining targets.
    degrees: Vec<u32>,
}

impl SpanningTrees {
    /// Finds entry_offsets and potentials for paths from the start through all targets.
    #[must_use]
    pub fn new(table: &PairTable) -> Self {
        let targets = table.targets();
        let entry_offsets = entry_offsets(table);
        let mut trees = Self {
            edges: undirected(table, &entry_offsets),
            entry_offsets,
            potentials: vec![0.0; targets],
        };
        let all: Vec<usize> = (0..targets).collect();
        let tree = trees.outer_tree(table, table.start(), &all);
        let mut best = (tree.bound, trees.potentials.clone());
        let mut step = FIRST_STEP * tree.bound.abs() / (targets + 1) as f64;
        let mut degrees = tree.degrees;
        for _ in 0..ASCENT_STEPS {
            for (potential, &degree) in trees.potentials.iter_mut().zip(&degrees) {
                *potential += step * (f64::from(degree) - 2.0);
            }
            let tree = trees.outer_tree(table, table.start(), &all);
            if tree.bound > best.0 {
                best = (tree.bound, trees.potentials.clone());
            }
            degrees = tree.degrees;
            step *= STEP_DECAY;
        }
        trees.potentials = best.1;
        trees
    }

    /// What every leg into a target is relieved of, s.
    pub(in crate::tour::order) fn entry_offsets(&self) -> &[f64] {
        &self.entry_offsets
    }

    /// What every leg at a target is raised by, s.
    pub(in crate::tour::order) fn potentials(&self) -> &[f64] {
        &self.potentials
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    #[must_use]
    pub fn bound(&self, table: &PairTable, from: usize, remaining: &[usize]) -> f64 {
        if remaining.is_empty() {
            return table.bound(from, table.end());
        }
        self.outer_tree(table, from, remaining).bound.max(0.0)
    }

    /// The least tree over the remaining targets, of which there is at least one.
    fn outer_tree(&self, table: &PairTable, from: usize, remaining: &[usize]) -> OuterTree {
        let count = remaining.len();
        let mut degrees = vec![0; count];
        let mut bound: f64 = remaining
            .iter()
            .map(|&target| self.entry_offsets[target] - 2.0 * self.potentials[target])
            .sum();
        for outer in [
            cheapest(remaining, |to| {
                table.bound(from, to) - self.entry_offsets[to] + self.potentials[to]
            }),
            cheapest(remaining, |last| {
                table.bound(last, table.end()) + self.potentials[last]
            }),
        ] {
            degrees[outer.0] += 1;
            bound += outer.1;
        }
        let edge = |a: usize, b: usize| self.edge(remaining[a], remaining[b]);
        for edge in least_tree(count, edge) {
            bound += edge.weight;
            degrees[edge.ends[0]] += 1;
            degrees[edge.ends[1]] += 1;
        }
        OuterTree { bound, degrees }
    }

    /// Weight of an edge between two targets, s.
    fn edge(&self, a: usize, b: usize) -> f64 {
        self.edges[a * self.entry_offsets.len() + b] + self.potentials[a] + self.potentials[b]
    }
}

/// The lesser of the two charged legs between every two targets, by rows, s.
fn undirected(table: &PairTable, entry_offsets: &[f64]) -> Vec<f64> {
    let leg = |from: usize, to: usize| table.bound(from, to) - entry_offsets[to];
    let targets = entry_offsets.len();
    (0..targets * targets)
        .map(|place| (place / targets, place % targets))
        .map(|(a, b)| leg(a, b).min(leg(b, a)))
        .collect()
}

/// The entry_offsets that make the table most nearly symmetric in the sense of least squares, s.
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
