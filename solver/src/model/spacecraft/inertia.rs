//! The inertia of a rigid body: symmetric, positive definite, with the triangle inequality.

use crate::model::findings::Findings;
use crate::model::problem::Code;
use nalgebra::Matrix3;

/// Difference of mirrored entries, relative to the largest entry, that rounding explains.
const SYMMETRY_TOLERANCE: f64 = 1e-9;
/// Smallest over largest principal moment below which a matrix counts as singular.
const DEFINITENESS_THRESHOLD: f64 = 1e-9;
/// Relative excess of a principal moment over the sum of the others that rounding explains: a flat
/// plate meets the triangle inequality with equality.
const TRIANGLE_TOLERANCE: f64 = 1e-6;

/// Reads a symmetric, positive definite inertia whose principal moments a body can have, with its
/// inverse.
pub(super) fn read(
    rows: &[[f64; 3]; 3],
    pointer: &str,
    findings: &mut Findings,
) -> Option<(Matrix3<f64>, Matrix3<f64>)> {
    let matrix = findings.matrix(pointer, rows)?;
    let symmetric = symmetrised(&matrix, pointer, findings)?;
    let [smallest, middle, largest] = principal_moments(&symmetric);
    let Some(inverse) = positive_definite_inverse(&symmetric) else {
        findings.refuse(
            pointer,
            Code::InertiaNotPositive,
            format!("the principal moments are {smallest}, {middle}, {largest} kg m2"),
            "all principal moments must be above 0; check signs and products of inertia",
        );
        return None;
    };
    if largest > (smallest + middle) * (1.0 + TRIANGLE_TOLERANCE) {
        findings.refuse(
            pointer,
            Code::InertiaTriangle,
            format!(
                "the largest principal moment {largest} kg m2 exceeds the sum of the others, \
                 {smallest} + {middle}"
            ),
            "no rigid body has these moments; check units and the products of inertia",
        );
        return None;
    }
    Some((symmetric, inverse))
}

fn symmetrised(
    matrix: &Matrix3<f64>,
    pointer: &str,
    findings: &mut Findings,
) -> Option<Matrix3<f64>> {
    let difference = matrix - matrix.transpose();
    if difference.amax() <= SYMMETRY_TOLERANCE * matrix.amax() {
        return Some(matrix - difference * 0.5);
    }
    let (i, j) = difference.iamax_full();
    findings.refuse(
        pointer,
        Code::InertiaNotSymmetric,
        format!(
            "entry [{i}][{j}] is {} but [{j}][{i}] is {}",
            matrix[(i, j)],
            matrix[(j, i)]
        ),
        "mirrored entries must be equal: the products of inertia enter with the same sign",
    );
    None
}

/// Eigenvalues of a symmetric matrix in ascending order.
fn principal_moments(matrix: &Matrix3<f64>) -> [f64; 3] {
    let scale = matrix.amax();
    if scale == 0.0 {
        return [0.0; 3];
    }
    // Scaled, so that the squares of extreme entries stay within the number range.
    let mut moments: [f64; 3] = ((matrix / scale).symmetric_eigenvalues() * scale).into();
    moments.sort_by(f64::total_cmp);
    moments
}

/// The inverse of a symmetric matrix, if it is safely positive definite.
pub(super) fn positive_definite_inverse(matrix: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let [smallest, _, largest] = principal_moments(matrix);
    if smallest <= DEFINITENESS_THRESHOLD * largest.abs() {
        return None;
    }
    let scale = matrix.amax();
    (matrix / scale)
        .try_inverse()
        .map(|inverse| inverse / scale)
}
