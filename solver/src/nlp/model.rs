//! Storage of one link's values and derivatives.

use super::chain::Chain;

/// Values of one link.
#[derive(Debug, Clone, Default)]
pub(crate) struct LinkValues {
    /// `f_k`.
    pub(crate) cost: f64,
    /// `phi_{k+1}(F_k)`.
    pub(crate) gap: Vec<f64>,
    /// `e_k`.
    pub(crate) equality: Vec<f64>,
    /// `g_k`.
    pub(crate) inequality: Vec<f64>,
}

/// Values and derivatives of one link; matrices are row-major over the variables `(x_k, v_k)`,
/// at the last node over `x_N` alone.
#[derive(Debug, Clone, Default)]
pub(crate) struct LinkModel {
    /// The values.
    pub(crate) values: LinkValues,
    /// Number of variables, the stride of all rows.
    pub(crate) vars: usize,
    /// Gradient of the cost.
    pub(crate) gradient: Vec<f64>,
    /// `[A_k B_k]`, one row per state.
    pub(crate) link_jacobian: Vec<f64>,
    /// One row per equality, over the state only (stride `state_dim`).
    pub(crate) equality_jacobian: Vec<f64>,
    /// One row per inequality.
    pub(crate) inequality_jacobian: Vec<f64>,
    /// Hessian of the Lagrangian: the lower triangle, the only one that is read.
    pub(crate) hessian: Vec<f64>,
}

impl LinkValues {
    fn for_node<C: Chain>(chain: &C, node: usize) -> Self {
        let gap = if node < chain.intervals() {
            chain.state_dim()
        } else {
            0
        };
        Self {
            cost: 0.0,
            gap: vec![0.0; gap],
            equality: vec![0.0; chain.equalities(node)],
            inequality: vec![0.0; chain.inequalities(node)],
        }
    }

    /// Takes over the values of the same node; nothing is allocated.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.cost = other.cost;
        self.gap.copy_from_slice(&other.gap);
        self.equality.copy_from_slice(&other.equality);
        self.inequality.copy_from_slice(&other.inequality);
    }

    /// Sum of absolute gaps and equalities, without inequalities.
    pub(crate) fn defect_norm(&self) -> f64 {
        self.gap.iter().chain(&self.equality).map(|v| v.abs()).sum()
    }

    /// Largest absolute gap or equality.
    pub(crate) fn defect_max(&self) -> f64 {
        self.gap
            .iter()
            .chain(&self.equality)
            .fold(0.0, |worst, v| worst.max(v.abs()))
    }

    /// Whether every value is a finite number.
    pub(crate) fn is_finite(&self) -> bool {
        let vectors = self
            .gap
            .iter()
            .chain(&self.equality)
            .chain(&self.inequality);
        self.cost.is_finite() && vectors.into_iter().all(|v| v.is_finite())
    }
}

impl LinkModel {
    /// Storage for one link of a chain.
    pub(crate) fn for_node<C: Chain>(chain: &C, node: usize) -> Self {
        let states = chain.state_dim();
        let last = node == chain.intervals();
        let vars = if last {
            states
        } else {
            states + chain.control_dim()
        };
        Self {
            values: LinkValues::for_node(chain, node),
            vars,
            gradient: vec![0.0; vars],
            link_jacobian: vec![0.0; if last { 0 } else { states * vars }],
            equality_jacobian: vec![0.0; chain.equalities(node) * states],
            inequality_jacobian: vec![0.0; chain.inequalities(node) * vars],
            hessian: vec![0.0; vars * vars],
        }
    }

    /// Sets all derivatives to zero before a new evaluation.
    pub(crate) fn clear(&mut self) {
        self.gradient.fill(0.0);
        self.link_jacobian.fill(0.0);
        self.equality_jacobian.fill(0.0);
        self.inequality_jacobian.fill(0.0);
        self.hessian.fill(0.0);
    }

    /// Row `i` of the inequality Jacobian.
    pub(crate) fn inequality_row(&self, i: usize) -> &[f64] {
        &self.inequality_jacobian[i * self.vars..(i + 1) * self.vars]
    }
}

/// Storage for the values of all links of a chain.
pub(crate) fn values_of<C: Chain>(chain: &C) -> Vec<LinkValues> {
    (0..=chain.intervals())
        .map(|node| LinkValues::for_node(chain, node))
        .collect()
}

/// Storage for the models of all links of a chain.
pub(crate) fn models_of<C: Chain>(chain: &C) -> Vec<LinkModel> {
    (0..=chain.intervals())
        .map(|node| LinkModel::for_node(chain, node))
        .collect()
}
