//! Attitudes, and the one place where their conventions are fixed.
//!
//! # Conventions
//!
//! * A quaternion is Hamilton's, `w` is its scalar part, and text and arrays put the scalar
//!   **last**: `[x, y, z, w]`.
//! * `q` maps body vectors to reference vectors: `v_ref = q v_body q*`; the columns of its matrix
//!   are the body axes seen in the reference frame.
//! * Kinematics `q' = 1/2 q (x) [w, 0]` with the body rate `w` in body axes, rad/s.
//! * A rotation vector `r` in body axes perturbs on the right: `q exp(r)`.
//! * `q` and `-q` are the same attitude; code for which the sign matters says so.
//!
//! The rest of the crate cites this block.

mod forms;

pub(in crate::model) use forms::{Aim, boresight_axis, pointed};
pub use forms::{AttitudeContext, upward};

use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};

/// A unit quaternion under the [conventions](self) of this module, sign included.
#[derive(Debug, Clone, Copy)]
pub struct Attitude(UnitQuaternion<f64>);

/// Equality of components: unlike in nalgebra, `q` and `-q` are different.
impl PartialEq for Attitude {
    fn eq(&self, other: &Self) -> bool {
        self.0.coords == other.0.coords
    }
}

impl Attitude {
    /// Body axes along the reference axes.
    #[must_use]
    pub fn identity() -> Self {
        Self(UnitQuaternion::identity())
    }

    /// From scalar-last components of any non-zero length; the sign is kept.
    ///
    /// Returns `None` when the length is zero or not finite.
    #[must_use]
    pub fn from_xyzw(components: [f64; 4]) -> Option<Self> {
        let [x, y, z, w] = components;
        let q = Quaternion::new(w, x, y, z);
        let norm = q.norm();
        (norm.is_finite() && norm > 0.0).then(|| Self(Unit::new_unchecked(q / norm)))
    }

    /// From scalar-last components that are already of unit length, bit for bit.
    ///
    /// Returns `None` when they are not, by more than rounding.
    pub(crate) fn from_unit_xyzw(components: [f64; 4]) -> Option<Self> {
        let [x, y, z, w] = components;
        let q = Quaternion::new(w, x, y, z);
        ((q.norm() - 1.0).abs() < 1e-12).then(|| Self(Unit::new_unchecked(q)))
    }

    /// The turn by a rotation vector (axis times angle), rad.
    #[must_use]
    pub fn from_rotation_vector(vector: Vector3<f64>) -> Self {
        Self(UnitQuaternion::from_scaled_axis(vector))
    }

    /// Scalar-last components.
    #[must_use]
    pub fn xyzw(&self) -> [f64; 4] {
        let q = self.0.quaternion();
        [q.i, q.j, q.k, q.w]
    }

    /// The matrix that maps body vectors to reference vectors.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<f64> {
        self.0.to_rotation_matrix().into_inner()
    }

    /// A body vector seen in the reference frame.
    #[must_use]
    pub fn to_reference(&self, body: Vector3<f64>) -> Vector3<f64> {
        self.0 * body
    }

    /// A reference vector seen in body axes.
    #[must_use]
    pub fn to_body(&self, reference: Vector3<f64>) -> Vector3<f64> {
        self.0.inverse_transform_vector(&reference)
    }

    /// The product `self other`: first `other`, then `self`, both as maps of vectors.
    #[must_use]
    pub fn then_in_body(&self, other: &Self) -> Self {
        Self(self.0 * other.0)
    }

    /// The turn from `self` to `other` in body axes of `self`: `self* other`, sign kept.
    #[must_use]
    pub fn turn_to(&self, other: &Self) -> Self {
        Self(self.0.inverse() * other.0)
    }

    /// The same turn with its axis expressed in other axes, orthonormal, given as columns.
    pub(crate) fn seen_from(&self, axes: &Matrix3<f64>) -> Option<Self> {
        let [x, y, z, w] = self.xyzw();
        let [x, y, z] = axes.tr_mul(&Vector3::new(x, y, z)).into();
        Self::from_xyzw([x, y, z, w])
    }

    /// The quaternion with all components negated: the same attitude.
    #[must_use]
    pub fn negated(&self) -> Self {
        Self(Unit::new_unchecked(-self.0.into_inner()))
    }

    /// The one of `q` and `-q` on the hemisphere of `other`.
    #[must_use]
    pub fn nearest_sign(&self, other: &Self) -> Self {
        if self.0.coords.dot(&other.0.coords) < 0.0 {
            self.negated()
        } else {
            *self
        }
    }

    /// Geodesic angle between two attitudes, rad, in `[0, pi]`, whatever their signs.
    #[must_use]
    pub fn angle_to(&self, other: &Self) -> f64 {
        self.nearest_sign(other).signed_turn_to(other).norm()
    }

    /// The rotation vector, rad, of the turn from `self` to `other` in body axes of `self`, along
    /// the quaternion sphere: its length is in `[0, 2 pi]` and exceeds `pi` when the signs differ.
    #[must_use]
    pub fn signed_turn_to(&self, other: &Self) -> Vector3<f64> {
        let relative = self.0.inverse() * other.0;
        let vector = relative.imag();
        let length = vector.norm();
        if length == 0.0 {
            // No turn, or a full one, whose axis is arbitrary.
            return if relative.w >= 0.0 {
                Vector3::zeros()
            } else {
                Vector3::x() * std::f64::consts::TAU
            };
        }
        vector * (2.0 * length.atan2(relative.w) / length)
    }

    /// The retraction of the optimiser: `q exp(r)` for a rotation vector in body axes, rad.
    #[must_use]
    pub fn retract(&self, vector: Vector3<f64>) -> Self {
        // Renormalised, so that long chains of small steps stay on the sphere.
        Self(UnitQuaternion::new_normalize(
            (self.0 * UnitQuaternion::from_scaled_axis(vector)).into_inner(),
        ))
    }
}

#[cfg(test)]
mod tests;
