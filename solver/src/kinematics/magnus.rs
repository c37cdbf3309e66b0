//! The turn with zero momentum by the Magnus expansion: closed form, two half intervals.
//!
//! On a half interval with the integral `u` of the rate and its change `v` times the length, the
//! rotation vector of the turn is, to order six,
//!
//! ```text
//!   Omega = u + (1/12 + |u|^2 / 720) u x v - v x (u x v) / 240
//! ```
//!
//! (Blanes, Casas, Oteo and Ros, Phys. Rep. 470, 2009, section 4, for a linear rate that multiplies
//! on the right). With `a` and `c` at the ends of the whole interval, `u_1 = (3 a + c) / 8`,
//! `u_2 = (a + 3 c) / 8` and `v = (c - a) / 4` on both halves.

use super::quaternion::{Quat, conjugate, dot4, imaginary, product, quat};
use super::{INPUTS, TurnDerivatives, TurnInputs};
use nalgebra::{Matrix3, Vector3};

/// Share of `a` and `c` in `u_1`, `u_2` and `v`.
const SHARES: [[f64; 2]; 3] = [[0.375, 0.125], [0.125, 0.375], [-0.25, 0.25]];

/// A half interval's turn with its derivatives by `(u, v)`.
struct Half {
    turn: Quat,
    first: [Quat; 6],
}

/// The turn over the interval.
pub(super) fn turn(z: &TurnInputs) -> Quat {
    let [first, second, change] = halves(z);
    let exp = |u: &Vector3<f64>| Exponential::of(&rotation_vector(u, &change)).turn();
    product(&exp(&first), &exp(&second))
}

/// The turn with derivatives, the second ones weighted by `mu`.
pub(super) fn derivatives(z: &TurnInputs, mu: &Quat) -> TurnDerivatives {
    let [u1, u2, v] = halves(z);
    let (begin, end) = (Half::of(&u1, &v), Half::of(&u2, &v));
    let bend1 = curvature(&u1, &v, &product(mu, &conjugate(&end.turn)));
    let bend2 = curvature(&u2, &v, &product(&conjugate(&begin.turn), mu));
    let mut first = [[0.0; 4]; INPUTS];
    let mut second = [[0.0; INPUTS]; INPUTS];
    // Derivatives by (u1, v) of the first and (u2, v) of the second half, spread over (a, c).
    let share = |half: usize, i: usize| if i < 3 { SHARES[half] } else { SHARES[2] };
    let spread = |i: usize, side: usize| 3 * side + i % 3;
    for i in 0..6 {
        let by_begin = product(&begin.first[i], &end.turn);
        let by_end = product(&begin.turn, &end.first[i]);
        for side in 0..2 {
            for (out, (b, e)) in first[spread(i, side)]
                .iter_mut()
                .zip(by_begin.iter().zip(&by_end))
            {
                *out += share(0, i)[side] * b + share(1, i)[side] * e;
            }
        }
        let pulled = product(mu, &conjugate(&end.first[i]));
        for j in 0..6 {
            let cross = dot4(&begin.first[j], &pulled);
            for (si, sj) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let (row, column) = (spread(i, si), spread(j, sj));
                let mixed = share(1, i)[si] * share(0, j)[sj] * cross;
                second[row][column] += share(0, i)[si] * share(0, j)[sj] * bend1[i][j]
                    + share(1, i)[si] * share(1, j)[sj] * bend2[i][j]
                    + mixed;
                second[column][row] += mixed;
            }
        }
    }
    TurnDerivatives {
        turn: product(&begin.turn, &end.turn),
        first,
        second,
    }
}

fn halves(z: &TurnInputs) -> [Vector3<f64>; 3] {
    SHARES.map(|[a, c]| z.begin * a + z.end * c)
}

/// `Omega(u, v)`.
fn rotation_vector(u: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    let w = u.cross(v);
    u + w * (1.0 / 12.0 + u.norm_squared() / 720.0) - v.cross(&w) / 240.0
}

/// `dOmega / du` and `dOmega / dv`.
fn rotation_jacobians(u: &Vector3<f64>, v: &Vector3<f64>) -> [Matrix3<f64>; 2] {
    let (across_u, across_v) = (u.cross_matrix(), v.cross_matrix());
    let w = u.cross(v);
    let weight = 1.0 / 12.0 + u.norm_squared() / 720.0;
    let by_u = Matrix3::identity() - across_v * weight
        + w * u.transpose() / 360.0
        + across_v * across_v / 240.0;
    let by_v = across_u * weight + (w.cross_matrix() - across_v * across_u) / 240.0;
    [by_u, by_v]
}

impl Half {
    fn of(u: &Vector3<f64>, v: &Vector3<f64>) -> Self {
        let exponential = Exponential::of(&rotation_vector(u, v));
        let by_omega = exponential.jacobian();
        let jacobians = rotation_jacobians(u, v);
        let first = std::array::from_fn(|i| {
            let column = jacobians[i / 3].column(i % 3);
            let mut moved = [0.0; 4];
            for (out, row) in moved.iter_mut().zip(&by_omega) {
                *out = row.dot(&column);
            }
            moved
        });
        Self {
            turn: exponential.turn(),
            first,
        }
    }
}

/// Second derivatives by `(u, v)` of `mu . exp(Omega(u, v))`.
fn curvature(u: &Vector3<f64>, v: &Vector3<f64>, mu: &Quat) -> [[f64; 6]; 6] {
    let exponential = Exponential::of(&rotation_vector(u, v));
    let (gradient, hessian) = exponential.weighted(mu);
    let [by_u, by_v] = rotation_jacobians(u, v);
    let (image_u, image_v) = (hessian * by_u, hessian * by_v);
    let [uu, uv, vv] = rotation_curvature(u, v, &gradient);
    let uu = by_u.tr_mul(&image_u) + uu;
    let uv = by_u.tr_mul(&image_v) + uv;
    let vv = by_v.tr_mul(&image_v) + vv;
    let mut all = [[0.0; 6]; 6];
    for i in 0..3 {
        for j in 0..3 {
            all[i][j] = uu[(i, j)];
            all[i][3 + j] = uv[(i, j)];
            all[3 + j][i] = uv[(i, j)];
            all[3 + i][3 + j] = vv[(i, j)];
        }
    }
    all
}

/// Blocks `uu`, `uv` and `vv` of the second derivative of `g . Omega(u, v)`.
fn rotation_curvature(u: &Vector3<f64>, v: &Vector3<f64>, g: &Vector3<f64>) -> [Matrix3<f64>; 3] {
    let identity = Matrix3::identity();
    let across = g.cross_matrix();
    let (k, l) = (v.cross(g), g.cross(u));
    let volume = u.dot(&k);
    // From |u|^2 g . (u x v) / 720.
    let uu = (identity * volume + u * k.transpose() + k * u.transpose()) / 360.0;
    // From v x (u x v) = u |v|^2 - v (u . v), and from the products g . (u x v).
    let uv = u * l.transpose() / 360.0
        - across * (1.0 / 12.0 + u.norm_squared() / 720.0)
        - (g * v.transpose() * 2.0 - v * g.transpose() - identity * g.dot(v)) / 240.0;
    let vv = (g * u.transpose() + u * g.transpose() - identity * (2.0 * g.dot(u))) / 240.0;
    [uu, uv, vv]
}

/// Terms of the power series below; enough for turns of two radians to the last digit.
const TERMS: usize = 12;

/// `exp(Omega / 2) = (s(x) Omega, c(x))` with `x = |Omega|^2`, `s = sin(sqrt x / 2) / sqrt x` and
/// `c = cos(sqrt x / 2)`; note `c' = -s / 4`.
struct Exponential {
    omega: Vector3<f64>,
    c: f64,
    /// `s` and its first two derivatives by `x`.
    s: [f64; 3],
}

impl Exponential {
    fn of(omega: &Vector3<f64>) -> Self {
        let x = omega.norm_squared();
        let mut s = [0.0; 3];
        let mut c = 0.0;
        // s = sum_k (-x)^k / (2^(2k+1) (2k+1)!), by Horner's rule with its derivatives.
        for k in (0..TERMS).rev() {
            let n = (2 * k) as f64;
            let ratio = -0.25 / ((n + 2.0) * (n + 3.0));
            s[2] = ratio * (x * s[2] + 2.0 * s[1]);
            s[1] = ratio * (x * s[1] + s[0]);
            s[0] = 0.5 + ratio * x * s[0];
            c = 1.0 - 0.25 / ((n + 1.0) * (n + 2.0)) * x * c;
        }
        Self {
            omega: *omega,
            c,
            s,
        }
    }

    fn turn(&self) -> Quat {
        quat(&(self.omega * self.s[0]), self.c)
    }

    /// Rows of the derivative by `Omega`.
    fn jacobian(&self) -> [Vector3<f64>; 4] {
        let [s, slope, _] = self.s;
        std::array::from_fn(|row| {
            if row < 3 {
                self.omega * (2.0 * slope * self.omega[row]) + Vector3::ith(row, s)
            } else {
                self.omega * (-0.5 * s)
            }
        })
    }

    /// Gradient and Hessian by `Omega` of `mu . exp(Omega / 2)`.
    fn weighted(&self, mu: &Quat) -> (Vector3<f64>, Matrix3<f64>) {
        let [s, slope, bend] = self.s;
        let (vector, scalar) = (imaginary(mu), mu[3]);
        let inner = vector.dot(&self.omega);
        let radial = 2.0 * (slope * inner - 0.25 * s * scalar);
        let gradient = vector * s + self.omega * radial;
        let outer = vector * self.omega.transpose();
        let hessian = (outer + outer.transpose()) * (2.0 * slope)
            + Matrix3::identity() * radial
            + self.omega * self.omega.transpose() * (4.0 * (bend * inner - 0.25 * slope * scalar));
        (gradient, hessian)
    }
}
