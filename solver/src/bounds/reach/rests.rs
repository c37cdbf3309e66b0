//! Rests of vectors that are turned together with them.
//!
//! A rest that stays a box along fixed axes grows with every turn of what it belongs to, and a costate near a minimum of
//! the level turns around it for a long time. So rests are put into the last three symbols of the forms, whose slopes
//! are the edges of a parallelepiped, and which every operation carries along.

use super::form::{VectorForm, each};
use nalgebra::{Matrix3, Vector3};

/// Relative error allowed for the rounding of a few operations.
const ROUNDING: f64 = 1e-14;
/// Share by which the edges of a parallelepiped may become longer in one step.
const LONGER: f64 = 0.2;

/// Puts the rests of a vector into its last three symbols, so that they are turned with it from now on.
pub(super) fn fold(v: &mut VectorForm) {
    let rests = each(|i| v[i].rest);
    let known = Matrix3::from_fn(|i, k| v[i].slopes[3 + k]);
    let kept = in_parallelepiped(&known, rests).unwrap_or_else(|| in_box(&known, rests));
    for i in 0..3 {
        for k in 0..3 {
            v[i].slopes[3 + k] = kept[(i, k)];
        }
        // Edges of other lengths have slightly other directions.
        v[i].rest = ROUNDING * kept.row(i).abs().sum();
    }
}

/// A longer parallelepiped that contains a given one and a box around each of its points; `None` where it would be
/// much longer.
fn in_parallelepiped(known: &Matrix3<f64>, rests: [f64; 3]) -> Option<Matrix3<f64>> {
    let inverse = known.try_inverse()?;
    // x = B^-1 r is C r + (1 - C B) x with the computed inverse C.
    let off = (Matrix3::identity() - inverse * known).abs();
    let off = off.row_sum().max().max(off.column_sum().max()) * 3.0
        + 1e-9
        + ROUNDING * (inverse.abs() * known.abs()).max();
    if off.is_nan() || off >= 1e-3 {
        return None;
    }
    let shares = inverse.abs() * Vector3::from(rests);
    let longer = shares.add_scalar(shares.max() * off * 1.01) * (1.0 + 1e-9);
    if longer.iter().any(|x| x.is_nan() || *x >= LONGER) {
        return None;
    }
    let mut kept = *known;
    for k in 0..3 {
        let factor = 1.0 + longer[k];
        kept.column_mut(k)
            .iter_mut()
            .for_each(|x| *x *= factor * (1.0 + 1e-14));
    }
    Some(kept)
}

/// A box along the longest edge of a parallelepiped that contains it, and a box around each of its points.
fn in_box(known: &Matrix3<f64>, rests: [f64; 3]) -> Matrix3<f64> {
    let mut order = [0, 1, 2];
    order.sort_by(|i, j| known.column(*j).norm().total_cmp(&known.column(*i).norm()));
    let sorted = Matrix3::from_fn(|i, k| known[(i, order[k])]);
    let mut q = sorted.qr().q();
    if !q.iter().all(|x| x.is_finite()) || (q.transpose() * q - Matrix3::identity()).amax() > 1e-12
    {
        q = Matrix3::identity();
    }
    let within = (q.transpose() * known).abs();
    let around = q.transpose().abs() * Vector3::from(rests);
    let extents = Vector3::from_fn(|k, _| within.row(k).sum() + around[k]);
    let mut kept = q;
    for k in 0..3 {
        // The axes are orthonormal to 1e-12.
        let extent = extents[k] * (1.0 + 1e-9) + 1e-10 * extents.max() + 1e-300;
        kept.column_mut(k).iter_mut().for_each(|x| *x *= extent);
    }
    kept
}
