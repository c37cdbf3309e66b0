//! Extremals of a polytope of rates, followed step by step without its level curves.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// Tolerance for a point on the border of a half-space.
const ON_BORDER: f64 = 1e-9;
/// A switch that is nearer, rad, is the one just made.
const JUST_MADE: f64 = 1e-9;

/// The vertices of `{w : |f . w| <= 1}`, rad/s: where three borders meet within all of them.
#[must_use]
pub fn vertices(half_spaces: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let borders: Vec<_> = half_spaces.iter().flat_map(|f| [*f, -f]).collect();
    let mut found: Vec<Vector3<f64>> = Vec::new();
    for i in 0..borders.len() {
        for j in 0..i {
            for k in 0..j {
                let rows = [borders[i], borders[j], borders[k]].map(|f| f.transpose());
                let Some(inverse) = Matrix3::from_rows(&rows).try_inverse() else {
                    continue;
                };
                let point = inverse * Vector3::repeat(1.0);
                let within = borders.iter().all(|f| f.dot(&point) <= 1.0 + ON_BORDER);
                let is_new = found.iter().all(|known| (known - point).norm() > ON_BORDER);
                if within && is_new {
                    found.push(point);
                }
            }
        }
    }
    found
}

/// The turn of the extremal that begins with a costate, after a duration, s: the rate is the vertex that maximises its
/// product with the costate, until another one does.
///
/// # Panics
///
/// Without vertices.
#[must_use]
pub fn extremal(
    vertices: &[Vector3<f64>],
    mut costate: Vector3<f64>,
    duration: f64,
) -> UnitQuaternion<f64> {
    let mut turn = UnitQuaternion::identity();
    let mut left = duration;
    let product = |costate: &Vector3<f64>, at: usize| costate.dot(&vertices[at]);
    let best = |a: &usize, b: &usize| product(&costate, *a).total_cmp(&product(&costate, *b));
    let mut at = (0..vertices.len())
        .max_by(best)
        .expect("a polytope has vertices");
    while left > 0.0 {
        let rate = vertices[at];
        let next = (0..vertices.len())
            .filter(|other| *other != at)
            .filter_map(|other| Some((passed(&costate, &rate, &vertices[other])?, other)))
            .min_by(|one, other| one.0.total_cmp(&other.0));
        let (angle, other) = next.unwrap_or((f64::INFINITY, at));
        let time = (angle / rate.norm()).min(left);
        let arc = UnitQuaternion::from_scaled_axis(rate * time);
        turn *= arc;
        costate = arc.inverse() * costate;
        left -= time;
        at = other;
    }
    UnitQuaternion::new_normalize(turn.into_inner())
}

/// The angle after which another vertex is as good, while the costate turns back about the rate.
fn passed(costate: &Vector3<f64>, rate: &Vector3<f64>, other: &Vector3<f64>) -> Option<f64> {
    let axis = rate.normalize();
    let gain = other - rate;
    // costate(a) = along + cos a across - sin a (axis x across)
    let along = axis * axis.dot(costate);
    let across = costate - along;
    let constant = gain.dot(&along);
    let (cos, sin) = (gain.dot(&across), -gain.dot(&axis.cross(&across)));
    let amplitude = cos.hypot(sin);
    let share = -constant / amplitude;
    if share.is_nan() || share.abs() > 1.0 {
        return None;
    }
    // It becomes better where the sum rises through zero.
    let angle = (sin.atan2(cos) - share.acos()).rem_euclid(TAU);
    Some(if angle < JUST_MADE {
        angle + TAU
    } else {
        angle
    })
}
