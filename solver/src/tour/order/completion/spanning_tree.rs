//! The spanning tree relaxation with node prices (Held and Karp 1970), for paths.
//!
//! A path from `l` through the set `R` to the end is an edge out of `l`, a path through `R` and an
//! edge into the end. Three steps lead to a bound on its length:
//!
//! 1. *Entry triple_bounds.* Every target of `R` is entered exactly once, so a charge `v_j` may be taken
//!    off every leg into `j` and added to the bound once. It is chosen to make what is left as
//!    symmetric as it can be; a dwell at `j`, which is part of every leg into `j`, drops out whole.
//! 2. *Trees.* Directions are forgotten: an edge of `R` weighs the lesser of its two legs. The path
//!    through `R` is a spanning tree of `R`, and none is lighter than the least one.
//! 3. *Prices.* Every target of `R` lies on exactly two legs, so a price `p_j` may be added to every
//!    leg at `j` and `2 p_j` be taken off. Any prices are valid; good ones, found once for the whole
//!    set by subgradient ascent, push the tree towards a path.

use super::least_tree::{cheapest, least_tree};
use crate::tour::order::PairTable;

/// Steps of the ascent; at 0.97 per step the last is a tenth of a percent of the first.
const ASCENT_STEPS: usize = 230;
/// Each step is this much shorter than the one before.
const STEP_DECAY: f64 = 0.97;
/// First step, as a share of the mean leg of the tree.
const FIRST_STEP: f64 = 0.5;

/// TripleBounds and prices of every target, s.
#[derive(Debug)]
pub struct SpanningTrees {
    triple_bounds: Vec<f64>,
    prices: Vec<f64>,
    /// The lesser of the two charged legs between every two targets, by rows.
    edges: Vec<f64>,
}

/// A least tree with its two outer edges.
struct Tree {
    /// Bound on the path, s.
    bound: f64,
    /// Number of edges at each of the remaining targets.
    degrees: Vec<u32>,
}

impl SpanningTrees {
    /// Finds triple_bounds and prices for paths from the start through all targets.
    #[must_use]
    pub fn new(table: &PairTable) -> Self {
        let targets = table.targets();
        let triple_bounds = entry_charges(table);
        let mut trees = Self {
            edges: undirected(table, &triple_bounds),
            triple_bounds,
            prices: vec![0.0; targets],
        };
        let all: Vec<usize> = (0..targets).collect();
        let tree = trees.outer_tree(table, table.start(), &all);
        let mut best = (tree.bound, trees.prices.clone());
        let mut step = FIRST_STEP * tree.bound.abs() / (targets + 1) as f64;
        let mut degrees = tree.degrees;
        for _ in 0..ASCENT_STEPS {
            for (price, &degree) in trees.prices.iter_mut().zip(&degrees) {
                *price += step * (f64::from(degree) - 2.0);
            }
            let tree = trees.outer_tree(table, table.start(), &all);
            if tree.bound > best.0 {
                best = (tree.bound, trees.prices.clone());
            }
            degrees = tree.degrees;
            step *= STEP_DECAY;
        }
        trees.prices = best.1;
        trees
    }

    /// What every leg into a target is relieved of, s.
    pub(in crate::tour::order) fn triple_bounds(&self) -> &[f64] {
        &self.triple_bounds
    }

    /// What every leg at a target is raised by, s.
    pub(in crate::tour::order) fn prices(&self) -> &[f64] {
        &self.prices
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
    fn outer_tree(&self, table: &PairTable, from: usize, remaining: &[usize]) -> Tree {
        let count = remaining.len();
        let mut degrees = vec![0; count];
        let mut bound: f64 = remaining
            .iter()
            .map(|&target| self.triple_bounds[target] - 2.0 * self.prices[target])
            .sum();
        for outer in [
            cheapest(remaining, |to| {
                table.bound(from, to) - self.triple_bounds[to] + self.prices[to]
            }),
            cheapest(remaining, |last| {
                table.bound(last, table.end()) + self.prices[last]
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
        Tree { bound, degrees }
    }

    /// Weight of an edge between two targets, s.
    fn edge(&self, a: usize, b: usize) -> f64 {
        self.edges[a * self.triple_bounds.len() + b] + self.prices[a] + self.prices[b]
    }
}

/// The lesser of the two charged legs between every two targets, by rows, s.
fn undirected(table: &PairTable, triple_bounds: &[f64]) -> Vec<f64> {
    let leg = |from: usize, to: usize| table.bound(from, to) - triple_bounds[to];
    let targets = triple_bounds.len();
    (0..targets * targets)
        .map(|place| (place / targets, place % targets))
        .map(|(a, b)| leg(a, b).min(leg(b, a)))
        .collect()
}

/// The triple_bounds that make the table most nearly symmetric in the sense of least squares, s.
fn entry_charges(table: &PairTable) -> Vec<f64> {
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
