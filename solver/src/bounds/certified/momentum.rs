//! Bounds with stored momentum.
//!
//! `J w = R^T H - h_locked - sum a_i I_i W_i`: the momentum alone turns the body at the rate
//! `J^-1 R^T H`. With a spherical inertia, `J^-1 = k`, this is the constant rate `k H` in space. So
//! the rate relative to axes that turn with this *drift*,
//!
//! ```text
//!   v = w - k R^T H = J^-1 (- h_locked - sum a_i I_i W_i) + (J^-1 - k) R^T H,
//! ```
//!
//! has a box that the momentum widens only through the difference of the inertia from a sphere:
//! along a direction `d` by `|(J^-1 - k) d| |H|`, as `R^T H` may have any direction. As
//! `(R^T H)' = -w x R^T H` and `J_eff w' = -w x R^T H - A u`,
//!
//! ```text
//!   v' = -J_eff^-1 A u - (J_eff^-1 - k) (w x R^T H),
//! ```
//!
//! whose second term along `d` is at most `|H| max_w |(J_eff^-1 d - k d) x w|`; this is convex in
//! `w`, so its maximum is at a corner of the box of rates. Limits on `w` hold for `v` up to
//! `k |H|`. Rest at an end means `v = -k R^T H`, which is known there. Slews with a drift are
//! bounded in [`crate::bounds::kinematic`]. The tolerances are given away as without momentum. Any
//! `k` is valid. The middle of the eigenvalues of `J^-1` makes the box narrow; zero, with the box of
//! all rates, is better where rates have limits of their own.

use super::{BodyFrame, MISSED_ATTITUDE, exceeded};
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::kinematic::ramps::SlewBound;
use crate::model::attitude::Attitude;
use crate::model::dynamics::{Dynamics, along};
use nalgebra::{Matrix3, Vector3};

#[cfg(test)]
mod tests;

/// Bounds on the slews of a spacecraft with momentum.
#[derive(Debug)]
pub(super) struct MomentumBounds {
    frames: Vec<DriftingFrame>,
}

/// Limits of all motions relative to a drift, with their bound.
#[derive(Debug)]
struct DriftingFrame {
    frame: BodyFrame,
    /// `k`, 1/(kg m²).
    share: f64,
    bound: SlewBound,
}

impl MomentumBounds {
    /// The bounds in some orthonormal frames, given as columns in body axes.
    pub(super) fn of(dynamics: &Dynamics, frames: &[Matrix3<f64>]) -> Self {
        let shares = [0.0, dynamics.mean_inverse_inertia()];
        let all = frames
            .iter()
            .flat_map(|axes| shares.map(|share| (*axes, share)));
        Self {
            frames: all
                .filter_map(|(axes, share)| DriftingFrame::of(dynamics, axes, share))
                .collect(),
        }
    }

    /// The frames whose limits are those of the body rate itself.
    pub(super) fn without_drift(&self) -> impl Iterator<Item = BodyFrame> {
        let without_drift = self.frames.iter().filter(|drifting| drifting.share == 0.0);
        without_drift.map(|drifting| drifting.frame)
    }

    /// Lower bound, s, on the duration of a slew that makes a turn, with the momentum, N m s, and
    /// limits of the rates at its two ends, all in body axes there.
    pub(super) fn leg(
        &self,
        turn: &Attitude,
        held: &[Vector3<f64>; 2],
        ends: &[Vector3<f64>; 2],
        tolerance: f64,
    ) -> Option<f64> {
        self.frames
            .iter()
            .filter_map(|drifting| {
                let DriftingFrame {
                    frame,
                    share,
                    bound,
                } = drifting;
                let drifts = held.map(|held| frame.axes.tr_mul(&held) * *share);
                // Where the attitude is missed by an angle, so is the direction of the drift.
                let turned = drifts[0].norm() * MISSED_ATTITUDE;
                let limits = [0, 1].map(|end| {
                    let most = frame.limits_in_axes(&ends[end]) + drifts[end].abs();
                    most.add_scalar(turned)
                });
                let ends = EndRates {
                    begin_rad_s: limits[0],
                    end_rad_s: limits[1],
                };
                let turn = turn.seen_from(&frame.axes)?;
                Some(bound.drifting_lower_bound_s(&turn, &drifts[0], ends, tolerance))
            })
            .reduce(f64::max)
    }
}

impl DriftingFrame {
    fn of(dynamics: &Dynamics, axes: Matrix3<f64>, share: f64) -> Option<Self> {
        let drift = share * dynamics.momentum.norm();
        let rate = |axis: &Vector3<f64>| {
            dynamics
                .reachable_relative_rate(axis, share)
                .min(dynamics.allowed_rate(axis) + drift)
        };
        let acceleration = |axis: &Vector3<f64>| {
            dynamics.reachable_acceleration(axis) + dynamics.gyroscopic_acceleration(axis, share)
        };
        let limits = exceeded(SlewLimits {
            rates_rad_s: along(&axes, rate),
            accelerations_rad_s2: along(&axes, acceleration),
        });
        Some(Self {
            frame: BodyFrame { axes, limits },
            share,
            bound: SlewBound::new(limits, EndRates::at_rest())?.missing(MISSED_ATTITUDE),
        })
    }
}
