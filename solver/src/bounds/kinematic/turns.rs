//! Operations on turns, and bounds on their least time that need no search.
//!
//! Rates are normalised to length one, so times are angles.

use super::levels::others;
use crate::math::quaternion::{Quat, product};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// `p v p*` for a unit quaternion.
pub(super) fn rotate(p: &Quat, v: &[f64; 3]) -> [f64; 3] {
    let t = cross(&[p[0], p[1], p[2]], v).map(|t| 2.0 * t);
    let u = cross(&[p[0], p[1], p[2]], &t);
    [0, 1, 2].map(|i| v[i] + p[3] * t[i] + u[i])
}

/// Vector product.
pub(super) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Scalar product.
pub(super) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The turn about a unit axis by an angle.
pub(super) fn about(axis: &[f64; 3], angle: f64) -> Quat {
    let (sin, cos) = (0.5 * angle).sin_cos();
    [axis[0] * sin, axis[1] * sin, axis[2] * sin, cos]
}

/// The rotation vector of a turn, the shorter way round, rad.
pub(super) fn rotation_vector(q: &Quat) -> [f64; 3] {
    let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt();
    // For small turns sin x = x up to rounding.
    let factor = if length < 1e-150 {
        2.0
    } else {
        2.0 * length.atan2(q[3].abs()) / length
    };
    let sign = if q[3] < 0.0 { -factor } else { factor };
    [q[0] * sign, q[1] * sign, q[2] * sign]
}

/// Time of the turn about its own axis: an upper bound.
pub(super) fn eigenaxis_time(q: &Quat, c: &[f64; 3]) -> f64 {
    let x = rotation_vector(q);
    (0..3).fold(0.0, |time, i| f64::max(time, x[i].abs() / c[i]))
}

/// Three turns about body axes `(axis, angle)` whose product is a turn, and their time: the best of
/// the orders `i j i`. When one rate is small this upper bound is far below that of the eigenaxis.
pub(super) fn best_axis_sequence(q: &Quat, c: &[f64; 3]) -> (f64, [(usize, f64); 3]) {
    let mut best = (f64::INFINITY, [(0, 0.0); 3]);
    for i in 0..3 {
        // q = e_i(a) e_j(b) e_i(d): q_w = cos(b/2) cos((a+d)/2), q_i = cos(b/2) sin((a+d)/2),
        // q_j = sin(b/2) cos((a-d)/2), q_k = sense sin(b/2) sin((a-d)/2).
        let (one, other) = others(i);
        let length = |x: f64, y: f64| (x * x + y * y).sqrt();
        let middle = 2.0 * length(q[one], q[other]).atan2(length(q[i], q[3]));
        let sum = 2.0 * q[i].atan2(q[3]);
        for (j, k, sense) in [(one, other, 1.0), (other, one, -1.0)] {
            let difference = 2.0 * (sense * q[k]).atan2(q[j]);
            let (first, last) = (0.5 * (sum + difference), 0.5 * (sum - difference));
            // Adding half a turn to the first and subtracting it from the last reverses the middle
            // one.
            for (shift, turned) in [(0.0, middle), (PI, -middle)] {
                let outer = [wrapped(first + shift), wrapped(last - shift)];
                let time = (outer[0].abs() + outer[1].abs()) / c[i] + middle / c[j];
                if time < best.0 {
                    best = (time, [(i, outer[0]), (j, turned), (i, outer[1])]);
                }
            }
        }
    }
    best
}

/// An angle reduced to `[-pi, pi]`.
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Twist about axis `i` in `[0, 2 pi)`, and swing away from it in `[0, pi]`, rad.
pub(super) fn twist_and_swing(q: &Quat, i: usize) -> (f64, f64) {
    let (j, k) = others(i);
    let twist = (2.0 * q[i].atan2(q[3])).rem_euclid(TAU);
    let swing = 2.0 * q[j].hypot(q[k]).atan2(q[i].hypot(q[3]));
    (twist, swing)
}

/// A lower bound without a search, tight for small turns.
///
/// The twist about `e_i` obeys `twist' = w_i + [w_k (q0 v_j + v_i v_k) + w_j (v_i v_j - q0 v_k)] /
/// (q0^2 + v_i^2) <= c_i + tan(swing / 2) hypot(c_j, c_k)`, and while the motion is at most as long
/// as the eigenaxis turn the swing is at most that time (rates have length one).
pub(super) fn small_angle_bound(q: &Quat, c: &[f64; 3]) -> f64 {
    let half = 0.5 * eigenaxis_time(q, c);
    if half >= 0.95 * FRAC_PI_2 {
        return 0.0;
    }
    let tangent = half.tan();
    (0..3).fold(0.0, |bound, i| {
        let (j, k) = others(i);
        let (twist, _) = twist_and_swing(q, i);
        let twist = twist.min(TAU - twist);
        f64::max(bound, twist / (c[i] + tangent * c[j].hypot(c[k])))
    })
}

/// A lower bound on the time of a turn that needs no search.
pub(super) fn least_time(q: &Quat, c: &[f64; 3]) -> f64 {
    // The rate's length is at most one.
    let angle = 2.0 * (q[0].hypot(q[1]).hypot(q[2])).atan2(q[3].abs());
    angle.max(small_angle_bound(q, c))
}

/// The product `q1 q2 ...` of turns.
pub(super) fn chain<'a>(turns: impl IntoIterator<Item = &'a Quat>) -> Quat {
    turns
        .into_iter()
        .fold([0.0, 0.0, 0.0, 1.0], |all, turn| product(&all, turn))
}
