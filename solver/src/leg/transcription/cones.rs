//! Cones: one row for each at every node whose attitude is not given.
//!
//! With the cone's axis `e = R(q)^T s` in body axes the row is
//!
//! ```text
//!   (cos(half angle + reserve) - b . e) / unit >= 0
//! ```
//!
//! for a boresight `b`; a step of the attitude changes `e` as it changes the momentum
//! ([`super::rows`]). In units of the sine of the half angle the row is nearly the angle between
//! boresight and surface there.
//!
//! Nodes alone would let one long interval lead through a cone. So lengths of intervals are limited
//! too, `1 - tau / longest >= 0`, and what the motion enters between nodes becomes a reserve.

use super::rows::{add_attitude_block, double_cross_curvature};
use super::{Transcription, quaternion_of};
use crate::math::quaternion::rotate_back;
use crate::model::cone::ForbiddenCone;
use crate::nlp::LinkModel;
use nalgebra::Vector3;

/// Smallest unit of a row: near the axis of a narrow cone the row is flat, and in the unit of its
/// sine it would be steeper elsewhere than all others.
const MIN_UNIT: f64 = 0.1;

impl Transcription {
    /// Limits the lengths of the intervals, s.
    pub(crate) fn limit_lengths(&mut self, longest: &[f64]) {
        self.longest = longest.iter().map(|l| l / self.scales.time).collect();
    }

    /// The limit of an interval's length, scaled, where there is one.
    pub(crate) fn longest_at(&self, interval: usize) -> Option<f64> {
        self.longest.get(interval).copied()
    }

    /// The cones that have rows at a node: none where the attitude is given, which would leave no
    /// interior on a surface, or an axis is pointed, whose admissible rolls are clear of them.
    pub(super) fn cones_at(&self, node: usize) -> &[ForbiddenCone] {
        if self.nodes[node].attitude.is_some() {
            &[]
        } else {
            &self.dynamics.cones
        }
    }

    /// The rows of a node.
    pub(super) fn cone_margins<'a>(
        &'a self,
        node: usize,
        point: &'a [f64],
    ) -> impl Iterator<Item = f64> + 'a {
        let cones = self.cones_at(node).iter();
        let reserves = self.reserves.of_cones_at(node);
        cones.zip(reserves).map(move |(cone, reserve)| {
            let axis = rotate_back(&quaternion_of(point), &cone.direction);
            ((cone.half_angle + reserve).cos() - cone.axis.dot(&axis)) / unit(cone)
        })
    }

    /// Writes the derivatives of a node's rows, the first of which has this index, and adds their
    /// curvature times minus their multipliers.
    pub(super) fn write_cone_rows(
        &self,
        (node, first): (usize, usize),
        point: &[f64],
        z: &[f64],
        out: &mut LinkModel,
    ) {
        for (i, cone) in self.cones_at(node).iter().enumerate() {
            let axis: Vector3<f64> = rotate_back(&quaternion_of(point), &cone.direction);
            let lever = -cone.axis / unit(cone);
            let slope = lever.cross(&axis) * self.scales.angle;
            let at = (first + i) * out.vars;
            out.inequality_jacobian[at..at + 3].copy_from_slice(slope.as_slice());
            let curvature = double_cross_curvature(&(lever * -z[first + i]), &axis);
            add_attitude_block(out, &(curvature * self.scales.angle.powi(2)));
        }
    }
}

fn unit(cone: &ForbiddenCone) -> f64 {
    cone.half_angle.sin().max(MIN_UNIT)
}
