//! The turn with zero momentum by the Magnus expansion: closed form.
//!
//! With the integral `u` of the rate over an interval and its change `v` times the length, the
//! rotation vector of the turn is, to order six,
//!
//! ```text
//!   Omega = u + (1/12 + |u|^2 / 720) u x v - v x (u x v) / 240
//! ```
//!
//! (Blanes, Casas, Oteo and Ros, Phys. Rep. 470, 2009, section 4, for a linear rate that multiplies
//! on the right). With `a` and `c` at the ends, `u = (a + c) / 2` and `v = c - a`.

use super::{INPUTS, TurnDerivatives, TurnInputs};
use crate::math::quaternion::{Quat, imaginary, quat};
use nalgebra::{Matrix3, Vector3};

/// The turn over the interval.
pub(super) fn turn(z: &TurnInputs) -> Quat {
    let (u, v) = integral_and_change(z);
    MagnusTurn::of(&u, &v).turn()
}

/// The turn with derivatives, the second ones weighted by `mu`.
pub(super) fn derivatives(z: &TurnInputs, mu: &Quat) -> TurnDerivatives {
    let (u, v) = integral_and_change(z);
    let magnus = MagnusTurn::of(&u, &v);
    // u = (a + c) / 2 and v = c - a.
    let [by_u, by_v] = magnus.jacobians();
    let [uu, uv, vv] = magnus.weighted(mu).curvature;
    let (quarter, skew, sum) = (uu * 0.25, (uv - uv.transpose()) * 0.5, uv + uv.transpose());
    let even = quarter + vv;
    let blocks = [even - sum * 0.5, quarter - vv + skew, even + sum * 0.5];
    let mut first = [[0.0; 4]; INPUTS];
    let mut second = [[0.0; INPUTS]; INPUTS];
    for j in 0..3 {
        for i in 0..4 {
            first[j][i] = by_u[i][j] * 0.5 - by_v[i][j];
            first[3 + j][i] = by_u[i][j] * 0.5 + by_v[i][j];
        }
        for i in 0..3 {
            second[i][j] = blocks[0][(i, j)];
            second[i][3 + j] = blocks[1][(i, j)];
            second[3 + j][i] = blocks[1][(i, j)];
            second[3 + i][3 + j] = blocks[2][(i, j)];
        }
    }
    TurnDerivatives {
        turn: magnus.turn(),
        first,
        second,
        middle: [Vector3::zeros(); INPUTS],
    }
}

/// The turn as a function of the integral `u` of the rate and of `v`, its change or, where the rate
/// is not linear, twelve times its first moment about the middle.
pub(super) struct MagnusTurn {
    u: Vector3<f64>,
    v: Vector3<f64>,
    exponential: Exponential,
}

/// Derivatives of `mu . turn` by `u` and `v`.
pub(super) struct Weighted {
    pub(super) gradient: [Vector3<f64>; 2],
    /// Blocks `uu`, `uv` and `vv`.
    pub(super) curvature: [Matrix3<f64>; 3],
}

impl MagnusTurn {
    pub(super) fn of(u: &Vector3<f64>, v: &Vector3<f64>) -> Self {
        Self {
            u: *u,
            v: *v,
            exponential: Exponential::of(&rotation_vector(u, v)),
        }
    }

    pub(super) fn turn(&self) -> Quat {
        self.exponential.turn()
    }

    /// Rows of the derivatives by `u` and by `v`.
    pub(super) fn jacobians(&self) -> [[Vector3<f64>; 4]; 2] {
        let rows = self.exponential.jacobian();
        rotation_jacobians(&self.u, &self.v).map(|by| rows.map(|row| by.tr_mul(&row)))
    }

    pub(super) fn weighted(&self, mu: &Quat) -> Weighted {
        let [by_u, by_v] = rotation_jacobians(&self.u, &self.v);
        let (gradient, hessian) = self.exponential.weighted(mu);
        let [uu, uv, vv] = rotation_curvature(&self.u, &self.v, &gradient);
        let (image_u, image_v) = (hessian * by_u, hessian * by_v);
        Weighted {
            gradient: [by_u.tr_mul(&gradient), by_v.tr_mul(&gradient)],
            curvature: [
                by_u.tr_mul(&image_u) + uu,
                by_u.tr_mul(&image_v) + uv,
                by_v.tr_mul(&image_v) + vv,
            ],
        }
    }
}

fn integral_and_change(z: &TurnInputs) -> (Vector3<f64>, Vector3<f64>) {
    ((z.begin + z.end) * 0.5, z.end - z.begin)
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
