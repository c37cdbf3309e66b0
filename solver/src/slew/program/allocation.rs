//! The conditions under which torques are those that the pseudo-inverse shares out.
//!
//! `u = A^+ A u` (RW/CMG thesis, equation 87) asks that `u` has nothing in the null space of `A`.
//! Constant torques have nothing there when the momenta have the same there at both nodes. Linear
//! torques could alternate about that, so it is asked of them themselves, at every node but the last:
//! there it follows from the momenta, which have their own condition at the end.

use super::Program;
use crate::nlp::Chain;
use crate::slew::shape::TorqueCourse;
use nalgebra::{DMatrix, DVector};

/// What the wheels keep in the null space of their axes.
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
    /// What is missing at a point, whose attitude has one number more than directions.
    pub(super) fn residual(&self, point: &[f64]) -> f64 {
        let entries = &point[1 + self.at..];
        let terms = self.coefficients.iter().zip(entries);
        terms.map(|(c, x)| c * x).sum::<f64>() - self.value
    }
}

impl Program {
    /// The equations of a node.
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
