//! The edges between targets less the multipliers, a row at a time.

use super::multipliers::{Multipliers, narrow};
use super::undirected_legs::UndirectedLegs;

/// Edges between targets less the multipliers, s, for spanning trees. Of most edges only the common parts of
/// the inner multipliers are subtracted, so that no matrix of all is kept.
pub(super) struct EdgeRows<'a> {
    legs: &'a UndirectedLegs,
    targets: &'a [usize],
    /// Whether these are all, in their order.
    whole: bool,
    common: &'a [f64],
    /// What else is subtracted from the edges at each target: the other target, and how much.
    rest: Vec<Vec<(u32, f64)>>,
    row: Vec<f64>,
}

impl<'a> EdgeRows<'a> {
    /// The edges between some targets.
    pub(super) fn new(
        legs: &'a UndirectedLegs,
        multipliers: &'a Multipliers,
        targets: &'a [usize],
    ) -> Self {
        let count = legs.table().targets();
        let mut rest = vec![Vec::new(); count];
        for target in 0..count {
            let near = multipliers.near_rest(target).listed();
            let listed = near.chain(multipliers.outer(target).listed());
            for (other, value) in listed.filter(|listed| listed.0 < count) {
                rest[target].push((narrow(other), value));
                rest[other].push((narrow(target), value));
            }
        }
        Self {
            legs,
            targets,
            whole: targets.iter().copied().eq(0..count),
            common: multipliers.common_parts(),
            rest,
            row: vec![0.0; count],
        }
    }

    /// Writes the edges between one of the targets, by its position, and all of them, in their order. That to
    /// itself means nothing.
    pub(super) fn fill(&mut self, position: usize, weights: &mut [f64]) {
        let target = self.targets[position];
        if self.whole {
            return self.fill_all(target, weights);
        }
        let mut row = std::mem::take(&mut self.row);
        self.fill_all(target, &mut row);
        for (weight, &other) in weights.iter_mut().zip(self.targets) {
            *weight = row[other];
        }
        self.row = row;
    }

    /// Writes the edges between a target and every other one.
    fn fill_all(&self, target: usize, weights: &mut [f64]) {
        let here = self.common[target];
        let edges = self.legs.edges_at(target).iter().zip(self.common);
        for (weight, (edge, there)) in weights.iter_mut().zip(edges) {
            *weight = edge - here - there;
        }
        for &(other, value) in &self.rest[target] {
            weights[other as usize] -= value;
        }
    }
}
