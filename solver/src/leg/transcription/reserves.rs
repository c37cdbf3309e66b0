//! Reserves kept from limits at nodes, so that the limits hold between nodes too.

use crate::model::dynamics::Dynamics;

/// Relative reserves, one per node and per share of [`Dynamics::limit_shares`].
#[derive(Debug, Clone)]
pub(crate) struct Reserves {
    shares: usize,
    values: Vec<f64>,
}

impl Reserves {
    /// No reserve at any of the nodes around so many intervals.
    pub(crate) fn none(dynamics: &Dynamics, intervals: usize) -> Self {
        let shares = dynamics.wheel_count() + 4;
        Self {
            shares,
            values: vec![0.0; shares * (intervals + 1)],
        }
    }

    /// The reserves of a node.
    pub(super) fn at(&self, node: usize) -> &[f64] {
        &self.values[node * self.shares..(node + 1) * self.shares]
    }

    /// Raises the reserves at both ends of every interval by the excess found inside it, times a
    /// factor; `excess` lists the shares of one interval after the other.
    pub(crate) fn raise(&mut self, excess: &[f64], factor: f64) {
        let before = self.values.clone();
        for (i, excess) in excess.iter().enumerate() {
            for end in [i, i + self.shares] {
                self.values[end] = self.values[end].max(before[end] + factor * excess);
            }
        }
    }

    /// Raises all reserves by the same amount.
    pub(crate) fn raise_all(&mut self, amount: f64) {
        for value in &mut self.values {
            *value += amount;
        }
    }
}
