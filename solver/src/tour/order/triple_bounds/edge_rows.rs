//! The edges between targets less the multipliers, a row at a time.

use super::coupling_gaps::narrow;
use super::multipliers::Multipliers;
use super::undirected_legs::UndirectedLegs;

/// What is subtracted from single edges between targets, s. From most edges only the common parts of the
/// inner multipliers are, so that no matrix of all is kept.
#[derive(Debug, Default)]
pub(super) struct EdgeRows {
    /// For each target the others whose edge is reduced by more, and by how much.
    rest: Vec<Vec<(u32, f64)>>,
}

impl EdgeRows {
    /// Takes what some multipliers subtract.
    pub(super) fn update(&mut self, targets: usize, multipliers: &Multipliers) {
        self.rest.resize_with(targets, Vec::new);
        self.rest.iter_mut().for_each(Vec::clear);
        for target in 0..targets {
            let near = multipliers.near_rest(target).listed();
            let listed = near.chain(multipliers.outer(target).listed());
            for (other, value) in listed.filter(|listed| listed.0 < targets) {
                self.rest[target].push((narrow(other), value));
                self.rest[other].push((narrow(target), value));
            }
        }
    }

    /// Writes the edges between a target and all targets less the multipliers. That to itself means nothing.
    pub(super) fn fill(
        &self,
        legs: &UndirectedLegs,
        multipliers: &Multipliers,
        target: usize,
        weights: &mut [f64],
    ) {
        let here = multipliers.common(target);
        let edges = legs.edges_at(target).iter();
        for (weight, (edge, there)) in weights
            .iter_mut()
            .zip(edges.zip(multipliers.common_parts()))
        {
            *weight = edge - here - there;
        }
        for &(other, value) in &self.rest[target] {
            weights[other as usize] -= value;
        }
    }
}
