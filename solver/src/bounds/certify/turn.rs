//! Turns as quaternions of intervals, scalar last.

use crate::bounds::interval::Interval;
use nalgebra::Vector3;

/// A quaternion of intervals, scalar last.
pub(super) type QuatInterval = [Interval; 4];
/// A vector of intervals.
pub(super) type VectorInterval = [Interval; 3];

pub(super) const IDENTITY: QuatInterval = [
    Interval::ZERO,
    Interval::ZERO,
    Interval::ZERO,
    Interval::ONE,
];

/// Hamilton's product.
pub(super) fn product(a: &QuatInterval, b: &QuatInterval) -> QuatInterval {
    let [ax, ay, az, aw] = *a;
    let [bx, by, bz, bw] = *b;
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// The product with a vector on the right.
pub(super) fn times_vector(a: &QuatInterval, b: &VectorInterval) -> QuatInterval {
    let [ax, ay, az, aw] = *a;
    let [bx, by, bz] = *b;
    [
        aw * bx + ay * bz - az * by,
        aw * by - ax * bz + az * bx,
        aw * bz + ax * by - ay * bx,
        -(ax * bx + ay * by + az * bz),
    ]
}

pub(super) fn conjugate(q: &QuatInterval) -> QuatInterval {
    [-q[0], -q[1], -q[2], q[3]]
}

pub(super) fn sum(a: &QuatInterval, b: &QuatInterval) -> QuatInterval {
    [0, 1, 2, 3].map(|i| a[i] + b[i])
}

pub(super) fn scaled(a: &QuatInterval, factor: Interval) -> QuatInterval {
    a.map(|x| x * factor)
}

/// Scalar product of two quaternions.
pub(super) fn dot4(a: &QuatInterval, b: &QuatInterval) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Scalar product of two vectors.
pub(super) fn dot(a: &VectorInterval, b: &VectorInterval) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vector of ordinary numbers.
pub(super) fn of_numbers(v: &Vector3<f64>) -> VectorInterval {
    [v.x, v.y, v.z].map(Interval::exactly)
}

/// Difference of two vectors.
pub(super) fn minus(a: &VectorInterval, b: &VectorInterval) -> VectorInterval {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// Vector product.
pub(super) fn cross(a: &VectorInterval, b: &VectorInterval) -> VectorInterval {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// The vector of length one in a direction; `None` where the vector may be zero.
pub(super) fn unit(v: &VectorInterval) -> Option<VectorInterval> {
    let length = v[0].length(v[1]).length(v[2]);
    (length.low > 0.0).then(|| v.map(|x| x / length))
}

/// The turn about a vector of unit length by an angle.
pub(super) fn about(axis: &VectorInterval, angle: Interval) -> QuatInterval {
    let (sin, cos) = angle.half().sin_cos();
    [axis[0] * sin, axis[1] * sin, axis[2] * sin, cos]
}

/// `q v q*`.
pub(super) fn rotate(q: &QuatInterval, v: &VectorInterval) -> VectorInterval {
    let [x, y, z, _] = product(&times_vector(q, v), &conjugate(q));
    [x, y, z]
}

/// Angle of a turn, the shorter way round.
pub(super) fn angle_of(q: &QuatInterval) -> Interval {
    let vector = q[0].length(q[1]).length(q[2]);
    // Both components are not negative, so the angle is within [0, pi / 2].
    let angle = Interval::angle(vector, q[3].abs()).twice();
    Interval {
        low: angle.low.max(0.0),
        high: angle.high.min(Interval::PI.high),
    }
}

/// Swing of a turn away from a body axis of length one, in `[0, pi]`.
pub(super) fn swing(q: &QuatInterval, axis: &VectorInterval) -> Interval {
    let vector = [q[0], q[1], q[2]];
    let [x, y, z] = cross(&vector, axis);
    Interval::angle(x.length(y).length(z), dot(&vector, axis).length(q[3])).twice()
}

/// Twist of a turn about a body axis of length one, modulo a full turn.
pub(super) fn twist(q: &QuatInterval, axis: &VectorInterval) -> Interval {
    Interval::angle(dot(&[q[0], q[1], q[2]], axis), q[3]).twice()
}

/// The least angle in `[0, 2 pi)` that equals an angle of the interval modulo a full turn, rounded
/// down.
pub(super) fn least_turn(angle: Interval) -> f64 {
    let full = Interval::PI.twice();
    let turns = (angle.low / full.low).floor();
    let low = (Interval::exactly(angle.low) - full * Interval::exactly(turns)).low;
    let high = (Interval::exactly(angle.high) - full * Interval::exactly(turns)).high;
    // An angle just below a full turn may be zero within its error.
    if high >= full.low { 0.0 } else { low.max(0.0) }
}
