//! Reserves kept from limits at nodes, so that the limits hold between nodes too.

use crate::model::dynamics::Dynamics;

/// Relative reserves, one per node and per share of [`Dynamics::limit_shares`], and angles, rad, one
/// per node and cone.
#[derive(Debug, Clone)]
pub(crate) struct Reserves {
    shares: usize,
    values: Vec<f64>,
    cones: usize,
    angles: Vec<f64>,
}

impl Reserves {
    /// No reserve at any of the nodes around so many intervals.
    pub(crate) fn none(dynamics: &Dynamics, intervals: usize) -> Self {
        let shares = dynamics.wheel_count() + 4;
        Self {
            shares,
            values: vec![0.0; shares * (intervals + 1)],
            cones: dynamics.cones.len(),
            angles: vec![0.0; dynamics.cones.len() * (intervals + 1)],
        }
    }

    /// The reserves of a node.
    pub(super) fn at(&self, node: usize) -> &[f64] {
        &self.values[node * self.shares..(node + 1) * self.shares]
    }

    /// The angles, rad, kept from cones at a node.
    pub(super) fn of_cones_at(&self, node: usize) -> &[f64] {
        &self.angles[node * self.cones..(node + 1) * self.cones]
    }

    /// Raises the angles kept from cones at both ends of every interval by the depth, rad, found
    /// inside it, times a factor; `depths` lists the cones of one interval after the other.
    pub(crate) fn raise_cones(&mut self, depths: &[f64], factor: f64) {
        raise_both_ends(&mut self.angles, self.cones, depths, factor);
    }

    /// Raises the reserves at both ends of every interval by the excess found inside it, times a
    /// factor; `excess` lists the shares of one interval after the other.
    pub(crate) fn raise(&mut self, excess: &[f64], factor: f64) {
        raise_both_ends(&mut self.values, self.shares, excess, factor);
    }

    /// Raises all reserves by the same amount.
    pub(crate) fn raise_all(&mut self, amount: f64) {
        for value in &mut self.values {
            *value += amount;
        }
    }
}

/// Raises values of nodes, so many per node, by what was found on the intervals around them.
fn raise_both_ends(values: &mut [f64], per_node: usize, found: &[f64], factor: f64) {
    let before = values.to_vec();
    for (i, found) in found.iter().enumerate() {
        for end in [i, i + per_node] {
            values[end] = values[end].max(before[end] + factor * found);
        }
    }
}
