//! Conditions under which torques are allocated by the pseudo-inverse.
//!
//! `u = A^+ A u` (RW/CMG thesis, equation 87) means that `u` has no component in the null space of
//! `A`. Constant torques have none if the momenta have the same null-space components at both nodes.
//! Linear torques could alternate about zero under that condition, so the condition is put on the
//! torques themselves at every node but the last, where it follows from the momenta's end condition.

use super::Program;
use crate::nlp::Chain;
use crate::slew::shape::TorqueCourse;
use nalgebra::{DMatrix, DVector};

/// The null-space momentum that the wheels keep.
#[derive(Debug, Clone)]
pub(super) struct PinnedNullSpace {
    /// Orthonormal columns that span the null space.
    pub(super) null_space: DMatrix<f64>,
    /// Components of the momenta along them, scaled.
    pub(super) momenta: DVector<f64>,
}

/// A linear equation on the state at a node: coefficients of one entry per wheel.
pub(super) struct AllocationRow {
    /// The first entry, among the state's.
    pub(super) at: usize,
    pub(super) coefficients: Vec<f64>,
    pub(super) value: f64,
}

impl AllocationRow {
    /// Left side minus right side at a point. A point has one number more than the state has
    /// directions, because of the quaternion.
    pub(super) fn residual(&self, point: &[f64]) -> f64 {
        let entries = &point[1 + self.at..];
        let terms = self.coefficients.iter().zip(entries);
        terms.map(|(c, x)| c * x).sum::<f64>() - self.value
    }
}

impl Program {
    /// The allocation's equations at a node.
    pub(super) fn allocation_rows(&self, node: usize) -> impl Iterator<Item = AllocationRow> + '_ {
        let (first, last) = (node == 0, node == self.base.intervals());
        let (at, ramps) = match self.shape.course {
            TorqueCourse::Steps => (3, false),
            TorqueCourse::Ramps => (self.shape.torque_at(), true),
        };
        // The momenta have conditions of their own at both ends.
        let asked = !last && (ramps || !first);
        let kept = self.pinned_null_space.iter().filter(move |_| asked);
        kept.flat_map(move |kept| {
            let columns = kept.null_space.column_iter().zip(kept.momenta.iter());
            columns.map(move |(column, held)| AllocationRow {
                at,
                coefficients: column.iter().copied().collect(),
                value: if ramps { 0.0 } else { *held },
            })
        })
    }
}
