//! The contract between a problem and the engine: the functions of a chain, and the storage for
//! its values and derivatives.

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
    /// Storage for one link of a chain.
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

    /// Copies the values of the same node without allocating.
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
    #[cfg(test)]
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
