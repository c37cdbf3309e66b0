//! What a problem must tell the interior point about itself.

use super::model::{LinkModel, LinkValues};

/// A chain-structured nonlinear program; see the [module](super) for the formulas.
pub(crate) trait Chain {
    /// Number of intervals `N`; nodes are `0..=N`.
    fn intervals(&self) -> usize;
    /// Numbers that store one state.
    fn point_len(&self) -> usize;
    /// Dimension of a state's tangent space.
    fn state_dim(&self) -> usize;
    /// Number of controls of an interval.
    fn control_dim(&self) -> usize;
    /// Number of equalities at a node.
    fn equalities(&self, node: usize) -> usize;
    /// Number of inequalities of a node and the interval that begins there.
    fn inequalities(&self, node: usize) -> usize;
    /// Moves a point by a tangent step; exact inverse of the chart in which gaps are measured.
    fn retract(&self, point: &[f64], step: &[f64], moved: &mut [f64]);
    /// Evaluates cost, gap, equalities and inequalities.
    fn values(&self, link: &Link<'_>, out: &mut LinkValues);
    /// Evaluates first derivatives and the lower triangle of the Hessian of the Lagrangian.
    ///
    /// `out` arrives with the values and with zeroed matrices and vectors.
    fn derivatives(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel);
}

/// One node with the interval that begins there; the last node has empty `control` and `next`.
pub(crate) struct Link<'a> {
    /// Index of the node.
    pub(crate) node: usize,
    /// The state at the node.
    pub(crate) point: &'a [f64],
    /// The controls of the interval.
    pub(crate) control: &'a [f64],
    /// The state at the next node.
    pub(crate) next: &'a [f64],
}

impl Link<'_> {
    /// Whether an interval begins at this node.
    pub(crate) fn has_interval(&self) -> bool {
        !self.control.is_empty()
    }
}

/// The multipliers that weigh the second derivatives of one link.
pub(crate) struct LinkMultipliers<'a> {
    /// Of the gap to the next node.
    pub(crate) gap: &'a [f64],
    /// Of the node equalities.
    pub(crate) equality: &'a [f64],
    /// Of the inequalities.
    pub(crate) inequality: &'a [f64],
}
