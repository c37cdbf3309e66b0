//! The conditions on the attitude at a waypoint.
//!
//! With `r = target* q`, signed such that its scalar part is positive, they are rows `c . 2 vec(r)`. Three
//! of them, along the body axes, fix the attitude: `2 vec(r) = 0`. Where only the axis `b` is pointed,
//! two across it do, since `vec(r)` is along `b` then, and `q = target exp(roll b)`: of a boresight off
//! by an angle `o` their norm is `2 sin(o / 2)`, which has no other zero. A limited roll adds two
//! inequalities: around the middle of its range, of half width `l`,
//!
//! ```text
//!   2 sin(l / 2) -+ b . 2 vec(r) >= 0
//! ```
//!
//! Both signs of a quaternion meet these. A step `d` of the attitude enters `r` as `(d / 2, 1 - |d|^2 / 8)`
//! from the right.

use super::rows::add_attitude_block;
use super::{Transcription, Waypoint, attitude_link, quaternion_of};
use crate::math::quaternion::{Quat, conjugate, imaginary, product, quat};
use crate::model::roll::RollArcs;
use crate::nlp::LinkModel;
use nalgebra::{Matrix3, Vector3};

/// Rows on the attitude at a node.
#[derive(Debug, Clone)]
pub(super) struct AttitudeRows {
    target: Quat,
    /// Directions whose components vanish.
    fixed: Vec<Vector3<f64>>,
    /// The pointed axis, and what its component may be at most, where the roll is limited.
    limited: Option<(Vector3<f64>, f64)>,
}

impl AttitudeRows {
    pub(super) fn of(waypoint: &Waypoint) -> Self {
        let Some(roll) = &waypoint.roll else {
            return Self {
                target: waypoint.attitude.xyzw(),
                fixed: Vec::from([0, 1, 2].map(|axis| Vector3::ith(axis, 1.0))),
                limited: None,
            };
        };
        let arc = roll.own();
        let middle = arc.map_or(0.0, |[least, greatest]| 0.5 * (least + greatest));
        let limited = arc.map(|[least, greatest]| {
            let half_width = 0.5 * (greatest - least);
            (roll.axis, 2.0 * (0.5 * half_width).sin())
        });
        Self {
            target: roll.rolled(&waypoint.attitude, middle).xyzw(),
            fixed: across(roll).into(),
            limited,
        }
    }

    /// Number of conditions that hold exactly.
    pub(super) fn equalities(&self) -> usize {
        self.fixed.len()
    }

    /// Number of inequalities.
    pub(super) fn inequalities(&self) -> usize {
        if self.limited.is_some() { 2 } else { 0 }
    }

    /// Whether the attitude is given.
    pub(super) fn is_fixed(&self) -> bool {
        self.fixed.len() == 3
    }

    /// `2 vec(target* q)`. Of a given attitude it is NaN on the far hemisphere, where its norm decreases
    /// again.
    fn error(&self, q: &Quat) -> Vector3<f64> {
        let relative = product(&conjugate(&self.target), q);
        if self.is_fixed() {
            attitude_link::chart(&relative)
        } else {
            imaginary(&relative) * 2.0
        }
    }
}

/// Two directions that complete the pointed axis to an orthonormal frame.
fn across(roll: &RollArcs) -> [Vector3<f64>; 2] {
    let least = roll.axis.iamin();
    let one = roll.axis.cross(&Vector3::ith(least, 1.0)).normalize();
    [one, roll.axis.cross(&one)]
}

impl Transcription {
    /// Writes the values of the equalities of a node's attitude, and returns how many; then those of
    /// the inequalities.
    pub(super) fn write_attitude_values(
        &self,
        rows: &AttitudeRows,
        point: &[f64],
        (equality, inequality): (&mut [f64], &mut [f64]),
    ) {
        let error = rows.error(&quaternion_of(point));
        for (out, direction) in equality.iter_mut().zip(&rows.fixed) {
            *out = direction.dot(&error) / self.scales.angle;
        }
        if let Some((axis, most)) = &rows.limited {
            let along = axis.dot(&error);
            inequality[0] = (most - along) / self.scales.angle;
            inequality[1] = (most + along) / self.scales.angle;
        }
    }

    /// Writes the derivatives of the equalities by so many directions of a state.
    pub(super) fn write_attitude_equalities(
        &self,
        rows: &AttitudeRows,
        point: &[f64],
        (nu, states): (&[f64], usize),
        out: &mut LinkModel,
    ) {
        let relative = product(&conjugate(&rows.target), &quaternion_of(point));
        let slope = slope_of(&relative);
        let mut pull = Vector3::zeros();
        for (row, (direction, nu)) in rows.fixed.iter().zip(nu).enumerate() {
            let gradient = slope.tr_mul(direction);
            out.equality_jacobian[row * states..][..3].copy_from_slice(gradient.as_slice());
            pull += direction * *nu;
        }
        self.add_bend(&pull, &relative, out);
    }

    /// Writes the derivatives of the inequalities, the first of which has this index, and adds their
    /// curvature times minus their multipliers.
    pub(super) fn write_roll_limits(
        &self,
        rows: &AttitudeRows,
        point: &[f64],
        (first, z): (usize, &[f64]),
        out: &mut LinkModel,
    ) {
        let Some((axis, _)) = &rows.limited else {
            return;
        };
        let relative = product(&conjugate(&rows.target), &quaternion_of(point));
        let gradient = slope_of(&relative).tr_mul(axis);
        for (row, sign) in [(first, -1.0), (first + 1, 1.0)] {
            let at = row * out.vars;
            out.inequality_jacobian[at..at + 3].copy_from_slice((gradient * sign).as_slice());
        }
        self.add_bend(&(axis * (z[first] - z[first + 1])), &relative, out);
    }

    /// Adds the curvature of `pull . 2 vec(r) / angle`.
    fn add_bend(&self, pull: &Vector3<f64>, relative: &Quat, out: &mut LinkModel) {
        let weight = pull * (2.0 / self.scales.angle);
        let bend = -0.25 * self.scales.angle.powi(2) * weight.dot(&imaginary(relative));
        add_attitude_block(out, &(Matrix3::identity() * bend));
    }
}

/// Derivative of `2 vec(r)` by the step; the unit of the step cancels that of the rows.
fn slope_of(relative: &Quat) -> Matrix3<f64> {
    let column = |axis| imaginary(&product(relative, &quat(&Vector3::ith(axis, 1.0), 0.0)));
    Matrix3::from_columns(&[0, 1, 2].map(column))
}
