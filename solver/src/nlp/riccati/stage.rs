//! One stage of the Riccati recursion, in blocks of fixed size.
//!
//! With `[L_vv; L_xv]` the factor of the controls' columns of `M + [A B]^T P+ [A B]`, the cost to
//! go is `P = M_xx - L_xv L_xv^T`, and of the linear parts `y = L_vv^-1 m_v`, `p = m_x - L_xv y`.
//! The controls are `dv = -L_vv^-T (y + L_xv^T dx)`.
//!
//! Many links have states at their end that a control of their own adds to, `x+_i = x_i + v_j`, as
//! momenta are. Products with such rows of `[A B]` are additions, see [`Stage::general`].

use crate::nlp::chain::LinkModel;

/// A row-major matrix.
pub(super) type Matrix<const ROWS: usize, const COLUMNS: usize> = [[f64; COLUMNS]; ROWS];

/// The factors of a stage that the sweeps store.
#[derive(Debug, Clone)]
pub(super) struct Stage<const N: usize, const M: usize> {
    /// `A`.
    by_state: Matrix<N, N>,
    /// `B`.
    by_control: Matrix<N, M>,
    /// `L_vv`, with the inverse of its diagonal.
    control_factor: Matrix<M, M>,
    /// `L_xv^T`.
    coupling: Matrix<M, N>,
    /// Number of leading rows of `[A B]` that may be of any kind. Row `general + i` is that of
    /// `x+ = x + v_i`.
    general: usize,
    /// Number of rows of `[A B]`; surplus rows are zero.
    rows: usize,
    /// `y`.
    feedforward: [f64; M],
    /// `P`, both triangles.
    pub(super) cost_to_go: Matrix<N, N>,
    /// `p`.
    pub(super) cost_vector: [f64; N],
}

impl<const N: usize, const M: usize> Default for Stage<N, M> {
    fn default() -> Self {
        Self {
            by_state: [[0.0; N]; N],
            by_control: [[0.0; M]; N],
            control_factor: [[0.0; M]; M],
            coupling: [[0.0; N]; M],
            general: N,
            rows: N,
            feedforward: [0.0; M],
            cost_to_go: [[0.0; N]; N],
            cost_vector: [0.0; N],
        }
    }
}

impl<const N: usize, const M: usize> Stage<N, M> {
    /// Copies the derivatives of the link from a model of `n` states.
    pub(super) fn read_links(&mut self, model: &LinkModel, n: usize) {
        for (i, row) in model.link_jacobian.chunks_exact(model.vars).enumerate() {
            let (states, controls) = row.split_at(n);
            self.by_state[i] = padded(states);
            self.by_control[i] = padded(controls);
        }
        self.rows = n;
        self.general = self.general_rows();
    }

    /// The number of general rows: the last row tells which controls are added to which states.
    fn general_rows(&self) -> usize {
        let last = self.by_control[self.rows - 1];
        let control = last.iter().position(|value| *value != 0.0);
        let first = control.and_then(|control| (self.rows - 1).checked_sub(control));
        let adds = |row: usize, first: usize| {
            let off = |(at, value): (usize, &f64), place: usize| {
                (value - if at == place { 1.0 } else { 0.0 }).abs()
            };
            let states = self.by_state[row].iter().enumerate();
            let controls = self.by_control[row].iter().enumerate();
            let by_states: f64 = states.map(|entry| off(entry, row)).sum();
            let by_controls: f64 = controls.map(|entry| off(entry, row - first)).sum();
            by_states + by_controls == 0.0
        };
        first
            .filter(|first| (*first..self.rows).all(|row| adds(row, *first)))
            .unwrap_or(self.rows)
    }

    /// Carries the costate at arrival to this stage; returns `p` without the equalities.
    pub(super) fn carry(
        &mut self,
        carried: &[f64; N],
        mut states: [f64; N],
        mut controls: [f64; M],
    ) -> [f64; N] {
        for i in 0..self.general {
            axpy(carried[i], &self.by_state[i], &mut states);
            axpy(carried[i], &self.by_control[i], &mut controls);
        }
        for i in self.general..self.rows {
            states[i] += carried[i];
            controls[i - self.general] += carried[i];
        }
        solve_lower(&self.control_factor, &mut controls);
        for (value, row) in controls.iter().zip(&self.coupling) {
            axpy(-value, row, &mut states);
        }
        self.feedforward = controls;
        states
    }

    /// The step of the controls at a step of the state.
    pub(super) fn control(&self, state: &[f64; N]) -> [f64; M] {
        let mut control: [f64; M] =
            std::array::from_fn(|i| -(self.feedforward[i] + dot(&self.coupling[i], state)));
        solve_upper(&self.control_factor, &mut control);
        control
    }

    /// The next state's step.
    pub(super) fn arrival(&self, state: &[f64; N], control: &[f64; M], gap: [f64; N]) -> [f64; N] {
        let mut arrived = gap;
        for i in 0..self.general {
            arrived[i] += dot(&self.by_state[i], state) + dot(&self.by_control[i], control);
        }
        for i in self.general..self.rows {
            arrived[i] += state[i] + control[i - self.general];
        }
        arrived
    }
}

/// The quadratic form of a stage: `M`, then `M` with the cost to go, then the Schur complement.
pub(super) struct Blocks<const N: usize, const M: usize> {
    states: Matrix<N, N>,
    /// Rows of controls, columns of states.
    mixed: Matrix<M, N>,
    controls: Matrix<M, M>,
}

impl<const N: usize, const M: usize> Blocks<N, M> {
    /// `H + J^T sigma J + delta I` of a model of `n` states, the identity in surplus rows.
    pub(super) fn condensed(
        model: &LinkModel,
        n: usize,
        sigma: &[f64],
        delta: f64,
        hessian: bool,
    ) -> Self {
        let (vars, m) = (model.vars, model.vars - n);
        let mut blocks = Self {
            states: [[0.0; N]; N],
            mixed: [[0.0; N]; M],
            controls: [[0.0; M]; M],
        };
        if hessian {
            for (i, row) in model.hessian.chunks_exact(vars).enumerate() {
                // Entries above the diagonal are not read.
                let (states, controls) = row.split_at(n);
                if i < n {
                    blocks.states[i] = padded(states);
                } else {
                    blocks.mixed[i - n] = padded(states);
                    blocks.controls[i - n] = padded(controls);
                }
            }
        }
        for (weight, row) in sigma
            .iter()
            .zip(model.inequality_jacobian.chunks_exact(vars))
        {
            blocks.add_row(*weight, &row[..n], &row[n..]);
        }
        for i in 0..N {
            blocks.states[i][i] += if i < n { delta } else { 1.0 };
        }
        for i in 0..M {
            blocks.controls[i][i] += if i < m { delta } else { 1.0 };
        }
        blocks
    }

    /// Adds a weighted outer product, skipping the zeros of a sparse row.
    fn add_row(&mut self, weight: f64, states: &[f64], controls: &[f64]) {
        let (x, v): ([f64; N], [f64; M]) = (padded(states), padded(controls));
        // Most rows are of the states alone or of the controls alone.
        let (of_states, of_controls) = (any(&x), any(&v));
        if of_states {
            for i in 0..N {
                if x[i] != 0.0 {
                    axpy(weight * x[i], &x, &mut self.states[i]);
                }
            }
        }
        if of_controls {
            for i in 0..M {
                if v[i] != 0.0 {
                    axpy(weight * v[i], &v, &mut self.controls[i]);
                }
            }
        }
        if of_states && of_controls {
            for i in 0..M {
                axpy(weight * v[i], &x, &mut self.mixed[i]);
            }
        }
    }

    /// Adds `[A B]^T P+ [A B]`.
    pub(super) fn add_cost_to_go(&mut self, stage: &Stage<N, M>, next: &Matrix<N, N>) {
        let (general, rows) = (stage.general, stage.rows);
        for (i, row) in next[..rows].iter().enumerate() {
            let (mut by_state, mut by_control) = ([0.0; N], [0.0; M]);
            for j in 0..general {
                axpy(row[j], &stage.by_state[j], &mut by_state);
                axpy(row[j], &stage.by_control[j], &mut by_control);
            }
            for j in general..rows {
                by_state[j] += row[j];
                by_control[j - general] += row[j];
            }
            if i >= general {
                axpy(1.0, &by_state, &mut self.states[i]);
                axpy(1.0, &by_state, &mut self.mixed[i - general]);
                axpy(1.0, &by_control, &mut self.controls[i - general]);
                continue;
            }
            for (out, value) in self.states.iter_mut().zip(&stage.by_state[i]) {
                axpy(*value, &by_state, out);
            }
            for (j, value) in stage.by_control[i].iter().enumerate() {
                axpy(*value, &by_state, &mut self.mixed[j]);
                axpy(*value, &by_control, &mut self.controls[j]);
            }
        }
    }

    /// Eliminates the controls into a stage; false when they have a direction without curvature.
    pub(super) fn eliminate_controls(&mut self, stage: &mut Stage<N, M>) -> bool {
        stage.control_factor = self.controls;
        if !cholesky(&mut stage.control_factor) {
            return false;
        }
        for i in 0..M {
            let mut row = self.mixed[i];
            for j in 0..i {
                axpy(-stage.control_factor[i][j], &stage.coupling[j], &mut row);
            }
            let inverse = stage.control_factor[i][i];
            let row = row.map(|value| inverse * value);
            for (out, value) in self.states.iter_mut().zip(&row) {
                axpy(-value, &row, out);
            }
            stage.coupling[i] = row;
        }
        true
    }

    /// `P`: the states' block, both triangles, with the penalty of node equalities.
    pub(super) fn with_equalities(&self, rows: &[f64], n: usize, rho: f64) -> Matrix<N, N> {
        let mut matrix = self.states;
        for i in 0..N {
            for j in 0..i {
                matrix[j][i] = matrix[i][j];
            }
        }
        for row in rows.chunks_exact(n) {
            for (i, &value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
                for (out, other) in matrix[i].iter_mut().zip(row) {
                    *out += value / rho * other;
                }
            }
        }
        matrix
    }
}

/// A vector extended by zeros.
pub(super) fn padded<const L: usize>(values: &[f64]) -> [f64; L] {
    // The common case: the exact size, a copy of known length.
    values.first_chunk().copied().unwrap_or_else(|| {
        let mut all = [0.0; L];
        all[..values.len()].copy_from_slice(values);
        all
    })
}

/// Whether a vector has entries other than zero; as two sums, which the processor forms at once.
fn any<const L: usize>(values: &[f64; L]) -> bool {
    let mut sums = [0.0; 2];
    for i in 0..L {
        sums[i % 2] += values[i].abs();
    }
    sums[0] + sums[1] != 0.0
}

/// Scalar product.
pub(super) fn dot<const L: usize>(a: &[f64; L], b: &[f64; L]) -> f64 {
    let mut sum = 0.0;
    for i in 0..L {
        sum += a[i] * b[i];
    }
    sum
}

/// `y += scale x`.
pub(super) fn axpy<const L: usize>(scale: f64, x: &[f64; L], y: &mut [f64; L]) {
    for i in 0..L {
        y[i] += scale * x[i];
    }
}

/// Cholesky factor of the symmetric matrix in the lower triangle, in place, with the inverses of
/// its diagonal in the diagonal's place. False when a pivot is not safely positive.
pub(super) fn cholesky<const L: usize>(a: &mut Matrix<L, L>) -> bool {
    for i in 0..L {
        for j in 0..i {
            let mut value = a[i][j];
            for c in 0..j {
                value -= a[i][c] * a[j][c];
            }
            a[i][j] = value * a[j][j];
        }
        let diagonal = a[i][i];
        let mut pivot = diagonal;
        for c in 0..i {
            pivot -= a[i][c] * a[i][c];
        }
        // Positive by more than the cancellation error of the pivot itself.
        if !(pivot > 1e-14 * diagonal.abs() && pivot > 1e-300) {
            return false;
        }
        a[i][i] = pivot.sqrt().recip();
    }
    true
}

/// Solves `L x = b` in place.
pub(super) fn solve_lower<const L: usize>(factor: &Matrix<L, L>, b: &mut [f64; L]) {
    for i in 0..L {
        let mut value = b[i];
        for j in 0..i {
            value -= factor[i][j] * b[j];
        }
        b[i] = value * factor[i][i];
    }
}

/// Solves `L^T x = b` in place.
pub(super) fn solve_upper<const L: usize>(factor: &Matrix<L, L>, b: &mut [f64; L]) {
    for i in (0..L).rev() {
        let value = b[i] * factor[i][i];
        b[i] = value;
        for j in 0..i {
            b[j] -= factor[i][j] * value;
        }
    }
}

#[cfg(test)]
mod tests;
