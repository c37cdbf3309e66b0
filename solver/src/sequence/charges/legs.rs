//! Legs and pairs of legs with the directions forgotten.

use super::triples::Triples;
use crate::sequence::PairTable;

/// Legs with the entry charges of [`crate::sequence::remainder::SpanningTrees`] taken off, s.
///
/// Places are numbered as in [`PairTable`].
#[derive(Debug)]
pub(super) struct Legs {
    table: PairTable,
    charges: Vec<f64>,
    /// The lesser of the two charged legs between two places; from the start and to the end there
    /// is only one.
    edges: Vec<f64>,
    /// By how much a charged leg exceeds its edge.
    slack: Vec<f64>,
}

impl Legs {
    pub(super) fn new(table: &PairTable, charges: &[f64]) -> Self {
        let (targets, places) = (table.targets(), table.targets() + 2);
        let mut legs = Self {
            table: table.clone(),
            charges: charges.to_vec(),
            edges: vec![0.0; places * places],
            slack: vec![0.0; places * places],
        };
        for a in 0..targets {
            for b in (0..targets).filter(|&b| b != a) {
                let (forth, back) = (legs.charged(a, b), legs.charged(b, a));
                legs.edges[a * places + b] = forth.min(back);
                legs.slack[a * places + b] = forth - forth.min(back);
            }
            let (first, last) = (legs.charged(table.start(), a), table.bound(a, table.end()));
            for (place, edge) in [(table.start(), first), (table.end(), last)] {
                legs.edges[a * places + place] = edge;
                legs.edges[place * places + a] = edge;
            }
        }
        legs
    }

    /// The pair bounds.
    pub(super) fn table(&self) -> &PairTable {
        &self.table
    }

    /// What is taken off every leg into a target, s.
    pub(super) fn charge(&self, target: usize) -> f64 {
        self.charges[target]
    }

    /// A leg into a target without its charge, s.
    pub(super) fn charged(&self, from: usize, to: usize) -> f64 {
        self.table.bound(from, to) - self.charges[to]
    }

    /// The lesser of the two directions, s.
    pub(super) fn edge(&self, a: usize, b: usize) -> f64 {
        self.edges[a * (self.charges.len() + 2) + b]
    }

    /// What passing a target between two places costs beyond half of either edge, s, on a path that
    /// comes from `entry`: from there every leg is taken as it is, and nothing leads there. The
    /// lesser of the directions that are possible, and infinite when none is.
    pub(super) fn passing(
        &self,
        triples: &Triples,
        entry: usize,
        via: usize,
        ends: [usize; 2],
    ) -> f64 {
        let end = self.table.end();
        let places = self.charges.len() + 2;
        let directed = |from: usize, to: usize| {
            if to == entry || from == end {
                return f64::INFINITY;
            }
            let first = if from == entry {
                0.0
            } else {
                self.slack[from * places + via]
            };
            first + self.slack[via * places + to] + triples.excess(from, via, to)
        };
        0.5 * directed(ends[0], ends[1]).min(directed(ends[1], ends[0]))
    }
}
