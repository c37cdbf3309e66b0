//! Axes of wheels: whether they span space, and the pseudo-inverse that allocates a vector to them.
//!
//! The pseudo-inverse `A^+` has the axes, as they are given, as columns of `A`. Of all amounts that
//! add up to a vector it gives those with the least sum of squares. It differs from that of the
//! unit axes with rows divided by lengths: of two parallel wheels the one with the longer axis gets
//! more.

use crate::model::findings::{Findings, unit};
use crate::model::problem::Code;
use nalgebra::{DMatrix, Matrix3, Vector3};
use std::ops::RangeInclusive;

/// Smallest over largest singular value of the unit axes below which they lie in a plane.
const COPLANARITY_THRESHOLD: f64 = 1e-6;
/// Allowed lengths of axes that are not normalised. Wheel momenta and torques grow with the
/// reciprocal: far outside, squares of momenta and durations would leave the number range.
const LENGTHS: RangeInclusive<f64> = 1e-3..=1e3;

/// Reads an axis that is not normalised: not zero, and within the allowed lengths.
pub(crate) fn read(
    pointer: &str,
    values: [f64; 3],
    findings: &mut Findings,
) -> Option<Vector3<f64>> {
    let axis = findings.nonzero(pointer, values)?;
    let length = length(&axis);
    if LENGTHS.contains(&length) {
        return Some(axis);
    }
    findings.refuse(
        pointer,
        Code::OutOfRange,
        format!("the axis enters as given and is {length:e} long"),
        format!(
            "give an axis between {} and {} long, or let it be scaled to unit length",
            LENGTHS.start(),
            LENGTHS.end()
        ),
    );
    None
}

/// Smallest and largest singular value of the unit axes.
pub(crate) fn singular_values(axes: &[Vector3<f64>]) -> (f64, f64) {
    let units: Vec<_> = axes.iter().map(|axis| unit(*axis)).collect();
    // Fewer than three axes are padded with columns of zeros, so that a singular value is zero.
    let columns = units.len().max(3);
    let matrix = DMatrix::from_fn(3, columns, |i, j| units.get(j).map_or(0.0, |unit| unit[i]));
    let values = matrix.singular_values();
    (values.min(), values.max())
}

/// `A^+`, K x 3, of axes that are not zero; `None` when they lie in a plane.
///
/// With `A P = Q R`, columns in order of the length that they add, the rows of `R = D R'` are of
/// very different size when the axes are, but `R'`, divided by the pivots, is always well
/// conditioned: `A^+ = P R'^T (R' R'^T)^-1 D^-1 Q^T`, where `A^T (A A^T)^-1` would square the
/// lengths.
pub(crate) fn pseudo_inverse(axes: &[Vector3<f64>]) -> Option<DMatrix<f64>> {
    let (least, greatest) = singular_values(axes);
    if least < COPLANARITY_THRESHOLD * greatest || greatest == 0.0 {
        return None;
    }
    let mut rest = axes.to_vec();
    let mut base: Vec<Vector3<f64>> = Vec::with_capacity(3);
    let mut pivots = Vector3::zeros();
    // P R'^T.
    let mut shares = DMatrix::zeros(axes.len(), 3);
    for row in 0..3 {
        let (pivot, longest) = first_longest(&rest)?;
        let direction = perpendicular(unit(rest[longest]), &base);
        for (j, rest) in rest.iter_mut().enumerate() {
            let along = direction.dot(rest);
            shares[(j, row)] = along / pivot;
            *rest -= direction * along;
        }
        rest[longest] = Vector3::zeros();
        pivots[row] = pivot;
        base.push(direction);
    }
    let gram = shares.tr_mul(&shares).fixed_view::<3, 3>(0, 0).into_owned();
    let scaled = Matrix3::from_fn(|row, column| base[row][column] / pivots[row]);
    let inverse = shares * (gram.try_inverse()? * scaled);
    Some(DMatrix::from_fn(axes.len(), 3, |i, j| inverse[(i, j)]))
}

/// Greatest ratio of an amount to its limit, given as pairs of a least and a greatest amount; at
/// most one within the limits.
pub(crate) fn greatest_share<'a>(
    limits: impl Iterator<Item = (f64, f64)>,
    amounts: impl IntoIterator<Item = &'a f64>,
) -> f64 {
    limits
        .zip(amounts)
        .map(|((least, most), x)| x / if *x < 0.0 { least } else { most })
        .fold(0.0, f64::max)
}

/// The length of a vector of any representable length.
fn length(vector: &Vector3<f64>) -> f64 {
    let scale = vector.amax();
    if scale > 0.0 {
        scale * (vector / scale).norm()
    } else {
        0.0
    }
}

/// Length and position of the first of the longest vectors; `None` when all are zero.
fn first_longest(vectors: &[Vector3<f64>]) -> Option<(f64, usize)> {
    let mut longest = None;
    let mut most = 0.0;
    for (i, vector) in vectors.iter().enumerate() {
        let length = length(vector);
        if length > most {
            (most, longest) = (length, Some((length, i)));
        }
    }
    longest
}

/// A unit vector that is nearly perpendicular to a base, made exactly so. Two projections suffice.
fn perpendicular(mut vector: Vector3<f64>, base: &[Vector3<f64>]) -> Vector3<f64> {
    for _ in 0..2 {
        for other in base {
            vector -= other * other.dot(&vector);
        }
        vector.normalize_mut();
    }
    vector
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::SplitMix;

    fn columns(axes: &[Vector3<f64>]) -> DMatrix<f64> {
        DMatrix::from_fn(3, axes.len(), |i, j| axes[j][i])
    }

    fn random_axes(count: usize, random: &mut SplitMix) -> Vec<Vector3<f64>> {
        (0..count)
            .map(|_| unit(Vector3::from_fn(|_, _| random.normal())))
            .collect()
    }

    #[test]
    fn the_pseudo_inverse_meets_the_conditions_of_penrose() {
        let mut random = SplitMix::new(1);
        for count in [3, 4, 5, 17] {
            for spread in [0.0, 1.0, 3.0] {
                let mut axes = random_axes(count, &mut random);
                for axis in &mut axes {
                    *axis *= 10_f64.powf(spread * (random.below(2001) as f64 / 1000.0 - 1.0));
                }
                let Some(inverse) = pseudo_inverse(&axes) else {
                    panic!("random axes span space");
                };
                // Penrose's conditions, each in its own scale.
                let matrix = columns(&axes);
                let unity = &matrix * &inverse;
                assert!((unity - DMatrix::identity(3, 3)).amax() < 1e-9, "{axes:?}");
                let projector = &inverse * &matrix;
                assert!(
                    (&projector - projector.transpose()).amax() < 1e-9,
                    "{axes:?}"
                );
                assert!((&projector * &projector - &projector).amax() < 1e-9);
                if spread == 0.0 {
                    let usual = matrix.pseudo_inverse(0.0).expect("full rank");
                    assert!((usual - inverse).amax() < 1e-11);
                }
            }
        }
    }

    #[test]
    fn axes_of_the_body_are_inverted_exactly_at_any_length() {
        for lengths in [
            [1.0; 3],
            [1e-170, 1.0, 1e170],
            [1e-300; 3],
            [1e300, 1e-5, 1e7],
        ] {
            let axes: Vec<_> = (0..3).map(|i| Vector3::ith(i, lengths[i])).collect();
            let inverse = pseudo_inverse(&axes);
            let expected =
                DMatrix::from_fn(3, 3, |i, j| if i == j { 1.0 / lengths[i] } else { 0.0 });
            assert_eq!(inverse, Some(expected), "{lengths:?}");
        }
    }

    #[test]
    fn of_parallel_wheels_the_one_with_the_longer_axis_gets_more() {
        let axes = [Vector3::x(), Vector3::x() * 2.0, Vector3::y(), Vector3::z()];
        let inverse = pseudo_inverse(&axes).expect("they span space");
        // x = (1, 2) / 5 makes 1 with the least sum of squares.
        assert!((inverse[(0, 0)] - 0.2).abs() < 1e-15);
        assert!((inverse[(1, 0)] - 0.4).abs() < 1e-15);
    }

    #[test]
    fn axes_in_a_plane_have_no_inverse() {
        let flat = [Vector3::x(), Vector3::y(), Vector3::new(0.6, 0.8, 1e-7)];
        for few in [&flat[..], &flat[..2], &[]] {
            assert!(pseudo_inverse(few).is_none());
        }
    }

    #[test]
    fn lengths_outside_the_range_are_refused() {
        for (length, accepted) in [
            (1.0, true),
            (1e-2, true),
            (1e2, true),
            (1e-4, false),
            (1e-170, false),
            (1e5, false),
            (1e300, false),
        ] {
            let mut findings = Findings::default();
            let axis = read("/axis", [0.6 * length, 0.0, 0.8 * length], &mut findings);
            assert_eq!(axis.is_some(), accepted, "{length}");
        }
    }
}
