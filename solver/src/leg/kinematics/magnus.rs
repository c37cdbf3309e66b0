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
    exponential(&rotation_vector(&u, &v))
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
        self.weighted_along(mu, &rotation_jacobians(&self.u, &self.v))
    }

    /// The same with the slopes of the rotation vector.
    fn weighted_along(&self, mu: &Quat, [by_u, by_v]: &[Matrix3<f64>; 2]) -> Weighted {
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

/// The turn with derivatives by `u` and `v`, the second ones weighted by a covector `mu`.
pub(crate) struct BentTurn {
    pub(crate) turn: Quat,
    /// Slopes of the rotation vector by `u` and `v`.
    pub(crate) rotation: [Matrix3<f64>; 2],
    /// Gradient of the weighted turn by `u` and `v`.
    pub(crate) gradient: [Vector3<f64>; 2],
    /// Its blocks `uu`, `uv` and `vv`.
    pub(crate) curvature: [Matrix3<f64>; 3],
    exponential: Exponential,
}

impl BentTurn {
    pub(crate) fn of(u: &Vector3<f64>, v: &Vector3<f64>, mu: &Quat) -> Self {
        let magnus = MagnusTurn::of(u, v);
        let rotation = rotation_jacobians(u, v);
        let weighted = magnus.weighted_along(mu, &rotation);
        Self {
            turn: magnus.turn(),
            rotation,
            gradient: weighted.gradient,
            curvature: weighted.curvature,
            exponential: magnus.exponential,
        }
    }

    /// A linear function of quaternions along the slopes of the turn by the rotation vector, a
    /// column each: the slopes are `s [e_i, 0] + Omega_i radial`.
    pub(crate) fn along(
        &self,
        of_unit: impl Fn(usize) -> Vector3<f64>,
        of_radial: impl FnOnce(&Quat) -> Vector3<f64>,
    ) -> Matrix3<f64> {
        let Exponential { omega, s, .. } = &self.exponential;
        let radial = of_radial(&quat(&(omega * (2.0 * s[1])), -0.5 * s[0]));
        Matrix3::from_columns(&[0, 1, 2].map(|i| of_unit(i) * s[0] + radial * omega[i]))
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
    let w = u.cross(v);
    let weight = 1.0 / 12.0 + u.norm_squared() / 720.0;
    // Products of two cross matrices are [a]x [b]x = b a^T - (a . b) I.
    let by_u = Matrix3::from_diagonal_element(1.0 - v.norm_squared() / 240.0)
        - (v * weight).cross_matrix()
        + w * (u / 360.0).transpose()
        + v * (v / 240.0).transpose();
    let by_v = Matrix3::from_diagonal_element(u.dot(v) / 240.0)
        + (u * weight + w / 240.0).cross_matrix()
        - u * (v / 240.0).transpose();
    [by_u, by_v]
}

/// Blocks `uu`, `uv` and `vv` of the second derivative of `g . Omega(u, v)`.
fn rotation_curvature(u: &Vector3<f64>, v: &Vector3<f64>, g: &Vector3<f64>) -> [Matrix3<f64>; 3] {
    let diagonal = Matrix3::from_diagonal_element;
    let (k, l, m) = (v.cross(g) / 360.0, g.cross(u) / 360.0, g / 240.0);
    // From |u|^2 g . (u x v) / 720.
    let uu = diagonal(u.dot(&k)) + both_products(u, &k);
    // From v x (u x v) = u |v|^2 - v (u . v), and from the products g . (u x v).
    let uv = diagonal(m.dot(v)) + u * l.transpose()
        - (g * (1.0 / 12.0 + u.norm_squared() / 720.0)).cross_matrix()
        - m * (v * 2.0).transpose()
        + v * m.transpose();
    let vv = both_products(&m, u) - diagonal(2.0 * m.dot(u));
    [uu, uv, vv]
}

/// `a b^T + b a^T`.
fn both_products(a: &Vector3<f64>, b: &Vector3<f64>) -> Matrix3<f64> {
    let one = a * b.transpose();
    one + one.transpose()
}

/// Terms of the power series below; enough for turns of two radians to the last digit, and for
/// those of one.
const TERMS: usize = 12;
const SHORT_TERMS: usize = 8;

/// `exp(Omega / 2)`.
fn exponential(omega: &Vector3<f64>) -> Quat {
    let x = omega.norm_squared();
    let (s, c) = if x <= 1.0 {
        values::<SHORT_TERMS>(x)
    } else {
        values::<TERMS>(x)
    };
    quat(&(omega * s), c)
}

/// `s` and `c` of [`Exponential`].
fn values<const TERMS: usize>(x: f64) -> (f64, f64) {
    let (mut s, mut c) = (0.0, 0.0);
    for k in (0..TERMS).rev() {
        let [of_s, of_c] = ratios(k);
        s = 0.5 + of_s * x * s;
        c = 1.0 + of_c * x * c;
    }
    (s, c)
}

/// A term of the series of `s` and of `c` by the one before it, per `x`.
fn ratios(k: usize) -> [f64; 2] {
    let n = (2 * k) as f64;
    [
        -0.25 / ((n + 2.0) * (n + 3.0)),
        -0.25 / ((n + 1.0) * (n + 2.0)),
    ]
}

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
        if omega.norm_squared() <= 1.0 {
            Self::by_series::<SHORT_TERMS>(omega)
        } else {
            Self::by_series::<TERMS>(omega)
        }
    }

    fn by_series<const TERMS: usize>(omega: &Vector3<f64>) -> Self {
        let x = omega.norm_squared();
        let mut s = [0.0; 3];
        let mut c = 0.0;
        // s = sum_k (-x)^k / (2^(2k+1) (2k+1)!), by Horner's rule with its derivatives.
        for k in (0..TERMS).rev() {
            let [of_s, of_c] = ratios(k);
            s[2] = of_s * (x * s[2] + 2.0 * s[1]);
            s[1] = of_s * (x * s[1] + s[0]);
            s[0] = 0.5 + of_s * x * s[0];
            c = 1.0 + of_c * x * c;
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
        // a Omega^T + Omega a^T, of which the last share is half of that of Omega Omega^T.
        let side =
            vector * (2.0 * slope) + self.omega * (2.0 * (bend * inner - 0.25 * slope * scalar));
        let hessian = both_products(&side, &self.omega) + Matrix3::from_diagonal_element(radial);
        (gradient, hessian)
    }
}
