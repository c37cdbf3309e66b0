//! Undirected reduced legs, and the cost of passing a target between two of them.

use super::coupling_gaps::CouplingGaps;
use crate::tour::order::{PairTable, TourModel};

/// Legs reduced by the entry offsets of [`crate::tour::order::completion::SpanningTrees`], as
/// undirected edges with their slacks, s.
///
/// Places are numbered as in [`PairTable`].
#[derive(Debug)]
pub(super) struct UndirectedLegs {
    table: PairTable,
    entry_offsets: Vec<f64>,
    /// The lesser of the two reduced legs between two places; from the start and to the end there
    /// is only one leg.
    edges: Vec<f64>,
    /// By how much each reduced leg exceeds its edge.
    slack: Vec<f64>,
}

impl UndirectedLegs {
    pub(super) fn new(table: &PairTable, entry_offsets: &[f64]) -> Self {
        let (targets, places) = (table.targets(), table.targets() + 2);
        let mut legs = Self {
            table: table.clone(),
            entry_offsets: entry_offsets.to_vec(),
            edges: vec![0.0; places * places],
            slack: vec![0.0; places * places],
        };
        for a in 0..targets {
            for b in 0..a {
                legs.update(a, b);
            }
            for outer in [table.start(), table.end()] {
                legs.update(a, outer);
            }
        }
        legs
    }

    /// Sets the edge between a target and another place, and its slacks, from the pair bounds.
    fn update(&mut self, a: usize, b: usize) {
        let (start, end, places) = (
            self.table.start(),
            self.table.end(),
            self.table.targets() + 2,
        );
        let [forth, back] = if b == start {
            [self.reduced(b, a); 2]
        } else if b == end {
            [self.table.bound(a, b); 2]
        } else {
            [self.reduced(a, b), self.reduced(b, a)]
        };
        let edge = forth.min(back);
        for (from, to, leg) in [(a, b, forth), (b, a, back)] {
            self.edges[from * places + to] = edge;
            self.slack[from * places + to] = leg - edge;
        }
    }

    /// Lets the model raise the bounds of open legs.
    pub(super) fn raise(&mut self, model: &dyn TourModel, legs: &[[usize; 2]]) {
        self.table.raise(model, legs);
        for &[from, to] in legs {
            let (outer, target) = (from.max(to), from.min(to));
            self.update(target, outer);
        }
    }

    /// The pair bounds.
    pub(super) fn table(&self) -> &PairTable {
        &self.table
    }

    /// Offset subtracted from every leg into a target, s.
    pub(super) fn entry_offset(&self, target: usize) -> f64 {
        self.entry_offsets[target]
    }

    /// A leg into a target less the entry offset, s.
    pub(super) fn reduced(&self, from: usize, to: usize) -> f64 {
        self.table.bound(from, to) - self.entry_offsets[to]
    }

    /// The lesser of the two directions, s.
    pub(super) fn edge(&self, a: usize, b: usize) -> f64 {
        self.edges[a * (self.entry_offsets.len() + 2) + b]
    }

    /// The same for a target and all targets.
    pub(super) fn edges_at(&self, target: usize) -> &[f64] {
        let targets = self.entry_offsets.len();
        &self.edges[target * (targets + 2)..][..targets]
    }

    /// Cost of passing a target between two places, one way and the other, beyond the two edges, s: half the
    /// slacks of the legs and half the coupling gap. The path comes from `entry`: a leg out of it is its own
    /// edge, and no leg leads into it. Infinite for a direction that is not possible.
    pub(super) fn ways(
        &self,
        coupling_gaps: &CouplingGaps,
        entry: usize,
        [a, via, b]: [usize; 3],
    ) -> [f64; 2] {
        [[a, via, b], [b, via, a]].map(|path| self.directed(coupling_gaps, entry, path))
    }

    /// The lesser of the two for a target with two places before and after it, plus a quarter of the coupling
    /// gap of all five places in this direction.
    pub(super) fn passing_five(
        &self,
        coupling_gaps: &CouplingGaps,
        entry: usize,
        path: [usize; 5],
        ways: [f64; 2],
    ) -> f64 {
        let directed = |path: [usize; 5], way: f64| {
            if path[0] == self.table.end() || path[4] == entry || way.is_infinite() {
                return f64::INFINITY;
            }
            way + 0.25 * coupling_gaps.five(path)
        };
        let [a, b, c, d, e] = path;
        directed(path, ways[0]).min(directed([e, d, c, b, a], ways[1]))
    }

    fn directed(&self, coupling_gaps: &CouplingGaps, entry: usize, path: [usize; 3]) -> f64 {
        let [from, via, to] = path;
        if to == entry || from == self.table.end() {
            return f64::INFINITY;
        }
        let places = self.entry_offsets.len() + 2;
        let first = if from == entry {
            0.0
        } else {
            self.slack[from * places + via]
        };
        0.5 * (first + self.slack[via * places + to] + coupling_gaps.triple(from, via, to))
    }
}
