//! Quaternions as plain arrays, scalar last, for the inner loops.

use nalgebra::Vector3;

/// A quaternion, scalar last, of any length.
pub(crate) type Quat = [f64; 4];

/// Quaternion product.
pub(crate) fn product(a: &Quat, b: &Quat) -> Quat {
    [
        a[3] * b[0] + b[3] * a[0] + a[1] * b[2] - a[2] * b[1],
        a[3] * b[1] + b[3] * a[1] + a[2] * b[0] - a[0] * b[2],
        a[3] * b[2] + b[3] * a[2] + a[0] * b[1] - a[1] * b[0],
        a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
    ]
}

/// Conjugate quaternion.
pub(crate) fn conjugate(q: &Quat) -> Quat {
    [-q[0], -q[1], -q[2], q[3]]
}

/// Vector part.
pub(crate) fn imaginary(q: &Quat) -> Vector3<f64> {
    Vector3::new(q[0], q[1], q[2])
}

/// Quaternion of a vector part and a scalar.
pub(crate) fn quat(v: &Vector3<f64>, w: f64) -> Quat {
    [v.x, v.y, v.z, w]
}

/// `R(p)^T v`, scaled by `|p|^2`.
pub(crate) fn rotate_back(p: &Quat, v: &Vector3<f64>) -> Vector3<f64> {
    let (u, w) = (imaginary(p), p[3]);
    v * (w * w - u.norm_squared()) + u * (2.0 * u.dot(v)) - u.cross(v) * (2.0 * w)
}

/// `p (x) [v, 0] / 2`.
pub(crate) fn half_product(p: &Quat, v: &Vector3<f64>) -> Quat {
    product(p, &quat(&(v * 0.5), 0.0))
}

/// `to += scale from`.
pub(crate) fn add_scaled(to: &mut Quat, scale: f64, from: &Quat) {
    for (out, value) in to.iter_mut().zip(from) {
        *out += scale * value;
    }
}

/// Scalar product.
pub(crate) fn dot4(a: &Quat, b: &Quat) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}
