//! The Newton system of a chain, solved by one backward and one forward sweep.
//!
//! With the inequalities condensed into `sigma = z / s`, a Newton step minimises
//!
//! ```text
//!   sum_k  1/2 d_k^T M_k d_k + r_k . d_k      d_k = (dx_k, dv_k)
//!   subject to  dx_{k+1} = A_k dx_k + B_k dv_k + gap_k,   C_k dx_k + e_k = 0
//! ```
//!
//! with `M_k = H_k + J_k^T sigma_k J_k + delta I`. The cost to go `1/2 dx^T P dx + p . dx` follows
//! the Riccati recursion; the costates are `lambda_k = P_k dx_k + p_k`.
//!
//! Node equalities enter as a proximal penalty: `C dx + e = rho (nu+ - nu)`. Repeating the cheap
//! vector sweep with `nu <- nu+` converges to the exact multiplier at a rate of order `rho`; the
//! factorisation stays a plain Cholesky, and curvature along directions that the equalities fix
//! need not be positive.

use super::dense::{
    add_mul, add_outer_lower, add_transpose_mul, axpy, cholesky, cholesky_solve, dot,
};
use super::iterate::Layout;
use super::model::LinkModel;

/// Proximal weight of node equalities. Smaller converges in fewer sweeps, larger loses fewer
/// digits in the sums `M + C^T C / rho`.
const RHO: f64 = 1e-6;
/// Most vector sweeps for one step; each shrinks the equality residual by orders of magnitude.
const MAX_SWEEPS: usize = 6;
/// Equality residual at which the sweeps end (absolute, scaled variables).
const SWEEP_TOLERANCE: f64 = 1e-13;

/// The blocks of one node after the backward sweep.
#[derive(Debug, Clone, Default)]
struct Stage {
    /// `M` plus the cost to go, then the Cholesky factor of its control block in place.
    matrix: Vec<f64>,
    /// `-M_vv^-1 M_vx`, one row per control.
    feedback: Vec<f64>,
    /// `-M_vv^-1 m_v`.
    feedforward: Vec<f64>,
    /// Cholesky factor of `M_vv`.
    control_factor: Vec<f64>,
    /// `P`, both triangles.
    cost_to_go: Vec<f64>,
    /// `p`.
    cost_vector: Vec<f64>,
}

/// Right-hand side of the Newton system, in the order of the iterate's flat vectors.
#[derive(Debug, Clone, Default)]
pub(super) struct RightHandSide {
    /// `r_k`, states.
    pub(super) states: Vec<f64>,
    /// `r_k`, controls.
    pub(super) controls: Vec<f64>,
    /// `gap_k`.
    pub(super) gap: Vec<f64>,
    /// `e_k`.
    pub(super) equality: Vec<f64>,
}

/// A Newton step: primal steps and the new multipliers of links and equalities.
#[derive(Debug, Clone, Default)]
pub(super) struct Step {
    /// `dx_k`.
    pub(super) states: Vec<f64>,
    /// `dv_k`.
    pub(super) controls: Vec<f64>,
    /// New link multipliers.
    pub(super) lambda: Vec<f64>,
    /// New equality multipliers.
    pub(super) nu: Vec<f64>,
}

/// The factorised Newton system.
#[derive(Debug, Default)]
pub(super) struct Riccati {
    layout: Layout,
    stages: Vec<Stage>,
    /// Cholesky factor of `P_0`.
    initial_factor: Vec<f64>,
    scratch: Vec<f64>,
}

impl Riccati {
    /// Storage for a layout.
    pub(super) fn new(layout: &Layout) -> Self {
        let (n, m) = (layout.states, layout.controls);
        let stage = |last: bool| {
            let vars = if last { n } else { n + m };
            Stage {
                matrix: vec![0.0; vars * vars],
                feedback: vec![0.0; m * n],
                feedforward: vec![0.0; m],
                control_factor: vec![0.0; m * m],
                cost_to_go: vec![0.0; n * n],
                cost_vector: vec![0.0; n],
            }
        };
        Self {
            layout: layout.clone(),
            stages: (0..=layout.intervals)
                .map(|k| stage(k == layout.intervals))
                .collect(),
            initial_factor: vec![0.0; n * n],
            scratch: vec![0.0; n * (n + m)],
        }
    }

    /// Factorises the system; false when it is not convex on the null space of the constraints,
    /// so that a larger `delta` is needed. Without `hessian` only `J^T sigma J + delta I` is used.
    pub(super) fn factor(
        &mut self,
        models: &[LinkModel],
        sigma: &[f64],
        delta: f64,
        hessian: bool,
    ) -> bool {
        for node in (0..=self.layout.intervals).rev() {
            self.condense(node, &models[node], sigma, delta, hessian);
            if node < self.layout.intervals {
                self.add_cost_to_go(node, &models[node]);
                if !self.eliminate_controls(node) {
                    return false;
                }
            } else {
                let n = self.layout.states;
                let Stage {
                    matrix, cost_to_go, ..
                } = &mut self.stages[node];
                for i in 0..n {
                    for j in 0..=i {
                        cost_to_go[i * n + j] = matrix[i * n + j];
                        cost_to_go[j * n + i] = matrix[i * n + j];
                    }
                }
            }
            self.add_equalities(node, &models[node]);
        }
        self.initial_factor
            .copy_from_slice(&self.stages[0].cost_to_go);
        cholesky(&mut self.initial_factor, self.layout.states)
    }

    fn condense(
        &mut self,
        node: usize,
        model: &LinkModel,
        sigma: &[f64],
        delta: f64,
        hessian: bool,
    ) {
        let matrix = &mut self.stages[node].matrix;
        if hessian {
            matrix.copy_from_slice(&model.hessian);
        } else {
            matrix.fill(0.0);
        }
        let weights = &sigma[self.layout.inequality(node)];
        for (i, weight) in weights.iter().enumerate() {
            add_outer_lower(matrix, model.vars, *weight, model.inequality_row(i));
        }
        for i in 0..model.vars {
            matrix[i * model.vars + i] += delta;
        }
    }

    /// `M += [A B]^T P_{k+1} [A B]`, lower triangle.
    fn add_cost_to_go(&mut self, node: usize, model: &LinkModel) {
        let (n, vars) = (self.layout.states, model.vars);
        let (head, tail) = self.stages.split_at_mut(node + 1);
        let matrix = &mut head[node].matrix;
        let next = &tail[0].cost_to_go;
        self.scratch.fill(0.0);
        for i in 0..n {
            let product = &mut self.scratch[i * vars..(i + 1) * vars];
            for j in 0..n {
                axpy(
                    next[i * n + j],
                    &model.link_jacobian[j * vars..(j + 1) * vars],
                    product,
                );
            }
        }
        for r in 0..n {
            let product = &self.scratch[r * vars..(r + 1) * vars];
            for i in 0..vars {
                let scale = model.link_jacobian[r * vars + i];
                axpy(scale, &product[..=i], &mut matrix[i * vars..=i * vars + i]);
            }
        }
    }

    fn eliminate_controls(&mut self, node: usize) -> bool {
        let (n, m) = (self.layout.states, self.layout.controls);
        let vars = n + m;
        let Stage {
            matrix,
            feedback,
            control_factor,
            cost_to_go,
            ..
        } = &mut self.stages[node];
        for i in 0..m {
            for j in 0..=i {
                control_factor[i * m + j] = matrix[(n + i) * vars + n + j];
            }
        }
        if !cholesky(control_factor, m) {
            return false;
        }
        let mut column = [0.0; 32];
        for j in 0..n {
            for i in 0..m {
                column[i] = matrix[(n + i) * vars + j];
            }
            cholesky_solve(control_factor, m, &mut column[..m]);
            for i in 0..m {
                feedback[i * n + j] = -column[i];
            }
        }
        for i in 0..n {
            for j in 0..=i {
                let mut value = matrix[i * vars + j];
                for c in 0..m {
                    value += matrix[(n + c) * vars + i] * feedback[c * n + j];
                }
                cost_to_go[i * n + j] = value;
                cost_to_go[j * n + i] = value;
            }
        }
        true
    }

    fn add_equalities(&mut self, node: usize, model: &LinkModel) {
        let n = self.layout.states;
        let cost_to_go = &mut self.stages[node].cost_to_go;
        for row in model.equality_jacobian.chunks_exact(n) {
            for (i, &value) in row.iter().enumerate() {
                axpy(value / RHO, row, &mut cost_to_go[i * n..(i + 1) * n]);
            }
        }
    }

    /// Solves for a step; `step.nu` holds the current multipliers of the equalities on entry.
    pub(super) fn solve(&mut self, models: &[LinkModel], rhs: &RightHandSide, step: &mut Step) {
        for _ in 0..MAX_SWEEPS {
            self.backward(models, rhs, &step.nu);
            self.forward(models, rhs, step);
            if self.update_multipliers(models, rhs, step) <= SWEEP_TOLERANCE {
                break;
            }
        }
    }

    fn backward(&mut self, models: &[LinkModel], rhs: &RightHandSide, nu: &[f64]) {
        let (n, m) = (self.layout.states, self.layout.controls);
        let mut linear = [0.0; 64];
        for node in (0..=self.layout.intervals).rev() {
            let model = &models[node];
            let linear = &mut linear[..model.vars];
            linear[..n].copy_from_slice(&rhs.states[self.layout.state(node)]);
            linear[n..].copy_from_slice(&rhs.controls[self.layout.control(node)]);
            if node < self.layout.intervals {
                let next = &self.stages[node + 1];
                let carried = &mut self.scratch[..n];
                carried.copy_from_slice(&next.cost_vector);
                add_mul(
                    &next.cost_to_go,
                    n,
                    &rhs.gap[self.layout.link(node)],
                    carried,
                );
                add_transpose_mul(&model.link_jacobian, model.vars, carried, linear);
            }
            let stage = &mut self.stages[node];
            let (state_part, control_part) = linear.split_at(n);
            stage.cost_vector.copy_from_slice(state_part);
            if node < self.layout.intervals {
                add_transpose_mul(&stage.feedback, n, control_part, &mut stage.cost_vector);
                for (out, value) in stage.feedforward.iter_mut().zip(control_part) {
                    *out = -value;
                }
                cholesky_solve(&stage.control_factor, m, &mut stage.feedforward);
            }
            let rows = self.layout.equality(node);
            let residuals = rhs.equality[rows.clone()].iter().zip(&nu[rows]);
            for (row, (e, nu)) in model.equality_jacobian.chunks_exact(n).zip(residuals) {
                axpy(nu + e / RHO, row, &mut stage.cost_vector);
            }
        }
    }

    fn forward(&mut self, models: &[LinkModel], rhs: &RightHandSide, step: &mut Step) {
        let n = self.layout.states;
        for (out, value) in step.states[..n].iter_mut().zip(&self.stages[0].cost_vector) {
            *out = -value;
        }
        cholesky_solve(&self.initial_factor, n, &mut step.states[..n]);
        for node in 0..self.layout.intervals {
            let (stage, model) = (&self.stages[node], &models[node]);
            let next = self.layout.state(node + 1);
            let (head, tail) = step.states.split_at_mut(next.start);
            let state = &head[self.layout.state(node)];
            let arrived = &mut tail[..n];
            let control = &mut step.controls[self.layout.control(node)];
            control.copy_from_slice(&stage.feedforward);
            add_mul(&stage.feedback, n, state, control);
            arrived.copy_from_slice(&rhs.gap[self.layout.link(node)]);
            for (row, out) in model
                .link_jacobian
                .chunks_exact(model.vars)
                .zip(arrived.iter_mut())
            {
                *out += dot(&row[..n], state) + dot(&row[n..], control);
            }
            let ahead = &self.stages[node + 1];
            let costate = &mut step.lambda[self.layout.link(node)];
            costate.copy_from_slice(&ahead.cost_vector);
            add_mul(&ahead.cost_to_go, n, arrived, costate);
        }
    }

    /// Moves the equality multipliers to their proximal update; returns the largest residual.
    fn update_multipliers(
        &self,
        models: &[LinkModel],
        rhs: &RightHandSide,
        step: &mut Step,
    ) -> f64 {
        let n = self.layout.states;
        let mut worst = 0.0_f64;
        for (node, model) in models.iter().enumerate() {
            let state = &step.states[self.layout.state(node)];
            let rows = self.layout.equality(node);
            for (row, index) in model.equality_jacobian.chunks_exact(n).zip(rows) {
                let residual = dot(row, state) + rhs.equality[index];
                step.nu[index] += residual / RHO;
                worst = worst.max(residual.abs());
            }
        }
        worst
    }
}
