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
//! the Riccati recursion ([`stage`]); the costates are `lambda_k = P_k dx_k + p_k`.
//!
//! Node equalities enter as a proximal penalty: `C dx + e = rho (nu+ - nu)`. Repeating the cheap
//! vector sweep with `nu <- nu+` converges to the exact multiplier at a rate of order `rho`; the
//! factorisation stays a plain Cholesky, and curvature along directions that the equalities fix
//! need not be positive.
//!
//! Blocks have a handful of rows, where loops of unknown length cost several times their
//! arithmetic. The sweeps are therefore compiled for fixed sizes, and a chain uses the smallest
//! size that holds its states and controls; surplus rows are those of the identity.

mod stage;

use super::chain::LinkModel;
use super::iterate::Layout;
use stage::{Matrix, Stage, axpy, padded, solve_lower, solve_upper};

/// Proximal weight of node equalities. Smaller converges in fewer sweeps, larger loses fewer
/// digits in the sums `M + C^T C / rho`.
const RHO: f64 = 1e-6;
/// Limit of the vector sweeps for one step; each shrinks the equality residual by orders of
/// magnitude.
const MAX_SWEEPS: usize = 6;
/// Equality residual at which the sweeps end (absolute, scaled variables): a tenth of what any
/// solve asks for. The multipliers are already those of the next sweep then.
const SWEEP_TOLERANCE: f64 = 1e-10;

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
    /// `g_k - s_k`, condensed into `r_k`.
    pub(super) slack: Vec<f64>,
}

/// A Newton step: primal steps, the new multipliers of links and equalities, and the steps of the
/// condensed slacks and their multipliers.
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
    /// `ds_k`.
    pub(super) slack: Vec<f64>,
    /// `dz_k`.
    pub(super) z: Vec<f64>,
}

impl RightHandSide {
    /// Storage for a chain.
    pub(super) fn zeros(layout: &Layout) -> Self {
        Self {
            states: vec![0.0; layout.all_states()],
            controls: vec![0.0; layout.all_controls()],
            gap: vec![0.0; layout.all_links()],
            equality: vec![0.0; layout.all_equalities()],
            slack: vec![0.0; layout.all_inequalities()],
        }
    }
}

impl Step {
    /// Storage for a chain.
    pub(super) fn zeros(layout: &Layout) -> Self {
        Self {
            states: vec![0.0; layout.all_states()],
            controls: vec![0.0; layout.all_controls()],
            lambda: vec![0.0; layout.all_links()],
            nu: vec![0.0; layout.all_equalities()],
            slack: vec![0.0; layout.all_inequalities()],
            z: vec![0.0; layout.all_inequalities()],
        }
    }
}

/// A Newton system with its factors.
pub(super) trait NewtonSystem: Send {
    /// Factorises the system. Without `hessian` only `J^T sigma J + delta I` is used.
    ///
    /// # Errors
    ///
    /// The node at which it is not convex on the null space of the constraints, so that a larger
    /// `delta` is needed.
    fn factor(
        &mut self,
        models: &[LinkModel],
        sigma: &[f64],
        delta: f64,
        hessian: bool,
    ) -> Result<(), usize>;

    /// Solves for a step but for its slacks and their multipliers; `step.nu` holds the current
    /// multipliers of the equalities on entry.
    fn solve(&mut self, models: &[LinkModel], rhs: &RightHandSide, step: &mut Step);
}

/// The system for a chain, of the smallest compiled size that holds it.
///
/// # Panics
///
/// When no size does, more than [`MAX_CONTROLS`] controls or [`MAX_STATES`] states.
pub(super) fn system_for(layout: &Layout) -> Box<dyn NewtonSystem> {
    match (layout.states, layout.controls) {
        (..=3, ..=2) => Box::new(Riccati::<3, 2>::new(layout)),
        (..=6, ..=4) => Box::new(Riccati::<6, 4>::new(layout)),
        (..=7, ..=5) => Box::new(Riccati::<7, 5>::new(layout)),
        (..=9, ..=7) => Box::new(Riccati::<9, 7>::new(layout)),
        (..=12, ..=10) => Box::new(Riccati::<12, 10>::new(layout)),
        (states, controls) => {
            assert!(controls <= MAX_CONTROLS && states <= MAX_STATES);
            Box::new(Riccati::<MAX_STATES, MAX_CONTROLS>::new(layout))
        }
    }
}

/// Most controls of an interval.
pub(crate) const MAX_CONTROLS: usize = 18;
/// Most states of a node.
pub(crate) const MAX_STATES: usize = 20;

/// The factorised Newton system of `N` states and `M` controls.
struct Riccati<const N: usize, const M: usize> {
    layout: Layout,
    stages: Vec<Stage<N, M>>,
    /// `P` and `p` of the last node.
    last: (Matrix<N, N>, [f64; N]),
    /// Cholesky factor of `P_0`.
    initial: Matrix<N, N>,
}

impl<const N: usize, const M: usize> Riccati<N, M> {
    fn new(layout: &Layout) -> Self {
        Self {
            layout: layout.clone(),
            stages: vec![Stage::default(); layout.intervals],
            last: ([[0.0; N]; N], [0.0; N]),
            initial: [[0.0; N]; N],
        }
    }

    /// `P` and `p` of a node.
    fn cost_to_go(&self, node: usize) -> (&Matrix<N, N>, &[f64; N]) {
        self.stages
            .get(node)
            .map_or((&self.last.0, &self.last.1), |stage| {
                (&stage.cost_to_go, &stage.cost_vector)
            })
    }

    fn backward(&mut self, models: &[LinkModel], rhs: &RightHandSide, nu: &[f64]) {
        let n = self.layout.states;
        for (node, model) in models.iter().enumerate().rev() {
            let r_states = padded(&rhs.states[self.layout.state(node)]);
            let mut vector = if node < self.layout.intervals {
                let gap: [f64; N] = padded(&rhs.gap[self.layout.link(node)]);
                let r_controls = padded(&rhs.controls[self.layout.control(node)]);
                let (next, next_vector) = self.cost_to_go(node + 1);
                let mut carried = *next_vector;
                for (value, row) in gap.iter().zip(next) {
                    axpy(*value, row, &mut carried);
                }
                self.stages[node].carry(&carried, r_states, r_controls)
            } else {
                r_states
            };
            let rows = self.layout.equality(node);
            let residuals = rhs.equality[rows.clone()].iter().zip(&nu[rows]);
            for (row, (e, nu)) in model.equality_jacobian.chunks_exact(n).zip(residuals) {
                for (out, value) in vector.iter_mut().zip(row) {
                    *out += (nu + e / RHO) * value;
                }
            }
            match self.stages.get_mut(node) {
                Some(stage) => stage.cost_vector = vector,
                None => self.last.1 = vector,
            }
        }
    }

    fn forward(&mut self, rhs: &RightHandSide, step: &mut Step) {
        let (n, m) = (self.layout.states, self.layout.controls);
        let mut state = self.cost_to_go(0).1.map(|p| -p);
        solve_lower(&self.initial, &mut state);
        solve_upper(&self.initial, &mut state);
        step.states[..n].copy_from_slice(&state[..n]);
        for (node, stage) in self.stages.iter().enumerate() {
            let gap = padded(&rhs.gap[self.layout.link(node)]);
            let control = stage.control(&state);
            state = stage.arrival(&state, &control, gap);
            step.controls[self.layout.control(node)].copy_from_slice(&control[..m]);
            step.states[self.layout.state(node + 1)].copy_from_slice(&state[..n]);
        }
    }

    /// The costates of a step that is known.
    fn write_costates(&self, step: &mut Step) {
        let n = self.layout.states;
        for node in 1..=self.layout.intervals {
            let state: [f64; N] = padded(&step.states[self.layout.state(node)]);
            let (matrix, vector) = self.cost_to_go(node);
            let mut costate = *vector;
            for (value, row) in state.iter().zip(matrix) {
                axpy(*value, row, &mut costate);
            }
            step.lambda[self.layout.link(node - 1)].copy_from_slice(&costate[..n]);
        }
    }

    /// Moves the equality multipliers to their proximal update; returns the largest residual.
    fn update_multipliers(
        &self,
        models: &[LinkModel],
        rhs: &RightHandSide,
        step: &mut Step,
    ) -> f64 {
        let mut worst = 0.0_f64;
        for (node, model) in models.iter().enumerate() {
            let state = &step.states[self.layout.state(node)];
            let rows = model.equality_jacobian.chunks_exact(state.len());
            for (row, index) in rows.zip(self.layout.equality(node)) {
                let moved: f64 = row.iter().zip(state).map(|(c, x)| c * x).sum();
                let residual = moved + rhs.equality[index];
                step.nu[index] += residual / RHO;
                worst = worst.max(residual.abs());
            }
        }
        worst
    }
}

impl<const N: usize, const M: usize> NewtonSystem for Riccati<N, M> {
    fn factor(
        &mut self,
        models: &[LinkModel],
        sigma: &[f64],
        delta: f64,
        hessian: bool,
    ) -> Result<(), usize> {
        let n = self.layout.states;
        for (node, model) in models.iter().enumerate().rev() {
            let weights = &sigma[self.layout.inequality(node)];
            let mut blocks = stage::Blocks::condensed(model, n, weights, delta, hessian);
            if node < self.layout.intervals {
                let (head, tail) = self.stages.split_at_mut(node + 1);
                let stage = &mut head[node];
                stage.read_links(model, n);
                let next = tail.first().map_or(&self.last.0, |next| &next.cost_to_go);
                blocks.add_cost_to_go(stage, next);
                if !blocks.eliminate_controls(stage) {
                    return Err(node);
                }
            }
            let cost_to_go = blocks.with_equalities(&model.equality_jacobian, n, RHO);
            match self.stages.get_mut(node) {
                Some(stage) => stage.cost_to_go = cost_to_go,
                None => self.last.0 = cost_to_go,
            }
        }
        self.initial = *self.cost_to_go(0).0;
        stage::cholesky(&mut self.initial).then_some(()).ok_or(0)
    }

    fn solve(&mut self, models: &[LinkModel], rhs: &RightHandSide, step: &mut Step) {
        for _ in 0..MAX_SWEEPS {
            self.backward(models, rhs, &step.nu);
            self.forward(rhs, step);
            if self.update_multipliers(models, rhs, step) <= SWEEP_TOLERANCE {
                break;
            }
        }
        self.write_costates(step);
    }
}
