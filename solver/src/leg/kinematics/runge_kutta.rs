//! The turn by a Runge-Kutta method, with or without momentum, as exact as its substeps are short.
//!
//! Butcher's method of order six on fixed substeps; first derivatives are propagated forward,
//! second ones come from one reverse sweep, both of the discrete map itself.

use super::{INPUTS, INPUTS_WITHOUT_MOMENTUM, TurnDerivatives, TurnInputs};
use crate::math::quaternion::{
    Quat, add_scaled, conjugate, dot4, half_product, imaginary, product, quat, rotate_back,
};
use nalgebra::{Matrix3, Vector3};

/// Most substeps of an interval.
const MAX_SUBSTEPS: usize = 32;
/// Substeps up to which the stages of an interval are kept on the stack.
const DEFAULT_SUBSTEPS: usize = 2;

const STAGES: usize = 7;
/// J. C. Butcher, "On Runge-Kutta processes of high order", 1964.
const A: [[f64; STAGES]; STAGES] = [
    [0.0; 7],
    [1.0 / 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 2.0 / 3.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0 / 12.0, 1.0 / 3.0, -1.0 / 12.0, 0.0, 0.0, 0.0, 0.0],
    [
        25.0 / 48.0,
        -55.0 / 24.0,
        35.0 / 48.0,
        15.0 / 8.0,
        0.0,
        0.0,
        0.0,
    ],
    [
        3.0 / 20.0,
        -11.0 / 24.0,
        -1.0 / 8.0,
        1.0 / 2.0,
        1.0 / 10.0,
        0.0,
        0.0,
    ],
    [
        -261.0 / 260.0,
        33.0 / 13.0,
        43.0 / 156.0,
        -118.0 / 39.0,
        32.0 / 195.0,
        80.0 / 39.0,
        0.0,
    ],
];
const B: [f64; STAGES] = [
    13.0 / 200.0,
    0.0,
    11.0 / 40.0,
    11.0 / 40.0,
    4.0 / 25.0,
    4.0 / 25.0,
    13.0 / 200.0,
];
const C: [f64; STAGES] = [
    0.0,
    1.0 / 3.0,
    2.0 / 3.0,
    1.0 / 3.0,
    5.0 / 6.0,
    1.0 / 6.0,
    1.0,
];

/// The map from inputs to turns.
#[derive(Debug, Clone)]
pub(crate) struct RungeKutta {
    inertia_inverse: Matrix3<f64>,
    with_momentum: bool,
    substeps: usize,
}

/// The turn so far with its derivatives.
struct Flow {
    p: Quat,
    first: [Quat; INPUTS],
}

#[derive(Clone, Copy, Default)]
struct StageRecord {
    sigma: f64,
    p: Quat,
    rate: Vector3<f64>,
    sensitivity: [Quat; INPUTS],
}

/// The turn over an interval in equal substeps, under a rate times the interval's length.
pub(super) fn flow(substeps: usize, rate: &impl Fn(f64, &Quat) -> Vector3<f64>) -> Quat {
    let h = 1.0 / substeps as f64;
    let mut p = [0.0, 0.0, 0.0, 1.0];
    for step in 0..substeps {
        let mut k = [[0.0; 4]; STAGES];
        for i in 0..STAGES {
            let mut at = p;
            for j in 0..i {
                add_scaled(&mut at, h * A[i][j], &k[j]);
            }
            let sigma = h * (step as f64 + C[i]);
            k[i] = half_product(&at, &rate(sigma, &at));
        }
        for i in 0..STAGES {
            add_scaled(&mut p, h * B[i], &k[i]);
        }
    }
    p
}

impl RungeKutta {
    /// A map with a number of substeps per interval, for `J_eff` inverse in matching units.
    pub(super) fn new(inertia_inverse: Matrix3<f64>, with_momentum: bool, substeps: usize) -> Self {
        Self {
            inertia_inverse,
            with_momentum,
            substeps: substeps.clamp(1, MAX_SUBSTEPS),
        }
    }

    /// The map with half the step.
    pub(super) fn finer(&self) -> Self {
        Self::new(self.inertia_inverse, self.with_momentum, 2 * self.substeps)
    }

    /// The inverse of `J_eff`.
    pub(super) fn inertia_inverse(&self) -> &Matrix3<f64> {
        &self.inertia_inverse
    }

    /// Number of inputs with non-zero derivatives.
    pub(super) fn inputs(&self) -> usize {
        if self.with_momentum {
            INPUTS
        } else {
            INPUTS_WITHOUT_MOMENTUM
        }
    }

    /// The rate times the length of the interval.
    pub(super) fn rate(&self, z: &TurnInputs, sigma: f64, p: &Quat) -> Vector3<f64> {
        let linear = z.begin * (1.0 - sigma) + z.end * sigma;
        if self.with_momentum {
            linear + self.inertia_inverse * rotate_back(p, &z.momentum)
        } else {
            linear
        }
    }

    /// The turn over the interval.
    pub(super) fn turn(&self, z: &TurnInputs) -> Quat {
        flow(self.substeps, &|sigma, p| self.rate(z, sigma, p))
    }

    /// The turn with derivatives, the second ones weighted by `mu`.
    pub(super) fn derivatives(&self, z: &TurnInputs, mu: &Quat) -> TurnDerivatives {
        if self.substeps <= DEFAULT_SUBSTEPS {
            let mut records = [StageRecord::default(); STAGES * DEFAULT_SUBSTEPS];
            self.sweep(z, mu, &mut records)
        } else {
            let mut records = vec![StageRecord::default(); STAGES * self.substeps];
            self.sweep(z, mu, &mut records)
        }
    }

    /// Forward over all substeps, then back.
    fn sweep(&self, z: &TurnInputs, mu: &Quat, records: &mut [StageRecord]) -> TurnDerivatives {
        let h = 1.0 / self.substeps as f64;
        let mut flow = Flow {
            p: [0.0, 0.0, 0.0, 1.0],
            first: [[0.0; 4]; INPUTS],
        };
        let chunks = records.chunks_exact_mut(STAGES).take(self.substeps);
        for (step, records) in chunks.enumerate() {
            self.forward_substep(z, step, h, &mut flow, records);
        }
        let mut second = [[0.0; INPUTS]; INPUTS];
        let mut adjoint = *mu;
        for records in records.chunks_exact(STAGES).take(self.substeps).rev() {
            self.reverse_substep(z, h, &mut adjoint, records, &mut second);
        }
        for i in 0..self.inputs() {
            for j in 0..i {
                second[j][i] = second[i][j];
            }
        }
        TurnDerivatives {
            turn: flow.p,
            first: flow.first,
            second,
            middle: [Vector3::zeros(); INPUTS],
        }
    }

    fn forward_substep(
        &self,
        z: &TurnInputs,
        step: usize,
        h: f64,
        flow: &mut Flow,
        records: &mut [StageRecord],
    ) {
        let n = self.inputs();
        let mut k = [[0.0; 4]; STAGES];
        let mut dk = [[[0.0; 4]; INPUTS]; STAGES];
        for i in 0..STAGES {
            let mut record = StageRecord {
                sigma: h * (step as f64 + C[i]),
                p: flow.p,
                rate: Vector3::zeros(),
                sensitivity: flow.first,
            };
            for j in 0..i {
                if A[i][j] != 0.0 {
                    add_scaled(&mut record.p, h * A[i][j], &k[j]);
                    for (out, value) in record.sensitivity[..n].iter_mut().zip(&dk[j]) {
                        add_scaled(out, h * A[i][j], value);
                    }
                }
            }
            record.rate = self.rate(z, record.sigma, &record.p);
            k[i] = half_product(&record.p, &record.rate);
            for (input, out) in dk[i][..n].iter_mut().enumerate() {
                *out = half_product(&record.sensitivity[input], &record.rate);
                let rate = self.rate_derivative(z, &record, input);
                add_scaled(out, 1.0, &half_product(&record.p, &rate));
            }
            records[i] = record;
        }
        for i in 0..STAGES {
            add_scaled(&mut flow.p, h * B[i], &k[i]);
            for (out, value) in flow.first[..n].iter_mut().zip(&dk[i]) {
                add_scaled(out, h * B[i], value);
            }
        }
    }

    /// Total derivative of a stage's rate with respect to one input.
    fn rate_derivative(&self, z: &TurnInputs, at: &StageRecord, input: usize) -> Vector3<f64> {
        let mut rate = Vector3::zeros();
        match input {
            0..3 => rate[input] = 1.0 - at.sigma,
            3..6 => rate[input - 3] = at.sigma,
            _ => {
                let mut axis = Vector3::zeros();
                axis[input - 6] = 1.0;
                rate = self.inertia_inverse * rotate_back(&at.p, &axis);
            }
        }
        if self.with_momentum {
            let change = rotate_back_derivative(&at.p, &z.momentum, &at.sensitivity[input]);
            rate += self.inertia_inverse * change;
        }
        rate
    }

    fn reverse_substep(
        &self,
        z: &TurnInputs,
        h: f64,
        adjoint: &mut Quat,
        records: &[StageRecord],
        second: &mut [[f64; INPUTS]; INPUTS],
    ) {
        let mut carried = [[0.0; 4]; STAGES];
        for i in (0..STAGES).rev() {
            let mut weight = [0.0; 4];
            add_scaled(&mut weight, h * B[i], adjoint);
            for j in i + 1..STAGES {
                add_scaled(&mut weight, h * A[j][i], &carried[j]);
            }
            carried[i] = self.accumulate_stage(z, &weight, &records[i], second);
        }
        for value in &carried {
            add_scaled(adjoint, 1.0, value);
        }
    }

    /// Adds one stage's share of the weighted second derivatives (lower triangle) and returns the
    /// adjoint with respect to the stage's `p`.
    ///
    /// With `phi = weight . 1/2 p (x) w = p^T m(w)`, `m(v) = 1/2 weight (x) [v, 0]*`:
    /// `d2 phi = 2 dp^T m(dw) + y . d2(R^T zeta)`, `y = Ji^T 1/2 vec(p* (x) weight)`.
    fn accumulate_stage(
        &self,
        z: &TurnInputs,
        weight: &Quat,
        at: &StageRecord,
        second: &mut [[f64; INPUTS]; INPUTS],
    ) -> Quat {
        let n = self.inputs();
        let mut through_rate = [[0.0; 4]; INPUTS];
        for (input, out) in through_rate[..n].iter_mut().enumerate() {
            *out = half_product(weight, &-self.rate_derivative(z, at, input));
        }
        for i in 0..n {
            for j in 0..=i {
                second[i][j] += dot4(&at.sensitivity[i], &through_rate[j])
                    + dot4(&at.sensitivity[j], &through_rate[i]);
            }
        }
        let mut carried = half_product(weight, &-at.rate);
        if self.with_momentum {
            let pulled = imaginary(&product(&conjugate(&at.p), weight)) * 0.5;
            let y = self.inertia_inverse.tr_mul(&pulled);
            add_scaled(&mut carried, 2.0, &quadratic(&y, &z.momentum, &at.p));
            accumulate_momentum(z, &y, at, second);
        }
        carried
    }
}

/// Adds `y . d2(R(p)^T zeta)` with `y . R(p)^T zeta = p^T Q(y, zeta) p`, lower triangle.
fn accumulate_momentum(
    z: &TurnInputs,
    y: &Vector3<f64>,
    at: &StageRecord,
    second: &mut [[f64; INPUTS]; INPUTS],
) {
    for i in 0..INPUTS {
        let image = quadratic(y, &z.momentum, &at.sensitivity[i]);
        for j in 0..=i {
            second[i][j] += 2.0 * dot4(&image, &at.sensitivity[j]);
        }
    }
    for axis in 0..3 {
        let image = quadratic(y, &Vector3::ith(axis, 1.0), &at.p);
        let row = 6 + axis;
        for j in 0..INPUTS {
            let value = 2.0 * dot4(&image, &at.sensitivity[j]);
            let twice = if j == row { 2.0 } else { 1.0 };
            second[row.max(j)][row.min(j)] += twice * value;
        }
    }
}

/// `Q(y, zeta) p` of the quadratic form `y . R(p)^T zeta = p^T Q p`.
fn quadratic(y: &Vector3<f64>, zeta: &Vector3<f64>, p: &Quat) -> Quat {
    let (u, w) = (imaginary(p), p[3]);
    let inner = y.dot(zeta);
    let cross = y.cross(zeta);
    let vector = u * -inner + y * zeta.dot(&u) + zeta * y.dot(&u) + cross * w;
    quat(&vector, inner * w + cross.dot(&u))
}

/// Derivative of `R(p)^T v` along `dp`.
fn rotate_back_derivative(p: &Quat, v: &Vector3<f64>, dp: &Quat) -> Vector3<f64> {
    let (u, w, du, dw) = (imaginary(p), p[3], imaginary(dp), dp[3]);
    v * (2.0 * (w * dw - u.dot(&du))) + du * (2.0 * u.dot(v)) + u * (2.0 * du.dot(v))
        - (du.cross(v) * w + u.cross(v) * dw) * 2.0
}
