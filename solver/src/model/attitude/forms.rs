//! The input forms of an attitude.
//!
//! Quaternion, roll-pitch-yaw and modified Rodrigues parameters cover the quaternion sphere twice
//! and keep the sign that they imply; a matrix and right ascension, declination and roll do not,
//! so their quaternion is the one with `w >= 0`.
//!
//! Right ascension and declination point the boresight along
//! `d = (cos dec cos ra, cos dec sin ra, sin dec)`. At roll zero the *upward* body axis, which is
//! body +Z (body +X when the boresight lies along Z) made perpendicular to the boresight, points
//! to local north `(-sin dec cos ra, -sin dec sin ra, cos dec)`, defined at the poles as well.
//! Roll is a right-handed turn about the boresight.

use super::Attitude;
use crate::model::boresights;
use crate::model::findings::{Findings, unit};
use crate::model::problem::{Code, Problem};
use crate::model::spec::{AttitudeEquivalence, AttitudeSpec, BoresightChoice, BoresightSpec};
use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

/// Deviation from a rotation up to which it is attributed to rounding of the text.
const SILENT_DEVIATION: f64 = 1e-6;
/// Deviation from a rotation above which the numbers are no rotation.
const MAX_DEVIATION: f64 = 1e-3;
/// Sine of the angle to body Z below which a boresight lies along it.
const ALONG_Z: f64 = 1e-6;

/// What an input form may refer to.
#[derive(Debug, Clone, Copy)]
pub struct AttitudeContext<'a> {
    /// Whether q and -q are the same attitude.
    pub equivalence: AttitudeEquivalence,
    /// The boresights that the form may name.
    pub boresights: &'a [BoresightSpec],
}

impl Attitude {
    /// Reads an input form without named boresights; returns warnings beside the attitude.
    ///
    /// `pointer` is the JSON pointer of the attitude.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the form.
    pub fn try_new(
        spec: &AttitudeSpec,
        equivalence: AttitudeEquivalence,
        pointer: &str,
    ) -> Result<(Self, Vec<Problem>), Vec<Problem>> {
        let mut findings = Findings::default();
        let context = AttitudeContext {
            equivalence,
            boresights: &[],
        };
        let attitude = Self::read(spec, context, pointer, &mut findings);
        findings.conclude(attitude)
    }

    /// Like [`Attitude::try_new`], for a reader of a larger description.
    pub fn read(
        spec: &AttitudeSpec,
        context: AttitudeContext<'_>,
        pointer: &str,
        findings: &mut Findings,
    ) -> Option<Self> {
        let equivalence = context.equivalence;
        match spec {
            AttitudeSpec::Quaternion(xyzw) => {
                quaternion(*xyzw, &format!("{pointer}/quaternion"), findings)
            }
            AttitudeSpec::RollPitchYawDeg(angles) => findings
                .finite_all(&format!("{pointer}/roll_pitch_yaw_deg"), *angles)
                .map(roll_pitch_yaw),
            AttitudeSpec::Mrp(s) => mrp(*s, &format!("{pointer}/mrp"), findings),
            AttitudeSpec::Matrix(rows) => {
                let pointer = format!("{pointer}/matrix");
                sign_required(equivalence, &pointer, findings);
                matrix(rows, &pointer, findings)
            }
            AttitudeSpec::RaDecRollDeg { angles, boresight } => {
                let angles_pointer = format!("{pointer}/ra_dec_roll_deg");
                sign_required(equivalence, &angles_pointer, findings);
                let angles = sky_angles(*angles, &angles_pointer, findings);
                let pointer = format!("{pointer}/boresight");
                let boresight = boresight_axis(boresight, context.boresights, &pointer, findings);
                Some(ra_dec_roll(angles?, boresight?))
            }
        }
    }
}

/// Right ascension, declination and roll, degrees.
fn sky_angles(angles: [f64; 3], pointer: &str, findings: &mut Findings) -> Option<[f64; 3]> {
    let angles = findings.finite_all(pointer, angles)?;
    let declination = angles[1];
    if declination.abs() <= 90.0 {
        return Some(angles);
    }
    findings.refuse(
        format!("{pointer}/1"),
        Code::OutOfRange,
        format!("the declination is {declination} degrees, it must be from -90 to 90"),
        "write right ascension, declination and roll in this order, all in degrees",
    );
    None
}

/// Unit vector along the body axis that is pointed.
pub(in crate::model) fn boresight_axis(
    choice: &BoresightChoice,
    boresights: &[BoresightSpec],
    pointer: &str,
    findings: &mut Findings,
) -> Option<Vector3<f64>> {
    match choice {
        BoresightChoice::Axis(axis) => findings.direction(pointer, *axis),
        BoresightChoice::Name(name) => {
            let axis = Vector3::from(boresights::find(name, boresights, pointer, findings)?.axis);
            // One without a direction has been refused where it is declared.
            let usable = axis.iter().all(|c| c.is_finite()) && axis.amax() > 0.0;
            usable.then(|| unit(axis))
        }
    }
}

fn sign_required(equivalence: AttitudeEquivalence, pointer: &str, findings: &mut Findings) {
    if equivalence == AttitudeEquivalence::Quaternion {
        findings.refuse(
            pointer,
            Code::SignUndefined,
            "this form does not tell q from -q, but attitude_equivalence is \"quaternion\"",
            "give a quaternion, roll_pitch_yaw_deg or mrp, or use attitude_equivalence \"rotation\"",
        );
    }
}

fn quaternion(xyzw: [f64; 4], pointer: &str, findings: &mut Findings) -> Option<Attitude> {
    let mut finite = true;
    for (name, value) in ["x", "y", "z", "w"].into_iter().zip(xyzw) {
        finite &= findings
            .finite(&format!("{pointer}/{name}"), value)
            .is_some();
    }
    if !finite {
        return None;
    }
    let norm = xyzw.iter().map(|c| c * c).sum::<f64>().sqrt();
    let deviation = (norm - 1.0).abs();
    if deviation > MAX_DEVIATION {
        findings.refuse(
            pointer,
            Code::QuaternionNorm,
            format!("the norm is {norm}, it must be 1 within {MAX_DEVIATION:e}"),
            "divide the components by the norm; x, y, z is the vector part and w the scalar part",
        );
        return None;
    }
    if deviation > SILENT_DEVIATION {
        findings.warn(
            pointer,
            Code::AttitudeNormalized,
            format!("the norm is {norm}; the quaternion has been normalised"),
            "give the components with at least seven digits",
        );
    }
    Attitude::from_xyzw(xyzw)
}

/// Yaw about z, then pitch about y, then roll about x, as a product of half angles: an angle
/// beyond half a turn changes the sign of the quaternion.
fn roll_pitch_yaw(angles_deg: [f64; 3]) -> Attitude {
    let [roll, pitch, yaw] = angles_deg;
    let product = turn(Vector3::z(), yaw) * turn(Vector3::y(), pitch) * turn(Vector3::x(), roll);
    Attitude(UnitQuaternion::new_normalize(product.into_inner()))
}

/// The turn about a unit axis by an angle in degrees, not wrapped.
fn turn(axis: Vector3<f64>, angle_deg: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = (0.5 * angle_deg.to_radians()).sin_cos();
    Unit::new_unchecked(Quaternion::from_parts(cos, axis * sin))
}

fn mrp(s: [f64; 3], pointer: &str, findings: &mut Findings) -> Option<Attitude> {
    let s = findings.vector(pointer, s)?;
    let squared = s.norm_squared();
    if !squared.is_finite() {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!(
                "the largest component is {:e}, too large to be squared",
                s.amax()
            ),
            "lengths above 1 are turns beyond 180 degrees; use the shadow set -s/|s|^2",
        );
        return None;
    }
    let v = s * (2.0 / (1.0 + squared));
    Attitude::from_xyzw([v.x, v.y, v.z, (1.0 - squared) / (1.0 + squared)])
}

fn matrix(rows: &[[f64; 3]; 3], pointer: &str, findings: &mut Findings) -> Option<Attitude> {
    let matrix = findings.matrix(pointer, rows)?;
    let deviation = (matrix.transpose() * matrix - Matrix3::identity()).amax();
    let determinant = matrix.determinant();
    // Written so that an overflow to NaN is refused as well.
    if !(deviation <= MAX_DEVIATION && determinant > 0.0) {
        findings.refuse(
            pointer,
            Code::MatrixNotRotation,
            format!(
                "the columns are off orthonormal by {deviation:.3e} (allowed {MAX_DEVIATION:e}) \
                 and the determinant is {determinant:.6} (must be +1)"
            ),
            "give rows of the matrix whose columns are the body axes in the reference frame",
        );
        return None;
    }
    if deviation > SILENT_DEVIATION {
        findings.warn(
            pointer,
            Code::AttitudeNormalized,
            format!(
                "the columns are off orthonormal by {deviation:.3e}; the nearest rotation is used"
            ),
            "give the entries with at least seven digits",
        );
    }
    Some(without_sign(nearest_rotation(matrix)))
}

/// The rotation nearest to a matrix with a positive determinant: its orthogonal polar factor.
fn nearest_rotation(matrix: Matrix3<f64>) -> Rotation3<f64> {
    let svd = matrix.svd_unordered(true, true);
    let (u, v_t) = svd.u.zip(svd.v_t).expect("both factors were asked for");
    Rotation3::from_matrix_unchecked(u * v_t)
}

fn ra_dec_roll(angles_deg: [f64; 3], boresight: Vector3<f64>) -> Attitude {
    let [ra, dec, roll] = angles_deg;
    let level = level(sky_direction([ra, dec]), boresight);
    without_sign((level * turn(boresight, roll)).to_rotation_matrix())
}

/// A direction of the sky with local north there, both of unit length.
type SkyDirection = [Vector3<f64>; 2];

/// The direction at a right ascension and declination, degrees.
fn sky_direction([ra, dec]: [f64; 2]) -> SkyDirection {
    let (sin_ra, cos_ra) = ra.to_radians().sin_cos();
    let (sin_dec, cos_dec) = dec.to_radians().sin_cos();
    let direction = Vector3::new(cos_dec * cos_ra, cos_dec * sin_ra, sin_dec);
    let north = Vector3::new(-sin_dec * cos_ra, -sin_dec * sin_ra, cos_dec);
    [direction, north]
}

/// The attitude of roll 0.
fn level([direction, north]: SkyDirection, boresight: Vector3<f64>) -> UnitQuaternion<f64> {
    let up = upward(boresight);
    let in_reference = Matrix3::from_columns(&[direction, north, direction.cross(&north)]);
    let in_body = Matrix3::from_columns(&[boresight, up, boresight.cross(&up)]);
    let level = Rotation3::from_matrix_unchecked(in_reference * in_body.transpose());
    UnitQuaternion::from_rotation_matrix(&level)
}

/// Where a boresight is pointed.
#[derive(Debug, Clone, Copy)]
pub(in crate::model) enum Aim {
    /// At a right ascension and declination, degrees.
    RaDecDeg([f64; 2]),
    /// Along a unit vector of the reference frame; at the poles of right ascension 0.
    Direction(Vector3<f64>),
}

/// The attitude of roll 0 at which a unit vector of the body is pointed.
pub(in crate::model) fn pointed(aim: Aim, boresight: Vector3<f64>) -> Attitude {
    let sky = match aim {
        Aim::RaDecDeg(angles) => sky_direction(angles),
        Aim::Direction(direction) => {
            let level = direction.xy().norm();
            let (cos_ra, sin_ra) = if level > 0.0 {
                (direction.x / level, direction.y / level)
            } else {
                (1.0, 0.0)
            };
            let north = Vector3::new(-direction.z * cos_ra, -direction.z * sin_ra, level);
            [direction, north]
        }
    };
    without_sign(level(sky, boresight).to_rotation_matrix())
}

/// The unit vector of the body that points to local north at roll zero, of a unit boresight.
#[must_use]
pub fn upward(boresight: Vector3<f64>) -> Vector3<f64> {
    let along_z = boresight.xy().norm() < ALONG_Z;
    let axis = if along_z { Vector3::x() } else { Vector3::z() };
    unit(axis - boresight * boresight.dot(&axis))
}

fn without_sign(rotation: Rotation3<f64>) -> Attitude {
    let attitude = Attitude(UnitQuaternion::new_normalize(
        UnitQuaternion::from_rotation_matrix(&rotation).into_inner(),
    ));
    attitude.nearest_sign(&Attitude::identity())
}
