//! The turn with stored momentum by the Taylor expansion of the rate: polynomial, closed form.
//!
//! With `w' = c - a + Ji (zeta x w)` (the momentum `zeta` turns back in body axes as the body
//! turns), the derivatives of the rate at the beginning of the interval follow from each other:
//!
//! ```text
//!   zeta_0 = zeta,  w_0 = a + Ji zeta
//!   zeta_{i+1} = sum_j binomial(i, j) zeta_{i-j} x w_j,   w_{i+1} = [i = 0] (c - a) + Ji zeta_{i+1}
//! ```
//!
//! Their series gives the integral `u` of the rate, its first moment `v = 12 int (sigma - 1/2) w`,
//! from which [`super::magnus`] makes the turn, and the rate in the middle of the interval, where
//! limits are imposed beside the nodes. Everything is a composition of products of two vectors:
//! first derivatives go forward, second ones come from one sweep back.

use super::magnus::MagnusTurn;
use super::{INPUTS, TurnDerivatives, TurnInputs};
use crate::math::quaternion::Quat;
use nalgebra::{Matrix3, Vector3};

/// Highest derivative of the rate in the series.
const ORDER: usize = 4;
const TERMS: usize = ORDER + 1;
const BINOMIAL: [[f64; ORDER]; ORDER] = [
    [1.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0],
    [1.0, 3.0, 3.0, 1.0],
];
/// `1 / (i + 1)!`: weights of the derivatives in the integral of the rate.
const INTEGRAL: [f64; TERMS] = [1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0];
/// `6 i / (i! (i + 1) (i + 2))`: in twelve times its first moment about the middle.
const MOMENT: [f64; TERMS] = [0.0, 1.0, 1.0 / 2.0, 3.0 / 20.0, 1.0 / 30.0];
/// `1 / (2^i i!)`: in the rate in the middle.
const MIDDLE: [f64; TERMS] = [1.0, 1.0 / 2.0, 1.0 / 8.0, 1.0 / 48.0, 1.0 / 384.0];

/// Derivatives of three numbers by the inputs, a row for each number.
type Rows = [[f64; INPUTS]; 3];
const NO_ROWS: Rows = [[0.0; INPUTS]; 3];

/// The derivatives of momentum and rate at the beginning of an interval.
struct Series {
    momentum: [Vector3<f64>; TERMS],
    rate: [Vector3<f64>; TERMS],
}

impl Series {
    fn of(z: &TurnInputs, inertia_inverse: &Matrix3<f64>) -> Self {
        let mut momentum = [z.momentum; TERMS];
        let mut rate = [z.begin + inertia_inverse * z.momentum; TERMS];
        for i in 0..ORDER {
            let products = (0..=i).map(|j| momentum[i - j].cross(&rate[j]) * BINOMIAL[i][j]);
            momentum[i + 1] = products.sum();
            rate[i + 1] = inertia_inverse * momentum[i + 1];
            if i == 0 {
                rate[1] += z.end - z.begin;
            }
        }
        Self { momentum, rate }
    }

    fn sum(&self, weights: &[f64; TERMS]) -> Vector3<f64> {
        let terms = self.rate.iter().zip(weights);
        terms.map(|(rate, weight)| rate * *weight).sum()
    }

    /// Derivatives of momenta and rates by the inputs.
    fn rows(&self, inertia_inverse: &Matrix3<f64>) -> [[Rows; TERMS]; 2] {
        let (mut momentum, mut rate) = ([NO_ROWS; TERMS], [NO_ROWS; TERMS]);
        for axis in 0..3 {
            momentum[0][axis][6 + axis] = 1.0;
        }
        add_product(&mut rate[0], inertia_inverse, &momentum[0]);
        for axis in 0..3 {
            rate[0][axis][axis] = 1.0;
            rate[1][axis][axis] = -1.0;
            rate[1][axis][3 + axis] = 1.0;
        }
        for i in 0..ORDER {
            let mut next = NO_ROWS;
            for j in 0..=i {
                let weight = BINOMIAL[i][j];
                add_cross(&mut next, &(self.momentum[i - j] * weight), &rate[j]);
                add_cross(&mut next, &(self.rate[j] * -weight), &momentum[i - j]);
            }
            add_product(&mut rate[i + 1], inertia_inverse, &next);
            momentum[i + 1] = next;
        }
        [momentum, rate]
    }
}

/// `to += factor from`.
fn add_row(to: &mut [f64; INPUTS], factor: f64, from: &[f64; INPUTS]) {
    for (out, value) in to.iter_mut().zip(from) {
        *out += factor * value;
    }
}

/// `to += matrix from`.
fn add_product(to: &mut Rows, matrix: &Matrix3<f64>, from: &Rows) {
    for (i, out) in to.iter_mut().enumerate() {
        for (j, row) in from.iter().enumerate() {
            add_row(out, matrix[(i, j)], row);
        }
    }
}

/// `to += v x from`.
fn add_cross(to: &mut Rows, v: &Vector3<f64>, from: &Rows) {
    for (i, out) in to.iter_mut().enumerate() {
        let (next, last) = ((i + 1) % 3, (i + 2) % 3);
        add_row(out, v[next], &from[last]);
        add_row(out, -v[last], &from[next]);
    }
}

fn weighted_sum(rows: &[Rows; TERMS], weights: &[f64; TERMS]) -> Rows {
    let mut sum = NO_ROWS;
    for (rows, weight) in rows.iter().zip(weights) {
        for (out, row) in sum.iter_mut().zip(rows) {
            add_row(out, *weight, row);
        }
    }
    sum
}

/// `to += one^T other`.
fn add_outer(to: &mut [[f64; INPUTS]; INPUTS], one: &Rows, other: &Rows) {
    for (left, right) in one.iter().zip(other) {
        for (out, factor) in to.iter_mut().zip(left) {
            add_row(out, *factor, right);
        }
    }
}

/// The turn over the interval.
pub(super) fn turn(z: &TurnInputs, inertia_inverse: &Matrix3<f64>) -> Quat {
    let series = Series::of(z, inertia_inverse);
    MagnusTurn::of(&series.sum(&INTEGRAL), &series.sum(&MOMENT)).turn()
}

/// The rate in the middle of the interval, times its length.
pub(super) fn middle(z: &TurnInputs, inertia_inverse: &Matrix3<f64>) -> Vector3<f64> {
    Series::of(z, inertia_inverse).sum(&MIDDLE)
}

/// The turn and the rate in the middle with derivatives; the second ones weighted by `mu` and
/// `pull` and added up.
pub(super) fn derivatives(
    z: &TurnInputs,
    inertia_inverse: &Matrix3<f64>,
    mu: &Quat,
    pull: &Vector3<f64>,
) -> TurnDerivatives {
    let series = Series::of(z, inertia_inverse);
    let [by_momentum, by_rate] = series.rows(inertia_inverse);
    let [u, v] = [&INTEGRAL, &MOMENT].map(|weights| weighted_sum(&by_rate, weights));
    let magnus = MagnusTurn::of(&series.sum(&INTEGRAL), &series.sum(&MOMENT));
    let weighted = magnus.weighted(mu);
    // Back through the products: their covectors, and what each adds to the curvature.
    let [by_u, by_v] = weighted.gradient;
    let mut of_rate: [Vector3<f64>; TERMS] =
        std::array::from_fn(|i| by_u * INTEGRAL[i] + by_v * MOMENT[i] + pull * MIDDLE[i]);
    let mut of_momentum = [Vector3::zeros(); TERMS];
    let mut partners = [NO_ROWS; ORDER];
    for i in (0..ORDER).rev() {
        let covector = of_momentum[i + 1] + inertia_inverse.tr_mul(&of_rate[i + 1]);
        for j in 0..=i {
            let covector = covector * BINOMIAL[i][j];
            of_momentum[i - j] += series.rate[j].cross(&covector);
            of_rate[j] += covector.cross(&series.momentum[i - j]);
            add_cross(&mut partners[j], &covector, &by_momentum[i - j]);
        }
    }
    let mut half = [[0.0; INPUTS]; INPUTS];
    for (partner, rate) in partners.iter().zip(&by_rate) {
        add_outer(&mut half, partner, rate);
    }
    let mut second: [[f64; INPUTS]; INPUTS] =
        std::array::from_fn(|i| std::array::from_fn(|j| half[i][j] + half[j][i]));
    let [uu, uv, vv] = weighted.curvature;
    let (mut image_u, mut image_v) = (NO_ROWS, NO_ROWS);
    add_product(&mut image_u, &uu, &u);
    add_product(&mut image_u, &uv, &v);
    add_product(&mut image_v, &uv.transpose(), &u);
    add_product(&mut image_v, &vv, &v);
    add_outer(&mut second, &u, &image_u);
    add_outer(&mut second, &v, &image_v);
    let middle = weighted_sum(&by_rate, &MIDDLE);
    let [rows_u, rows_v] = magnus.jacobians();
    let mut turned = [[0.0; INPUTS]; 4];
    for (i, out) in turned.iter_mut().enumerate() {
        for axis in 0..3 {
            add_row(out, rows_u[i][axis], &u[axis]);
            add_row(out, rows_v[i][axis], &v[axis]);
        }
    }
    TurnDerivatives {
        turn: magnus.turn(),
        first: std::array::from_fn(|j| turned.map(|row| row[j])),
        second,
        middle: std::array::from_fn(|j| Vector3::from(middle.map(|row| row[j]))),
    }
}
